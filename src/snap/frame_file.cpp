#include "snap/frame_file.hpp"

#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace isostat::compare {

namespace {

/// The line without its line end.
std::string_view content(std::string_view line) {
    return line.ends_with('\n') ? line.substr(0, line.size() - 1) : line;
}

} // namespace

FrameFile::FrameFile(std::string path, std::string item)
    : source_(std::move(path)), item_(std::move(item)), file_(source_, std::ios::binary) {
    if (!file_ || file_.peek() == std::ifstream::traits_type::eof()) {
        (void)read_text(source_); // throws the reason when the file cannot be read
        file_.clear();
    }
    recognise();
}

std::string FrameFile::where(int line) const {
    return fmt::format("{}:{}", source_, line);
}

std::string FrameFile::take_line() {
    std::string line = std::move(pending_);
    pending_.clear();
    if (line.empty() && std::getline(file_, line) && !file_.eof()) {
        line += '\n';
    }
    if (file_.bad()) {
        refuse(source_, "cannot read");
    }
    return line;
}

/// Recognises the format from the first line that is neither blank nor a comment; of a table it reads the column names.
void FrameFile::recognise() {
    std::string head, row;
    do {
        head += row = take_line();
    } while (!row.empty() && is_no_row(without_byte_order_mark(row)));
    const TextLine first(content(without_byte_order_mark(row)), 0, &source_);
    const bool number = first.size() == 1 && first.field(0).find_first_not_of("0123456789") == std::string_view::npos;
    format_ = first.size() == 0 || row.find("ITEM:") != std::string::npos ? Format::dump
              : number && item_ == "ATOMS"                                ? Format::xyz
                                                                          : Format::table;
    if (format_ != Format::table) {
        pending_ = std::move(head);
        return;
    }
    TextLines lines(head, source_);
    foreign::Raw nothing;
    names_ = foreign::read_table_names(lines, {}, nothing, item_ == "ENTRIES");
    step_ = foreign::find_column(names_.names, "timestep");
    pending_ = lines.at_end() ? "" : row;
    lines_ = lines.number();
}

std::string FrameFile::take_dump() {
    std::string text;
    bool in_rows = false;
    for (std::string line = take_line(); !line.empty(); line = take_line()) {
        if (in_rows && line.starts_with("ITEM:")) {
            pending_ = std::move(line);
            break;
        }
        in_rows = in_rows || line.starts_with("ITEM: " + item_);
        text += line;
    }
    return text;
}

std::string FrameFile::take_xyz() {
    std::string line = take_line(), text = line;
    const TextLine count(content(without_byte_order_mark(line)), 0, &source_);
    const double rows = count.size() == 1 ? finite_number(count.field(0)).value_or(0) : 0;
    for (double k = 0; k <= rows && !line.empty(); ++k) { // these rows include the line of key=value
        text += line = take_line();
    }
    return text;
}

/// Reads the rows of one time step.
std::string FrameFile::take_table() {
    const auto step = static_cast<std::size_t>(std::max(step_, 0));
    std::string text, current;
    for (std::string line = take_line(); !line.empty(); line = take_line()) {
        const TextLine row(content(line), 0, &source_, names_.separator);
        if (step_ >= 0 && !is_no_row(line) && step < row.size()) {
            if (!current.empty() && row.field(step) != current) {
                pending_ = std::move(line);
                break;
            }
            current = row.field(step);
        }
        text += line;
    }
    return text;
}

void FrameFile::read_xyz(TextLines& lines, foreign::FrameHeader& header) const {
    const TextLine count = lines.next("the number of rows");
    count.require_size(1, "the number of rows");
    const long rows = count.integer(0, "number of rows", 1, foreign::most_disks);
    const TextLine comment = lines.next("the line of key=value");
    if (comment.text().starts_with("ITEM:")) {
        count.fail(count.text(), "start of a frame", "ITEM: TIMESTEP before it");
    }
    header = foreign::read_xyz_header(comment, rows);
    for (std::string& name : header.names) {
        name = name == "pos.0" ? "x" : name == "pos.1" ? "y" : name == "pos.2" ? "z" : name;
        for (const auto& [number, speed] : {std::pair(".0", "vx"), std::pair(".1", "vy"), std::pair(".2", "vz")}) {
            name = name == std::string("velo") + number || name == std::string("vel") + number ? speed : name;
        }
    }
    header.timestep = foreign::xyz_timestep(comment, source_).value_or(frames_);
}

void FrameFile::read_rows(TextLines& lines, FileFrame& frame) const {
    const foreign::FrameHeader& header = frame.header;
    for (long k = 0; k < header.rows; ++k) {
        const std::string what = fmt::format("row {} of {} of time step {}", k + 1, header.rows, header.timestep);
        if (lines.at_end() && !pending_.empty()) {
            refuse(where(lines.number() + 1), "'{}': expected {}", pending_.substr(0, pending_.find('\n')), what);
        }
        TextLine line = lines.next(what);
        line.require_size(header.names.size(), what);
        frame.rows.push_back(std::move(line));
    }
    if (!lines.only_blanks()) {
        const TextLine line = lines.next("a row");
        line.fail(line.text(), "line after the rows", "the next frame: {} rows were announced", header.rows);
    }
}

void FrameFile::read_table(TextLines& lines, FileFrame& frame) const {
    frame.header.names = names_.names;
    frame.header.line = names_.line;
    while (lines.find_row()) {
        TextLine row = lines.next("a row", names_.separator);
        row.require_size(names_.names.size(), "one value per column");
        frame.rows.push_back(std::move(row));
    }
    frame.header.rows = static_cast<long>(frame.rows.size());
    if (step_ >= 0 && !frame.rows.empty()) {
        frame.header.timestep = frame.rows.front().integer(static_cast<std::size_t>(step_), "timestep", 0, 1L << 62);
    }
}

std::optional<FileFrame> FrameFile::next() {
    FileFrame frame;
    frame.text = std::make_unique<std::string>(format_ == Format::dump  ? take_dump()
                                               : format_ == Format::xyz ? take_xyz()
                                                                        : take_table());
    TextLines lines(*frame.text, source_, lines_);
    lines_ += static_cast<int>(std::ranges::count(*frame.text, '\n'));
    if (lines.only_blanks()) {
        return std::nullopt;
    }
    if (format_ == Format::table) {
        read_table(lines, frame);
        return frame.rows.empty() ? std::nullopt : std::optional(std::move(frame));
    }
    if (format_ == Format::dump) {
        frame.header = foreign::read_dump_header(lines, item_);
    } else {
        read_xyz(lines, frame.header);
    }
    read_rows(lines, frame);
    ++frames_;
    return frame;
}

FileFrame FrameFile::at(long timestep) {
    while (auto frame = next()) {
        const long found = frame->header.timestep;
        if (found <= last_) {
            const int line = format_ == Format::table ? frame->rows.front().number() : frame->header.line;
            refuse(where(line), "time step {} after {}: expected each once, in their order", found, last_);
        }
        last_ = found;
        if (found == timestep) {
            return std::move(*frame);
        }
    }
    refuse(source_, "no time step {} (after the one before): expected those of the frames, in their order", timestep);
}

std::size_t FrameFile::column(const FileFrame& frame, const std::string& name) const {
    const std::string place = where(frame.header.line);
    const int found = foreign::find_column(frame.header.names, name);
    if (found < 0) {
        refuse(place, "no column '{}': expected one of {}", name, fmt::join(frame.header.names, ", "));
    }
    auto twice = foreign::columns_twice(frame.header.names);
    std::erase_if(twice, [found](const auto& pair) { return pair.first != found; });
    for (const TextLine& row : frame.rows) {
        foreign::require_same(twice, frame.header.names, row);
    }
    return static_cast<std::size_t>(found);
}

} // namespace isostat::compare
