#pragma once
// What the readers of foreign formats share: named columns, the raw packing.

#include "io/digits.hpp"
#include "io/lines.hpp"

#include <isostat/foreign/foreign.hpp>

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isostat::foreign {

constexpr long most_disks = 100'000'000;

enum class Boundary { open, periodic, unknown };

/// Of three axes where the file has them: whether it holds disks or spheres is known when its rows are.
struct Bounds {
    std::optional<PerAxis<std::array<double, 2>>> box; ///< low and high
    PerTilt<double> tilt{};                            ///< A_ab, a < b
    /// The period vectors where they are not as `box` and `tilt` say: these are then to be turned.
    std::optional<PerAxis<PerAxis<double>>> vectors;
    PerAxis<Boundary> boundary{Boundary::unknown, Boundary::unknown, Boundary::unknown};
    PerAxis<bool> loose{}; ///< the bounds only follow the disks: no walls there
    PerAxis<Digits> sides; ///< of box and tilts; those of a packing of disks are in the first two
    std::string place;     ///< what says so: the begin of a message
    /// The cell has these vectors, from here.
    void take_vectors(const PerAxis<PerAxis<double>>& periods, const PerAxis<double>& origin);
    /// The period vectors of x and y are not in the plane of x and y, or that of z is not normal to it.
    [[nodiscard]] bool leaves_the_plane() const;
};

/// Whether period vectors are written as the cell is. \p d: so many axes of them count.
bool are_upper(const PerAxis<PerAxis<double>>& vectors, std::size_t d);

/// A tilt xy, xz or yz of LAMMPS, in a field of the line.
void take_tilt(const TextLine& line, std::size_t field, std::size_t tilt, Bounds& bounds);
/// A period vector, in the first three fields of the line.
void take_vector(const TextLine& line, PerAxis<double>& vector, Bounds& bounds);

/// What stands before the rows of a frame.
struct FrameHeader : Bounds {
    long timestep = 0;
    long rows = -1;
    int line = 0; ///< of the names
    std::vector<std::string> names;
};

/// Of a LAMMPS dump, up to the names of the columns. \p item: "ATOMS" or "ENTRIES".
FrameHeader read_dump_header(TextLines& lines, const std::string& item);
/// Of extended XYZ: `comment` is the line of key=value. Vectors are named name.0, name.1, ...
FrameHeader read_xyz_header(const TextLine& comment, long rows);
/// Its key Timestep, if it has one.
std::optional<long> xyz_timestep(const TextLine& comment, const std::string& source);

/// What a reader found, before walls and checks.
struct Raw : Bounds {
    std::optional<int> dimension; ///< where the format states it
    bool has_z = false;
    std::vector<PerAxis<double>> centre;
    std::vector<double> size;
    std::vector<int> line; ///< of each disk
    std::vector<long> ids; ///< one per disk, or none
    SizeMeaning meaning = SizeMeaning::radius;
    std::vector<std::string> notes;
    PerAxis<Digits> places;           ///< digits of coordinates
    Digits sizes;                     ///< of radii or diameters
    bool scaled = false;              ///< coordinates are in units of the box
    std::string types;                ///< empty, or which there are, and that all are taken for disks; a note too
    std::vector<unsigned char> fixed; ///< one per disk, or none
    std::vector<long> bodies;         ///< one per disk, or none
};

/// Which columns hold what.
struct Columns {
    PerAxis<int> at{-1, -1, -1}; ///< x, y, z; -1: not there
    int id = -1, size = -1;
    SizeMeaning meaning = SizeMeaning::radius;
    std::string size_name; ///< empty: a constant
    double constant = 0;
    std::vector<std::pair<std::string, double>> size_of; ///< not empty: of the words in column `size`
    int select = -1; ///< rows with a word of `selected` there are disks; -1: every row is one
    std::vector<std::string> selected;
    int fix = -1; ///< disks with a word of `fixed` there cannot move
    std::vector<std::string> fixed;
    int body = -1;                         ///< which rows are one rigid body
    bool are_molecules = false;            ///< `body` was not stated and its name is that of molecules: for a note
    std::optional<long> first_id;          ///< of the first row; the column of ids is not read then
    int type = -1;                         ///< counted, for a note
    std::vector<std::string> names;        ///< of all columns
    std::vector<std::pair<int, int>> same; ///< columns of one name: their values must agree
};

/// By the names, which are those that the user stated where there are any. Throws when coordinates, what a statement
/// speaks of, or the size (from the statement of the user, or from one of the names that state it) are not there;
/// `where` starts the message.
Columns find_columns(const std::vector<std::string>& names, const ForeignOptions& options, const std::string& where,
                     Raw& raw);

std::string lower(std::string_view text);

/// Throws when two columns have one name; "" names none.
void refuse_twice(const std::vector<std::string>& names, const std::string& where);

/// The first column `name`, or -1.
int find_column(const std::vector<std::string>& names, std::string_view name);
/// Pairs of columns with the same name; "" names none.
std::vector<std::pair<int, int>> columns_twice(const std::vector<std::string>& names);
/// Throws where a row has not the same words in such columns.
void require_same(const std::vector<std::pair<int, int>>& twice, const std::vector<std::string>& names,
                  const TextLine& row);

/// Adds the rows that are selected to a raw packing; finds ids given twice.
class Rows {
  public:
    Rows(Columns columns, std::string source) : columns_(std::move(columns)), source_(std::move(source)) {}
    void add(const TextLine& line, Raw& raw);
    /// Throws when an id was given twice, or no row is selected. Several types are noted.
    void finish(Raw& raw);
    [[nodiscard]] long seen() const { return seen_; }

  private:
    [[nodiscard]] double size_of_word(const TextLine& line, const std::string& name) const;
    Columns columns_;
    std::string source_;
    std::vector<std::pair<long, int>> ids_; ///< with their lines
    std::map<std::string, int, std::less<>> types_;
    long seen_ = 0; ///< rows
};

/// The rows with the same number above 0, ascending; bodies of more than one.
std::vector<std::vector<int>> bodies_of(const std::vector<long>& ids);

/// They become members of one body, in a cell beside the first of them, with bars of the
/// places that they have. Throws where images are not told apart, or the members from such on one line by the digits.
/// \pre `out.rounding`
void add_bodies(ForeignPacking& out, const std::vector<long>& ids, const std::string& source);

/// The frame that is asked for, the last one where none is. \p head takes what stands before the rows of a frame, which
/// messages call `row`.
struct ChosenFrame {
    long number = 0;
    FrameHeader header;
    TextLines rows;
    const char* row;
    /// Adds them to a raw packing.
    void read(Columns columns, Raw& raw);
};
ChosenFrame choose_frame(const std::string& text, const std::string& source, const ForeignOptions& options,
                         const char* row, const std::function<FrameHeader(TextLines&)>& head);

/// Names of the columns of a table: from the comments at its start, or the row of names; reads up to the first row.
struct TableNames {
    std::vector<std::string> names;
    int line = 0; ///< 0: no line names them
    char separator = ' ';
};
/// \p any: a comment may name other columns than x and y, as many as the first row has.
TableNames read_table_names(TextLines& lines, const ForeignOptions& options, Raw& raw, bool any = false);

Raw read_lammps_data(const std::string& text, const std::string& source, const ForeignOptions& options);
Raw read_lammps_dump(const std::string& text, const std::string& source, const ForeignOptions& options);
Raw read_xyz(const std::string& text, const std::string& source, const ForeignOptions& options);
Raw read_table(const std::string& text, const std::string& source, const ForeignOptions& options);
Raw read_braces(const std::string& text, const std::string& source, const ForeignOptions& options);
Raw read_centres(const std::string& text, const std::string& source, const ForeignOptions& options);

} // namespace isostat::foreign
