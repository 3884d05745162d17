// LAMMPS dumps of style local: rows of pairs.
#include "io/files.hpp"
#include "io/foreign_source.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace isostat {

namespace {

using foreign::Line;
using foreign::Lines;

/// A frame up to its entries.
struct LocalFrame {
    long entries = 0;
    int line = 0; ///< of the names
    std::vector<std::string> names;
};

LocalFrame read_header(Lines& lines) {
    LocalFrame frame;
    while (true) {
        const Line item = lines.next("ITEM: ENTRIES");
        if (item.text().starts_with("ITEM: TIMESTEP") || item.text().starts_with("ITEM: UNITS") ||
            item.text().starts_with("ITEM: TIME")) {
            (void)lines.take("its value");
        } else if (item.text().starts_with("ITEM: NUMBER OF ENTRIES")) {
            frame.entries = lines.next("the number of entries").integer(0, "number of entries", 0, foreign::most_disks);
        } else if (item.text().starts_with("ITEM: BOX BOUNDS")) {
            for (int axis = 0; axis < 3; ++axis) {
                (void)lines.take("the bounds of the box");
            }
        } else if (item.text().starts_with("ITEM: ENTRIES")) {
            for (std::size_t k = 2; k < item.size(); ++k) {
                frame.names.emplace_back(item.field(k));
            }
            frame.line = item.number();
            return frame;
        } else {
            item.fail(item.text(), "item", "a dump of style local: TIMESTEP, NUMBER OF ENTRIES, BOX BOUNDS, ENTRIES");
        }
    }
}

/// The pairs of one frame.
class Pairs {
  public:
    Pairs(const LocalFrame& frame, const PairColumns& columns, const std::vector<long>& ids, const std::string& source)
        : where_(fmt::format("{}:{}", source, frame.line)), names_(frame.names), first_(column(columns.first)),
          second_(column(columns.second)), force_(column(columns.force)) {
        for (std::size_t i = 0; i < ids.size(); ++i) {
            disk_of_.emplace(ids[i], static_cast<int>(i));
        }
    }

    void add(const Line& line) {
        line.require_size(names_.size(), "entry");
        const int i = disk(line, first_), j = disk(line, second_);
        if (i == j) {
            line.fail(line.field(second_), "second id", "another disk than the first");
        }
        if (line.number(force_, names_[force_]) > 0) {
            contacts_.push_back({ContactKind::disk_disk, std::min(i, j), std::max(i, j)});
        }
    }

    std::vector<Contact> take() {
        std::sort(contacts_.begin(), contacts_.end());
        contacts_.erase(std::unique(contacts_.begin(), contacts_.end()), contacts_.end());
        return std::move(contacts_);
    }

  private:
    [[nodiscard]] std::size_t column(const std::string& name) const {
        const int found = foreign::find_column(names_, name, where_);
        if (found < 0) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: no column '{}': expected one of {}", where_, name, fmt::join(names_, ", ")));
        }
        return static_cast<std::size_t>(found);
    }
    [[nodiscard]] int disk(const Line& line, std::size_t at) const {
        const auto found = disk_of_.find(line.integer(at, names_[at], 0, 1L << 62));
        if (found == disk_of_.end()) {
            line.fail(line.field(at), names_[at], "the id of a disk");
        }
        return found->second;
    }

    std::string where_;
    std::vector<std::string> names_;
    std::size_t first_, second_, force_;
    std::map<long, int> disk_of_;
    std::vector<Contact> contacts_;
};

} // namespace

std::vector<Contact> read_local_dump(const std::filesystem::path& path, const PairColumns& columns,
                                     const std::vector<long>& ids, std::optional<long> frame) {
    const std::string source = path.string();
    const std::string text = read_text(path);
    Lines lines(text, source);
    for (long number = 0;; ++number) {
        if (lines.only_blanks()) {
            lines.fail(fmt::format("the file ends after {} frames: expected frame {} (from 0)", number,
                                   frame.value_or(number)));
        }
        const LocalFrame header = read_header(lines);
        Lines rows = lines;
        for (long k = 0; k < header.entries; ++k) {
            (void)lines.take(fmt::format("entry {} of {} in frame {}", k + 1, header.entries, number));
        }
        if (frame ? number < *frame : !lines.only_blanks()) {
            continue;
        }
        Pairs pairs(header, columns, ids, source);
        for (long k = 0; k < header.entries; ++k) {
            pairs.add(rows.next("an entry"));
        }
        return pairs.take();
    }
}

} // namespace isostat
