#include "io/lammps_dump.hpp"

#include "io/files.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace isostat::foreign {

namespace {

void read_bounds(Lines& lines, std::string_view flags_text, DumpHeader& frame) {
    const Line flags(flags_text, lines.number(), &lines.source());
    std::vector<std::string_view> codes;
    bool tilted = false;
    for (std::size_t k = 0; k < flags.size(); ++k) {
        const std::string_view code = flags.field(k);
        if (code == "xy" || code == "xz" || code == "yz") {
            tilted = true;
        } else if (code.size() == 2 && code.find_first_not_of("pfsm") == std::string_view::npos) {
            codes.push_back(code);
        } else {
            flags.fail(code, "boundary", "two of the letters p f s m, for instance ff");
        }
    }
    if (!codes.empty() && codes.size() != 3) {
        flags.fail(flags_text, "boundaries", "three of them");
    }
    for (std::size_t a = 0; a < codes.size() && a < 2; ++a) {
        frame.boundary[a] = codes[a].find('p') != std::string_view::npos ? Boundary::periodic : Boundary::open;
        frame.loose[a] = codes[a].find_first_of("sm") != std::string_view::npos;
    }
    for (std::size_t a = 0; a < 3; ++a) {
        const Line line = lines.next("the bounds of the box: low high");
        line.require_size(tilted ? 3 : 2, "bounds of the box");
        const double low = line.number(0, "lower bound"), high = line.number(1, "upper bound");
        if (!(low <= high)) {
            line.fail(line.field(1), "upper bound", fmt::format("a number above the lower bound {}", low));
        }
        if (tilted && a == 0) {
            frame.tilt = line.number(2, "tilt");
        } else if (tilted && line.number(2, "tilt") != 0) {
            line.fail(line.field(2), "tilt of the box", "0: only packings in a plane are read");
        }
        if (a < 2) {
            frame.box[2 * a] = low;
            frame.box[2 * a + 1] = high;
        }
    }
    // A dump bounds the whole parallelepiped: xlo + min(0, xy), xhi + max(0, xy).
    frame.box[0] -= std::min(0.0, frame.tilt);
    frame.box[1] -= std::max(0.0, frame.tilt);
}

} // namespace

DumpHeader read_dump_header(Lines& lines, const std::string& item) {
    DumpHeader frame;
    const std::string rows = item == "ATOMS" ? "atoms" : "entries";
    bool boxed = false;
    for (bool first = true;; first = false) {
        const std::string_view text = lines.take("ITEM: " + item);
        const Line line(text, lines.number(), &lines.source());
        const auto starts = [&](const std::string& name) {
            return text.starts_with(name) &&
                   (text.size() == name.size() || std::isspace(static_cast<unsigned char>(text[name.size()])) != 0);
        };
        if (first && !starts("ITEM: TIMESTEP") && !starts("ITEM: UNITS") && !starts("ITEM: TIME")) {
            line.fail(text, "start of a frame", "ITEM: TIMESTEP");
        }
        if (starts("ITEM: TIMESTEP")) {
            const Line value = lines.next("the time step");
            value.require_size(1, "the time step");
            frame.timestep = value.integer(0, "time step", 0, 1L << 62);
        } else if (starts("ITEM: UNITS") || starts("ITEM: TIME")) {
            (void)lines.take("units or time");
        } else if (starts("ITEM: NUMBER OF " + item)) {
            const Line value = lines.next("the number of " + rows);
            value.require_size(1, "the number of " + rows);
            frame.rows = value.integer(0, "number of " + rows, 0, most_disks);
        } else if (starts("ITEM: BOX BOUNDS")) {
            read_bounds(lines, text.substr(std::string_view("ITEM: BOX BOUNDS").size()), frame);
            boxed = true;
        } else if (starts("ITEM: " + item)) {
            if (frame.rows < 0 || !boxed) {
                line.fail(text, "item", fmt::format("ITEM: NUMBER OF {} and ITEM: BOX BOUNDS before it", item));
            }
            frame.line = line.number();
            for (std::size_t k = 2; k < line.size(); ++k) {
                frame.names.emplace_back(line.field(k));
            }
            return frame;
        } else {
            line.fail(text, "item",
                      fmt::format("TIMESTEP, UNITS, TIME, NUMBER OF {0}, BOX BOUNDS or {0} (a dump of style {1})", item,
                                  item == "ATOMS" ? "custom" : "local"));
        }
    }
}

DumpFile::DumpFile(std::string path, std::string item)
    : source_(std::move(path)), item_(std::move(item)), file_(source_, std::ios::binary) {
    if (!file_ || file_.peek() == std::ifstream::traits_type::eof()) {
        (void)read_text(source_); // says why it cannot be read
        file_.clear();
    }
}

std::string DumpFile::where(int line) const {
    return fmt::format("{}:{}", source_, line);
}

void DumpFile::fail(const std::string& message) const {
    throw Error(ErrorKind::bad_input, fmt::format("{}: {}", where(lines_), message));
}

std::unique_ptr<std::string> DumpFile::take_text() {
    auto text = std::make_unique<std::string>(std::move(pending_));
    pending_.clear();
    const std::string names = "ITEM: " + item_;
    bool in_rows = false;
    for (std::string line; std::getline(file_, line);) {
        if (!file_.eof()) {
            line += '\n';
        }
        if (in_rows && line.starts_with("ITEM:")) {
            pending_ = std::move(line);
            return text;
        }
        in_rows = in_rows || line.starts_with(names);
        *text += line;
    }
    if (file_.bad()) {
        throw Error(ErrorKind::bad_input, source_ + ": cannot read");
    }
    return text;
}

std::optional<DumpFrame> DumpFile::next() {
    DumpFrame frame;
    frame.text = take_text();
    Lines lines(*frame.text, source_, lines_);
    lines_ += static_cast<int>(std::count(frame.text->begin(), frame.text->end(), '\n'));
    if (lines.only_blanks()) {
        return std::nullopt;
    }
    frame.header = read_dump_header(lines, item_);
    const DumpHeader& header = frame.header;
    for (long k = 0; k < header.rows; ++k) {
        const std::string what = fmt::format("row {} of {} of time step {}", k + 1, header.rows, header.timestep);
        if (lines.at_end() && !pending_.empty()) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: '{}': expected {}", where(lines.number() + 1),
                                                          pending_.substr(0, pending_.find('\n')), what));
        }
        Line line = lines.next(what);
        line.require_size(header.names.size(), what);
        frame.rows.push_back(std::move(line));
    }
    if (!lines.only_blanks()) {
        const Line line = lines.next("a row");
        line.fail(line.text(), "line after the rows",
                  fmt::format("the next frame: {} rows were announced", header.rows));
    }
    return frame;
}

DumpFrame DumpFile::at(long timestep) {
    while (auto frame = next()) {
        const long found = frame->header.timestep;
        if (found <= last_) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: time step {} after {}: expected each once, in their order",
                                    where(frame->header.line), found, last_));
        }
        last_ = found;
        if (found == timestep) {
            return std::move(*frame);
        }
    }
    throw Error(ErrorKind::bad_input,
                fmt::format("{}: no time step {} (after the one before): expected those of the frames, in their order",
                            source_, timestep));
}

std::size_t DumpFile::column(const DumpFrame& frame, const std::string& name) const {
    const std::string place = where(frame.header.line);
    const int found = find_column(frame.header.names, name, place);
    if (found < 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: no column '{}': expected one of {}", place, name,
                                                      fmt::join(frame.header.names, ", ")));
    }
    return static_cast<std::size_t>(found);
}

} // namespace isostat::foreign
