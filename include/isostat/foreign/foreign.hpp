#pragma once
/// \file
/// Packings of disks and of spheres written by other programs.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// Whether a column (or a constant) holds radii or diameters.
enum class SizeMeaning { radius, diameter };

/// What the user says of the sizes; it takes precedence over the names in the file.
struct SizeStatement {
    SizeMeaning meaning = SizeMeaning::radius;
    std::string column; ///< name of the column with the sizes; empty: every disk has `value`
    double value = 0;   ///< used when `column` is empty
    std::vector<std::pair<std::string, double>> of_word{}; ///< the sizes of the words in the column, if it holds words
};

/// The rows that have one of these words in a column.
struct RowsWith {
    std::string column;
    std::vector<std::string> words;
};

/// Which walls a foreign packing gets; their positions are the bounds of the box. -
/// `none`; - `box`: lower walls fixed, upper ones movable, as in the paper (one more
/// degree of freedom per axis); - `square`: only the size of the box moves, written as
/// the last upper wall: where all forces are positive, this changes all by one factor
/// and changes no N_f, h or k (as `Cell::keeps_shape`); - `fixed`: all walls are fixed.
enum class ForeignWalls { none, box, square, fixed };
inline constexpr auto foreign_walls_words = words_of<ForeignWalls>("none", "box", "square", "fixed");

/// What the file does not say, stated by the user. The reader guesses none of these.
struct ForeignOptions {
    std::string format{}; ///< a name of `foreign_formats()`, or empty: recognised from the content
    std::optional<SizeStatement> size{};
    ForeignWalls walls = ForeignWalls::none;
    bool walls_unless_periodic = false; ///< `walls` apply only to packings without a periodic axis
    /// Disks or spheres; absent: disks when all z are the same (to 2^-27 of the smallest radius, below which no gap
    /// changes as a double) or the file has no z, else spheres.
    std::optional<int> dimension{};
    /// Empty, or xlo, xhi, ylo, yhi (for spheres also zlo, zhi) instead of the bounds in the file; with `periodic`, the
    /// periods of a file without bounds.
    std::vector<double> box{};
    /// Empty, or the cell of a file that has none: its lengths, then its tilts if any; or its period vectors one after
    /// another, 4 numbers for disks, 9 for spheres.
    std::vector<double> lattice{};
    std::optional<long> frame{};        ///< frame of a file with several, from 0; absent: the last frame
    std::vector<std::string> columns{}; ///< names that replace those in the file; "-" leaves a column out
    long skip = 0;                      ///< number of lines skipped before the rows of a table
    std::string style{};                ///< atom style of a LAMMPS data file, instead of the style that the file names
    std::string plane = "xy";           ///< plane of disks: also "xz", "yz"
    std::optional<long> first_id{};     ///< the rows get ids from this one on, whatever the file says
    std::optional<RowsWith> select{};   ///< only these rows are disks
    std::optional<RowsWith> fixed{};    ///< these disks cannot move
    /// The column that says which rows are members of one rigid body; "none": no column. Empty: body, clump or clumpId
    /// (YADE) where the file has one.
    std::string bodies{};
    bool cells = false;        ///< periodic boundaries make a cell; else they are refused
    bool periodic = false;     ///< boundaries that the file leaves open are periodic
    bool not_periodic = false; ///< boundaries that the file calls periodic (or does not deny to be) are open
};

struct ForeignPacking {
    Packing packing;       ///< grains in the order of the file; with walls, shifted so that the lower ones are at 0
    std::string format;    ///< a name of `foreign_formats()`
    std::vector<long> ids; ///< ids in the file, one per disk; empty: the file has no column of ids
    /// Bound of the difference between a gap here and in the packing that was written: by the last digits of the file
    /// (half a unit; numbers of at most four digits, and sides and sizes with fewer digits than others, count as
    /// exact), by doubles, by scaling, shifting and turning. Stated sizes and walls are exact up to doubles.
    double rounding = 0;
    /// What was done to the numbers and what the file left open, one sentence each:
    /// which column gave the size, by how much scaled or shifted coordinates were
    /// rounded, unknown boundaries, several types that were all taken for disks.
    std::vector<std::string> notes;
};

/// The names of the formats that `parse_foreign` reads.
const std::vector<std::string>& foreign_formats();

/// Reads a packing from text. Numbers are rounded to the nearest double.
///
/// - `lammps-data`: the atom styles sphere and bpm/sphere, with a *diameter* by definition; atomic, charge, bond,
///   angle, molecular and full, with a stated size; hybrid of these.
/// - `lammps-dump`: text; `x y`, `xu yu` (unwrapped) or scaled `xs ys`, `xsu ysu`; the columns `radius` or `diameter`.
/// - `xyz`: extended XYZ, `Properties=` with `pos` and `radius` or `diameter`; `Lattice`, `Origin`, `pbc` (a lattice
///   without `pbc` is periodic by the convention of the format). Plain XYZ with a stated size.
/// - `table`: rows of numbers separated by blanks, commas, semicolons or tabs, under a header: a first row of names, a
///   comment `# x y r`, `#format x_y_z_r`, or `columns`. Names: x, y, z, id; r, R, radius, Radius; d, D, diameter,
///   Diameter; others are ignored. A first row has names when none of its fields is a value (begins like a number, or
///   is nan, inf, NA, null, none); every other row is a disk. If `columns` are stated too, a note says so. A comment `#
///   box 0:4,0:2, tilt 0.5, periodic along xy`, as `csv_text` writes it, is the box. Comments begin with # or %.
/// - `braces`: `N = 2 ,L1= { 4 , 0 } ,L2= { 0.5 , 2 }`, then rows `x , y , r ,` between braces (jambashbulk).
/// - `centres`: the dimension (2 or 3), the number of grains, their diameter, each in its own row; then rows of centres
///   (CALiPPSO, Lubachevsky-Stillinger), or one period vector per row, and then the centres (TJ).
///
/// Rows with the same positive number in the column of bodies become members of one
/// body (`Packing::bars`, from the positions as read); a number of only one row, 0
/// and -1 belong to single grains. In a cell each member is put at its image next
/// to the first member, which is at most 3/8 of a period away along each axis.
///
/// Period vectors that are not upper triangular are rotated. A single sphere, or a layer of spheres with the same z, is
/// read as disks unless `dimension` is stated. A column whose name comes twice is read if its values agree.
///
/// A byte order mark is skipped. The exponent of a number may be written with D (Fortran); nan and inf are refused.
///
/// Throws `Error(bad_input)` with file, line, value and what was expected: also for sizes of
/// unstated meaning, periodic boundaries unless `cells`, tilted boxes that are not periodic,
/// disks with different z, ids given twice, more or fewer rows than announced, bodies that bars
/// cannot make rigid, disks with their centre outside the walls. Overlaps are not checked.
ForeignPacking parse_foreign(const std::string& text, const std::string& source, const ForeignOptions& options);

/// `parse_foreign` on the content of a file.
ForeignPacking read_foreign(const std::filesystem::path& path, const ForeignOptions& options);

/// The texts that other programs read, every number in the shortest form that gives the same double back: a LAMMPS data
/// file (atom style sphere, ids from 1, density 1); one frame of extended XYZ (OVITO), with `displacement` (d n
/// numbers, or empty) as a column; rows id, x, y, r under a header (CSV, ids from 0). The box is that of the walls, or
/// the cell with its tilt: `pbc` in XYZ; in LAMMPS data the disks are moved into the cell, with image flags, because
/// LAMMPS requires this (the moves are exact on the grid). These formats have no contacts and no loads.
std::string lammps_data_text(const Packing& packing, const std::string& title);
std::string xyz_text(const Packing& packing, const std::vector<double>& displacement,
                     std::span<const int> contacts = {});
std::string csv_text(const Packing& packing, std::span<const int> contacts = {});

} // namespace isostat
