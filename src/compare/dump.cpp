#include "compare/dump.hpp"

#include "io/files.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isostat::compare {

using foreign::Line;

Dump::Dump(const std::string& path, std::string item)
    : source_(path), text_(read_text(path)), item_(std::move(item)), lines_(text_, source_) {}

std::string Dump::where(int line) const {
    return fmt::format("{}:{}", source_, line);
}

std::optional<DumpFrame> Dump::next() {
    if (lines_.only_blanks()) {
        return std::nullopt;
    }
    DumpFrame frame;
    long rows = -1;
    frame.timestep = -1;
    while (true) {
        const Line line = lines_.next("ITEM: " + item_);
        const auto is = [&](std::string_view name) { return line.text().starts_with(name); };
        if (is("ITEM: TIMESTEP")) {
            frame.timestep = lines_.next("the time step").integer(0, "time step", 0, 1L << 62);
        } else if (is("ITEM: UNITS") || is("ITEM: TIME")) {
            (void)lines_.take("its value");
        } else if (is("ITEM: NUMBER OF")) {
            rows = lines_.next("the number of rows").integer(0, "number of rows", 0, foreign::most_disks);
        } else if (is("ITEM: BOX BOUNDS")) {
            for (int axis = 0; axis < 3; ++axis) {
                (void)lines_.take("the bounds of the box");
            }
        } else if (is("ITEM: " + item_) && frame.timestep >= 0 && rows >= 0) {
            frame.line = line.number();
            for (std::size_t k = 2; k < line.size(); ++k) {
                frame.names.emplace_back(line.field(k));
            }
            break;
        } else {
            line.fail(line.text(), "item", fmt::format("TIMESTEP, NUMBER OF ..., BOX BOUNDS, {}", item_));
        }
    }
    for (long k = 0; k < rows; ++k) {
        Line line = lines_.next(fmt::format("row {} of {} of time step {}", k + 1, rows, frame.timestep));
        line.require_size(frame.names.size(), fmt::format("row {} of {}", k + 1, rows));
        frame.rows.push_back(std::move(line));
    }
    return frame;
}

DumpFrame Dump::at(long timestep) {
    while (auto frame = next()) {
        if (frame->timestep == timestep) {
            return std::move(*frame);
        }
    }
    throw Error(ErrorKind::bad_input,
                fmt::format("{}: no time step {} (after the one before): expected those of the frames, in their order",
                            source_, timestep));
}

int Dump::find(const DumpFrame& frame, const std::string& name) const {
    return foreign::find_column(frame.names, name, where(frame.line));
}

std::size_t Dump::column(const DumpFrame& frame, const std::string& name) const {
    const int found = find(frame, name);
    if (found < 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: no column '{}': expected one of {}", where(frame.line), name,
                                                      fmt::join(frame.names, ", ")));
    }
    return static_cast<std::size_t>(found);
}

} // namespace isostat::compare
