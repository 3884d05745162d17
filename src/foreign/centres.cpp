// Equal grains: dimension, number, diameter, the period vectors (one per row) or none, centres. CALiPPSO and programs
// of Lubachevsky and Stillinger write this without vectors, TJ (Torquato and Jiao) with vectors.
#include "foreign/source.hpp"

#include <fmt/format.h>

#include <utility>

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
    PerAxis<PerAxis<double>> vectors{{{}, {}, {0, 0, 1}}};
    for (std::size_t b = 0; b < axes; ++b) {
        const TextLine row = lines.next_row("a period vector", axes);
        for (std::size_t a = 0; a < axes; ++a) {
            vectors[b][a] = row.number(a, "entry of a period vector");
            raw.sides[0].see(row.field(a));
        }
    }
    raw.take_vectors(vectors, {});
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
    ForeignOptions stated = options;
    if (!options.size) {
        stated.size = SizeStatement{SizeMeaning::diameter, "", size.positive(0, "diameter")};
    }
    Columns columns = find_columns(
        axes == 2 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"}, stated, source, raw);
    if (!options.size) {
        raw.sizes.see(size.field(0));
        raw.notes.back() = fmt::format("diameter {} for every disk, as line {} says", columns.constant, size.number());
    }
    if (const long left = rows_left(lines); left == count + *raw.dimension) {
        read_vectors(lines, axes, raw);
    } else if (left != count) {
        lines.fail("{} rows after this one: expected {} centres, or {} period vectors and then these", left, count,
                   axes);
    }
    Rows rows(std::move(columns), source);
    while (rows.seen() < count) {
        rows.add(lines.next_row(fmt::format("centre {} of {}", rows.seen() + 1, count), axes), raw);
    }
    rows.finish(raw);
    return raw;
}

} // namespace isostat::foreign
