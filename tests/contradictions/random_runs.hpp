#pragma once
// Runs drawn at random: the start, the programme, the settings, and where they are killed.

#include "contradictions/states.hpp"
#include "support/played.hpp"
#include "support/scratch.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/scene/scene.hpp>

namespace contradictions {

namespace fs = std::filesystem;
using namespace isostat;

struct RandomRun {
    State start;
    std::vector<Segment> segments;
    std::vector<double> change; ///< per segment: to which part more of its first load it goes; 0: equilibria count
    RunOptions options;
    int states_every = 1;
    long killed_at = 0; ///< during this arc, and resumed; 0: never

    [[nodiscard]] std::string text() const {
        return fmt::format("{} disks, rule {}, level {}, ties {}{}, {} segments, states_every {}, killed at {}",
                           start.packing.disk_count(), word_of(options.rule, opening_rule_words),
                           to_string(options.certify), word_of(options.ties, tie_policy_words),
                           options.chooses() || !options.at_first_order() ? "" : " nothing", segments.size(),
                           states_every, killed_at);
    }
};

/// The records of a run as the program handed them out.
struct Recorded {
    EquilibriumRecord record;
    State state;
    std::vector<double> forces;
};

namespace detail {

/// Of equal radii, of radii that differ by 1e-2 to 1e-15, or from 1 to 2.
inline std::vector<double> random_radii(int disks, Random& random) {
    const bool near = random.integer(2) == 0;
    const double spread = near ? std::pow(10, -random.real(2, 15)) : 1;
    std::vector<double> radii;
    for (int i = 0; i < disks; ++i) {
        radii.push_back(0.5 * (1 + spread * random.real()));
    }
    return radii;
}

inline std::optional<State> prepared_start(Random& random) {
    PreparationOptions options;
    const int most = random.integer(4) == 0 ? 60 : 14;
    options.disks = 2 + random.integer(most - 1);
    options.radii = random_radii(options.disks, random);
    options.seed = random.bits() >> 12;
    options.load = random.integer(5) == 0 ? LoadKind::true_stress : LoadKind::nominal;
    return prepared_or_none(options);
}

/// A pile, perhaps with fixed disks and forces on disks: rearrangements may end with "every load is supported".
inline std::optional<State> piled_start(Random& random) {
    PileOptions options{
        .disks = 2 + random.integer(7), .fixed = random.integer(3), .same = random.integer(2) == 0 ? 0.5 : 0};
    auto state = pile(options, random);
    if (!state) {
        return {};
    }
    if (random.integer(2) == 0) {
        return load(state, random, random.integer(2));
    }
    for (std::size_t a = 0; a < 2; ++a) {
        state->load.stress[a] = random.real(0.1, 2);
    }
    return state;
}

/// A few disks in a cell or a channel, or some more that are prepared.
inline std::optional<State> start_in_cell(Random& random) {
    if (random.integer(4) != 0) {
        return in_small_cell(static_cast<CellKind>(random.integer(3)), random);
    }
    PreparationOptions options{.disks = 20 + random.integer(21)};
    options.radii = random_radii(options.disks, random);
    options.seed = random.bits() >> 12;
    options.cell = random.integer(2) == 0 ? PreparedCell::rectangular : PreparedCell::tilted;
    return prepared_or_none(options);
}

/// Up or down by some equilibria, or to a stress inside or beyond what is supported: near ones need no arc.
inline void add_segment(RandomRun& run, Random& random) {
    Segment segment;
    segment.direction = random.integer(3) == 0 ? -1 : 1;
    run.change.push_back(random.integer(3) == 0 ? std::pow(10, -random.real(0.5, 8)) : 0);
    if (run.change.back() == 0) {
        segment.equilibria = 1 + random.integer(4);
    }
    run.segments.push_back(segment);
}

/// A disk that carries nothing as often as not.
inline void draw_pin(State& state, Random& random) {
    const Truth truth(state);
    if (!state.packing.cell.any() || !truth.known) {
        return;
    }
    std::vector<int> rattlers, others;
    for (int i = 0; i < state.packing.disk_count(); ++i) {
        bool carries = false;
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const Contact& c = state.contacts[l];
            const bool touches = c.i == i || (c.kind == ContactKind::disk_disk && c.j == i);
            carries = carries || (touches && sign_of(truth.force[l], truth.force_scale) != 0);
        }
        (carries ? others : rattlers).push_back(i);
    }
    const bool idle = others.empty() || (!rattlers.empty() && random.integer(2) == 0);
    const std::vector<int>& among = idle ? rattlers : others;
    state.packing.cell.pin = among[static_cast<std::size_t>(random.integer(static_cast<int>(among.size())))];
}

/// Hands the records on, keeps those of equilibria, and stops during an arc.
class Keeper final : public RunObserver {
  public:
    Keeper(RunObserver& next, std::vector<Recorded>& records, std::atomic<bool>& stop, long at)
        : next_(next), records_(records), stop_(stop), at_(at) {}
    void on_arc(const ArcRecord& arc) override {
        next_.on_arc(arc);
        stop_ = stop_ || arc.step == at_;
    }
    void on_equilibrium(const EquilibriumRecord& record, const State& state,
                        const std::vector<double>& forces) override {
        records_.push_back({record, state, forces});
        next_.on_equilibrium(record, state, forces);
    }
    [[nodiscard]] std::optional<Failure> objection() const override { return next_.objection(); }

  private:
    RunObserver& next_;
    std::vector<Recorded>& records_;
    std::atomic<bool>& stop_;
    long at_;
};

inline RunHeader header_of(const RandomRun& run) {
    RunHeader header;
    header.program = "test";
    header.settings = played::settings(run.options);
    header.touching = run.options.at_first_order();
    header.programme.assign(run.segments.size(), "a segment");
    header.states_every = run.states_every;
    header.witnesses = run.options.certify == CertifyLevel::arcs;
    header.checkpoint_seconds = 0;
    return header;
}

} // namespace detail

enum class Draw {
    all,
    choosing, ///< with ties = "choose"
    as_before ///< without the pin and what came with it: runs that cases name by their number
};

/// Nothing: the draw gave no start that a run takes.
inline std::optional<RandomRun> random_run(std::uint64_t seed, bool in_cell, Draw draw) {
    Random random(seed);
    Random more(seed + 1);
    auto start = in_cell                  ? detail::start_in_cell(random)
                 : random.integer(3) == 0 ? detail::piled_start(random)
                                          : detail::prepared_start(random);
    if (!start) {
        return {};
    }
    if (draw != Draw::as_before) {
        detail::draw_pin(*start, more);
        snap_to_grid(start->packing);
    }
    try {
        check_start(*start, "start");
    } catch (const Error&) {
        return {};
    }
    RandomRun run;
    snap_to_grid(start->packing);
    run.start = *start;
    run.options.rule = static_cast<OpeningRule>(
        random.integer(2) == 0 ? 0 : random.integer(static_cast<int>(opening_rule_words.size())));
    run.options.rule_seed = random.bits() >> 1;
    run.options.certify =
        static_cast<CertifyLevel>(std::max(0, random.integer(in_cell ? 2 : 4) - 1)); // cells: decisions
    run.options.max_strain = 1e3;
    run.options.max_arcs = 400;
    if (!in_cell && random.integer(5) == 0) {
        run.options.ties = TiePolicy::choose;
        run.options.max_choices = 0;
        run.options.ties_seed = random.bits();
    }
    for (int k = 1 + random.integer(3); k > 0; --k) {
        detail::add_segment(run, random);
    }
    run.states_every = 1 + 2 * random.integer(2);
    run.killed_at = random.integer(4) == 0 ? 1 + random.integer(12) : 0;
    if (draw != Draw::as_before && in_cell) {
        run.options.certify = static_cast<CertifyLevel>(more.integer(3));
    }
    if (draw == Draw::choosing || (draw == Draw::all && in_cell && more.integer(5) == 0)) {
        run.options.ties = TiePolicy::choose;
        run.options.max_choices = RunOptions().max_choices;
        run.options.ties_seed = more.bits();
    }
    return run;
}

/// Plays it into a folder, from its checkpoint if it has one; `stop_at`: killed during that arc (0: not). False:
/// killed.
inline bool play(RandomRun& run, const fs::path& folder, long stop_at, std::vector<Recorded>& records) {
    RunCounters counters;
    const bool resumes = fs::exists(folder);
    RunDirectory directory(folder, detail::header_of(run),
                           resumes ? RunDirectory::Mode::resume : RunDirectory::Mode::fresh, counters);
    State state = run.start;
    std::size_t first = 0;
    int made = 0;
    if (const auto& point = directory.checkpoint()) {
        state = point->state;
        counters = point->counters;
        first = static_cast<std::size_t>(point->segment) + (point->segment_done ? 1 : 0);
        made = point->segment_done ? 0 : point->made;
        records.resize(static_cast<std::size_t>(counters.equilibria) + 1);
    } else {
        directory.store_start(run.start);
        records.clear();
    }
    std::atomic<bool> stop{false};
    RunOptions options = run.options;
    options.stop = &stop;
    std::optional<StateCertifier> certifier;
    if (options.certify >= CertifyLevel::states) {
        certifier.emplace(folder, "test", counters, directory);
    }
    RunObserver& next = certifier ? static_cast<RunObserver&>(*certifier) : directory;
    detail::Keeper keeper(next, records, stop, stop_at);
    for (std::size_t s = first; s < run.segments.size(); ++s, made = 0) {
        if (run.change[s] > 0 && !run.segments[s].to_stress) {
            run.segments[s].to_stress = state.load.stress[1] * (1 + run.segments[s].direction * run.change[s]);
        }
        Segment segment = run.segments[s];
        directory.begin_segment(static_cast<int>(s), segment, made, state.equilibrium);
        if (segment.equilibria) {
            *segment.equilibria -= made;
        }
        const SegmentOutcome outcome = run_segment(state, segment, static_cast<int>(s), options, counters, keeper);
        if (!outcome.completed && outcome.failure->kind == FailureKind::interrupted) {
            return false; // no farewell: as after a kill
        }
        if (!outcome.completed) {
            const bool open =
                outcome.failure->kind == FailureKind::tie || outcome.failure->kind == FailureKind::undecided;
            directory.finish(open ? RunStatus::undecided : RunStatus::failed, outcome.failure->message());
            return true;
        }
    }
    directory.finish(RunStatus::completed, "");
    return true;
}

} // namespace contradictions
