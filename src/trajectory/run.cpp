#include "trajectory/plain.hpp"
#include "trajectory/record.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/motion/arc.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The same choice for the same step of a run, also after a resume (splitmix64 finaliser).
std::uint64_t bits_for(std::uint64_t seed, long step) {
    std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(step + 1);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
}

template <int Dim> double sigma_of(const Load<Dim>& load) {
    return load.stress[static_cast<std::size_t>(load.loaded_axis)];
}

template <int Dim> class Run {
  public:
    Run(State<Dim>& state, int segment, const RunOptions& options, RunCounters& counters, RunObserver<Dim>& observer)
        : state_(state), segment_(segment), options_(options), counters_(counters), observer_(observer),
          seconds_before_(counters.seconds) {}

    SegmentOutcome run(const Segment& segment) {
        SegmentOutcome outcome = play(segment);
        if (outcome.failure &&
            (outcome.failure->kind == FailureKind::undecided || outcome.failure->kind == FailureKind::tie)) {
            ++counters_.tally.undecided;
            counters_.tally.ties += outcome.failure->kind == FailureKind::tie ? 1 : 0;
        }
        return outcome;
    }

  private:
    SegmentOutcome play(const Segment& segment);
    [[nodiscard]] double sigma() const { return sigma_of(state_.load); }
    void set_sigma(Load<Dim>& load, double value) const {
        load.stress[static_cast<std::size_t>(load.loaded_axis)] = value;
    }
    [[nodiscard]] double elapsed() const {
        return seconds_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

    /// Caches that belong to the last equilibrium only, so that a resumed run takes the same path.
    void fresh_caches(const Packing<Dim>& packing) {
        if (candidates_.reference != packing.q || candidates_.contacts.empty()) { // else it would be the same list
            candidates_ = find_candidates(packing, candidate_fraction);
        }
        bound_cache_ = {};
    }

    void count(DecisionKind kind, double margin, Rung rung, ArcRecord<Dim>* arc = nullptr) {
        counters_.tally.count(kind, margin, rung);
        margin_ = std::min(margin_, margin);
        rung_ = std::max(rung_, rung);
        if (arc != nullptr) {
            arc->margin = std::min(arc->margin, margin);
            arc->decided_by = std::max(arc->decided_by, rung);
        }
    }

    std::optional<Failure> start();
    std::optional<Failure> rearrange(Opening opening, const std::string& kind, double stress);
    Result<std::unique_ptr<Vertex<Dim>>> follow(const Vertex<Dim>& from, const Opening& opening, bool at_limit,
                                                const Load<Dim>& load, ArcRecord<Dim>& record);
    std::optional<Failure> check_arc(const Vertex<Dim>& from, Vertex<Dim>& to, const Opening& opening,
                                     const Load<Dim>& load, ArcRecord<Dim>& record);
    void certify(const Vertex<Dim>& from, const Vertex<Dim>& to, const Opening& opening, bool at_limit,
                 const Load<Dim>& load, ArcRecord<Dim>& record);
    std::optional<Failure> rearrange_plainly(Opening opening, const std::string& kind, const Load<Dim>& load);
    std::optional<Failure> report(int arcs);

    State<Dim>& state_;
    int segment_;
    const RunOptions& options_;
    RunCounters& counters_;
    RunObserver<Dim>& observer_;
    double seconds_before_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::unique_ptr<Vertex<Dim>> vertex_;
    CandidateList<Dim> candidates_;
    InverseBoundCache bound_cache_;
    EquilibriumRecord<Dim> record_;
    double margin_ = infinity; ///< of the decisions since the last equilibrium
    Rung rung_ = Rung::combinatorial;
};

/// Where a failure happened: appended to its message so that the last line of a run says all.
Failure located(const Failure& failure, const std::string& where) {
    return {failure.kind, where + ": " + failure.message};
}

template <int Dim>
Result<std::unique_ptr<Vertex<Dim>>> Run<Dim>::follow(const Vertex<Dim>& from, const Opening& opening, bool at_limit,
                                                      const Load<Dim>& load, ArcRecord<Dim>& record) {
    ArcOptions arc_options;
    arc_options.step_fraction = options_.step_fraction;
    const PowerLoad<Dim> power{&load, opening.infinitesimal, at_limit};
    // Rattlers turn far from arc to arc: factors taken over predict their curvature badly. They are few, so that their
    // own block costs next to nothing.
    std::optional<Factorisation> fresh;
    if (opening.infinitesimal && !from.factorisation.is_fresh()) {
        fresh = Factorisation::of_moving_block(from.structure, static_cast<int>(opening.contact.index()));
        if (!fresh) {
            fresh.emplace(from.structure);
        }
    }
    // A second pass only when the proved gaps say that another candidate closed before.
    for (int pass = 0; pass < 8; ++pass) {
        const auto attempt = [&] {
            return follow_arc(from.packing, from.structure, fresh ? *fresh : from.factorisation, opening.contact,
                              opening.direction, power, candidates_, arc_options);
        };
        auto arc = attempt();
        // An arc that fails, or ends where it began, may only have been predicted badly by old factors.
        if ((!arc.ok() || arc.value().closed == record.opened) && (!fresh || opening.infinitesimal) &&
            !from.factorisation.is_fresh()) {
            fresh.emplace(from.structure);
            arc = attempt();
        }
        if (!arc.ok()) {
            return arc.failure();
        }
        const Arc<Dim>& path = arc.value();
        record.closed = path.closed;
        record.power_turn = path.kind == ArcEnd::power_turn;
        record.power = path.power;
        record.displacement = path.displacement;
        record.steps = path.steps;
        auto made =
            Vertex<Dim>::exchanged(from, path.end, opening.contact, path.closed, path.tangent, load, bound_cache_);
        if (!made.ok()) {
            return located(made.failure(), fmt::format("at the end of the arc that opens {} and closes {}",
                                                       to_string<Dim>(record.opened), to_string<Dim>(path.closed)));
        }
        auto gaps = made.value()->check_gaps(candidates_);
        if (!gaps.ok()) {
            return located(gaps.failure(), fmt::format("at the end of the arc that opens {} and closes {}",
                                                       to_string<Dim>(record.opened), to_string<Dim>(path.closed)));
        }
        if (!gaps.value().negative) {
            count(DecisionKind::gaps, gaps.value().margin, gaps.value().rung, &record);
            record_.min_gap = gaps.value().smallest;
            record_.min_gap_contact = gaps.value().where;
            return std::move(made.value());
        }
        arc_options.closes = gaps.value().negative;
    }
    return Failure{FailureKind::undecided, "the order of the first contacts that close was not settled"};
}

template <int Dim>
std::optional<Failure> Run<Dim>::check_arc(const Vertex<Dim>& from, Vertex<Dim>& to, const Opening& opening,
                                           const Load<Dim>& load, ArcRecord<Dim>& record) {
    const std::vector<double> force = load.external_force(from.packing);
    double work = 0;
    double size = 0;
    double terms = 2;
    double force_norm = 0;
    for (std::size_t k = 0; k < force.size(); ++k) {
        const double part = force[k] * (to.packing.q[k] - from.packing.q[k]);
        work += part;
        size += std::abs(part);
        terms += part != 0 ? 1 : 0;
        force_norm += force[k] * force[k];
    }
    record.work = work;
    force_norm = std::sqrt(force_norm);
    // The stored ends are within `radius` of the true ones (plus their correction): that much of the work is not known.
    const auto off = [](const VertexEnclosure& enclosure) {
        double square = 0;
        for (const double c : enclosure.correction) {
            square += c * c;
        }
        return enclosure.radius + std::sqrt(square);
    };
    const double unknown =
        (force_norm * (off(from.enclosure) + off(to.enclosure)) + terms * 0x1p-52 * size) * (1 + 1e-10);
    if (load.kind == LoadKind::nominal && work < -unknown) {
        return Failure{FailureKind::undecided,
                       fmt::format("W increased by {:.6g} (known to {:.3g}) along the arc that opens {} and closes {}",
                                   -work, unknown, to_string<Dim>(record.opened), to_string<Dim>(record.closed))};
    }
    if (record.power_turn) {
        return std::nullopt;
    }
    // F.t = f_c (G t)_c at the event, and the new gap closes: the power is positive there iff the new force is.
    const auto sign = [&] {
        return opening.infinitesimal ? to.statics.infinitesimal(opening.contact)
                                     : to.statics.force(opening.contact, sigma_of(load));
    };
    Enclosure f = sign();
    while (!f.decided() && to.statics.climb()) {
        f = sign();
    }
    if (opening.infinitesimal || !to.statics.is_structural_zero(opening.contact)) {
        if (!f.positive()) {
            return Failure{FailureKind::undecided, fmt::format("the power of the load along the arc that opens {} and "
                                                               "closes {} is not proved positive at its end: "
                                                               "force {:.3g} in the new contact, proved to {:.3g}",
                                                               to_string<Dim>(record.opened),
                                                               to_string<Dim>(record.closed), f.value, f.radius)};
        }
        count(DecisionKind::power, f.margin(), to.statics.rung(), &record);
    }
    return std::nullopt;
}

/// Level `arcs`: the certificate does not depend on how the arc was found, and an arc without one stays in the run.
template <int Dim>
void Run<Dim>::certify(const Vertex<Dim>& from, const Vertex<Dim>& to, const Opening& opening, bool at_limit,
                       const Load<Dim>& load, ArcRecord<Dim>& record) {
    const auto begin = std::chrono::steady_clock::now();
    // Factors of its own: those of the run count their use, and only fresh ones leave what does not move at exactly 0.
    const Factorisation first(from.structure);
    const Factorisation last(to.structure);
    const auto vertex = [](const Vertex<Dim>& v, const Factorisation& factorisation) {
        return ArcVertex<Dim>{v.packing, v.structure, factorisation, v.inverse, v.enclosure};
    };
    record.certificate = certify_arc(vertex(from, first), opening.contact, opening.direction, vertex(to, last),
                                     PowerLoad<Dim>{&load, opening.infinitesimal, at_limit}, candidates_);
    const ArcCertificate& certificate = *record.certificate;
    ArcTally& tally = counters_.arcs;
    const bool proved = certificate.verdict == Verdict::proved;
    (proved ? tally.certified : tally.undecided)++;
    tally.power_undecided += proved && certificate.power != Verdict::proved ? 1 : 0;
    tally.pieces += certificate.pieces;
    tally.factorisations += certificate.factorisations;
    const auto lower = [proved](double& smallest, double margin) {
        if (proved && std::isfinite(margin) && (smallest == 0 || margin < smallest)) {
            smallest = margin;
        }
    };
    lower(tally.tube_margin, certificate.tube_margin);
    lower(tally.gap_margin, certificate.gap_margin);
    tally.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <int Dim> std::optional<Failure> Run<Dim>::rearrange(Opening opening, const std::string& kind, double stress) {
    Load<Dim> load = state_.load;
    set_sigma(load, stress);
    if (options_.certify == CertifyLevel::plain) {
        return rearrange_plainly(opening, kind, load);
    }
    fresh_caches(vertex_->packing);
    std::unique_ptr<Vertex<Dim>> here;
    const Vertex<Dim>* from = vertex_.get();
    std::string arc_kind = kind;
    int arcs = 0;
    while (true) {
        if (options_.stop != nullptr && options_.stop->load()) {
            return Failure{FailureKind::interrupted,
                           fmt::format("stopped after {} arcs of a rearrangement at sigma = {:.17g}", arcs, stress)};
        }
        if (arcs >= options_.max_arcs) {
            return Failure{FailureKind::cap_reached,
                           fmt::format("no equilibrium after {} arcs at sigma = {:.17g}: the sample fails here (cap "
                                       "max_arcs)",
                                       arcs, stress)};
        }
        ++arcs;
        ArcRecord<Dim> record;
        record.step = ++counters_.steps;
        record.equilibrium = counters_.equilibria;
        record.arc = arcs;
        record.kind = arc_kind;
        record.opened = from->structure.contacts()[opening.contact.index()];
        record.stress = stress;
        record.force = opening.force.value;
        record.margin = infinity;
        record.decided_by = Rung::combinatorial;
        count(DecisionKind::opening, opening.margin, opening.rung, &record);
        const bool at_limit = arcs == 1 && kind == "limit";
        const std::string where = fmt::format("arc {} of the rearrangement at sigma = {:.17g}", arcs, stress);
        auto made = follow(*from, opening, at_limit, load, record);
        if (!made.ok()) {
            return located(made.failure(), where);
        }
        std::unique_ptr<Vertex<Dim>> next = std::move(made.value());
        if (auto failure = check_arc(*from, *next, opening, load, record)) {
            return located(*failure, where);
        }
        if (options_.certify == CertifyLevel::arcs) {
            certify(*from, *next, opening, at_limit, load, record);
        }
        const auto axis = static_cast<std::size_t>(load.loaded_axis);
        const double reference = load.reference_length[axis];
        record.strain = reference > 0 ? (reference - next->packing.length(load.loaded_axis)) / reference : 0;
        const ContactId fresh_hold = record.power_turn ? opening.contact : ContactId();
        auto decision = decide_opening(next->statics, stress, options_.rule, fresh_hold,
                                       bits_for(options_.rule_seed, counters_.steps));
        observer_.on_arc(record);
        if (!decision.ok()) {
            return located(decision.failure(), where);
        }
        here = std::move(next);
        from = here.get();
        if (std::abs(record.strain) > options_.max_strain) {
            return Failure{FailureKind::cap_reached,
                           fmt::format("|eps_2| = {:.6g} at sigma = {:.17g}: the sample fails here (cap max_strain = "
                                       "{:.6g})",
                                       std::abs(record.strain), stress, options_.max_strain)};
        }
        if (!decision.value().opening) {
            count(DecisionKind::equilibrium, decision.value().margin, decision.value().rung);
            break;
        }
        opening = *decision.value().opening;
        arc_kind = here->structure.contacts()[opening.contact.index()].kind == ContactKind::held ? "release"
                   : opening.infinitesimal                                                       ? "rattler"
                                                                                                 : "tension";
    }
    // The equilibrium itself is proved anew, from nothing that the way to it left: full exact elimination, fresh
    // factors and bound. A resumed run starts from the same bits.
    fresh_caches(here->packing);
    auto anew = Vertex<Dim>::make(here->packing, here->structure.contacts(), load, bound_cache_);
    if (!anew.ok()) {
        return located(anew.failure(), fmt::format("equilibrium at sigma = {:.17g}", stress));
    }
    vertex_ = std::move(anew.value());
    auto gaps = vertex_->check_gaps(candidates_);
    if (!gaps.ok()) {
        return located(gaps.failure(), fmt::format("equilibrium at sigma = {:.17g}", stress));
    }
    record_.min_gap = gaps.value().smallest;
    record_.min_gap_contact = gaps.value().where;
    // The questions that `start` asks after a resume: the statics then stand on the same rung.
    (void)decide_opening(vertex_->statics, stress, options_.rule, ContactId(), 0);
    state_.load = load;
    state_.packing = vertex_->packing;
    state_.contacts = vertex_->structure.contacts();
    return report(arcs);
}

/// Level `plain`: the way is steered without bounds, the end is proved. When the proof finds a negative force there,
/// steering goes on with it.
template <int Dim>
std::optional<Failure> Run<Dim>::rearrange_plainly(Opening opening, const std::string& kind, const Load<Dim>& load) {
    const double stress = sigma_of(load);
    int arcs = 0;
    const auto where = [&] { return fmt::format("arc {} of the rearrangement at sigma = {:.17g}", arcs, stress); };
    PlainCalls<Dim> calls;
    calls.begin = [&](ArcRecord<Dim>& record) -> std::optional<Failure> {
        if (options_.stop != nullptr && options_.stop->load()) {
            return Failure{FailureKind::interrupted, fmt::format("stopped after {} arcs of a rearrangement", arcs)};
        }
        if (arcs >= options_.max_arcs) {
            return Failure{FailureKind::cap_reached,
                           fmt::format("no equilibrium after {} arcs: the sample fails here (cap max_arcs)", arcs)};
        }
        record.step = ++counters_.steps;
        record.equilibrium = counters_.equilibria;
        record.arc = ++arcs;
        record.stress = stress;
        record.margin = std::nan("");
        record.decided_by = Rung::none;
        ++counters_.tally.plain;
        return std::nullopt;
    };
    calls.end = [&](ArcRecord<Dim>& record, const Packing<Dim>& packing) -> std::optional<Failure> {
        const double reference = load.reference_length[static_cast<std::size_t>(load.loaded_axis)];
        record.strain = reference > 0 ? (reference - packing.length(load.loaded_axis)) / reference : 0;
        observer_.on_arc(record);
        if (std::abs(record.strain) > options_.max_strain) {
            return Failure{FailureKind::cap_reached,
                           fmt::format("|eps_2| = {:.6g}: the sample fails here (cap max_strain = {:.6g})",
                                       std::abs(record.strain), options_.max_strain)};
        }
        return std::nullopt;
    };
    calls.random_bits = [&] { return bits_for(options_.rule_seed, counters_.steps); };
    std::unique_ptr<Vertex<Dim>> proved;
    const Vertex<Dim>* from = vertex_.get();
    std::string arc_kind = kind;
    while (true) {
        auto end = steer_plainly(*from, opening, arc_kind, load, options_, candidates_, calls);
        if (!end.ok()) {
            return located(end.failure(), where());
        }
        bound_cache_ = {};
        auto anew =
            Vertex<Dim>::make(std::move(end.value().packing), std::move(end.value().contacts), load, bound_cache_);
        if (!anew.ok()) {
            return located(anew.failure(), fmt::format("equilibrium at sigma = {:.17g}", stress));
        }
        proved = std::move(anew.value());
        fresh_caches(proved->packing);
        auto gaps = proved->check_gaps(candidates_);
        if (!gaps.ok()) {
            return located(gaps.failure(), fmt::format("equilibrium at sigma = {:.17g}", stress));
        }
        if (gaps.value().negative) {
            return Failure{FailureKind::undecided,
                           fmt::format("equilibrium at sigma = {:.17g}: plain steering went past a contact, {} overlap",
                                       stress, to_string<Dim>(*gaps.value().negative))};
        }
        auto decision =
            decide_opening(proved->statics, stress, options_.rule, end.value().fresh_hold, calls.random_bits());
        if (!decision.ok()) {
            return located(decision.failure(), where());
        }
        record_.min_gap = gaps.value().smallest;
        record_.min_gap_contact = gaps.value().where;
        if (!decision.value().opening) {
            count(DecisionKind::gaps, gaps.value().margin, gaps.value().rung);
            count(DecisionKind::equilibrium, decision.value().margin, decision.value().rung);
            break;
        }
        vertex_ = std::move(proved); // no equilibrium after all
        from = vertex_.get();
        opening = *decision.value().opening;
        arc_kind = vertex_->structure.contacts()[opening.contact.index()].kind == ContactKind::held ? "release"
                   : opening.infinitesimal                                                          ? "rattler"
                                                                                                    : "tension";
    }
    vertex_ = std::move(proved);
    // The questions that `start` asks after a resume: the statics then stand on the same rung.
    (void)decide_opening(vertex_->statics, stress, options_.rule, ContactId(), 0);
    state_.load = load;
    state_.packing = vertex_->packing;
    state_.contacts = vertex_->structure.contacts();
    return report(arcs);
}

template <int Dim> std::optional<Failure> Run<Dim>::report(int arcs) {
    auto described = describe(*vertex_, state_.load);
    if (!described.ok()) {
        return located(described.failure(), fmt::format("equilibrium at sigma = {:.17g}", sigma()));
    }
    EquilibriumRecord<Dim> record = described.value();
    // No two grains overlap by more than the uncertainty of the stored configuration, all pairs included.
    const double allowance = 4 * vertex_->enclosure.radius;
    const Admissibility admissible = certify_admissible(vertex_->packing, allowance, &candidates_);
    if (admissible.verdict != Verdict::proved) {
        return Failure{FailureKind::overlap,
                       fmt::format("equilibrium at sigma = {:.17g}: {} overlap, gap {:.6g}", sigma(),
                                   to_string<Dim>(admissible.worst), admissible.worst_gap)};
    }
    record.min_gap = record_.min_gap;
    record.min_gap_contact = record_.min_gap_contact;
    count(DecisionKind::equilibrium, record.margin, record.decided_by);
    record.margin = margin_;
    record.decided_by = rung_;
    record.number = counters_.equilibria;
    record.segment = segment_;
    record.arcs = arcs;
    record.verdict = Verdict::proved;
    record.seconds = elapsed();
    const bool box =
        vertex_->packing.walls == Walls<Dim>::box() && state_.load.disk_force.empty() && vertex_->packing.fixed.empty();
    if (box && record.held == 0 && record.backbone != Dim * (vertex_->packing.disk_count() - record.rattlers) + Dim) {
        return Failure{FailureKind::undecided,
                       fmt::format("backbone of {} contacts with {} rattlers: expected 2 (n - rattlers) + 2 = {}",
                                   record.backbone, record.rattlers,
                                   Dim * (vertex_->packing.disk_count() - record.rattlers) + Dim)};
    }
    margin_ = infinity;
    rung_ = Rung::combinatorial;
    record_ = record;
    state_.equilibrium = counters_.equilibria;
    counters_.seconds = elapsed();
    observer_.on_equilibrium(record, state_, finite_forces(*vertex_, state_.load));
    return std::nullopt;
}

template <int Dim> std::optional<Failure> Run<Dim>::start() {
    fresh_caches(state_.packing);
    auto made = Vertex<Dim>::make(state_.packing, state_.contacts, state_.load, bound_cache_);
    if (!made.ok()) {
        return located(made.failure(), "start");
    }
    vertex_ = std::move(made.value());
    auto gaps = vertex_->check_gaps(candidates_);
    if (!gaps.ok()) {
        return located(gaps.failure(), "start");
    }
    if (gaps.value().negative) {
        return Failure{FailureKind::overlap, fmt::format("start: {} overlap", to_string<Dim>(*gaps.value().negative))};
    }
    record_.min_gap = gaps.value().smallest;
    record_.min_gap_contact = gaps.value().where;
    if (counters_.equilibria != 0 || counters_.steps != 0) {
        // The same questions as when the equilibrium was found: the statics then stand on the same rung, and the run
        // goes on with the same bits.
        (void)decide_opening(vertex_->statics, sigma(), options_.rule, ContactId(), 0);
        auto described = describe(*vertex_, state_.load);
        if (!described.ok()) {
            return located(described.failure(), "start");
        }
        record_ = described.value();
        return std::nullopt;
    }
    count(DecisionKind::gaps, gaps.value().margin, gaps.value().rung);
    auto decision =
        decide_opening(vertex_->statics, sigma(), options_.rule, ContactId(), bits_for(options_.rule_seed, 0));
    if (!decision.ok()) {
        return located(decision.failure(), "start");
    }
    if (decision.value().opening) {
        const Opening& opening = *decision.value().opening;
        return rearrange(opening, opening.infinitesimal ? "rattler" : "tension", sigma());
    }
    count(DecisionKind::equilibrium, decision.value().margin, decision.value().rung);
    return report(0);
}

template <int Dim> SegmentOutcome Run<Dim>::play(const Segment& segment) {
    SegmentOutcome outcome;
    if (auto failure = start()) {
        outcome.failure = failure;
        return outcome;
    }
    int made = 0;
    while (true) {
        if (segment.equilibria && made >= *segment.equilibria) {
            outcome.completed = true;
            return outcome;
        }
        if (options_.stop != nullptr && options_.stop->load()) {
            outcome.failure =
                Failure{FailureKind::interrupted, fmt::format("stopped at equilibrium {}", counters_.equilibria)};
            return outcome;
        }
        if (record_.held > 0) {
            outcome.failure =
                Failure{FailureKind::undecided, fmt::format("equilibrium {} still holds {} coordinate(s): it is one at "
                                                            "this load only, and no contact limits it",
                                                            counters_.equilibria, record_.held)};
            return outcome;
        }
        auto found = find_limit(vertex_->statics, sigma(), segment.direction);
        if (!found.ok()) {
            outcome.failure = located(found.failure(), fmt::format("limit of equilibrium {}", counters_.equilibria));
            return outcome;
        }
        const LoadLimit& limit = found.value();
        counters_.tally.structural_ties += limit.tie_class.size() > 1 ? 1 : 0;
        if (segment.to_stress) {
            const double ahead = limit.unbounded ? infinity : segment.direction * (limit.stress - *segment.to_stress);
            if (!limit.unbounded && std::abs(ahead) <= limit.stress_error) {
                outcome.failure = Failure{
                    FailureKind::undecided,
                    fmt::format("the stress {:.17g} to reach cannot be told from the limit {:.17g} of equilibrium {}",
                                *segment.to_stress, limit.stress, counters_.equilibria)};
                return outcome;
            }
            if (ahead > 0) {
                set_sigma(state_.load, *segment.to_stress);
                ++counters_.equilibria;
                if (auto failure = report(0)) {
                    outcome.failure = failure;
                    return outcome;
                }
                outcome.completed = true;
                return outcome;
            }
        }
        if (limit.unbounded) {
            outcome.failure =
                Failure{FailureKind::no_limit,
                        fmt::format("equilibrium {} supports every load in this direction: no contact opens",
                                    counters_.equilibria)};
            return outcome;
        }
        Opening opening;
        opening.contact = limit.opens;
        opening.force = {0, std::abs(vertex_->statics.slope(limit.opens).value) * limit.stress_error};
        opening.margin = limit.margin;
        opening.rung = limit.rung;
        const RunCounters before = counters_;
        ++counters_.equilibria;
        if (auto failure = rearrange(opening, "limit", limit.stress)) {
            counters_.equilibria = before.equilibria; // the steps stay counted: their records are written
            counters_.seconds = elapsed();
            outcome.failure = failure;
            return outcome;
        }
        ++made;
    }
}

} // namespace

template <int Dim>
SegmentOutcome run_segment(State<Dim>& state, const Segment& segment, int segment_number, const RunOptions& options,
                           RunCounters& counters, RunObserver<Dim>& observer) {
    return Run<Dim>(state, segment_number, options, counters, observer).run(segment);
}

template SegmentOutcome run_segment<2>(State<2>&, const Segment&, int, const RunOptions&, RunCounters&,
                                       RunObserver<2>&);

} // namespace isostat
