#include "core/refuse.hpp"
#include "core/roundoff.hpp"

#include <isostat/core/result.hpp>
#include <isostat/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace isostat {

namespace {

using roundoff::infinity;

/// Lowest value of a stress ratio: 0; a shear, and the path parameter, may have either sign.
double lowest(const ProgrammeStep& step) {
    return step.from_zero ? -infinity : 0;
}

/// The ratios that a run can have at this point.
struct Range {
    double low = 0;
    double high = infinity;
};

/// Number of the last equilibrium of a segment, and the ratios of its equilibria. `last` is empty from the first
/// segment on that ends at a ratio.
struct Made {
    std::optional<int> last;
    Range ratio;
};

template <class... Values>
[[noreturn]] void refuse(const Scene& scene, const ProgrammeStep& step, fmt::format_string<Values...> what,
                         Values&&... values) {
    isostat::refuse(fmt::format("{}:{}: segment \"{}\"", scene.file, step.line, step.name), what,
                    std::forward<Values>(values)...);
}

std::string range_text(const Range& range) {
    return range.low == range.high  ? fmt::format("{}", range.low)
           : range.high == infinity ? fmt::format("at least {}", range.low)
           : range.low == 0         ? fmt::format("at most {}", range.high)
                                    : fmt::format("from {} to {}", range.low, range.high);
}

/// The possible ratios at the start of a segment that names its first equilibrium.
Range range_at(const Scene& scene, const ProgrammeStep& step, const std::vector<Made>& made) {
    const int from = *step.from;
    for (const Made& m : made) {
        if (!m.last) {
            return {lowest(step),
                    infinity}; // the number of equilibria is not known: `from` may be of this segment or of a later one
        }
        if (from <= *m.last) {
            return m.ratio;
        }
    }
    refuse(scene, step, "starts from equilibrium {}, but the segments before end at number {}: expected one of them",
           from, *made.back().last);
}

/// The possible ratios at the end of a segment.
Range after(const Scene& scene, const ProgrammeStep& step, const Range& start) {
    const bool known = start.low == start.high;
    if (step.action == Action::to) {
        if (known && *step.to == start.low) {
            refuse(scene, step, "to = {}, where the run already is: there is nothing to do", *step.to);
        }
        return {*step.to, *step.to};
    }
    const bool up = step.action == Action::up;
    if (step.to) {
        const bool behind = up ? *step.to <= start.low : *step.to >= start.high;
        if (behind) {
            refuse(scene, step, "{} to a ratio {} of {}, but the ratio at its start is {}: expected a {} one",
                   word_of(step.action, action_words), step.ratio, *step.to, range_text(start),
                   up ? "larger" : "smaller");
        }
        if (!step.equilibria) {
            return {*step.to, *step.to};
        }
    }
    return up ? Range{start.low, step.to.value_or(infinity)} : Range{step.to.value_or(lowest(step)), start.high};
}

} // namespace

std::string describe(const ProgrammeStep& step) {
    std::string text = word_of(step.action, action_words);
    if (step.from) {
        text += fmt::format(" from {}", *step.from);
    }
    if (step.equilibria) {
        text += fmt::format(": {} equilibria", *step.equilibria);
    }
    if (step.to) {
        text += fmt::format("{} {} = {}",
                            step.equilibria             ? " or to"
                            : step.action == Action::to ? ""
                                                        : ": to",
                            step.ratio, *step.to);
    }
    return text;
}

void check_programme(const Scene& scene, std::optional<double> ratio) {
    const double least = scene.programme.empty() ? 0 : lowest(scene.programme.front());
    const Range start = ratio ? Range{*ratio, *ratio} : Range{least, infinity};
    std::vector<Made> made{{0, start}};
    Range now = start;
    for (const ProgrammeStep& step : scene.programme) {
        if (step.action == Action::to) {
            if (!step.to) {
                refuse(scene, step, "do = \"to\" without a ratio: expected to = RATIO");
            }
            if (step.equilibria) {
                refuse(
                    scene, step,
                    "do = \"to\" ends at its ratio: expected no 'equilibria' (or do = \"up\" or \"down\" with both)");
            }
        } else if (!step.equilibria && !step.to) {
            refuse(scene, step, "has no end: expected equilibria = NUMBER, to = RATIO or both");
        }
        if (step.from) {
            now = range_at(scene, step, made);
        }
        const Range end = after(scene, step, now);
        Made next;
        if (made.back().last && step.equilibria && !step.to) {
            next.last = *made.back().last + *step.equilibria;
        }
        next.ratio = {std::min(now.low, end.low), std::max(now.high, end.high)};
        made.push_back(next);
        now = end;
    }
}

std::vector<int> needed_equilibria(const Scene& scene) {
    std::set<int> needed;
    for (const ProgrammeStep& step : scene.programme) {
        if (step.from) {
            needed.insert(*step.from);
        }
    }
    return {needed.begin(), needed.end()};
}

} // namespace isostat
