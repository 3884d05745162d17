#include "cli/read_packing.hpp"

#include "cli/ranges.hpp"
#include "core/dot.hpp"
#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/numbers.hpp"
#include "io/vertex_text.hpp"
#include "snap/untold.hpp"

#include <isostat/core/result.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace isostat::cli {

namespace {

constexpr std::int64_t most_frames = 1'000'000'000'000'000;

[[noreturn]] void usage(const std::string& option, const std::string& value, const std::string& expected) {
    refuse(ErrorKind::usage, "{} is '{}': expected {}", option, value, expected);
}

double number_of(const std::string& option, const std::string& text, const std::string& word,
                 const std::string& expected) {
    const auto value = ranges::number_in(word);
    if (!value) {
        usage(option, text, expected);
    }
    return *value;
}

/// A number, a column, or words of a column with the size of each, "type:1=1,2=1.4".
SizeStatement size_of(const std::string& option, const std::string& text, SizeMeaning meaning) {
    const std::string expected = "a positive number, the name of a column, or COLUMN:WORD=NUMBER,...";
    SizeStatement out{meaning, text, 0};
    if (const auto value = ranges::number_in(text)) {
        out.column.clear();
        out.value = *value;
    } else if (const std::size_t first = text.find('='); first != std::string::npos) {
        const std::size_t colon = text.rfind(':', first);
        if (colon == std::string::npos) {
            usage(option, text, expected);
        }
        out.column = text.substr(0, colon);
        for (const std::string& pair : parse_list(text.substr(colon + 1))) {
            const auto words = parse_list(pair, '=');
            if (words.size() != 2) {
                usage(option, text, expected);
            }
            out.of_word.emplace_back(words[0], number_of(option, text, words[1], expected));
        }
    }
    const bool positive = std::ranges::all_of(out.of_word, [](const auto& w) { return w.second > 0; });
    if (!positive || (out.column.empty() && !(out.value > 0))) {
        usage(option, text, expected);
    }
    return out;
}

/// "COLUMN=VALUE,VALUE".
std::optional<RowsWith> rows_of(const std::string& option, const std::string& text) {
    if (text.empty()) {
        return std::nullopt;
    }
    const auto words = parse_list(text, '=');
    if (words.size() != 2 || words[0].empty() || words[1].empty()) {
        usage(option, text, "COLUMN=VALUE,..., for instance type=1,2");
    }
    return RowsWith{words[0], parse_list(words[1])};
}

ForeignOptions options_of(const ForeignArguments& a) {
    ForeignOptions out = a.options;
    const std::vector<std::string>& formats = foreign_formats();
    if (!out.format.empty() && std::ranges::find(formats, out.format) == formats.end()) {
        usage("--format", out.format, fmt::format("one of {}", fmt::join(formats, ", ")));
    }
    if (!a.radius.empty() || !a.diameter.empty()) {
        out.size = size_of(a.radius.empty() ? "--diameter" : "--radius", a.radius.empty() ? a.diameter : a.radius,
                           a.radius.empty() ? SizeMeaning::diameter : SizeMeaning::radius);
    }
    out.walls = value_of(a.walls, foreign_walls_words).value_or(ForeignWalls::none);
    if (!a.box.empty()) {
        const auto axes = parse_list(a.box);
        if (axes.size() != 2 && axes.size() != most_axes) {
            usage("--box", a.box, "XLO:XHI,YLO:YHI, of spheres XLO:XHI,YLO:YHI,ZLO:ZHI");
        }
        for (const std::string& axis : axes) {
            const auto range = parse_range(axis, "--box");
            out.box.insert(out.box.end(), range.begin(), range.end());
        }
        if (out.walls == ForeignWalls::none && !out.periodic) {
            usage("--box", a.box, "--walls box or --walls fixed beside it, or --periodic (a tilted cell: --lattice)");
        }
    }
    if (a.frame != "last") {
        out.frame = ranges::integer_in(a.frame, 0, most_frames);
        if (!out.frame) {
            usage("--frame", a.frame, "an integer from 0, or last");
        }
    }
    if (!a.columns.empty()) {
        out.columns = parse_list(a.columns);
    }
    out.select = rows_of("--select", a.select);
    out.fixed = rows_of("--fixed", a.fixed);
    if (out.fixed && !a.fixes) {
        usage("--fixed", a.fixed, "none: only isostat plateau takes disks that cannot move");
    }
    for (const std::string& word : a.lattice.empty() ? std::vector<std::string>() : parse_list(a.lattice)) {
        out.lattice.push_back(number_of("--lattice", a.lattice, word, "numbers LX,LY,TILT"));
    }
    return out;
}

void require_plane_unless(bool spheres, const Packing& packing, const std::string& file) {
    if (!spheres) {
        require_plane(packing, file, "this command");
    }
}

/// Bound of the rounding of gaps in a file of this program.
double rounding_of(const Packing& packing) {
    const double rounding = 0x1p-53 * std::max(packing.max_radius(), largest(packing.q));
    return rounding_of_gaps(rounding, rounding, rounding, {packing.dimension});
}

} // namespace

std::vector<std::string> parse_list(const std::string& text, char at) {
    std::vector<std::string> out(1);
    for (const char c : text) {
        if (c == at) {
            out.emplace_back();
        } else {
            out.back() += c;
        }
    }
    return out;
}

std::array<double, 2> parse_range(const std::string& text, const std::string& option) {
    const auto ends = parse_list(text, ':');
    const auto low = ranges::number_in(ends[0]), high = ends.size() == 2 ? ranges::number_in(ends[1]) : std::nullopt;
    if (!low || !high || *low > *high) {
        usage(option, text, "A:B, two numbers with A <= B");
    }
    return {*low, *high};
}

ForeignPacking read_any_packing(const std::string& file, const ForeignArguments& arguments) {
    const ForeignOptions options = options_of(arguments);
    const std::string text = read_packed_text(file);
    const std::string format = options.format.empty() ? recognise_format(text) : options.format;
    const bool own = format == "state" || format == "vertex" || format == "packing";
    if (!own) {
        ForeignPacking foreign = parse_foreign(text, file, options);
        require_plane_unless(arguments.spheres, foreign.packing, file);
        if (!arguments.clumps) {
            require_single_grains(foreign.packing, file, "this command (but --bodies none leaves bodies out)");
        }
        return foreign;
    }
    if (options.size || !options.box.empty() || options.dimension || options.select || !arguments.walls.empty() ||
        !options.columns.empty() || !options.bodies.empty() || options.frame || options.not_periodic ||
        options.periodic || options.fixed || options.skip > 0 || !options.lattice.empty() || options.first_id ||
        !options.style.empty() || options.plane != "xy") {
        refuse(ErrorKind::usage,
               "{} is a {} file of isostat, which says all of its sizes and walls: expected none of --radius, "
               "--diameter, --walls, --box, --lattice, --frame, --dimension, --columns, --skip, --style, --plane, "
               "--ids, --select, --fixed, --bodies, --periodic, --not-periodic",
               file, format);
    }
    if (format == "packing") {
        const crafted::PackingFile crafted = crafted::parse_packing(text, file);
        ForeignPacking out{crafted::approximate(crafted.packing), format, {}, 0, {}};
        require_plane_unless(arguments.spheres, out.packing, file);
        out.rounding = rounding_of(out.packing);
        out.notes.emplace_back("exact numbers rounded to the nearest doubles: inspect decides contacts exactly");
        return out;
    }
    const Dimensions dimensions = arguments.clumps ? Dimensions::any_clumps : Dimensions::any;
    const State state = format != "state" ? parse_vertex_text(text, file)
                        : options.cells   ? parse_any_state(text, file, dimensions).state
                                          : parse_state(text, file).state;
    ForeignPacking out{
        state.packing, format, {}, std::max(rounding_of(state.packing), compare::imported_rounding(state)), {}};
    require_plane_unless(arguments.spheres, state.packing, file);
    out.notes.emplace_back("the contact list of the file is not used");
    return out;
}

} // namespace isostat::cli
