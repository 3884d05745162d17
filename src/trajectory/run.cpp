#include "contact/words.hpp"
#include "core/roundoff.hpp"
#include "packing/arc_bodies.hpp"
#include "trajectory/rearrangement.hpp"
#include "trajectory/steering.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

namespace isostat {

namespace {

using roundoff::infinity;

/// The vertex that a segment starts from.
struct SegmentStart {
    std::shared_ptr<Vertex> vertex;
    Vertex::Gaps gaps;   ///< none is negative
    bool chosen = false; ///< first-order terms chose contacts among the touching pairs
};

Result<SegmentStart> prove_start(const State& state, Prover& prover) {
    auto vertex = prover.vertex(state.packing, state.contacts, {state.load});
    if (!vertex.ok()) {
        return vertex.failure();
    }
    auto gaps = prover.gaps(*vertex.value());
    if (!gaps.ok()) {
        return gaps.failure();
    }
    return SegmentStart{std::move(vertex.value()), std::move(gaps.value())};
}

/// True: a choice was made.
Result<bool> choose_contacts(State& state, Prover& prover, const TieSettling& ties) {
    const auto dofs = static_cast<std::size_t>(DofMap(state.packing).dof_count());
    const bool hyperstatic = state.contacts.size() > dofs;
    if (hyperstatic) {
        if (auto failure = ties.choose_contacts()) {
            return *failure;
        }
    }
    const auto listed = prove_start(state, prover);
    if (!listed.ok()) {
        return listed.failure();
    }
    const ZeroGaps& zero = listed.value().gaps.zero;
    const auto overlap = settle_touching(*listed.value().vertex, zero);
    if (hyperstatic || !overlap || overlap->kind != FailureKind::overlap) {
        return hyperstatic;
    }
    for (const auto& [contact, order] : zero) {
        state.contacts.push_back(contact);
    }
    if (auto failure = ties.choose_contacts()) {
        return *failure;
    }
    return true;
}

/// Proves what a state says: a vertex at which no pair overlaps. Where ties are settled, and unless the run is
/// `resumed`, a hyperstatic start keeps (in `state.contacts`) those contacts of its list that carry the load for small
/// eps > 0. Where a run may not choose, another list whose touching pairs overlap at first order is joined by these,
/// and keeps as many. Failures: `overlap`, those of `Prover::vertex` and `Prover::gaps`, and of the choice.
Result<SegmentStart> start_segment(State& state, Prover& prover, const TieSettling& ties, bool resumed) {
    prover.start_at(state.packing);
    bool chosen = false;
    if (ties.settles() && !resumed) {
        const auto choice = choose_contacts(state, prover, ties);
        if (!choice.ok()) {
            return choice.failure();
        }
        chosen = choice.value();
    }
    auto start = prove_start(state, prover);
    if (!start.ok()) {
        return start;
    }
    SegmentStart& begun = start.value();
    if (begun.gaps.negative) {
        return failed(FailureKind::overlap, "{} overlap", named(*begun.gaps.negative));
    }
    if (auto failure = ties.resume(*begun.vertex, begun.gaps.zero)) {
        return *failure;
    }
    begun.chosen = chosen || !begun.gaps.zero.empty();
    return start;
}

/// One segment: from equilibrium to limit load, and by a rearrangement to the next equilibrium.
class Run {
  public:
    Run(State& state, const Segment& segment, int number, Recorder recorder)
        : state_(state), segment_(segment), number_(number), recorder_(recorder), counters_(recorder_.counters),
          seconds_before_(counters_.seconds) {}

    SegmentOutcome run();

  private:
    [[nodiscard]] bool resumed() const { return counters_.equilibria != 0 || counters_.steps != 0; }
    [[nodiscard]] LimitLoad load() const { return {state_.load}; }
    [[nodiscard]] double sigma() const { return state_.load.loaded_stress(); }
    [[nodiscard]] double elapsed() const {
        return seconds_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

    std::optional<Failure> start();
    std::optional<Failure> resume();
    std::optional<Failure> first_equilibrium(const SegmentStart& start);
    std::optional<Failure> still_equilibrium();
    std::optional<Failure> reload();
    /// True: the segment has reached its goal.
    Result<bool> next_equilibrium();
    Result<LoadLimit> find_limit();
    Result<bool> reach_stress(const LoadLimit& limit);
    Result<Reached> follow(const Opening& opening, ArcKind kind, const LimitLoad& at, bool& begun);
    std::optional<double> beyond_limit();
    std::optional<Failure> rearrange(const Opening& opening, ArcKind kind, LimitLoad at);
    std::optional<Failure> report(int arcs, std::optional<Result<Description>> known = std::nullopt);

    State& state_;
    const Segment& segment_;
    int number_;
    Recorder recorder_;
    RunCounters& counters_;
    double seconds_before_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::unique_ptr<const TieSettling> ties_ = tie_settling(state_, recorder_.options);
    Prover prover_{recorder_.options, *ties_};
    std::shared_ptr<Vertex> vertex_;
    EquilibriumRecord record_;                       ///< of `vertex_`
    std::array<std::optional<LoadLimit>, 2> limits_; ///< of `vertex_`, as `describe` found them
    int made_ = -1; ///< equilibria of the segment; making the start an equilibrium does not count
};

SegmentOutcome Run::run() {
    SegmentOutcome outcome;
    outcome.failure = start();
    made_ = 0;
    while (!outcome.failure && !outcome.completed) {
        if (segment_.equilibria && made_ >= *segment_.equilibria) {
            outcome.completed = true;
        } else if (auto reached = next_equilibrium(); reached.ok()) {
            outcome.completed = reached.value();
        } else {
            outcome.failure = reached.failure();
        }
    }
    if (outcome.failure &&
        (outcome.failure->kind == FailureKind::undecided || outcome.failure->kind == FailureKind::tie)) {
        ++counters_.tally.undecided;
        counters_.tally.ties += outcome.failure->kind == FailureKind::tie ? 1 : 0;
    }
    return outcome;
}

std::optional<Failure> Run::start() {
    auto begun = start_segment(state_, prover_, *ties_, resumed());
    if (!begun.ok()) {
        return located(begun.failure(), "start");
    }
    vertex_ = begun.value().vertex;
    return resumed() ? resume() : first_equilibrium(begun.value());
}

/// Repeats the decisions made when the equilibrium was found: the statics
/// are then on the same rung, and the run goes on with the same bits.
std::optional<Failure> Run::resume() {
    if (auto failure = still_equilibrium()) {
        return failure;
    }
    auto described = describe(*vertex_, state_.load);
    if (!described.ok()) {
        return located(described.failure(), "start");
    }
    record_ = described.value().record;
    limits_ = described.value().limit;
    return std::nullopt;
}

/// Rearranges the start at its own load where a force is negative.
std::optional<Failure> Run::first_equilibrium(const SegmentStart& start) {
    recorder_.count({DecisionKind::gaps, start.gaps.margin, start.gaps.rung});
    auto decided = prover_.decide(*vertex_, sigma(), {}, 0);
    if (!decided.ok()) {
        return located(decided.failure(), "start");
    }
    const OpeningDecision& decision = decided.value();
    if (vertex_->perturbed) { // what the record of the first arc says else is decided at its end
        vertex_->perturbed->zeros = decision.zeros;
        std::vector<TieDecision>& log = vertex_->perturbed->statics.log;
        std::erase_if(log, [](const TieDecision& tie) { return tie.what == "force"; });
        std::ranges::for_each(log, [](TieDecision& tie) { tie.what = "start"; });
    }
    if (decision.opening) {
        const Contact& opens = vertex_->structure.contacts()[decision.opening->contact.index()];
        return rearrange(*decision.opening, kind_of(opens, decision.opening->infinitesimal), load());
    }
    recorder_.count({DecisionKind::equilibrium, decision.margin, decision.rung, decision.perturbed || start.chosen});
    return report(0);
}

/// Proves again what the state stores about `vertex_`; with first-order terms it must still be an equilibrium.
std::optional<Failure> Run::still_equilibrium() {
    auto decision = prover_.ask_again(*vertex_, sigma());
    if (!ties_->settles() || (decision.ok() && !decision.value().opening)) {
        return std::nullopt;
    }
    return failed(FailureKind::undecided,
                  "equilibrium at sigma = {:.17g}: not found again with the load as it is stored{}", sigma(),
                  decision.ok() ? Words() : words(": {}", decision.failure()));
}

/// The same vertex under another load, whose stored stress is exact.
std::optional<Failure> Run::reload() {
    ties_->load_is_stored();
    const auto touching = vertex_->perturbed->touching;
    const ZeroGaps zero = vertex_->perturbed->zero;
    auto made = prover_.vertex(vertex_->packing, vertex_->structure.contacts(), load());
    if (!made.ok()) {
        return made.failure();
    }
    vertex_ = std::move(made.value());
    vertex_->perturbed->touching = touching;
    vertex_->perturbed->zero = zero;
    return still_equilibrium();
}

Result<bool> Run::next_equilibrium() {
    if (recorder_.stopped()) {
        return failed(FailureKind::interrupted, "stopped at equilibrium {}", counters_.equilibria);
    }
    if (holds_what_bears(*vertex_)) {
        return failed(FailureKind::undecided,
                      "equilibrium {} still holds {} coordinate(s): it is one at this load only, and no "
                      "contact limits it",
                      counters_.equilibria, record_.held);
    }
    auto found = find_limit();
    if (!found.ok()) {
        return located(found.failure(), fmt::format("limit of equilibrium {}", counters_.equilibria));
    }
    const LoadLimit& limit = found.value();
    counters_.tally.structural_ties += limit.tie_class.size() > 1 ? 1 : 0;
    auto reached = reach_stress(limit);
    if (!reached.ok() || reached.value()) {
        return reached;
    }
    if (limit.unbounded) {
        return failed(FailureKind::no_limit, "equilibrium {} supports every load in this direction: no contact opens",
                      counters_.equilibria);
    }
    Opening opening;
    opening.contact = limit.opens;
    opening.force = {0, std::abs(vertex_->statics.slope(limit.opens).value) * limit.stress_error};
    opening.margin = limit.margin;
    opening.rung = limit.rung;
    opening.perturbed = limit.perturbed;
    LimitLoad at = load();
    at.set_stress(limit.stress);
    ties_->set_limit(at, *vertex_, limit.opens, limit.stress_error);
    ++counters_.equilibria;
    if (auto failure = rearrange(opening, ArcKind::limit, std::move(at))) {
        --counters_.equilibria; // the steps stay counted, because their records are written
        counters_.seconds = elapsed();
        return *failure;
    }
    ++made_;
    return false;
}

/// Where the statics have climbed since `describe`, the limit has other bits now;
/// a resumed run, whose statics climb at other moments, must find the same limit
/// as recorded. With first-order terms ties are written to the log once more.
Result<LoadLimit> Run::find_limit() {
    if (vertex_->perturbed) {
        vertex_->perturbed->statics.log.clear();
    }
    const std::optional<LoadLimit>& known = limits_[segment_.direction > 0 ? 1 : 0];
    if (known && !ties_->settles() && vertex_->statics.rung() == Rung::double_bound) {
        return *known;
    }
    return isostat::find_limit(vertex_->statics, sigma(), segment_.direction, vertex_->first_order());
}

/// The stress that the segment is to reach, if it lies before the limit, is an equilibrium too. True: it was reached.
Result<bool> Run::reach_stress(const LoadLimit& limit) {
    if (!segment_.to_stress) {
        return false;
    }
    const double ahead = limit.unbounded ? infinity : segment_.direction * (limit.stress - *segment_.to_stress);
    if (!limit.unbounded && std::abs(ahead) <= limit.stress_error) {
        return failed(FailureKind::undecided,
                      "the stress {:.17g} to reach cannot be told from the limit {:.17g} of equilibrium {}",
                      *segment_.to_stress, limit.stress, counters_.equilibria);
    }
    if (!(ahead > 0)) {
        return false;
    }
    state_.load.set_loaded_stress(*segment_.to_stress);
    if (ties_->settles()) {
        if (auto failure = reload()) {
            return *failure;
        }
    }
    ++counters_.equilibria;
    if (auto failure = report(0)) {
        return *failure;
    }
    return true;
}

/// `begun`: an arc was recorded.
Result<Reached> Run::follow(const Opening& opening, ArcKind kind, const LimitLoad& at, bool& begun) {
    prover_.start_at(vertex_->packing);
    Rearrangement rearrangement({vertex_, opening, kind, at}, prover_, recorder_);
    auto reached = rearrangement.run();
    begun = rearrangement.arcs() > 0;
    return reached;
}

/// The first double beyond the limit; nothing: the limit is not known to within one double. The double nearest to the
/// limit may lie before the limit, where the force that opens is still positive by a rounding: the potential then grows
/// along the first part of the arc, which is as short as that rounding.
std::optional<double> Run::beyond_limit() {
    const int direction = segment_.direction;
    auto found = isostat::find_limit(vertex_->statics, sigma(), direction, nullptr);
    const auto known = [&] {
        const double size = std::abs(found.value().stress);
        return found.value().stress_error <= std::nextafter(size, infinity) - size;
    };
    while (found.ok() && !known() && vertex_->statics.climb()) {
        found = isostat::find_limit(vertex_->statics, sigma(), direction, nullptr);
    }
    if (!found.ok() || !known()) {
        return std::nullopt;
    }
    return std::nextafter(found.value().stress + direction * found.value().stress_error, direction * infinity);
}

/// Where the first arc from a limit is undecided, and without first-order terms, the rearrangement begins again with
/// the load rounded away from the equilibrium; only the attempt that is returned counts.
std::optional<Failure> Run::rearrange(const Opening& opening, ArcKind kind, LimitLoad at) {
    const RunCounters before = counters_;
    bool begun = false;
    auto reached = follow(opening, kind, at, begun);
    const bool in_vain = !reached.ok() && reached.failure().kind == FailureKind::undecided && !begun;
    if (in_vain && kind == ArcKind::limit && !recorder_.options.at_first_order()) {
        if (const auto stress = beyond_limit()) {
            counters_ = before;
            at.set_stress(*stress);
            reached = follow(opening, kind, at, begun);
        }
    }
    if (!reached.ok()) {
        return reached.failure();
    }
    Reached& there = reached.value();
    vertex_ = std::move(there.proof.vertex);
    state_.load = std::move(at.load);
    state_.packing = vertex_->packing;
    state_.contacts = vertex_->structure.contacts();
    return report(there.arcs, std::move(there.proof.description));
}

std::optional<Failure> Run::report(int arcs, std::optional<Result<Description>> known) {
    auto described = known ? std::move(*known) : describe(*vertex_, state_.load);
    if (!described.ok()) {
        return located(described.failure(), fmt::format("equilibrium at sigma = {:.17g}", sigma()));
    }
    EquilibriumRecord& record = described.value().record;
    limits_ = described.value().limit;
    if (auto failure = record_smallest_gap(record, *vertex_, described.value().vertex, prover_.candidates())) {
        return located(*failure, fmt::format("equilibrium at sigma = {:.17g}", sigma()));
    }
    if (auto failure = check_no_overlap(*vertex_, state_.load, prover_.candidates())) {
        return failure;
    }
    recorder_.count({DecisionKind::equilibrium, record.margin, record.decided_by});
    recorder_.take_margin(record);
    record.number = counters_.equilibria;
    record.segment = number_;
    record.arcs = arcs;
    record.verdict = Verdict::proved;
    record.seconds = elapsed();
    ties_->store(*vertex_, record);
    record_ = record;
    state_.equilibrium = counters_.equilibria;
    counters_.seconds = elapsed();
    recorder_.observer.on_structure(*vertex_);
    recorder_.observer.on_equilibrium(record, state_, finite_forces(*vertex_, state_.load));
    return recorder_.observer.objection();
}

/// First-order ties are only proved for single grains.
void require_no_ties_of_clumps(const State& state, const RunOptions& options) {
    if (!state.packing.bars.empty() && options.at_first_order()) {
        throw Error(ErrorKind::bad_input, "state: a packing of clumps: expected ties = \"stop\"");
    }
}

} // namespace

SegmentOutcome run_segment(State& state, const Segment& segment, int segment_number, const RunOptions& options,
                           RunCounters& counters, RunObserver& observer) {
    require_floating_point();
    require_followed(state, "state");
    require_no_arcs(state.packing, "state", "a run");
    require_no_ties_of_clumps(state, options);
    if (options.certify == CertifyLevel::arcs && state.load.path) { // the power of an arc uses stored stresses
        throw Error(ErrorKind::bad_input, "state: several stresses change together, and certify is arcs: expected "
                                          "decisions or states");
    }
    const double stress = state.load.loaded_stress();
    if (segment.to_stress && segment.direction * (*segment.to_stress - stress) < 0) {
        return {false, failed(FailureKind::no_limit,
                              "the stress {:.17g} to reach lies behind the load, "
                              "which is {:.17g}",
                              *segment.to_stress, stress)};
    }
    return Run(state, segment, segment_number, {options, counters, observer}).run();
}

} // namespace isostat
