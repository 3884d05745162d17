#pragma once
/// \file
/// Packings of disks and of spheres written by other programs.

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// What a column (or a constant) holds.
enum class SizeMeaning { radius, diameter };

/// A statement of the user on the sizes: it wins over the names in the file.
struct SizeStatement {
    SizeMeaning meaning = SizeMeaning::radius;
    std::string column; ///< name of the column that holds it; empty: every disk has `value`
    double value = 0;   ///< when `column` is empty
    std::vector<std::pair<std::string, double>> of_word{}; ///< not empty: the sizes of the words that the column holds
};

/// The rows that have one of these words in a column.
struct RowsWith {
    std::string column;
    std::vector<std::string> words;
};

/// Which walls a foreign packing gets; their positions are the bounds of the box.
/// - `none`; - `box`: the lower ones fixed, the upper ones movable, as in the paper (as many more degrees of freedom as
///   there are axes); - `square`: the size of the box alone moves, written as the last upper wall: where all forces are
///   positive they are the same up to a factor, and so are N_f, h and k (as for `Cell::keeps_shape`); - `fixed`: all
///   fixed.
enum class ForeignWalls { none, box, square, fixed };

/// What the file does not say, stated by the user. Nothing of it is guessed.
struct ForeignOptions {
    std::string format; ///< a name of `foreign_formats()`, or empty: recognised from the content
    std::optional<SizeStatement> size;
    ForeignWalls walls = ForeignWalls::none;
    bool walls_unless_periodic = false; ///< `walls` are for packings without a periodic axis
    /// Disks or spheres; none: disks where all z are the same (to 2^-27 of the smallest radius, as no gap is another
    /// double then) or the file has none, else spheres.
    std::optional<int> dimension;
    /// Empty, or xlo, xhi, ylo, yhi (of spheres: zlo, zhi too) instead of the bounds in the file; with `periodic`, of a
    /// file without bounds, the periods.
    std::vector<double> box;
    /// Empty, or the cell of a file without one: its lengths, and then its tilts where there are some; or, of disks 4
    /// and of spheres 9 numbers, its period vectors, one after another.
    std::vector<double> lattice;
    std::optional<long> frame;        ///< of a file with several, from 0; the last one otherwise
    std::vector<std::string> columns; ///< in place of the names in the file; "-" is a column to leave out
    long skip = 0;                    ///< lines before the rows of a table that are passed over
    std::string style;                ///< atom style of a LAMMPS data file, in place of the one that it names
    std::string plane = "xy";         ///< of disks: or "xz", "yz"
    std::optional<long> first_id;     ///< the rows have the ids from this one on, whatever the file says
    std::optional<RowsWith> select;   ///< these rows are the disks
    std::optional<RowsWith> fixed;    ///< these disks cannot move
    /// The column that says which rows are members of one rigid body; "none": no column. Not stated: body, clump or
    /// clumpId (YADE) where there is one.
    std::string bodies;
    bool cells = false;        ///< periodic boundaries make a cell; else they are refused
    bool periodic = false;     ///< boundaries that the file leaves open are periodic
    bool not_periodic = false; ///< boundaries that the file calls periodic (or does not deny to be) are open
};

struct ForeignPacking {
    Packing packing;       ///< grains in the order of the file; with walls, shifted so that the lower ones are at 0
    std::string format;    ///< a name of `foreign_formats()`
    std::vector<long> ids; ///< those of the file, one per disk; none: it has no column of them
    /// So far may the gap of a pair be from that of the packing that was written: by the last digits of the file (half
    /// a unit; numbers of at most four digits, and sides and sizes of fewer than others have, are taken as they stand),
    /// by doubles, by scaling, shifting and turning. Stated sizes and walls are taken to the doubles.
    double rounding = 0;
    /// What was done to the numbers and what the file left open, one sentence each: which column gave the size, whether
    /// scaled or shifted coordinates were rounded and by how much, boundaries that are not known, several types of
    /// which every one was taken for disks.
    std::vector<std::string> notes;
};

/// "lammps-data", "lammps-dump", "xyz", "table", "braces", "centres".
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
///   Diameter; others are ignored. A first row is of names when none of its fields is a value (begins like a number, or
///   is nan, inf, NA, null, none); every other row is a disk. Where `columns` are stated too, a note says so. A comment
///   `# box 0:4,0:2, tilt 0.5, periodic along xy`, as `csv_text` writes it, is the box. Comments begin with # or %.
/// - `braces`: `N = 2 ,L1= { 4 , 0 } ,L2= { 0.5 , 2 }`, then rows `x , y , r ,` between braces (jambashbulk).
/// - `centres`: the dimension (2 or 3), the number of grains, their diameter, each in a row; then rows of centres
///   (CALiPPSO, Lubachevsky-Stillinger), or the period vectors, one a row, and then the centres (TJ).
///
/// Rows with the same number above 0 in the column of bodies become members of one body (`Packing::bars`, of the places
/// as they are read); a number that one row has, 0 and -1 are those of single grains. In a cell the members are put
/// together, each at its image next to the first one, which is
/// at most 3/8 of a period away along each axis.
///
/// Period vectors that are not upper triangular are turned. A single sphere, or a layer of them with the same z, is one
/// of disks unless `dimension` says otherwise. A column whose name comes twice is read where its values agree.
///
/// A byte order mark is skipped. The exponent of a number may be written with D (Fortran); nan and inf are refused.
///
/// Throws `Error(bad_input)` with file, line, value and what was expected: also for sizes whose meaning nobody stated,
/// periodic boundaries unless `cells`, tilted boxes that are not periodic, disks with different z, ids given twice,
/// more or fewer rows than announced, bodies that bars cannot make rigid, disks with their centre outside the walls.
/// Overlaps are not looked at.
ForeignPacking parse_foreign(const std::string& text, const std::string& source, const ForeignOptions& options);

/// The same from a file.
ForeignPacking read_foreign(const std::filesystem::path& path, const ForeignOptions& options);

/// The texts that other programs read, every number in the shortest form that gives the same double back: a LAMMPS
/// data file (atom style sphere, ids from 1, density 1); one frame of extended XYZ (OVITO), with `displacement` (d n
/// numbers, or none) as a column; rows id, x, y, r under a header (CSV, ids from 0). The box is that of the walls, or
/// the cell: with its tilt, `pbc` in XYZ, and in LAMMPS data the disks moved into it, with image flags (LAMMPS wants
/// them there; the moves are exact on the grid). Contacts and loads have no place there.
std::string lammps_data_text(const Packing& packing, const std::string& title);
std::string xyz_text(const Packing& packing, const std::vector<double>& displacement,
                     std::span<const int> contacts = {});
std::string csv_text(const Packing& packing, std::span<const int> contacts = {});

} // namespace isostat
