#include "contact/words.hpp"
#include "core/roundoff.hpp"
#include "trajectory/rearrangement.hpp"

#include <isostat/core/error.hpp>
#include <isostat/core/machine.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>
#include <qd/dd_real.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace isostat {

namespace {

using roundoff::infinity;

/// One segment: from equilibrium to limit load, and by a rearrangement to the next equilibrium.
template <int Dim> class Run {
  public:
    Run(State<Dim>& state, const Segment& segment, int number, Recorder<Dim> recorder)
        : state_(state), segment_(segment), number_(number), recorder_(std::move(recorder)),
          counters_(recorder_.counters), seconds_before_(counters_.seconds) {}

    SegmentOutcome run();

  private:
    [[nodiscard]] bool perturbs() const { return first_order_ != nullptr; }
    [[nodiscard]] bool resumed() const { return counters_.equilibria != 0 || counters_.steps != 0; }
    [[nodiscard]] LimitLoad<Dim> load() const { return {state_.load, nullptr, 0, {0, 0}}; }
    [[nodiscard]] double sigma() const { return load().stress(); }
    [[nodiscard]] double elapsed() const {
        return seconds_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

    std::optional<Failure> start();
    Result<bool> choose_start();
    std::optional<Failure> resume();
    std::optional<Failure> first_equilibrium(const typename Vertex<Dim>::Gaps& gaps, bool touching);
    std::optional<Failure> still_equilibrium();
    std::optional<Failure> reload();
    /// True: the goal of the segment is reached.
    Result<bool> next_equilibrium();
    Result<LoadLimit> find_limit();
    Result<bool> reach_stress(const LoadLimit& limit);
    std::optional<double> beyond(double limit);
    /// A rearrangement as it was begun.
    struct Attempt {
        Opening opening;
        ArcKind kind = ArcKind::limit;
        LimitLoad<Dim> at;
        std::vector<TieDecision> chosen; ///< why this one opens, where the rule takes another first
        bool begun = false;              ///< an arc was recorded
        [[nodiscard]] bool in_vain(const Result<Reached<Dim>>& reached) const {
            return !reached.ok() && reached.failure().kind == FailureKind::undecided && !begun;
        }
    };
    Result<Reached<Dim>> begin_at_limit(Attempt& attempt);
    Result<Reached<Dim>> follow(Attempt& attempt);
    [[nodiscard]] Failure offering_class(const Failure& failure, ContactId first) const;
    std::optional<Failure> rearrange(const Opening& opening, ArcKind kind, LimitLoad<Dim> at);
    std::optional<Failure> report(int arcs, std::optional<Result<Description<Dim>>> known = std::nullopt);
    [[nodiscard]] std::optional<Failure> check(const EquilibriumRecord<Dim>& record);

    State<Dim>& state_;
    const Segment& segment_;
    int number_;
    Recorder<Dim> recorder_;
    RunCounters& counters_;
    double seconds_before_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::unique_ptr<const FirstOrderSide<Dim>> first_order_ = ///< null: ties end the run
        at_first_order(recorder_.options.ties)
            ? std::make_unique<const FirstOrderSide<Dim>>(state_, recorder_.options.ties_seed,
                                                          recorder_.options.ties == TiePolicy::choose)
            : nullptr;
    Prover<Dim> prover_{recorder_.options, first_order_.get()};
    std::shared_ptr<Vertex<Dim>> vertex_;
    EquilibriumRecord<Dim> record_;                  ///< of `vertex_`
    std::array<std::optional<LoadLimit>, 2> limits_; ///< of `vertex_`, as `describe` found them
    int made_ = -1; ///< equilibria of the segment; a start that is no equilibrium yet makes one that does not count
    std::unique_ptr<NextRearrangement<Dim>> next_; ///< if it was begun
};

template <int Dim> SegmentOutcome Run<Dim>::run() {
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

template <int Dim> std::optional<Failure> Run<Dim>::start() {
    const auto at_start = [](const Failure& failure) { return located(failure, "start"); };
    prover_.start_at(state_.packing);
    bool touching = false; // a choice at first order was made
    if (perturbs()) {
        auto chosen = choose_start();
        if (!chosen.ok()) {
            return at_start(chosen.failure());
        }
        touching = chosen.value();
    }
    auto made = prover_.vertex(state_.packing, state_.contacts, load());
    if (!made.ok()) {
        return at_start(made.failure());
    }
    vertex_ = std::move(made.value());
    auto gaps = prover_.gaps(*vertex_);
    if (!gaps.ok()) {
        return at_start(gaps.failure());
    }
    if (gaps.value().negative) {
        return failed(FailureKind::overlap, "start: {} overlap", named<Dim>(*gaps.value().negative));
    }
    if (perturbs()) {
        if (auto failure = first_order_->resume(*vertex_, gaps.value().zero)) {
            return at_start(*failure);
        }
        touching = touching || !gaps.value().zero.empty();
    }
    return resumed() ? resume() : first_equilibrium(gaps.value(), touching);
}

/// Of the contacts of a hyperstatic start those are kept that carry the load for small eps > 0: of those listed, and of
/// the pairs that touch without being listed. True: a choice was made.
template <int Dim> Result<bool> Run<Dim>::choose_start() {
    if (resumed()) {
        return false;
    }
    const auto dofs = static_cast<std::size_t>(DofMap<Dim>(state_.packing).dof_count());
    const bool hyperstatic = state_.contacts.size() > dofs;
    if (hyperstatic) {
        if (auto failure = first_order_->choose_contacts()) {
            return *failure;
        }
    }
    auto made = prover_.vertex(state_.packing, state_.contacts, load());
    if (!made.ok()) {
        return made.failure();
    }
    auto gaps = prover_.gaps(*made.value());
    if (!gaps.ok()) {
        return gaps.failure();
    }
    const auto overlap = settle_touching(*made.value(), gaps.value().zero);
    if (hyperstatic || !overlap || overlap->kind != FailureKind::overlap) {
        return hyperstatic;
    }
    for (const auto& [contact, order] : gaps.value().zero) {
        state_.contacts.push_back(contact);
    }
    if (auto failure = first_order_->choose_contacts()) {
        return *failure;
    }
    return true;
}

/// The same questions as when the equilibrium was found: the statics then stand on the same rung, and the run goes on
/// with the same bits.
template <int Dim> std::optional<Failure> Run<Dim>::resume() {
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

/// Rearranged at its own load where a force is negative.
template <int Dim>
std::optional<Failure> Run<Dim>::first_equilibrium(const typename Vertex<Dim>::Gaps& gaps, bool touching) {
    recorder_.count({DecisionKind::gaps, gaps.margin, gaps.rung});
    auto decided = prover_.decide(*vertex_, sigma(), {}, 0);
    if (!decided.ok()) {
        return located(decided.failure(), "start");
    }
    const OpeningDecision& decision = decided.value();
    if (decision.opening) {
        return rearrange(*decision.opening, decision.opening->infinitesimal ? ArcKind::rattler : ArcKind::tension,
                         load());
    }
    if (vertex_->perturbed) {
        vertex_->perturbed->zeros = decision.zeros;
        vertex_->perturbed->statics.log.clear();
    }
    recorder_.count({DecisionKind::equilibrium, decision.margin, decision.rung, decision.perturbed || touching});
    return report(0);
}

/// What the state stores says of `vertex_`; with first-order terms it must be an equilibrium again.
template <int Dim> std::optional<Failure> Run<Dim>::still_equilibrium() {
    auto decision = prover_.ask_again(*vertex_, sigma());
    if (!perturbs() || (decision.ok() && !decision.value().opening)) {
        return std::nullopt;
    }
    return failed(FailureKind::undecided,
                  "equilibrium at sigma = {:.17g}: not found again with the load as it is stored{}", sigma(),
                  decision.ok() ? Words() : words(": {}", decision.failure()));
}

/// The same vertex under another load, which is meant as it is stored.
template <int Dim> std::optional<Failure> Run<Dim>::reload() {
    first_order_->load_is_stored();
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

template <int Dim> Result<bool> Run<Dim>::next_equilibrium() {
    if (recorder_.stopped()) {
        return failed(FailureKind::interrupted, "stopped at equilibrium {}", counters_.equilibria);
    }
    if (record_.held > 0) {
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
    LimitLoad<Dim> at = load();
    at.set_stress(limit.stress);
    if (perturbs()) {
        at.shift = vertex_->statics.zero_of(limit.opens, limit.stress);
        at.error = limit.stress_error;
        at.stress_rate = vertex_->perturbed->statics.limit_rate(limit.opens, limit.stress, limit.stress_error);
    }
    ++counters_.equilibria;
    if (auto failure = rearrange(opening, ArcKind::limit, std::move(at))) {
        --counters_.equilibria; // the steps stay counted: their records are written
        counters_.seconds = elapsed();
        return *failure;
    }
    ++made_;
    return false;
}

/// Where the statics have climbed since `describe`, the same question has an answer with other bits; a resumed run,
/// whose statics climb at other moments, must find the same. With first-order terms ties are written to the log once
/// more.
template <int Dim> Result<LoadLimit> Run<Dim>::find_limit() {
    if (vertex_->perturbed) {
        vertex_->perturbed->statics.log.clear();
    }
    const std::optional<LoadLimit>& known = limits_[segment_.direction > 0 ? 1 : 0];
    if (known && !perturbs() && vertex_->statics.rung() == Rung::double_bound) {
        return *known;
    }
    return isostat::find_limit(vertex_->statics, sigma(), segment_.direction, vertex_->first_order());
}

/// The stress that the segment is to reach, if it lies before the limit: an equilibrium of its own. True: it does.
template <int Dim> Result<bool> Run<Dim>::reach_stress(const LoadLimit& limit) {
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
    LimitLoad<Dim> at = load();
    at.set_stress(*segment_.to_stress);
    state_.load = at.load;
    if (perturbs()) {
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

/// The first double beyond the limit at which a rearrangement began in vain; none: it is not known that well. The
/// nearest double may lie before the limit: the force that opens is then still positive, by roundings, and on a way as
/// short as those the potential grows.
template <int Dim> std::optional<double> Run<Dim>::beyond(double limit) {
    const double step = std::nextafter(std::abs(limit), infinity) - std::abs(limit);
    auto found = isostat::find_limit(vertex_->statics, sigma(), segment_.direction, vertex_->first_order());
    while (found.ok() && !(found.value().stress_error <= step) && vertex_->statics.climb()) {
        found = isostat::find_limit(vertex_->statics, sigma(), segment_.direction, vertex_->first_order());
    }
    if (!found.ok() || !(found.value().stress_error <= step)) {
        return std::nullopt;
    }
    return std::nextafter(found.value().stress + segment_.direction * found.value().stress_error,
                          segment_.direction * infinity);
}

/// In vain: its first arc is not decided. Then it may begin with the load rounded away, or, by `TiePolicy::by_class`,
/// with another force that vanishes at the same one.
template <int Dim> Result<Reached<Dim>> Run<Dim>::begin_at_limit(Attempt& attempt) {
    const RunCounters before = counters_;
    const LimitLoad<Dim> nearest = attempt.at;
    auto reached = follow(attempt);
    if (!attempt.in_vain(reached) || perturbs()) {
        return reached;
    }
    if (const auto stress = beyond(nearest.stress())) {
        counters_ = before;
        attempt.at.set_stress(*stress);
        reached = follow(attempt);
    }
    if (attempt.in_vain(reached) && recorder_.options.ties == TiePolicy::by_class) {
        const auto& contacts = vertex_->structure.contacts();
        for (const TieDecision& choice : others_of_class(vertex_->statics, attempt.opening.contact)) {
            const auto chosen = std::find(contacts.begin(), contacts.end(), choice.chosen) - contacts.begin();
            const RunCounters after = std::exchange(counters_, before);
            for (const LimitLoad<Dim>& at : {nearest, attempt.at}) {
                counters_ = before;
                Attempt other{attempt.opening, attempt.kind, at, {choice}};
                other.opening.contact = ContactId(static_cast<std::size_t>(chosen));
                auto its = follow(other);
                if (!other.in_vain(its)) {
                    attempt = std::move(other);
                    return its;
                }
            }
            counters_ = after;
        }
    }
    if (attempt.in_vain(reached)) {
        return offering_class(reached.failure(), attempt.opening.contact);
    }
    return reached;
}

/// What a run that chooses nothing says where another policy would look further.
template <int Dim> Failure Run<Dim>::offering_class(const Failure& failure, ContactId first) const {
    const RunOptions& options = recorder_.options;
    const bool may = options.ties == TiePolicy::stop && options.certify != CertifyLevel::plain &&
                     !others_of_class(vertex_->statics, first).empty();
    return may ? failed(failure.kind, "{}; other forces vanish with it: ties = \"class\" in [run] may open one of them",
                        failure)
               : failure;
}

template <int Dim> Result<Reached<Dim>> Run<Dim>::follow(Attempt& attempt) {
    const bool last = segment_.equilibria && made_ + 1 >= *segment_.equilibria;
    prover_.start_at(vertex_->packing);
    Rearrangement<Dim> rearrangement({vertex_, attempt.opening, attempt.kind, attempt.at, attempt.chosen}, prover_,
                                     recorder_, last ? nullptr : &segment_);
    auto reached = rearrangement.run(std::move(next_));
    attempt.begun = rearrangement.arcs() > 0;
    return reached;
}

template <int Dim> std::optional<Failure> Run<Dim>::rearrange(const Opening& opening, ArcKind kind, LimitLoad<Dim> at) {
    Attempt attempt{opening, kind, std::move(at), {}};
    auto reached = kind == ArcKind::limit ? begin_at_limit(attempt) : follow(attempt);
    if (!reached.ok()) {
        return reached.failure();
    }
    const Load<Dim> load = attempt.at.load;
    Reached<Dim>& there = reached.value();
    next_ = std::move(there.next);
    vertex_ = std::move(there.proof.vertex);
    state_.load = load;
    state_.packing = vertex_->packing;
    state_.contacts = vertex_->structure.contacts();
    return report(there.arcs, std::move(there.proof.description));
}

template <int Dim> std::optional<Failure> Run<Dim>::report(int arcs, std::optional<Result<Description<Dim>>> known) {
    auto described = known ? std::move(*known) : describe(*vertex_, state_.load);
    if (!described.ok()) {
        return located(described.failure(), fmt::format("equilibrium at sigma = {:.17g}", sigma()));
    }
    EquilibriumRecord<Dim>& record = described.value().record;
    limits_ = described.value().limit;
    if (auto failure = record_smallest_gap(record, *vertex_, described.value().vertex, prover_.candidates())) {
        return located(*failure, fmt::format("equilibrium at sigma = {:.17g}", sigma()));
    }
    if (auto failure = check(record)) {
        return failure;
    }
    recorder_.count({DecisionKind::equilibrium, record.margin, record.decided_by});
    recorder_.take_margin(record);
    record.number = counters_.equilibria;
    record.segment = number_;
    record.arcs = arcs;
    record.verdict = Verdict::proved;
    record.seconds = elapsed();
    if (perturbs()) {
        record.touching = static_cast<int>(vertex_->perturbed->touching.size());
    }
    record_ = record;
    state_.equilibrium = counters_.equilibria;
    if (perturbs()) {
        first_order_->store(*vertex_);
    }
    counters_.seconds = elapsed();
    recorder_.observer.on_equilibrium(record, state_, finite_forces(*vertex_, state_.load));
    return recorder_.observer.objection();
}

/// What holds of every equilibrium.
template <int Dim> std::optional<Failure> Run<Dim>::check(const EquilibriumRecord<Dim>& record) {
    // No two grains overlap by more than the uncertainty of the stored configuration, all pairs included.
    const double allowance = 4 * vertex_->enclosure.distance();
    const Admissibility admissible = certify_admissible(vertex_->packing, allowance, &prover_.candidates());
    if (admissible.verdict != Verdict::proved) {
        return failed(FailureKind::overlap, "equilibrium at sigma = {:.17g}: {} overlap, gap {:.6g}", sigma(),
                      named<Dim>(admissible.worst), admissible.worst_gap);
    }
    const Packing<Dim>& packing = vertex_->packing;
    const bool plain = state_.load.disk_force.empty() && packing.fixed.empty();
    const bool walled = packing.cell.any() || packing.walls == Walls<Dim>::box(); // nothing is free as a whole
    const int expected = vertex_->structure.dofs().dof_count() - Dim * record.rattlers;
    if (plain && walled && record.held == 0 && record.backbone != expected) {
        return failed(FailureKind::undecided,
                      "backbone of {} contacts with {} rattlers: expected N_f - {} rattlers = {}", record.backbone,
                      record.rattlers, Dim, expected);
    }
    return std::nullopt;
}

} // namespace

template <int Dim>
void require_followed(const State<Dim>& state, const RunOptions& options, const std::string& source) {
    const Cell<Dim>& cell = state.packing.cell;
    if (!cell.any()) {
        return;
    }
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::bad_input, source + ": a periodic cell; " + what);
    };
    if (cell.keeps_shape) {
        refuse("it keeps its shape, and a load on its size only scales the forces: no contact ever opens. Expected a "
               "rectangular or tilted cell (inspect, certify and verify take this one)");
    }
    if (at_first_order(options.ties)) { // first-order gaps and bodies know no images (proofs/perturbation.md)
        refuse("ties = \"perturb\" and \"choose\" are for boxes only so far: expected ties = \"stop\" or \"class\"");
    }
    const bool shears = std::find(cell.tilt_moves.begin(), cell.tilt_moves.end(), true) != cell.tilt_moves.end();
    if (state.load.kind == LoadKind::true_stress && shears) {
        refuse(
            "true stresses have no potential where the tilt moves, and nothing would tell where a run leads: expected "
            "dead loads, kind = \"nominal\", or a tilt that does not move");
    }
    for (std::size_t a = 0; a < Dim; ++a) {
        const auto balanced = [&](const std::vector<double>& forces, const char* what) {
            dd_real sum = 0.0;
            for (std::size_t k = a; k < forces.size() && cell.periodic[a]; k += Dim) {
                sum += forces[k];
            }
            if (!(sum == 0.0)) {
                refuse(fmt::format("the {} along axis {} sum to {}: expected 0 exactly, or the pinned disk would bear "
                                   "the rest",
                                   what, a, to_double(sum)));
            }
        };
        balanced(state.load.infinitesimal, "infinitesimal loads");
        balanced(state.load.disk_force, "forces on disks");
    }
}

template <int Dim>
SegmentOutcome run_segment(State<Dim>& state, const Segment& segment, int segment_number, const RunOptions& options,
                           RunCounters& counters, RunObserver<Dim>& observer) {
    require_floating_point();
    require_followed(state, options, "state");
    const double stress = state.load.loaded_stress();
    if (segment.to_stress && segment.direction * (*segment.to_stress - stress) < 0) {
        return {false, failed(FailureKind::no_limit,
                              "the stress {:.17g} to reach lies behind the load, "
                              "which is {:.17g}",
                              *segment.to_stress, stress)};
    }
    return Run<Dim>(state, segment, segment_number, {options, counters, observer}).run();
}

template void require_followed<2>(const State<2>&, const RunOptions&, const std::string&);
template SegmentOutcome run_segment<2>(State<2>&, const Segment&, int, const RunOptions&, RunCounters&,
                                       RunObserver<2>&);

} // namespace isostat
