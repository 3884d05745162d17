// Equal grains: dimension, number, diameter, the period vectors (one a row) or none, centres. CALiPPSO and programs of
// Lubachevsky and Stillinger write it without vectors, TJ (Torquato and Jiao) with them.
#include "io/foreign_source.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

namespace isostat::foreign {

namespace {

long rows_left(TextLines lines) {
    long rows = 0;
    for (; lines.find_row(blanks_or_commas); ++rows) {
        (void)lines.take("a row");
    }
    return rows;
}

void read_vectors(TextLines& lines, std::size_t axes, Raw& raw) {
    raw.vectors.emplace();
    raw.box.emplace();
    for (std::size_t b = 0; b < axes; ++b) {
        const TextLine row = lines.next_row("a period vector", axes);
        for (std::size_t a = 0; a < axes; ++a) {
            (*raw.vectors)[b][a] = row.number(a, "entry of a period vector");
            raw.sides[0].see(row.field(a));
        }
        (*raw.box)[b][1] = (*raw.vectors)[b][b];
        for (std::size_t a = 0; a < b; ++a) {
            raw.tilt[Cell::tilt(a, b)] = (*raw.vectors)[b][a];
        }
    }
    raw.boundary.fill(Boundary::periodic);
}

} // namespace

Raw read_centres(const std::string& text, const std::string& source, const ForeignOptions& options) {
    Raw raw;
    TextLines lines(text, source);
    raw.dimension = static_cast<int>(lines.next_row("the dimension", 1).integer(0, "dimension", 2, most_axes));
    const auto axes = static_cast<std::size_t>(*raw.dimension);
    const long count = lines.next_row("the number of centres", 1).integer(0, "number of centres", 1, most_disks);
    const TextLine size = lines.next_row("the diameter", 1);
    Columns columns;
    columns.constant = size.positive(0, "diameter");
    columns.meaning = raw.meaning = SizeMeaning::diameter;
    if (options.size) {
        find_size(columns, {}, options, source, raw);
    } else {
        raw.sizes.see(size.field(0));
        raw.notes.push_back(
            fmt::format("diameter {} for every disk, as line {} says", columns.constant, size.number()));
    }
    find_selection(columns, {}, options, source);
    if (const long left = rows_left(lines); left == count + *raw.dimension) {
        read_vectors(lines, axes, raw);
    } else if (left != count) {
        lines.fail(fmt::format("{} rows after this one: expected {} centres, or {} period vectors and then these", left,
                               count, axes));
    }
    for (std::size_t a = 0; a < axes; ++a) {
        columns.at[a] = static_cast<int>(a);
    }
    Rows rows(columns, source);
    while (rows.seen() < count) {
        rows.add(lines.next_row(fmt::format("centre {} of {}", rows.seen() + 1, count), axes), raw);
    }
    rows.finish(raw);
    return raw;
}

} // namespace isostat::foreign
