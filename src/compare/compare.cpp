#include "compare/path.hpp"
#include "core/parallel.hpp"
#include "core/refuse.hpp"
#include "packing/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::compare {

namespace {

/// The equilibrium of the path with this list that is nearest to the expected one; -1: no equilibrium has it.
int place_on(const std::vector<PathEquilibrium>& path, const std::vector<Contact>& list, int expected) {
    int best = -1;
    for (const PathEquilibrium& e : path) {
        if (e.contacts == list && (best < 0 || std::abs(e.number - expected) < std::abs(best - expected))) {
            best = e.number;
        }
    }
    return best;
}

/// Compares a frame with the exact run.
void place(JudgedFrame& judged, const Path& path, int expected) {
    FrameResult& r = judged.result;
    r.expected = expected;
    if (r.status == FrameStatus::file || r.status == FrameStatus::moving) {
        return;
    }
    r.found = place_on(path.equilibria, judged.list, expected);
    if (expected >= 0) {
        const PathEquilibrium& e = path.equilibria[static_cast<std::size_t>(expected)];
        r.missing = without(e.contacts, judged.list);
        r.extra = without(judged.list, e.contacts);
    }
    if (r.status != FrameStatus::same) {
        return;
    }
    if (expected < 0) {
        r.status = FrameStatus::undecided;
        r.reason = "its vertex is proved; the exact run ends before: " + path.end;
    } else if (!path.equilibria[static_cast<std::size_t>(expected)].proved) {
        r.status = FrameStatus::undecided;
        r.reason = "its vertex is proved, the equilibrium of the exact run is not";
    } else if (r.found != expected) {
        r.status = r.found < 0 ? FrameStatus::other : r.found > expected ? FrameStatus::early : FrameStatus::late;
    }
}

/// The numbers of the equilibria with this list (`here`), or of the other ones that support this load.
std::string numbers_of(const std::vector<const PathEquilibrium*>& known, const std::vector<Contact>& list, double load,
                       bool here) {
    std::string text;
    for (const PathEquilibrium* e : known) {
        if (here ? e->contacts == list : e->contacts != list && e->proved && e->low <= load && load <= e->high) {
            text += fmt::format(" {}", e->number);
        }
    }
    return text.empty() ? " none" : text;
}

/// Adds to the reason which known equilibria have the list of the vertex downhill, and which others support the load.
void add_others(JudgedFrame& judged, const Path& path, const Bundle& bundle) {
    if (judged.downhill.empty()) {
        return;
    }
    std::vector<const PathEquilibrium*> known;
    for (const BundleNode& node : bundle.nodes) {
        known.push_back(&node.equilibrium);
    }
    for (std::size_t k = 0; k < path.equilibria.size() && bundle.nodes.empty(); ++k) {
        known.push_back(&path.equilibria[k]);
    }
    const auto numbers = [&](bool here) { return numbers_of(known, judged.downhill, judged.result.stress, here); };
    judged.result.reason += fmt::format("; {} with its list:{}; others that support this load:{}",
                                        bundle.nodes.empty() ? "equilibria of the exact run" : "nodes of the bundle",
                                        numbers(true), numbers(false));
}

/// Finds the frame in the bundle too.
void place(JudgedFrame& judged, Bundle& bundle) {
    FrameResult& r = judged.result;
    r.node = r.status == FrameStatus::file || r.status == FrameStatus::moving ? -1 : node_with(bundle, judged.list);
    if (r.node < 0) {
        return;
    }
    BundleNode& node = bundle.nodes[static_cast<std::size_t>(r.node)];
    node.frames.push_back(r.frame);
    if (r.status == FrameStatus::other) {
        r.reason = fmt::format("node {} of the bundle, which {} of {} members come through", r.node,
                               node.members.size(), bundle.members.size());
    }
}

/// The next requested frames, at most so many.
std::vector<Frame> read_some(SeriesReader& reader, std::size_t most, const CompareOptions& options) {
    std::vector<Frame> out;
    while (out.size() < most) {
        auto frame = reader.next();
        if (!frame || frame->number > options.frames[1]) {
            break;
        }
        if (frame->number < options.frames[0]) {
            continue;
        }
        if (options.start && options.start->packing.radius != frame->packing.radius) {
            refuse(frame->row, "other radii than the start of the exact run (--reference): expected the same disks, in "
                               "the order of their ids");
        }
        for (std::size_t a = 0; options.start && a + 1 < frame->packing.axes(); ++a) {
            const double stress = frame->load.stress[a] / frame->scale, expected = options.start->load.stress[a];
            if (!(std::abs(stress - expected) <= 1e-9 * expected)) { // both numbers have the digits of a file
                refuse(frame->row, "sigma{} is {}{}: expected {}, that of the start of the exact run (--reference)",
                       a + 1, stress, frame->scale == 1 ? "" : " times sigma1", expected);
            }
        }
        out.push_back(std::move(*frame));
    }
    return out;
}

/// Whether the exact run from the frame before ends at the list of the frame; empty: it is not asked.
std::string outcome(const JudgedFrame& before, const JudgedFrame& after, const RunOptions& options) {
    const FrameResult& r = after.result;
    if (!before.state || r.status == FrameStatus::file || r.status == FrameStatus::moving) {
        return {};
    }
    const auto list = list_after(*before.state, r.stress, false, options);
    return !list.ok()                   ? "undecided: " + list.failure().message(before.state->packing.dimension)
           : list.value() == after.list ? "same"
                                        : "other";
}

/// Each frame against the exact run from the previous frame, a score on which an earlier departure has no effect: sets
/// `local` of every frame at rest, from number `first` on, whose previous frame has a state.
void compare_with_frame_before(std::vector<JudgedFrame>& frames, std::size_t first, const RunOptions& options) {
    parallel_pieces(frames.size() - first, [&](std::size_t k) {
        if (const std::size_t at = first + k; at > 0) {
            frames[at].result.local = outcome(frames[at - 1], frames[at], options);
        }
    });
}

/// Judges as many frames in parallel as there are threads: only their coordinates and states are in memory. `start`: if
/// empty, set to the state of the first frame with one; until then frames are read singly.
std::vector<JudgedFrame> judge_all(SeriesReader& reader, const CompareOptions& options, const RunOptions& run,
                                   std::optional<State>& start) {
    std::vector<JudgedFrame> judged;
    while (options.stop == nullptr || !options.stop->load()) {
        const std::vector<Frame> frames = read_some(reader, start ? static_cast<std::size_t>(threads()) : 1, options);
        if (frames.empty()) {
            break;
        }
        const std::size_t first = judged.size();
        const bool complete = !start || options.local;
        judged.resize(first + frames.size());
        parallel_pieces(frames.size(),
                        [&](std::size_t k) { judged[first + k] = judge(reader.series(), frames[k], complete); });
        if (options.local) {
            compare_with_frame_before(judged, first, run);
        }
        start = start ? start : judged.back().state;
        for (std::size_t k = first == 0 ? 0 : first - 1; k + 1 < judged.size(); ++k) {
            judged[k].state.reset();
        }
    }
    return judged;
}

int status_of(const std::vector<FrameResult>& frames) {
    const auto has = [&](auto what) { return std::ranges::any_of(frames, what); };
    const auto at_rest_and_elsewhere = [](const FrameResult& f) {
        return f.status != FrameStatus::same && f.status != FrameStatus::moving && f.status != FrameStatus::undecided;
    };
    const auto is = [](FrameStatus status) { return [status](const FrameResult& f) { return f.status == status; }; };
    return has(at_rest_and_elsewhere)                                       ? 1
           : has(is(FrameStatus::undecided)) || !has(is(FrameStatus::same)) ? 2 // or no frame is at rest
                                                                            : 0;
}

} // namespace

Comparison compare(SeriesReader& reader, const CompareOptions& options) {
    const Series& series = reader.series();
    Comparison out;
    out.dimension = series.dimension;
    RunOptions run;
    run.rule = options.rule;
    run.stop = options.stop;
    std::optional<State> start = options.start;
    if (start) {
        if (start->packing.dimension != series.dimension || start->load.loaded_axis != series.dimension - 1 ||
            start->load.path) {
            refuse(
                ErrorKind::bad_input,
                "the start of the exact run (--reference) loads {} of {}s: expected sigma{} of {}s, as the frames do",
                start->load.stress_name(), grain_word(start->packing.dimension), series.dimension,
                grain_word(series.dimension));
        }
        if (series.several) {
            start->load = over(start->load, start->load.stress[0]);
        }
        (void)snap_to_grid(start->packing); // the bounds of a cell hold for coordinates on the grid
        reader.begin_after(start->packing);
    }
    std::vector<JudgedFrame> judged = judge_all(reader, options, run, start);
    Path path;
    std::vector<double> loads;
    for (const JudgedFrame& frame : judged) {
        loads.push_back(frame.result.stress);
    }
    if (start) {
        NearestArcs arcs(judged);
        path = follow_beyond(*start, loads, run, series.linear_stiffness(), options.nearest_arc ? &arcs : nullptr);
        if (options.nearest_arc) {
            arcs.tell(judged, series.dimension);
        }
    } else {
        path.at_load.assign(loads.size(), -1);
        path.end = "no frame has a proved vertex to start from";
    }
    if (start) {
        out.bundle = make_bundle(*start, path, loads, options.bundle, run);
    }
    for (std::size_t k = 0; k < judged.size(); ++k) {
        place(judged[k], path, path.at_load[k]);
        place(judged[k], out.bundle);
        add_others(judged[k], path, out.bundle);
        std::string& reason = judged[k].result.reason;
        reason += (reason.empty() || judged[k].note.empty() ? "" : "; ") + judged[k].note;
        out.frames.push_back(judged[k].result);
    }
    out.departure = find_departure(series, judged, path, out.bundle, options);
    out.path = std::move(path.equilibria);
    out.path_end = path.end;
    out.status = status_of(out.frames);
    return out;
}

} // namespace isostat::compare
