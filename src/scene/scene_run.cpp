#include "certificate/state_certifier.hpp"
#include "core/refuse.hpp"
#include "io/json.hpp"
#include "packing/arc_bodies.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

using json::Json;

RunStatus status_of(FailureKind kind) {
    switch (kind) {
    case FailureKind::tie:
    case FailureKind::undecided: return RunStatus::undecided;
    case FailureKind::interrupted: return RunStatus::interrupted;
    default: return RunStatus::failed;
    }
}

/// Calls two observers in turn, the files first.
class Both final : public RunObserver {
  public:
    Both(RunObserver& first, RunObserver& second) : first_(first), second_(second) {}
    void on_segment(int number, const Segment& goal, int made, const State& from) override {
        first_.on_segment(number, goal, made, from);
        second_.on_segment(number, goal, made, from);
    }
    void on_arc(const ArcRecord& arc) override {
        first_.on_arc(arc);
        second_.on_arc(arc);
    }
    void on_equilibrium(const EquilibriumRecord& record, const State& state,
                        const std::vector<double>& forces) override {
        first_.on_equilibrium(record, state, forces);
        second_.on_equilibrium(record, state, forces);
    }

  private:
    RunObserver& first_;
    RunObserver& second_;
};

} // namespace

void choose_loaded(State& state, const Scene& scene, const std::string& source) {
    const auto bad = [&](const char* what, const char* expected) {
        refuse(source, "{}, and 'loaded' in [load] of {} is \"{}\": expected {}", what, scene.file, scene.loaded,
               expected);
    };
    const Packing& packing = state.packing;
    const bool in_plane = packing.dimension == plane;
    const std::vector<std::string> words = in_plane ? std::vector<std::string>{"", "y", "tilt"}
                                                    : std::vector<std::string>{"x", "y", "z", "xy", "xz", "yz"};
    if (!scene.path.empty()) {
        if (const std::string fault = fault_of_path(packing, scene.path); !fault.empty()) {
            refuse(source, "[load] of {} names a direction in the space of stresses, {}", scene.file, fault);
        }
        StressRates rate{};
        std::ranges::copy(scene.path, rate.begin());
        state.load.follow(rate);
        return;
    }
    if (scene.loaded.empty()) {
        return;
    }
    state.load.path.reset();
    const auto axis = static_cast<std::size_t>(std::ranges::find(words, scene.loaded) - words.begin());
    if (axis == words.size()) {
        bad(in_plane ? "disks" : "spheres", in_plane ? "\"y\" or \"tilt\"" : "an axis, x to z, or a tilt, xy to yz");
    }
    if (axis >= packing.axes() && !(packing.cell.any() && packing.cell.tilt_moves[axis - packing.axes()])) {
        bad(in_plane ? "no tilt moves" : "that tilt does not move",
            in_plane ? "\"y\", or a cell whose tilt moves" : "an axis, or a tilt that moves");
    }
    state.load.loaded_axis = static_cast<int>(axis);
}

/// Adds an entry to the provenance of the state.
template <class Value> void note(State& state, const char* name, const Value& value) {
    Json provenance = state.provenance.empty() ? Json::object() : Json::parse(state.provenance);
    provenance[name] = value;
    state.provenance = provenance.dump();
}

/// Brings free motions to rest under infinitesimal loads, like rattlers. The state of the file is judged before.
State clumps_at_rest(State state, const Scene& scene, const std::string& source) {
    state = with_free_motions_held(std::move(state));
    check_start(state, source);
    if (state.load.infinitesimal.empty()) {
        constexpr unsigned long long seed = 1;
        state.load.infinitesimal = generic_infinitesimal(state.packing.radius, seed, state.packing.dimension);
        balance(state.load.infinitesimal, state.packing.cell);
    }
    const bool moves =
        std::ranges::any_of(state.contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
    if (!moves) {
        return state; // if a force is negative, the run records the rearrangement
    }
    State unpressed = state;
    unpressed.load.infinitesimal.clear();
    if (const Certification truth = certify(unpressed); !truth.claims.counting) {
        refuse(source,
               "{}: a trajectory of clumps starts from an isostatic structure, but for bodies that bear no force or "
               "turn about one member",
               truth.claims.undecided.front());
    }
    Segment rest;
    rest.equilibria = 0; // only the initial equilibrium
    RunCounters counters;
    RunObserver nobody;
    RunOptions options = scene.run;
    options.certify = CertifyLevel::decisions;
    options.max_strain = HUGE_VAL; // the load is constant
    (void)snap_to_grid(state.packing);
    const SegmentOutcome outcome = run_segment(state, rest, 0, options, counters, nobody);
    if (outcome.failure) {
        refuse(source, "bodies that are free to move do not come to rest: {}",
               outcome.failure->message(state.packing.dimension));
    }
    note(state, "arcs_to_rest", counters.steps);
    return state;
}

State start_of_scene(State state, const Scene& scene, const std::string& source) {
    if (scene.load_kind) {
        state.load.kind = *scene.load_kind;
    }
    choose_loaded(state, scene, source);
    if (scene.infinitesimal_seed) {
        state.load.infinitesimal =
            generic_infinitesimal(state.packing.radius, *scene.infinitesimal_seed, state.packing.dimension);
        balance(state.load.infinitesimal, state.packing.cell);
    }
    state.equilibrium = 0;
    state.perturbation.reset(); // a run chooses its own
    for (std::size_t a = 0; a < state.packing.axes(); ++a) {
        if (!(state.load.stress[a] > 0)) {
            refuse(source, "load.stress[{}] is {}: expected a positive stress", a, state.load.stress[a]);
        }
    }
    require_followed(state, source);
    require_no_arcs(state.packing, source, "a run");
    if (!state.packing.bars.empty()) {
        state = clumps_at_rest(std::move(state), scene, source);
    }
    check_start(state, source, scene.run.at_first_order());
    check_programme(scene, state.load.ratio());
    if (const double moved = snap_to_grid(state.packing); moved > 0) { // the file's state is judged before
        note(state, "moved_to_grid", moved);
    }
    return state;
}

State start_from_file(const Scene& scene) {
    return start_of_scene(read_any_state(scene.start, Dimensions::any_clumps).state, scene, scene.start.string());
}

std::string provenance_of(const Scene& scene, const std::string& program, const std::string& command,
                          const PreparationReport& report) {
    Json provenance;
    provenance["program"] = program;
    provenance["command"] = command;
    provenance["scene_file"] = scene.file;
    provenance["settings"] = Json::parse(settings_json(scene));
    provenance["infinitesimal_seed"] = report.infinitesimal_seed;
    provenance["linear_programmes"] = report.programmes;
    provenance["pivots"] = report.pivots;
    return json::dumped(provenance);
}

RunHeader header_of(const Scene& scene, const std::string& program, const std::string& command) {
    RunHeader header;
    header.program = program;
    header.command = command;
    header.scene_name = scene.file;
    header.scene_text = scene.text;
    header.settings = settings_json(scene);
    for (const ProgrammeStep& step : scene.programme) {
        header.programme.push_back(step.name);
    }
    header.keep = needed_equilibria(scene);
    header.states_every = scene.states_every;
    header.witnesses = scene.run.certify == CertifyLevel::arcs;
    header.touching = scene.run.at_first_order();
    header.checkpoint_seconds = scene.checkpoint_seconds;
    return header;
}

std::string advice(const Scene& scene, const Failure& failure, const Packing& packing) {
    std::vector<double> radius = packing.radius;
    const bool can_choose = !scene.run.chooses();
    std::ranges::sort(radius);
    const bool equal = std::ranges::adjacent_find(radius) != radius.end();
    const bool open = failure.kind <= FailureKind::undecided || failure.kind == FailureKind::not_converged;
    if (!open) {
        return "";
    }
    if (!scene.start.empty()) {
        return equal ? fmt::format("; equal radii: try isostat import {} --jitter 1e-9 --contacts nearest{}",
                                   scene.start.string(), can_choose ? ", or ties = \"choose\" in [run]" : "")
                     : "";
    }
    constexpr double ample = 1e-6;
    const double jitter = scene.preparation.jitter;
    // When all radii are equal most arcs have ties: a smaller jitter leaves more runs undecided (src/scene/README.md).
    const bool all = equal && radius.front() == radius.back();
    const bool choose = can_choose && !scene.programme.empty();
    return equal && jitter == 0 ? fmt::format("; equal radii: try [packing] jitter = {}{}", all ? "1e-4" : "1e-9",
                                              choose ? ", or ties = \"choose\" in [run]" : "")
           : jitter > 0 && jitter < ample ? fmt::format("; nearly equal radii: try a larger jitter than {}", jitter)
                                          : "";
}

SceneEnding ending_of(const Failure& failure, const std::string& where, int dimension) {
    return {status_of(failure.kind),
            fmt::format("{}{}: {}", where, to_string(failure.kind), failure.message(dimension)), failure};
}

SceneEnding play_scene(const Scene& scene, State state, RunDirectory& directory, const std::string& program,
                       RunCounters& counters, const std::atomic<bool>& stop, RunObserver& further) {
    Programme programme;
    programme.steps = scene.programme;
    programme.source = scene.file;
    programme.stored = [&](int equilibrium) { return directory.stored(equilibrium); };
    if (const auto& point = directory.checkpoint()) {
        state = point->state;
        counters = point->counters;
        const std::optional<int> goal = scene.programme[static_cast<std::size_t>(point->segment)].equilibria;
        if (goal && point->made > *goal) {
            refuse((directory.path() / "checkpoint.json").string(),
                   "made is {}: expected at most {}, as the scene says", point->made, *goal);
        }
        programme.first = static_cast<std::size_t>(point->segment) + (point->segment_done ? 1 : 0);
        programme.made = point->segment_done ? 0 : point->made;
    }
    if (counters.states.refuted > 0) {
        return {RunStatus::failed, "an equilibrium of this run was refuted by its certificate: it does not go on", {}};
    }
    RunOptions options = scene.run;
    options.stop = &stop;
    Both both(directory, further);
    std::optional<StateCertifier> certifier;
    if (options.certify >= CertifyLevel::states) {
        certifier.emplace(directory.path(), program, counters, both);
    }
    RunObserver& observer = certifier ? static_cast<RunObserver&>(*certifier) : both;
    const ProgrammeOutcome outcome = play(programme, state, options, counters, observer);
    if (outcome.failure) {
        SceneEnding ending =
            ending_of(*outcome.failure, fmt::format("segment \"{}\": ", outcome.segment), state.packing.dimension);
        ending.reason += advice(scene, *outcome.failure, state.packing);
        return ending;
    }
    return outcome.impossible.empty() ? SceneEnding{} : SceneEnding{RunStatus::failed, outcome.impossible, {}};
}

} // namespace isostat
