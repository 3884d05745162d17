#pragma once
/// \file
/// Shared by the readers of foreign formats: named columns, the raw packing, walls and cells around its grains.

#include "io/lines.hpp"
#include "io/numbers.hpp"

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

/// The box of a file, for three axes if the file has them: the rows decide whether these are disks or spheres.
struct Bounds {
    std::optional<PerAxis<std::array<double, 2>>> box; ///< low and high
    PerTilt<double> tilt{};                            ///< A_ab, a < b
    /// The period vectors if they are not as `box` and `tilt` say, so that they have to be rotated.
    std::optional<PerAxis<PerAxis<double>>> vectors;
    PerAxis<Boundary> boundary{Boundary::unknown, Boundary::unknown, Boundary::unknown};
    PerAxis<bool> loose{}; ///< the bounds only follow the disks: no walls there
    PerAxis<Digits> sides; ///< digits of box and tilts; for disks in the first two axes
    std::string place;     ///< where the file says so: the beginning of a message
    /// Makes these the vectors of the cell, with this origin.
    void take_vectors(const PerAxis<PerAxis<double>>& periods, const PerAxis<double>& origin);
    /// The period vectors of x and y are not in the plane of x and y, or that of z is not normal to it.
    [[nodiscard]] bool leaves_the_plane() const;
};

/// Whether period vectors are written as the cell is. \p d: the number of axes that count.
bool are_upper(const PerAxis<PerAxis<double>>& vectors, std::size_t d);

/// A tilt xy, xz or yz of LAMMPS, in a field of the line.
void take_tilt(const TextLine& line, std::size_t field, std::size_t tilt, Bounds& bounds);
/// A period vector, in the first three fields of the line.
void take_vector(const TextLine& line, PerAxis<double>& vector, Bounds& bounds);

/// The header of a frame, before its rows.
struct FrameHeader : Bounds {
    long timestep = 0;
    long rows = -1;
    int line = 0; ///< line of the names
    std::vector<std::string> names;
};

/// The header of a LAMMPS dump, up to the names of the columns. \p item: "ATOMS" or "ENTRIES".
FrameHeader read_dump_header(TextLines& lines, const std::string& item);
/// The header of extended XYZ: `comment` is the line of key=value. Vectors are named name.0, name.1, ...
FrameHeader read_xyz_header(const TextLine& comment, long rows);
/// Its key Timestep, if it has one.
std::optional<long> xyz_timestep(const TextLine& comment, const std::string& source);

/// The result of a reader, before walls and checks.
struct Raw : Bounds {
    std::optional<int> dimension; ///< where the format states it
    bool has_z = false;
    std::vector<PerAxis<double>> centre;
    std::vector<double> size;
    std::vector<int> line; ///< of each disk
    std::vector<long> ids; ///< one per disk, or empty
    SizeMeaning meaning = SizeMeaning::radius;
    std::vector<std::string> notes;
    PerAxis<Digits> places;           ///< digits of coordinates
    Digits sizes;                     ///< of radii or diameters
    bool scaled = false;              ///< coordinates are in units of the box
    std::string types;                ///< empty, or a note: the types in the file, all of which are taken for disks
    std::vector<unsigned char> fixed; ///< one per disk, or empty
    std::vector<long> bodies;         ///< one per disk, or empty
};

/// The meaning of columns.
struct Columns {
    PerAxis<int> at{-1, -1, -1}; ///< x, y, z; -1: absent
    int id = -1, size = -1;
    SizeMeaning meaning = SizeMeaning::radius;
    std::string size_name; ///< empty: a constant
    double constant = 0;
    std::vector<std::pair<std::string, double>> size_of; ///< not empty: sizes of the words in column `size`
    int select = -1; ///< rows with a word of `selected` in this column are disks; -1: every row is one
    std::vector<std::string> selected;
    int fix = -1; ///< disks with a word of `fixed` in this column cannot move
    std::vector<std::string> fixed;
    int body = -1;                         ///< the body of each row
    bool are_molecules = false;            ///< `body` was not stated and its name is one for molecules: for a note
    std::optional<long> first_id;          ///< id of the first row; the column of ids is then not read
    int type = -1;                         ///< its values are counted, for a note
    std::vector<std::string> names;        ///< of all columns
    std::vector<std::pair<int, int>> same; ///< columns with one name: their values must agree
};

/// The columns by their names, which are the stated ones if there are any.
/// Throws when coordinates, a stated column, or the size (stated by the user,
/// or in a column with a known name) are missing; `where` starts the message.
Columns find_columns(const std::vector<std::string>& names, const ForeignOptions& options, const std::string& where,
                     Raw& raw);

std::string lower(std::string_view text);

/// Throws when two columns have one name; "" names none.
void refuse_twice(const std::vector<std::string>& names, const std::string& where);

/// The first column `name`, or -1.
int find_column(const std::vector<std::string>& names, std::string_view name);
/// Pairs of columns with the same name; "" names none.
std::vector<std::pair<int, int>> columns_twice(const std::vector<std::string>& names);
/// Throws when such columns of a row have different words.
void require_same(const std::vector<std::pair<int, int>>& twice, const std::vector<std::string>& names,
                  const TextLine& row);

/// Adds selected rows to a raw packing; finds ids given twice.
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

/// Makes the bodies: members are in a cell beside the first one, with bars from
/// their positions. Throws where images cannot be told apart, or where the digits
/// cannot tell the members of a body from points on one line. \pre `out.rounding`
void add_bodies(ForeignPacking& out, const std::vector<long>& ids, const std::string& source);

/// Finds the frame that the options name, or the last one. \p head
/// reads the header of a frame; messages call its rows `row`.
struct ChosenFrame {
    long number = 0;
    FrameHeader header;
    TextLines rows;
    const char* row;
    /// Adds the rows of the frame to a raw packing.
    void read(Columns columns, Raw& raw);
};
ChosenFrame choose_frame(const std::string& text, const std::string& source, const ForeignOptions& options,
                         const char* row, const std::function<FrameHeader(TextLines&)>& head);

/// Names of the columns of a table: from the comments at its start, or the row of names; reads up to the first row.
struct TableNames {
    std::vector<std::string> names;
    int line = 0; ///< line of the names; 0: no line has them
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

/// A format by its name for options and messages, and its reader.
struct Format {
    std::string_view name;
    Raw (*read)(const std::string& text, const std::string& source, const ForeignOptions& options);
};
inline constexpr std::array formats{Format{"lammps-data", read_lammps_data},
                                    Format{"lammps-dump", read_lammps_dump},
                                    Format{"xyz", read_xyz},
                                    Format{"table", read_table},
                                    Format{"braces", read_braces},
                                    Format{"centres", read_centres}};

/// Combines in `raw` the statements of file and user on bounds and periodic axes. A stated box that is the cell is
/// removed from `options`. Throws where the statements contradict each other, and for unsupported boundaries.
void settle_bounds(Raw& raw, std::size_t axes, const std::string& source, ForeignOptions& options);

/// Adds the walls, or the cell with the grains in it. Returns the largest rounding of a coordinate. \pre settled
double add_box(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options);

} // namespace isostat::foreign
