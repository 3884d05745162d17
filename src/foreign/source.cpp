#include "foreign/source.hpp"

#include "io/numbers.hpp"
#include "packing/words.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <tuple>

namespace isostat::foreign {

namespace {

/// The probable name of a column: "x" of "X", "x (m)", "pos_x" and "Points:0", "radius" of "R [mm]"; "-": unknown.
std::string likely_name(const std::string& name) {
    std::vector<std::string> words(1);
    for (const char c : lower(name)) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
            words.back() += c;
        } else if (!words.back().empty()) {
            words.emplace_back();
        }
    }
    std::erase(words, "");
    std::string out = "-";
    for (const std::string& word : words) {
        static const std::map<std::string, std::string, std::less<>> meant{{"x", "x"},
                                                                           {"y", "y"},
                                                                           {"z", "z"},
                                                                           {"r", "radius"},
                                                                           {"rad", "radius"},
                                                                           {"id", "id"},
                                                                           {"d", "diameter"},
                                                                           {"diam", "diameter"},
                                                                           {"radius", "radius"},
                                                                           {"diameter", "diameter"},
                                                                           {"0", "x"},
                                                                           {"1", "y"},
                                                                           {"2", "z"}};
        static const std::set<std::string, std::less<>> ignored{
            "m", "mm", "cm", "um", "pos", "position", "points", "center", "centre", "coordinates"};
        if (const auto found = meant.find(word); found != meant.end() && out == "-") {
            out = found->second;
        } else if (ignored.find(word) == ignored.end()) {
            return "-";
        }
    }
    return out;
}

/// Lists the columns of a file, and the statement that may be meant.
std::string seen_columns(const std::vector<std::string>& names) {
    std::vector<std::string> seen, likely;
    for (const std::string& name : names) {
        seen.push_back(name.empty() ? "-" : name);
        const std::string word = likely_name(name);
        likely.push_back(std::ranges::find(likely, word) == likely.end() ? word : "-");
    }
    std::string out =
        fmt::format("the columns are {}", names.empty() ? "none" : fmt::format("{}", fmt::join(seen, " ")));
    const auto has = [&](const char* name) { return std::ranges::find(likely, name) != likely.end(); };
    if (likely != seen && has("x") && has("y") && (has("radius") || has("diameter"))) {
        out += fmt::format("; --columns {} names them anew", fmt::join(likely, ","));
    }
    return out;
}

/// Finds coordinates, either wrapped, unwrapped or scaled to the box.
void find_coordinates(Columns& columns, const std::vector<std::string>& names, const std::string& where, Raw& raw) {
    for (const auto& [x, y, z, is_scaled, note] : {std::tuple{"x", "y", "z", false, ""},
                                                   {"pos.0", "pos.1", "pos.2", false, ""},
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
    refuse(where, "no coordinates: expected columns x y, pos (of XYZ), xu yu, xs ys or xsu ysu; {}",
           seen_columns(names));
}

/// The column named in a statement. \p what: the quantity of the column.
int stated_column(const std::vector<std::string>& names, const std::string& column, const char* what,
                  const std::string& where) {
    const int at = find_column(names, column);
    if (at < 0) {
        refuse(where, "no column '{}' {}: expected one of those; {}", column, what, seen_columns(names));
    }
    return at;
}

void find_size(Columns& columns, const ForeignOptions& options, const std::string& where, Raw& raw) {
    const std::vector<std::string>& names = columns.names;
    const auto word = [](SizeMeaning meaning) { return meaning == SizeMeaning::radius ? "radius" : "diameter"; };
    if (options.size) {
        columns.meaning = raw.meaning = options.size->meaning;
        columns.size_name = options.size->column;
        columns.constant = options.size->value;
        columns.size_of = options.size->of_word;
        if (columns.size_name.empty()) {
            raw.notes.push_back(fmt::format("{} {} for every disk, as stated", word(raw.meaning), columns.constant));
            return;
        }
        columns.size = stated_column(names, columns.size_name,
                                     raw.meaning == SizeMeaning::radius ? "for the radius" : "for the diameter", where);
        raw.notes.push_back(fmt::format("{} from column '{}', as stated", word(raw.meaning), columns.size_name));
        return;
    }
    for (const SizeMeaning meaning : {SizeMeaning::radius, SizeMeaning::diameter}) {
        for (const char* name : meaning == SizeMeaning::radius
                                    ? std::array<const char*, 4>{"radius", "Radius", "r", "R"}
                                    : std::array<const char*, 4>{"diameter", "Diameter", "d", "D"}) {
            const int column = find_column(names, name);
            if (column < 0) {
                continue;
            }
            if (columns.size >= 0) {
                refuse(where,
                       "columns '{}' and '{}' both state the size of the disks: expected one, or the choice with "
                       "--radius COLUMN or --diameter COLUMN",
                       columns.size_name, name);
            }
            columns.size = column;
            columns.size_name = name;
            columns.meaning = raw.meaning = meaning;
        }
    }
    if (columns.size < 0) {
        refuse(where,
               "no column states the size of the disks: expected radius or diameter, or the statement --radius "
               "COLUMN|NUMBER or --diameter COLUMN|NUMBER, or of types --radius type:1=1,2=1.4; {}",
               seen_columns(names));
    }
    raw.notes.push_back(fmt::format("{} from column '{}'", word(raw.meaning), columns.size_name));
}

void find_bodies(Columns& columns, const ForeignOptions& options, const std::string& where, Raw& raw) {
    if (!options.bodies.empty()) {
        columns.body =
            options.bodies == "none" ? -1 : stated_column(columns.names, options.bodies, "for the bodies", where);
    } else {
        for (const char* name : {"body", "clump", "clumpId", "mol", "molecule"}) {
            columns.are_molecules = columns.are_molecules || (columns.body < 0 && *name == 'm');
            columns.body = columns.body < 0 ? find_column(columns.names, name) : columns.body;
        }
    }
    if (columns.body >= 0 && !columns.are_molecules) {
        raw.notes.push_back(
            fmt::format("bodies from column '{}'", columns.names[static_cast<std::size_t>(columns.body)]));
    }
}

/// Finds the column of a statement about rows, and the words to match.
void find_rows(const std::optional<RowsWith>& rows, const std::vector<std::string>& names, const std::string& where,
               int& column, std::vector<std::string>& words) {
    if (!rows) {
        return;
    }
    column = stated_column(names, rows->column, "to select disks by", where);
    words = rows->words;
}

bool is_one_of(std::string_view word, const std::vector<std::string>& words) {
    return std::ranges::find(words, word) != words.end();
}

} // namespace

std::string lower(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(),
                           [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    return out;
}

void refuse_twice(const std::vector<std::string>& names, const std::string& where) {
    if (const auto twice = columns_twice(names); !twice.empty()) {
        refuse(where, "column '{}' is given twice: expected it once",
               names[static_cast<std::size_t>(twice.front().first)]);
    }
}

int find_column(const std::vector<std::string>& names, std::string_view name) {
    const auto at = std::ranges::find(names, name);
    return at == names.end() ? -1 : static_cast<int>(at - names.begin());
}

std::vector<std::pair<int, int>> columns_twice(const std::vector<std::string>& names) {
    std::vector<std::pair<int, int>> out;
    std::map<std::string_view, int> first;
    for (std::size_t k = 0; k < names.size(); ++k) {
        const auto [at, is_new] = first.emplace(names[k], static_cast<int>(k));
        if (!is_new && !names[k].empty()) {
            out.emplace_back(at->second, static_cast<int>(k));
        }
    }
    return out;
}

void require_same(const std::vector<std::pair<int, int>>& twice, const std::vector<std::string>& names,
                  const TextLine& row) {
    for (const auto& [first, second] : twice) {
        const std::string_view word = row.field(static_cast<std::size_t>(first));
        if (const std::string_view other = row.field(static_cast<std::size_t>(second)); word != other) {
            row.fail(
                other,
                fmt::format("column '{}' is given twice, and the second one", names[static_cast<std::size_t>(first)]),
                "'{}', as in the first one", word);
        }
    }
}

Columns find_columns(const std::vector<std::string>& names, const ForeignOptions& options, const std::string& where,
                     Raw& raw) {
    Columns out;
    out.names = options.columns.empty() ? names : options.columns;
    std::ranges::replace(out.names, std::string("-"), std::string());
    find_coordinates(out, out.names, where, raw);
    out.first_id = options.first_id;
    out.id = options.first_id ? -1 : find_column(out.names, "id");
    out.type = find_column(out.names, "type");
    find_bodies(out, options, where, raw);
    find_size(out, options, where, raw);
    find_rows(options.select, out.names, where, out.select, out.selected);
    find_rows(options.fixed, out.names, where, out.fix, out.fixed);
    out.same = columns_twice(out.names);
    std::erase_if(out.same, [&](const auto& twice) {
        const std::array<int, 9> used{out.at[0],  out.at[1], out.at[2],
                                      out.id,     out.size,  out.type,
                                      out.select, out.fix,   out.are_molecules ? -1 : out.body};
        return std::ranges::find(used, twice.first) == used.end();
    });
    return out;
}

void Rows::add(const TextLine& line, Raw& raw) {
    ++seen_;
    if (columns_.type >= 0) {
        ++types_[std::string(line.field(static_cast<std::size_t>(columns_.type)))];
    }
    if (columns_.select >= 0 && !is_one_of(line.field(static_cast<std::size_t>(columns_.select)), columns_.selected)) {
        return;
    }
    require_same(columns_.same, columns_.names, line);
    const std::size_t disk = raw.centre.size();
    const auto number = [&](int column, const char* name) {
        return line.number(static_cast<std::size_t>(column), fmt::format("{} of disk {}", name, disk));
    };
    PerAxis<double> centre{};
    for (std::size_t a = 0; a < most_axes; ++a) {
        if (columns_.at[a] >= 0) {
            centre[a] = number(columns_.at[a], axis_names[a]);
            raw.places[a].see(line.field(static_cast<std::size_t>(columns_.at[a])));
        }
    }
    raw.has_z = columns_.at[2] >= 0;
    raw.centre.push_back(centre);
    raw.line.push_back(line.number());
    if (columns_.id >= 0) {
        raw.ids.push_back(
            line.integer(static_cast<std::size_t>(columns_.id), fmt::format("id of disk {}", disk), 0, 1L << 62));
        ids_.emplace_back(raw.ids.back(), line.number());
    }
    if (columns_.first_id) {
        raw.ids.push_back(*columns_.first_id + seen_ - 1);
    }
    double size = columns_.constant;
    const std::string name = columns_.meaning == SizeMeaning::radius ? "radius" : "diameter";
    if (!columns_.size_of.empty()) {
        size = size_of_word(line, name);
    } else if (columns_.size >= 0) {
        const auto column = static_cast<std::size_t>(columns_.size);
        size = line.positive(column, fmt::format("{} of disk {}", name, disk));
        raw.sizes.see(line.field(column));
    }
    raw.size.push_back(size);
    if (columns_.fix >= 0) {
        raw.fixed.push_back(is_one_of(line.field(static_cast<std::size_t>(columns_.fix)), columns_.fixed) ? 1 : 0);
    }
    if (columns_.body >= 0) {
        const auto column = static_cast<std::size_t>(columns_.body);
        raw.bodies.push_back(columns_.are_molecules
                                 ? plain_integer(line.field(column)).value_or(0)
                                 : line.integer(column, fmt::format("body of disk {}", disk), -1, 1L << 62));
    }
}

double Rows::size_of_word(const TextLine& line, const std::string& name) const {
    const std::string_view word = line.field(static_cast<std::size_t>(columns_.size));
    for (const auto& [of, size] : columns_.size_of) {
        if (of == word) {
            return size;
        }
    }
    line.fail(word, columns_.size_name, "a word whose {} was stated", name);
}

void Rows::finish(Raw& raw) {
    if (columns_.select >= 0 && seen_ > 0 && raw.centre.empty()) {
        refuse(source_, "no row has '{}' in the column that selects disks: expected one at least",
               fmt::join(columns_.selected, "' or '"));
    }
    if (columns_.fix >= 0) {
        raw.notes.push_back(fmt::format("{} disks cannot move, as stated", std::ranges::count(raw.fixed, 1)));
    }
    if (columns_.select >= 0) {
        raw.notes.push_back(fmt::format("{} of {} rows are disks, as selected", raw.centre.size(), seen_));
    } else if (types_.size() > 1 && columns_.fix < 0 && columns_.size_of.empty()) {
        std::vector<std::string> words;
        for (const auto& [type, rows] : types_) {
            words.push_back(fmt::format("{} ({} rows)", type, rows));
        }
        raw.types = fmt::format("types {}: every row is taken for a disk; --select type={} takes one type",
                                fmt::join(words, ", "), types_.begin()->first);
        raw.notes.push_back(raw.types);
    }
    if (columns_.are_molecules) {
        const auto bodies = bodies_of(raw.bodies);
        if (!bodies.empty() && bodies.front().size() < raw.bodies.size()) {
            const std::string& name = columns_.names[static_cast<std::size_t>(columns_.body)];
            raw.notes.push_back(fmt::format("column '{}' is not used, though several rows have the same number there: "
                                            "--bodies {} makes rigid bodies of them",
                                            name, name));
        }
        raw.bodies.clear();
    }
    std::ranges::sort(ids_);
    const auto twice =
        std::ranges::adjacent_find(ids_, [](const auto& a, const auto& b) { return a.first == b.first; });
    if (twice != ids_.end()) {
        refuse(ErrorKind::bad_input, "{}:{}: id {} was given in line {} already: expected another", source_,
               (twice + 1)->second, twice->first, twice->second);
    }
}

ChosenFrame choose_frame(const std::string& text, const std::string& source, const ForeignOptions& options,
                         const char* row, const std::function<FrameHeader(TextLines&)>& head) {
    TextLines lines(text, source);
    for (long number = 0;; ++number) {
        if (lines.only_blanks()) {
            lines.fail("the file ends after {} frames: expected frame {} (from 0)", number,
                       options.frame.value_or(number));
        }
        ChosenFrame frame{number, head(lines), lines, row};
        for (long k = 0; k < frame.header.rows; ++k) {
            const std::string what = fmt::format("{} {} of {} in frame {}", row, k + 1, frame.header.rows, number);
            if (const std::string_view line = lines.take(what); line.starts_with("ITEM:")) {
                lines.fail("'{}': expected {}", line.substr(0, 40), what);
            }
        }
        if (options.frame ? number == *options.frame : lines.only_blanks()) {
            return frame;
        }
    }
}

void ChosenFrame::read(Columns columns, Raw& raw) {
    static_cast<Bounds&>(raw) = static_cast<const Bounds&>(header);
    const std::size_t width = columns.names.size();
    Rows reader(std::move(columns), rows.source());
    for (long k = 0; k < header.rows; ++k) {
        const TextLine line = rows.next(row);
        line.require_size(width, fmt::format("{} {} of {}", row, k + 1, header.rows));
        reader.add(line, raw);
    }
    reader.finish(raw);
}

} // namespace isostat::foreign
