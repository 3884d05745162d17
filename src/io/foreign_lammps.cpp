// LAMMPS: data files (atom_style sphere) and text dumps.
#include "io/foreign_source.hpp"
#include "io/numbers.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

namespace isostat::foreign {

namespace {

std::string_view without_comment(std::string_view line) {
    return without_blanks(line.substr(0, line.find('#')));
}

std::string comment_of(std::string_view line) {
    const std::size_t at = line.find('#');
    return at == std::string_view::npos ? "" : std::string(without_blanks(line.substr(at + 1)));
}

/// `names`: "|one|two|".
bool is_among(std::string_view names, const std::string& name) {
    return name.find('|') == std::string::npos && names.find("|" + name + "|") != std::string_view::npos;
}

/// Sections that may stand beside Atoms; all of them are skipped.
bool is_section(const std::string& name) {
    constexpr std::string_view names = "|Velocities|Masses|Ellipsoids|Lines|Triangles|Bodies|Bonds|Angles|Dihedrals|"
                                       "Impropers|Atom Type Labels|";
    return is_among(names, name) || name.ends_with(" Coeffs") || name.ends_with(" Labels");
}

/// "12 atoms", "0 1 xlo xhi": the numbers and the words after them.
struct HeaderLine {
    TextLine line;
    std::size_t numbers = 0;
    std::string keyword;
    explicit HeaderLine(TextLine l) : line(std::move(l)) {
        while (numbers < line.size() && finite_number(line.field(numbers))) {
            ++numbers;
        }
        for (std::size_t k = numbers; k < line.size(); ++k) {
            keyword += (keyword.empty() ? "" : " ") + std::string(line.field(k));
        }
    }
};

bool is_counter(const std::string& keyword) {
    constexpr std::string_view names =
        "|bonds|angles|dihedrals|impropers|atom types|bond types|angle types|dihedral types|improper types|ellipsoids|"
        "lines|triangles|bodies|extra bond per atom|extra angle per atom|extra dihedral per atom|"
        "extra improper per atom|extra special per atom|";
    return is_among(names, keyword);
}

struct DataHeader {
    long atoms = -1;
    Bounds box;
    PerAxis<std::optional<std::array<double, 2>>> bounds;
    std::set<std::string> seen; ///< keywords

    void take(const HeaderLine& header) {
        const TextLine& line = header.line;
        if (!seen.insert(header.keyword).second) {
            line.fail(header.keyword, "a second header line", "it once");
        }
        const auto numbers = [&](std::size_t count) {
            if (header.numbers != count) {
                line.fail(line.text(), "header line", fmt::format("{} numbers before '{}'", count, header.keyword));
            }
        };
        if (header.keyword == "atoms") {
            numbers(1);
            atoms = line.integer(0, "number of atoms", 1, most_disks);
        } else if (header.keyword == "xlo xhi" || header.keyword == "ylo yhi" || header.keyword == "zlo zhi") {
            numbers(2);
            const auto axis = static_cast<std::size_t>(header.keyword[0] - 'x');
            const double low = line.number(0, "lower bound"), high = line.number(1, "upper bound");
            if (!(low < high)) {
                line.fail(line.field(1), "upper bound", fmt::format("a number above the lower bound {}", low));
            }
            box.sides[axis].see(line.field(0));
            box.sides[axis].see(line.field(1));
            bounds[axis] = {low, high};
        } else if (header.keyword == "xy xz yz") {
            numbers(3);
            for (std::size_t k = 0; k < most_tilts; ++k) {
                take_tilt(line, k, k, box);
            }
        } else if (is_counter(header.keyword)) {
            numbers(1);
            (void)line.integer(0, "number of " + header.keyword, 0, most_disks);
        } else {
            line.fail(line.text(), "header line",
                      "'N atoms', 'xlo xhi', ... or a section (LAMMPS data file; the first line is a comment)");
        }
    }
};

void read_atoms(TextLines& lines, const std::string& style, const DataHeader& header, const ForeignOptions& options,
                Raw& raw) {
    // read_data of LAMMPS: sphere: id type diameter density x y z; bpm/sphere: id molecule type diameter density x y z.
    if (style != "sphere" && style != "bpm/sphere") {
        lines.fail(fmt::format("section Atoms {}: expected 'Atoms # sphere' or 'Atoms # bpm/sphere': other styles have "
                               "no diameter, and columns are not guessed",
                               style.empty() ? "does not name its style" : "has style '" + style + "'"));
    }
    Columns columns;
    const int shift = style == "sphere" ? 0 : 1;
    columns.id = 0;
    columns.size = 2 + shift;
    columns.at = {4 + shift, 5 + shift, 6 + shift};
    columns.meaning = raw.meaning = SizeMeaning::diameter;
    if (options.size) {
        if (!options.size->column.empty() || options.size->meaning != SizeMeaning::diameter) {
            lines.fail("the third column of atom style sphere is the diameter by definition: expected no other "
                       "statement (a constant --diameter may replace it)");
        }
        columns.size = -1;
        columns.constant = options.size->value;
        raw.notes.push_back(fmt::format("diameter {} for every disk, as stated", columns.constant));
    } else {
        raw.notes.emplace_back("diameters, as atom style " + style + " defines");
    }
    const auto width = static_cast<std::size_t>(7 + shift);
    std::vector<std::string> names(width);
    names[static_cast<std::size_t>(1 + shift)] = "type";
    find_selection(columns, names, options, fmt::format("{}:{}", lines.source(), lines.number()));
    Rows rows(columns, lines.source());
    while (rows.seen() < header.atoms) {
        const std::string what =
            fmt::format("atom {} of {}: {} values, and 3 image flags or none", rows.seen() + 1, header.atoms, width);
        const std::string_view text = without_comment(lines.take(what));
        if (text.empty()) {
            continue;
        }
        const TextLine line(text, lines.number(), &lines.source());
        if (line.size() != width + 3) {
            line.require_size(width, what);
        }
        for (std::size_t k = width; k < line.size(); ++k) {
            if (line.integer(k, "image flag", -1000000, 1000000) != 0) {
                raw.boundary[k - width] = Boundary::periodic;
            }
        }
        rows.add(line, raw);
    }
    rows.finish(raw);
}

/// Coordinates as wrapped, unwrapped or scaled to the box.
void find_coordinates(Columns& columns, const std::vector<std::string>& names, const std::string& where, Raw& raw) {
    for (const auto& [x, y, z, is_scaled, note] : {std::tuple{"x", "y", "z", false, ""},
                                                   {"xu", "yu", "zu", false, "unwrapped coordinates xu yu"},
                                                   {"xs", "ys", "zs", true, "scaled coordinates xs ys"},
                                                   {"xsu", "ysu", "zsu", true, "scaled coordinates xsu ysu"}}) {
        columns.at = {find_column(names, x), find_column(names, y), find_column(names, z)};
        if (columns.at[0] >= 0 && columns.at[1] >= 0) {
            raw.scaled = is_scaled;
            if (*note != '\0') {
                raw.notes.emplace_back(note);
            }
            return;
        }
    }
    throw Error(ErrorKind::bad_input,
                fmt::format("{}: no coordinates: expected columns x y, xu yu, xs ys or xsu ysu", where));
}

/// In units of the box: lengths.
void multiply_out(Raw& raw) {
    const auto& box = raw.box.value();
    for (PerAxis<double>& x : raw.centre) {
        for (std::size_t a = 0; a < most_axes; ++a) {
            x[a] = box[a][0] + x[a] * (box[a][1] - box[a][0]);
            for (std::size_t b = a + 1; b < most_axes; ++b) {
                x[a] += x[b] * raw.tilt[Cell::tilt(a, b)];
            }
        }
    }
    raw.notes.emplace_back("scaled coordinates were multiplied out in double: rounded at 2^-52 of the box");
}

} // namespace

Raw read_lammps_data(const std::string& text, const std::string& source, const ForeignOptions& options) {
    TextLines lines(text, source);
    Raw raw;
    DataHeader header;
    (void)lines.take("a comment"); // LAMMPS ignores the first line
    bool read = false;
    bool in_section = false;
    bool in_atoms = false;
    while (!lines.at_end()) {
        const std::string_view whole = lines.take("a line");
        const std::string_view content = without_comment(whole);
        if (content.empty()) {
            continue;
        }
        const TextLine line(content, lines.number(), &source);
        if (content == "Atoms") {
            if (read) {
                line.fail(content, "section", "one section Atoms");
            }
            if (header.atoms < 0) {
                line.fail(content, "section", "'N atoms' before it");
            }
            read_atoms(lines, comment_of(whole), header, options, raw);
            read = in_section = in_atoms = true;
        } else if (is_section(std::string(content))) {
            in_section = true;
            in_atoms = false;
        } else if (in_atoms) {
            line.fail(content, "line after the atoms",
                      fmt::format("a section, or the end: {} atoms were announced", header.atoms));
        } else if (!in_section) {
            header.take(HeaderLine(line));
        } else if (std::isalpha(static_cast<unsigned char>(content.front())) != 0) {
            line.fail(content, "section", "a section of a LAMMPS data file");
        } else if (read && line.size() > 0 && !finite_number(line.field(0))) {
            line.fail(line.field(0), "first value of the row", "a number");
        }
    }
    if (!read) {
        lines.fail("the file ends here: expected a section 'Atoms # sphere'");
    }
    if (header.bounds[0] && header.bounds[1]) {
        constexpr std::array<double, 2> none{};
        header.box.box = {*header.bounds[0], *header.bounds[1], header.bounds[2].value_or(none)};
        header.box.boundary = raw.boundary; // image flags told
        static_cast<Bounds&>(raw) = header.box;
    }
    return raw;
}

Raw read_lammps_dump(const std::string& text, const std::string& source, const ForeignOptions& options) {
    Raw raw;
    ChosenFrame frame =
        choose_frame(text, source, options, "atom", [](TextLines& lines) { return read_dump_header(lines, "ATOMS"); });
    const FrameHeader& header = frame.header;
    const std::string where = fmt::format("{}:{}", source, header.line);
    if (header.rows == 0) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{}: frame {} has 0 atoms: expected at least 1", where, frame.number));
    }
    Columns columns;
    find_coordinates(columns, header.names, where, raw);
    find_size(columns, header.names, options, where, raw);
    find_selection(columns, header.names, options, where);
    columns.id = find_column(header.names, "id");
    frame.read(Rows(columns, source), raw);
    if (raw.scaled) {
        multiply_out(raw);
    }
    raw.notes.push_back(fmt::format("frame {} (time step {})", frame.number, header.timestep));
    return raw;
}

} // namespace isostat::foreign
