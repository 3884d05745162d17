// LAMMPS: data files (atom_style sphere) and text dumps.
#include "foreign/source.hpp"
#include "io/numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
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

/// Whether a name is among `names`, written "|one|two|".
bool is_among(std::string_view names, const std::string& name) {
    return name.find('|') == std::string::npos && names.find("|" + name + "|") != std::string_view::npos;
}

/// Whether a section may accompany Atoms; all such sections are skipped.
bool is_section(const std::string& name) {
    constexpr std::string_view names = "|Velocities|Masses|Ellipsoids|Lines|Triangles|Bodies|Bonds|Angles|Dihedrals|"
                                       "Impropers|Atom Type Labels|";
    return is_among(names, name) || name.ends_with(" Coeffs") || name.ends_with(" Labels");
}

/// The numbers of a header line such as "12 atoms" or "0 1 xlo xhi", and the words after them.
struct HeaderLine {
    TextLine line;
    std::size_t numbers = 0;
    std::string keyword;
    explicit HeaderLine(TextLine l) : line(std::move(l)) {
        while (numbers < line.size() && finite_number(line.field(numbers))) {
            ++numbers;
        }
        for (std::size_t k = numbers; k < line.size(); ++k) {
            keyword += keyword.empty() ? "" : " ";
            keyword += line.field(k);
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
    PerAxis<PerAxis<double>> vectors{}; ///< of a general triclinic box
    PerAxis<double> origin{};
    std::set<std::string> seen; ///< keywords read so far

    void take(const HeaderLine& header) {
        const TextLine& line = header.line;
        if (!seen.insert(header.keyword).second) {
            line.fail(header.keyword, "a second header line", "it once");
        }
        const auto numbers = [&](std::size_t count) {
            if (header.numbers != count) {
                line.fail(line.text(), "header line", "{} numbers before '{}'", count, header.keyword);
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
                line.fail(line.field(1), "upper bound", "a number above the lower bound {}", low);
            }
            box.sides[axis].see(line.field(0));
            box.sides[axis].see(line.field(1));
            bounds[axis] = {low, high};
        } else if (header.keyword == "xy xz yz") {
            numbers(3);
            for (std::size_t k = 0; k < most_tilts; ++k) {
                take_tilt(line, k, k, box);
            }
        } else if (is_among("|avec|bvec|cvec|abc origin|", header.keyword)) {
            numbers(3);
            const auto vector = static_cast<std::size_t>(header.keyword[0] - 'a');
            take_vector(line, header.keyword == "abc origin" ? origin : vectors[vector], box);
        } else if (is_counter(header.keyword)) {
            numbers(1);
            (void)line.integer(0, "number of " + header.keyword, 0, most_disks);
        } else {
            line.fail(line.text(), "header line",
                      "'N atoms', 'xlo xhi', ... or a section (LAMMPS data file; the first line is a comment)");
        }
    }
};

/// An atom style and its columns, as read_data of LAMMPS reads them.
struct Style {
    std::string_view name, columns;
};
constexpr std::array<Style, 8> styles{{{"sphere", "id type diameter density x y z"},
                                       {"bpm/sphere", "id molecule type diameter density x y z"},
                                       {"atomic", "id type x y z"},
                                       {"charge", "id type q x y z"},
                                       {"bond", "id molecule type x y z"},
                                       {"angle", "id molecule type x y z"},
                                       {"molecular", "id molecule type x y z"},
                                       {"full", "id molecule type q x y z"}}};

/// The columns of a style; hybrid styles have id, type and place first, then the further columns of each style.
std::vector<std::string> columns_of_style(const TextLines& lines, const std::string& text) {
    const TextLine words(text, lines.number(), &lines.source());
    const bool hybrid = words.size() > 1 && words.field(0) == "hybrid";
    std::vector<std::string> out;
    const auto add = [&](std::string_view names, std::size_t kept) {
        const TextLine columns(names, lines.number(), &lines.source());
        for (std::size_t c = 0; c < columns.size(); ++c) {
            if (std::find(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(kept), columns.field(c)) ==
                out.begin() + static_cast<std::ptrdiff_t>(kept)) {
                out.emplace_back(columns.field(c));
            }
        }
    };
    add(hybrid ? styles[2].columns : "", 0);
    const std::size_t common = out.size();
    std::size_t known = hybrid ? 1 : 0;
    for (std::size_t k = known; k < words.size() && (hybrid || k == 0); ++k) {
        for (const Style& style : styles) {
            if (style.name == words.field(k)) {
                add(style.columns, common);
                ++known;
            }
        }
    }
    if (known == 0 || known != words.size()) {
        std::vector<std::string_view> names;
        std::ranges::transform(styles, std::back_inserter(names), [](const Style& s) { return s.name; });
        lines.fail("section Atoms {}: expected 'Atoms # sphere' or another of {}, or hybrid with several of these; "
                   "--style sphere and --columns id,type,... state it",
                   text.empty() ? "does not name its style" : "has style '" + text + "'", fmt::join(names, ", "));
    }
    return out;
}

void read_atoms(TextLines& lines, const std::string& named, const DataHeader& header, const ForeignOptions& options,
                Raw& raw) {
    const std::string& style = options.style.empty() ? named : options.style;
    const std::vector<std::string> names = options.columns.empty() ? columns_of_style(lines, style) : options.columns;
    const bool defined = options.columns.empty() && find_column(names, "diameter") >= 0;
    if (defined && options.size && options.size->of_word.empty() &&
        (!options.size->column.empty() || options.size->meaning != SizeMeaning::diameter)) {
        lines.fail("atom style sphere has a diameter by definition: expected no other statement (a constant --diameter "
                   "may replace it, or --radius type:1=1)");
    }
    Columns columns = find_columns(names, options, fmt::format("{}:{}", lines.source(), lines.number()), raw);
    if (defined && !options.size) {
        raw.notes.back() = fmt::format("diameters, as atom style {} defines", style);
    }
    const std::size_t width = names.size();
    Rows rows(std::move(columns), lines.source());
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
            line.fail(content, "line after the atoms", "a section, or the end: {} atoms were announced", header.atoms);
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
    if (header.seen.contains("avec")) {
        header.box.take_vectors(header.vectors, header.origin);
    } else if (header.bounds[0] && header.bounds[1]) {
        constexpr std::array<double, 2> none{};
        header.box.box = {*header.bounds[0], *header.bounds[1], header.bounds[2].value_or(none)};
    }
    if (header.box.box) {
        header.box.boundary = raw.boundary; // image flags showed the periodic axes
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
        refuse(where, "frame {} has 0 atoms: expected at least 1", frame.number);
    }
    Columns columns = find_columns(header.names, options, where, raw);
    frame.read(std::move(columns), raw);
    raw.notes.push_back(fmt::format("frame {} (time step {})", frame.number, header.timestep));
    return raw;
}

} // namespace isostat::foreign
