// Reads extended XYZ: a number of rows, a line of key=value, the rows; frames follow each other.
#include "foreign/source.hpp"
#include "io/numbers.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace isostat::foreign {

namespace {

/// Reads key=value, key="several words", key='..', key={..}; words without '=' are flags. Keys become lower case.
std::map<std::string, std::string> key_values(const TextLine& line) {
    std::map<std::string, std::string> out;
    std::string_view rest = line.text();
    const auto skip_blanks = [&] { rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r"), rest.size())); };
    for (skip_blanks(); !rest.empty(); skip_blanks()) {
        const std::size_t end = std::min(rest.find_first_of("= \t\r"), rest.size());
        const std::string key = lower(rest.substr(0, end));
        rest.remove_prefix(end);
        std::string value;
        if (rest.starts_with('=')) {
            rest.remove_prefix(1);
            const std::size_t quote = rest.empty() ? std::string_view::npos : std::string_view("\"'{[").find(rest[0]);
            if (quote != std::string_view::npos) {
                const char closing = "\"'}]"[quote];
                const std::size_t stop = rest.find(closing, 1);
                if (stop == std::string_view::npos) {
                    line.fail(rest, "value of " + key, "an end {}", closing);
                }
                value = std::string(rest.substr(1, stop - 1));
                rest.remove_prefix(stop + 1);
            } else {
                const std::size_t stop = std::min(rest.find_first_of(" \t\r"), rest.size());
                value = std::string(rest.substr(0, stop));
                rest.remove_prefix(stop);
            }
        }
        if (!key.empty() && !out.emplace(key, value).second) {
            line.fail(key, "key", "it once");
        }
        if (key.empty() && value.empty()) {
            break;
        }
    }
    return out;
}

/// Turns Properties=name:type:count:... into one name per column; vectors become name.0, name.1, ...
std::vector<std::string> property_columns(const TextLine& line, const std::string& properties) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= properties.size();) {
        const std::size_t end = std::min(properties.find(':', at), properties.size());
        parts.push_back(properties.substr(at, end - at));
        at = end + 1;
    }
    if (parts.size() % 3 != 0) {
        line.fail(properties, "Properties", "name:type:count, repeated");
    }
    std::vector<std::string> names;
    constexpr double most_columns = 1000;
    for (std::size_t k = 0; k < parts.size(); k += 3) {
        const std::string& type = parts[k + 1];
        const double count = finite_number(parts[k + 2]).value_or(0);
        if (parts[k].empty() || type.size() != 1 || std::string_view("SRIL").find(type[0]) == std::string_view::npos ||
            !(count >= 1 && count <= most_columns) || count != static_cast<int>(count)) {
            line.fail(parts[k] + ":" + type + ":" + parts[k + 2], "Properties",
                      "name:type:count with type S, R, I or L and count from 1");
        }
        for (int c = 0; c < static_cast<int>(count); ++c) {
            names.push_back(count == 1 ? parts[k] : fmt::format("{}.{}", parts[k], c));
        }
    }
    return names;
}

std::vector<double> numbers_of(const TextLine& line, const std::string& key, const std::string& value,
                               std::array<std::size_t, 2> counts, Digits& digits) {
    std::string blanks = value;
    std::ranges::replace(blanks, ',', ' ');
    const std::string source;
    const TextLine fields(blanks, 0, &source);
    std::vector<double> out;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        const auto number = finite_number(fields.field(k));
        if (!number) {
            line.fail(fields.field(k), key, "a finite number");
        }
        out.push_back(*number);
        digits.see(fields.field(k));
    }
    if (out.size() != counts[0] && out.size() != counts[1]) {
        line.fail(value, key, "{} numbers", counts[1]);
    }
    return out;
}

void read_box(const TextLine& line, const std::map<std::string, std::string>& keys, FrameHeader& out) {
    const auto lattice = keys.find("lattice");
    if (lattice != keys.end()) {
        std::vector<double> v = numbers_of(line, "Lattice", lattice->second, {4, 9}, out.sides[0]);
        if (v.size() == 4) { // for disks
            v = {v[0], v[1], 0, v[2], v[3], 0, 0, 0, 1};
        }
        std::vector<double> origin(most_axes, 0);
        if (const auto o = keys.find("origin"); o != keys.end()) {
            origin = numbers_of(line, "Origin", o->second, {3, 3}, out.sides[0]);
        }
        out.place = fmt::format("{}: Lattice is '{}'", line.place(), lattice->second);
        out.take_vectors({{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}}},
                         {origin[0], origin[1], origin[2]});
        out.boundary.fill(Boundary::periodic); // the default without pbc
    }
    if (const auto pbc = keys.find("pbc"); pbc != keys.end()) {
        const std::string source;
        std::string text = pbc->second;
        std::ranges::replace(text, ',', ' ');
        const TextLine fields(text, 0, &source);
        if (fields.size() != 3 && fields.size() != 2) {
            line.fail(pbc->second, "pbc", "three of T and F");
        }
        for (std::size_t a = 0; a < fields.size(); ++a) {
            const std::string word = lower(fields.field(a));
            const bool yes = word == "t" || word == "true" || word == "1";
            if (!yes && word != "f" && word != "false" && word != "0") {
                line.fail(fields.field(a), "pbc", "T or F");
            }
            out.boundary[a] = yes ? Boundary::periodic : Boundary::open;
        }
    }
}

} // namespace

std::optional<long> xyz_timestep(const TextLine& comment, const std::string& source) {
    const auto keys = key_values(comment);
    const auto step = keys.find("timestep");
    if (step == keys.end()) {
        return std::nullopt;
    }
    const TextLine value(step->second, comment.number(), &source);
    value.require_size(1, "the time step");
    return value.integer(0, "Timestep", 0, 1L << 62);
}

FrameHeader read_xyz_header(const TextLine& comment, long rows) {
    FrameHeader out;
    out.rows = rows;
    out.line = comment.number();
    const auto keys = key_values(comment);
    const auto properties = keys.find("properties");
    out.names = property_columns(comment, properties == keys.end() ? "species:S:1:pos:R:3" : properties->second);
    read_box(comment, keys, out);
    return out;
}

Raw read_xyz(const std::string& text, const std::string& source, const ForeignOptions& options) {
    Raw raw;
    std::optional<TextLine> comment; // of the chosen frame: other frames may be wrong
    ChosenFrame frame = choose_frame(text, source, options, "row", [&comment](TextLines& lines) {
        const TextLine count = lines.next("the number of rows");
        count.require_size(1, "the number of rows");
        FrameHeader header;
        header.rows = count.integer(0, "number of rows", 1, most_disks);
        comment = lines.next("the line of key=value");
        return header;
    });
    frame.header = read_xyz_header(*comment, frame.header.rows);
    Columns columns = find_columns(frame.header.names, options, comment->place(), raw);
    if (const auto& box = frame.header.box; box && ((*box)[0][0] != 0 || (*box)[1][0] != 0 || (*box)[2][0] != 0)) {
        raw.notes.emplace_back("upper bounds = Origin + Lattice in double: rounded at 2^-53 of them");
    }
    frame.read(std::move(columns), raw);
    if (frame.number > 0) {
        raw.notes.push_back(fmt::format("frame {}", frame.number));
    }
    return raw;
}

} // namespace isostat::foreign
