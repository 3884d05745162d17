#include "io/foreign_source.hpp"

#include "packing/words.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace isostat::foreign {

void refuse_twice(const std::vector<std::string>& names, const std::string& where) {
    std::vector<std::string> sorted = names;
    std::sort(sorted.begin(), sorted.end());
    std::erase(sorted, "");
    if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end()) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{}: column '{}' is given twice: expected it once", where, *twice));
    }
}

int find_column(const std::vector<std::string>& names, std::string_view name) {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? -1 : static_cast<int>(at - names.begin());
}

void find_size(Columns& columns, const std::vector<std::string>& names, const ForeignOptions& options,
               const std::string& where, Raw& raw) {
    const auto word = [](SizeMeaning meaning) { return meaning == SizeMeaning::radius ? "radius" : "diameter"; };
    const std::string listed = names.empty() ? "none" : fmt::format("{}", fmt::join(names, " "));
    if (options.size) {
        columns.meaning = raw.meaning = options.size->meaning;
        columns.size_name = options.size->column;
        columns.constant = options.size->value;
        if (columns.size_name.empty()) {
            raw.notes.push_back(fmt::format("{} {} for every disk, as stated", word(raw.meaning), columns.constant));
            return;
        }
        columns.size = find_column(names, columns.size_name);
        if (columns.size < 0) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: no column '{}' for the {}: expected one of: {}", where,
                                                          columns.size_name, word(raw.meaning), listed));
        }
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
                throw Error(ErrorKind::bad_input,
                            fmt::format("{}: columns '{}' and '{}' both state the size of the disks: expected one, or "
                                        "the choice with --radius COLUMN or --diameter COLUMN",
                                        where, columns.size_name, name));
            }
            columns.size = column;
            columns.size_name = name;
            columns.meaning = raw.meaning = meaning;
        }
    }
    if (columns.size < 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: no column states the size of the disks (columns: {}): "
                                                      "expected radius or diameter, or the statement --radius "
                                                      "COLUMN|NUMBER or --diameter COLUMN|NUMBER",
                                                      where, listed));
    }
    raw.notes.push_back(fmt::format("{} from column '{}'", word(raw.meaning), columns.size_name));
}

void find_selection(Columns& columns, const std::vector<std::string>& names, const ForeignOptions& options,
                    const std::string& where) {
    columns.type = find_column(names, "type");
    if (!options.select) {
        return;
    }
    columns.select = find_column(names, options.select->first);
    columns.selected = options.select->second;
    if (columns.select < 0) {
        std::vector<std::string> named = names;
        std::erase(named, "");
        throw Error(ErrorKind::bad_input, fmt::format("{}: no column '{}' to select disks by: expected one of: {}",
                                                      where, options.select->first, fmt::join(named, " ")));
    }
}

void Rows::add(const TextLine& line, Raw& raw) {
    ++seen_;
    if (columns_.type >= 0) {
        ++types_[std::string(line.field(static_cast<std::size_t>(columns_.type)))];
    }
    if (columns_.select >= 0 && line.field(static_cast<std::size_t>(columns_.select)) != columns_.selected) {
        return;
    }
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
    double size = columns_.constant;
    const std::string name = columns_.meaning == SizeMeaning::radius ? "radius" : "diameter";
    if (columns_.size >= 0) {
        const auto column = static_cast<std::size_t>(columns_.size);
        size = line.positive(column, fmt::format("{} of disk {}", name, disk));
        raw.sizes.see(line.field(column));
    }
    raw.size.push_back(size);
}

void Rows::finish(Raw& raw) {
    if (columns_.select >= 0 && seen_ > 0 && raw.centre.empty()) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{}: no row has '{}' in the column that selects disks: expected one at least", source_,
                                columns_.selected));
    }
    if (columns_.select >= 0) {
        raw.notes.push_back(fmt::format("{} of {} rows are disks, as selected", raw.centre.size(), seen_));
    } else if (types_.size() > 1) {
        std::vector<std::string> words;
        for (const auto& [type, rows] : types_) {
            words.push_back(fmt::format("{} ({} rows)", type, rows));
        }
        raw.types = fmt::format("types {}: every row is taken for a disk; --select type={} takes one type",
                                fmt::join(words, ", "), types_.begin()->first);
        raw.notes.push_back(raw.types);
    }
    std::sort(ids_.begin(), ids_.end());
    const auto twice =
        std::adjacent_find(ids_.begin(), ids_.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
    if (twice != ids_.end()) {
        throw Error(ErrorKind::bad_input, fmt::format("{}:{}: id {} was given in line {} already: expected another",
                                                      source_, (twice + 1)->second, twice->first, twice->second));
    }
}

ChosenFrame choose_frame(const std::string& text, const std::string& source, const ForeignOptions& options,
                         const char* row, const std::function<FrameHeader(TextLines&)>& head) {
    TextLines lines(text, source);
    for (long number = 0;; ++number) {
        if (lines.only_blanks()) {
            lines.fail(fmt::format("the file ends after {} frames: expected frame {} (from 0)", number,
                                   options.frame.value_or(number)));
        }
        ChosenFrame frame{number, head(lines), lines, row};
        for (long k = 0; k < frame.header.rows; ++k) {
            const std::string what = fmt::format("{} {} of {} in frame {}", row, k + 1, frame.header.rows, number);
            if (const std::string_view line = lines.take(what); line.starts_with("ITEM:")) {
                lines.fail(fmt::format("'{}': expected {}", line.substr(0, 40), what));
            }
        }
        if (options.frame ? number == *options.frame : lines.only_blanks()) {
            return frame;
        }
    }
}

void ChosenFrame::read(Rows reader, Raw& raw) {
    static_cast<Bounds&>(raw) = static_cast<const Bounds&>(header);
    for (long k = 0; k < header.rows; ++k) {
        const TextLine line = rows.next(row);
        line.require_size(header.names.size(), fmt::format("{} {} of {}", row, k + 1, header.rows));
        reader.add(line, raw);
    }
    reader.finish(raw);
}

} // namespace isostat::foreign
