#include "trajectory/behind.hpp"
#include "trajectory/descent.hpp"
#include "trajectory/first_order_side.hpp"
#include "trajectory/plain.hpp"
#include "trajectory/record.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/core/floating_point.hpp>
#include <isostat/core/work.hpp>
#include <isostat/motion/arc.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Relative accuracy of forces on the way: what records say of them, and far more than most decisions need.
constexpr double enough_to_decide = 1e-12;

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

using WorkCounts = std::array<long, work_kinds>;

/// While it lives this thread counts its work there.
class CountingIn {
  public:
    explicit CountingIn(WorkCounts* counts) : before_(count_work_in(counts)) {}
    CountingIn(const CountingIn&) = delete;
    CountingIn& operator=(const CountingIn&) = delete;
    ~CountingIn() { count_work_in(before_); }

  private:
    WorkCounts* before_;
};

void add_work(const WorkCounts& counts) {
    for (std::size_t k = 0; k < work_kinds; ++k) {
        if (counts[k] != 0) {
            count_work(static_cast<Work>(k), counts[k]);
        }
    }
}

template <int Dim> class Run {
  public:
    Run(State<Dim>& state, int segment, const RunOptions& options, RunCounters& counters, RunObserver<Dim>& observer)
        : state_(state), segment_(segment), options_(options), counters_(counters), observer_(observer),
          seconds_before_(counters.seconds) {
        if (options.ties == TiePolicy::perturb) {
            first_order_.emplace(state, options.ties_seed);
        }
    }

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
            candidates_ = find_candidates(packing, candidate_fraction, candidates_.triangulation);
        }
        bound_cache_.forget();
    }

    [[nodiscard]] bool perturbs() const { return first_order_.has_value(); }
    Result<std::unique_ptr<Vertex<Dim>>> make_vertex(Packing<Dim> packing, std::vector<Contact> contacts,
                                                     const Load<Dim>& load);
    static void take_log(Vertex<Dim>& vertex, std::vector<TieDecision>& into);
    Result<bool> choose_start();
    std::optional<Failure> still_equilibrium(double stress);
    std::optional<Failure> reload();

    void count(DecisionKind kind, double margin, Rung rung, ArcRecord<Dim>* arc = nullptr, bool perturbed = false) {
        counters_.tally.perturbed[static_cast<std::size_t>(kind)] += perturbed ? 1 : 0;
        counters_.tally.count(kind, margin, rung);
        margin_ = std::min(margin_, margin);
        rung_ = std::max(rung_, rung);
        if (arc != nullptr) {
            arc->margin = std::min(arc->margin, margin);
            arc->decided_by = std::max(arc->decided_by, rung);
        }
    }

    std::optional<Failure> start();
    std::optional<Failure> rearrange(Opening opening, const std::string& kind, const LimitLoad<Dim>& limit);
    Result<std::unique_ptr<Vertex<Dim>>> follow(const Vertex<Dim>& from, const Opening& opening, bool at_limit,
                                                const LimitLoad<Dim>& limit, ArcRecord<Dim>& record);
    using Tell = std::function<void(DecisionKind, double margin, Rung, bool perturbed)>;
    std::optional<Failure> check_arc(const Vertex<Dim>& from, Vertex<Dim>& to, const Opening& opening,
                                     const Load<Dim>& load, ArcRecord<Dim>& record, bool& descends,
                                     const Tell& tell) const;
    /// An arc that was steered ahead, and then proved.
    struct ProvedArc {
        struct Count {
            DecisionKind kind;
            double margin;
            Rung rung;
        };
        std::unique_ptr<Vertex<Dim>> vertex;
        ArcRecord<Dim> record;
        OpeningDecision decision;
        std::vector<Count> counts;
        double min_gap = 0;
        Contact min_gap_contact;
        double seconds = 0; ///< of its certificate, at level `arcs`
    };
    std::optional<ProvedArc> prove_arc(const Vertex<Dim>& from, PlainArrival<Dim>& arrival, const Opening& opening,
                                       const Load<Dim>& load);
    /// Where a rearrangement is.
    struct Way {
        std::unique_ptr<Vertex<Dim>> here; ///< null: at `vertex_`
        Opening opening;
        std::string kind;
        int arcs = 0;
        ContactId last_hold;               ///< of the power turn at `here`
        bool ended = false;                ///< no force is negative at `here`
        bool by_steps = false;             ///< the next arc is one that must be proved before going on
        std::unique_ptr<Vertex<Dim>> anew; ///< when it ended and is there: the same vertex, proved from nothing
    };
    std::optional<Failure> go_ahead(Way& way, const Load<Dim>& load);
    /// The other rules choose by differences that steering does not resolve.
    [[nodiscard]] bool steers_ahead() const { return !perturbs() && options_.rule == OpeningRule::most_negative; }
    [[nodiscard]] Failure too_far(const ArcRecord<Dim>& record) const;
    /// Returns the seconds that it took.
    double certify(const Vertex<Dim>& from, const Vertex<Dim>& to, const Opening& opening, bool at_limit,
                   const Load<Dim>& load, ArcRecord<Dim>& record) const;
    void tally(const ArcCertificate& certificate, double seconds);
    std::optional<Failure> rearrange_plainly(Opening opening, const std::string& kind, const Load<Dim>& load);
    /// A rearrangement at level `plain`, perhaps begun before the equilibrium that it starts from was proved: then with
    /// what it starts from, and records of its arcs that nobody has seen yet.
    struct PlainWay {
        /// An equilibrium of which nothing is proved.
        struct Origin {
            Packing<Dim> packing;
            IsostaticStructure<Dim> structure;
            Factorisation factorisation;
        };
        std::optional<Origin> origin;
        ContactId opens;
        Load<Dim> load;
        CandidateList<Dim> candidates;
        std::unique_ptr<PlainSteering<Dim>> steering; ///< refers to the others
        std::vector<ArcRecord<Dim>> unseen;
        WorkCounts work{}; ///< of these
        std::optional<Result<PlainEnd<Dim>>> end;
    };
    /// What is found out about the end of a way; what there is no need of is not there.
    struct PlainProof {
        Result<std::unique_ptr<Vertex<Dim>>> vertex;
        std::optional<Result<typename Vertex<Dim>::Gaps>> gaps;
        std::optional<Result<OpeningDecision>> decision;
        std::optional<Result<Description<Dim>>> description;
    };
    PlainProof prove_plain_end(typename Vertex<Dim>::Beginning beginning, const Load<Dim>& load, ContactId fresh_hold,
                               std::uint64_t random_bits);
    [[nodiscard]] bool goes_on(const PlainEnd<Dim>& end) const;
    bool set_out(PlainWay& way, const Load<Dim>& load);
    void steer_unseen(PlainWay& way, const std::function<bool()>& enough);
    [[nodiscard]] double strain(const Load<Dim>& load, const Packing<Dim>& packing) const {
        const double reference = load.reference_length[static_cast<std::size_t>(load.loaded_axis)];
        return reference > 0 ? (reference - packing.length(load.loaded_axis)) / reference : 0;
    }
    std::optional<Failure> report(int arcs, std::optional<Result<Description<Dim>>> known = std::nullopt);

    State<Dim>& state_;
    int segment_;
    const RunOptions& options_;
    RunCounters& counters_;
    RunObserver<Dim>& observer_;
    double seconds_before_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::unique_ptr<Vertex<Dim>> vertex_;
    CandidateList<Dim> candidates_;
    KeptCandidates kept_; ///< of `candidates_`
    InverseBoundCache bound_cache_;
    EquilibriumRecord<Dim> record_;
    std::array<std::optional<LoadLimit>, 2> limits_; ///< of `vertex_`, as `describe` found them
    double margin_ = infinity;                       ///< of the decisions since the last equilibrium
    Rung rung_ = Rung::combinatorial;
    std::optional<FirstOrderSide<Dim>> first_order_; ///< under `ties = "perturb"`
    const Segment* segment_wanted_ = nullptr;
    int made_ = 0;                    ///< equilibria of it
    std::unique_ptr<PlainWay> ahead_; ///< the next rearrangement, if it was begun
};

/// Where a failure happened: appended to its message so that the last line of a run says all.
Failure located(const Failure& failure, const std::string& where) {
    return {failure.kind, where + ": " + failure.message};
}

template <int Dim>
Result<std::unique_ptr<Vertex<Dim>>> Run<Dim>::make_vertex(Packing<Dim> packing, std::vector<Contact> contacts,
                                                           const Load<Dim>& load) {
    auto made = Vertex<Dim>::make(std::move(packing), std::move(contacts), load, bound_cache_);
    if (made.ok() && perturbs()) {
        first_order_->attach(*made.value(), {load, nullptr, 0, {0, 0}});
    }
    return made;
}

template <int Dim> void Run<Dim>::take_log(Vertex<Dim>& vertex, std::vector<TieDecision>& into) {
    if (vertex.perturbed) {
        std::vector<TieDecision>& log = vertex.perturbed->statics.log;
        into.insert(into.end(), log.begin(), log.end());
        log.clear();
    }
}

template <int Dim>
Result<std::unique_ptr<Vertex<Dim>>> Run<Dim>::follow(const Vertex<Dim>& from, const Opening& opening, bool at_limit,
                                                      const LimitLoad<Dim>& limit, ArcRecord<Dim>& record) {
    const Load<Dim>& load = limit.load;
    ArcOptions arc_options;
    arc_options.step_fraction = options_.step_fraction;
    LadderOptions ladder;
    ladder.first_accuracy = perturbs() ? 0 : enough_to_decide; // ties are told from zeros at full accuracy
    const PowerLoad<Dim> power{&load, opening.infinitesimal, at_limit};
    std::optional<Contact> next_to; // closes on a way of length O(eps)
    std::vector<TieDecision> departed;
    if (from.perturbed && !from.perturbed->touching.empty()) {
        auto departure = depart(from, opening.contact, opening.direction);
        if (!departure.ok()) {
            return departure.failure();
        }
        next_to = departure.value().closes;
        departed = departure.value().settled;
        arc_options.leaving = departure.value().leaving;
        arc_options.resting = departure.value().resting;
    }
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
        const auto attempt = [&]() -> Result<Arc<Dim>> {
            if (next_to) {
                Arc<Dim> none;
                none.end = from.packing;
                none.closed = *next_to;
                return none;
            }
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
        record_path(record, path);
        auto made = Vertex<Dim>::exchanged(from, path.end, opening.contact, path.closed, path.tangent, load,
                                           bound_cache_, fresh ? 0 : path.passes, ladder);
        if (made.ok() && perturbs()) {
            first_order_->attach(*made.value(), limit);
        }
        if (!made.ok() && !fresh && !next_to && !from.factorisation.is_fresh()) {
            fresh.emplace(from.structure); // old factors may also have ended it badly
            continue;
        }
        if (!made.ok()) {
            return located(made.failure(), fmt::format("at the end of the arc that opens {} and closes {}",
                                                       to_string<Dim>(record.opened), to_string<Dim>(path.closed)));
        }
        auto gaps = made.value()->check_gaps(candidates_, kept_, perturbs());
        if (!gaps.ok()) {
            return located(gaps.failure(), fmt::format("at the end of the arc that opens {} and closes {}",
                                                       to_string<Dim>(record.opened), to_string<Dim>(path.closed)));
        }
        if (perturbs() && !gaps.value().negative && !gaps.value().zero.empty()) {
            auto arrival =
                arrive(*made.value(), gaps.value().zero, opening.contact, next_to.has_value(), arc_options.resting);
            if (!arrival.ok()) {
                return arrival.failure();
            }
            if (arrival.value().earlier) {
                (next_to ? next_to : arc_options.closes) = arrival.value().earlier;
                continue;
            }
            departed.insert(departed.end(), arrival.value().settled.begin(), arrival.value().settled.end());
        }
        if (!gaps.value().negative) {
            record.perturbed.insert(record.perturbed.end(), departed.begin(), departed.end());
            count(DecisionKind::gaps, gaps.value().margin, gaps.value().rung, &record, !departed.empty());

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
                                           const Load<Dim>& load, ArcRecord<Dim>& record, bool& descends,
                                           const Tell& tell) const {
    const Enclosure decrease = potential_decrease(from, to, load, opening.infinitesimal);
    record.work = work_of(load, from.packing, to.packing).value;
    descends = decrease.positive();
    // A way of length O(eps) ends where it began: first-order terms decide there.
    const bool at_once = from.perturbed && from.packing.q == to.packing.q;
    const bool has_potential = std::isfinite(decrease.radius);
    if (has_potential && !descends && !at_once) {
        return Failure{
            FailureKind::undecided,
            fmt::format("the potential is not proved to decrease along the arc that opens {} and closes {}: by "
                        "{:.6g}, known to {:.3g}",
                        to_string<Dim>(record.opened), to_string<Dim>(record.closed), decrease.value, decrease.radius)};
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
    record.power = f.value;
    if (to.perturbed && !opening.infinitesimal && !f.decided() && !to.statics.is_structural_zero(opening.contact)) {
        const Order order = to.statics.sign(to.statics.force_expression(opening.contact, sigma_of(load)));
        PerturbedStatics<Dim>& side = to.perturbed->statics;
        if ((!order.decided || order.sign == 0) && is_tie(order, side.size())) {
            f = side.force(opening.contact);
            if (!f.positive()) {
                return Failure{
                    FailureKind::undecided,
                    fmt::format("the new force in {} vanishes, and its first-order term is {:.6g} +- {:.3g}: "
                                "the power of the load is not proved positive at the end of the arc",
                                to_string<Dim>(record.closed), f.value, f.radius)};
            }
            record.perturbed.push_back(
                {"force", record.closed, f, {ContactKind::disk_disk, -1, -1}, {}, order.exponent, order.bits});
            tell(DecisionKind::power, f.margin(), to.statics.rung(), true);
            return std::nullopt;
        }
        if (order.decided && order.sign > 0) {
            tell(DecisionKind::power, order.margin, order.rung, false);
            return std::nullopt;
        }
    }
    while (!f.decided() && to.statics.climb()) {
        f = sign();
        record.power = f.value;
    }
    if (opening.infinitesimal || !to.statics.is_structural_zero(opening.contact)) {
        if (!f.positive()) {
            return Failure{FailureKind::undecided, fmt::format("the power of the load along the arc that opens {} and "
                                                               "closes {} is not proved positive at its end: "
                                                               "force {:.3g} in the new contact, proved to {:.3g}",
                                                               to_string<Dim>(record.opened),
                                                               to_string<Dim>(record.closed), f.value, f.radius)};
        }
        tell(DecisionKind::power, f.margin(), to.statics.rung(), false);
    }
    return std::nullopt;
}

/// Level `arcs`: the certificate does not depend on how the arc was found, and an arc without one stays in the run.
template <int Dim>
double Run<Dim>::certify(const Vertex<Dim>& from, const Vertex<Dim>& to, const Opening& opening, bool at_limit,
                         const Load<Dim>& load, ArcRecord<Dim>& record) const {
    const auto begin = std::chrono::steady_clock::now();
    // Factors of its own: those of the run count their use, and only fresh ones leave what does not move at exactly 0.
    const Factorisation first(from.structure);
    const Factorisation last(to.structure);
    const auto vertex = [](const Vertex<Dim>& v, const Factorisation& factorisation) {
        return ArcVertex<Dim>{v.packing, v.structure, factorisation, v.inverse, v.enclosure};
    };
    record.certificate = certify_arc(vertex(from, first), opening.contact, opening.direction, vertex(to, last),
                                     PowerLoad<Dim>{&load, opening.infinitesimal, at_limit}, candidates_);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <int Dim> void Run<Dim>::tally(const ArcCertificate& certificate, double seconds) {
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
    tally.seconds += seconds;
}

template <int Dim> std::string kind_of(const Vertex<Dim>& at, const Opening& opening) {
    return at.structure.contacts()[opening.contact.index()].kind == ContactKind::held ? "release"
           : opening.infinitesimal                                                    ? "rattler"
                                                                                      : "tension";
}

/// Asks again what made `vertex_` an equilibrium: after a resume the statics then stand on the same rung. Under
/// `perturb` the answer must be the same with the load that the state stores.
template <int Dim> std::optional<Failure> Run<Dim>::still_equilibrium(double stress) {
    auto decision = decide_opening(vertex_->statics, stress, options_.rule, ContactId(), 0, vertex_->first_order());
    if (!perturbs()) {
        return std::nullopt;
    }
    vertex_->perturbed->statics.log.clear();
    if (!decision.ok() || decision.value().opening) {
        return Failure{FailureKind::undecided,
                       fmt::format("equilibrium at sigma = {:.17g}: not found again with the load as it is stored{}",
                                   stress, decision.ok() ? "" : ": " + decision.failure().message)};
    }
    vertex_->perturbed->zeros = decision.value().zeros;
    return std::nullopt;
}

/// The same vertex under another load, which is meant as it is stored.
template <int Dim> std::optional<Failure> Run<Dim>::reload() {
    first_order_->load_is_stored();
    const auto touching = vertex_->perturbed->touching;
    auto made = make_vertex(vertex_->packing, vertex_->structure.contacts(), state_.load);
    if (!made.ok()) {
        return made.failure();
    }
    vertex_ = std::move(made.value());
    vertex_->perturbed->touching = touching;
    return still_equilibrium(sigma());
}

/// Of the contacts of a hyperstatic start those are kept that carry the load for small eps > 0: of those listed, and of
/// the pairs that touch without being listed. True: a choice was made.
template <int Dim> Result<bool> Run<Dim>::choose_start() {
    if (counters_.equilibria != 0 || counters_.steps != 0) {
        return false;
    }
    const auto dofs = static_cast<std::size_t>(DofMap<Dim>(state_.packing).dof_count());
    bool chosen = false;
    const auto choose = [&]() -> std::optional<Failure> {
        chosen = true;
        const auto failure = first_order_->choose_contacts();
        return failure ? std::optional<Failure>(located(*failure, "start")) : std::nullopt;
    };
    if (state_.contacts.size() > dofs) {
        if (auto failure = choose()) {
            return *failure;
        }
    }
    auto made = make_vertex(state_.packing, state_.contacts, state_.load);
    if (!made.ok()) {
        return located(made.failure(), "start");
    }
    auto gaps = made.value()->check_gaps(candidates_, kept_, true);
    if (!gaps.ok()) {
        return located(gaps.failure(), "start");
    }
    const auto overlap = settle_touching(*made.value(), gaps.value().zero);
    if (overlap && overlap->kind == FailureKind::overlap && !chosen) {
        for (const auto& [contact, order] : gaps.value().zero) {
            state_.contacts.push_back(contact);
        }
        if (auto failure = choose()) {
            return *failure;
        }
    }
    return chosen;
}

template <int Dim> Failure Run<Dim>::too_far(const ArcRecord<Dim>& record) const {
    return {FailureKind::cap_reached,
            fmt::format("|eps_2| = {:.6g} at sigma = {:.17g}: the sample fails here (cap max_strain = {:.6g})",
                        std::abs(record.strain), record.stress, options_.max_strain)};
}

/// What `follow`, `check_arc` and `decide_opening` ask of an arc that was steered ahead. Nothing when one of them does
/// not agree: the arc is then done again, step by step.
template <int Dim>
std::optional<typename Run<Dim>::ProvedArc> Run<Dim>::prove_arc(const Vertex<Dim>& from, PlainArrival<Dim>& arrival,
                                                                const Opening& opening, const Load<Dim>& load) {
    ProvedArc arc;
    arc.record = arrival.record;
    ArcRecord<Dim>& record = arc.record;
    record.force = opening.force.value;
    record.margin = infinity;
    record.decided_by = Rung::combinatorial;
    const auto tell = [&arc](DecisionKind kind, double margin, Rung rung, bool /*perturbed*/) {
        arc.counts.push_back({kind, margin, rung});
        arc.record.margin = std::min(arc.record.margin, margin);
        arc.record.decided_by = std::max(arc.record.decided_by, rung);
    };
    tell(DecisionKind::opening, opening.margin, opening.rung, false);
    LadderOptions ladder;
    ladder.first_accuracy = enough_to_decide;
    auto made = Vertex<Dim>::proved(from, std::move(arrival), load, bound_cache_, ladder);
    if (!made.ok()) {
        return std::nullopt;
    }
    arc.vertex = std::move(made.value());
    const auto gaps = arc.vertex->check_gaps(candidates_, kept_);
    if (!gaps.ok() || gaps.value().negative) {
        return std::nullopt;
    }
    tell(DecisionKind::gaps, gaps.value().margin, gaps.value().rung, false);
    arc.min_gap = gaps.value().smallest;
    arc.min_gap_contact = gaps.value().where;
    bool descends = false;
    const auto unproved = check_arc(from, *arc.vertex, opening, load, record, descends, tell);
    if (unproved || (record.power_turn && record.closed == record.opened)) {
        return std::nullopt;
    }
    record_strain(record, *arc.vertex, load);
    auto decision =
        decide_opening(arc.vertex->statics, record.stress, options_.rule,
                       record.power_turn ? opening.contact : ContactId(), bits_for(options_.rule_seed, record.step));
    if (!decision.ok()) {
        return std::nullopt;
    }
    arc.decision = std::move(decision.value());
    if (options_.certify == CertifyLevel::arcs) {
        arc.seconds = certify(from, *arc.vertex, opening, record.kind == "limit", load, record);
    }
    return arc;
}

/// Steers as at level `plain`, and proves every vertex behind, in the same order. What was steered beyond a vertex that
/// decides otherwise is thrown away, and its work not counted: how much of it there is depends on the threads.
template <int Dim> std::optional<Failure> Run<Dim>::go_ahead(Way& way, const Load<Dim>& load) {
    constexpr std::size_t most_waiting = 6;
    const Vertex<Dim>& start = way.here ? *way.here : *vertex_;
    const double stress = sigma_of(load);
    const int before = way.arcs;
    const long step = counters_.steps;
    int steered = 0;
    if (options_.certify == CertifyLevel::arcs) {
        (void)start.structure.ordering(); // made at the first call: both sides may ask for it
    }
    // Of the proofs, until they end:
    std::unique_ptr<Vertex<Dim>> last;
    OpeningDecision decision;
    decision.opening = way.opening;
    ContactId last_hold;
    WorkCounts by_proofs{};
    Behind<PlainArrival<Dim>, ProvedArc> proofs(
        [&](PlainArrival<Dim>& arrival) -> std::optional<ProvedArc> {
            const std::optional<Opening>& due = decision.opening;
            if (!due || due->contact != arrival.opening.contact || due->direction != arrival.opening.direction ||
                due->infinitesimal != arrival.opening.infinitesimal) {
                return std::nullopt;
            }
            const CountingIn counting(&by_proofs);
            const bool held = arrival.record.power_turn;
            auto arc = prove_arc(last ? *last : start, arrival, *due, load);
            if (arc) {
                last_hold = held ? due->contact : ContactId();
                last = std::move(arc->vertex);
                decision = arc->decision;
            }
            return arc;
        },
        most_waiting);
    // Here:
    std::optional<Failure> failure;
    const auto stopped = [this] { return options_.stop != nullptr && options_.stop->load(); };
    WorkCounts* const outside = count_work_in(nullptr);
    count_work_in(outside);
    const auto record = [&] {
        const CountingIn counting(outside); // what the observer does belongs to the run
        while (!failure && !stopped()) {
            auto arc = proofs.next();
            if (!arc) {
                return;
            }
            ++way.arcs;
            ++counters_.steps;
            for (const auto& [kind, margin, rung] : arc->counts) {
                count(kind, margin, rung);
            }
            record_.min_gap = arc->min_gap;
            record_.min_gap_contact = arc->min_gap_contact;
            if (arc->record.certificate) {
                tally(*arc->record.certificate, arc->seconds);
            }
            observer_.on_arc(arc->record);
            counters_.tally.structural_ties += arc->decision.opening && arc->decision.opening->straight_strut ? 1 : 0;
            if (std::abs(arc->record.strain) > options_.max_strain) {
                failure = too_far(arc->record);
            }
        }
    };
    WorkCounts by_steering{};
    std::vector<WorkCounts> before_arc;
    PlainCalls<Dim> calls;
    calls.begin = [&](ArcRecord<Dim>& arc) -> std::optional<Failure> {
        before_arc.push_back(by_steering);
        record();
        if (failure || stopped() || proofs.ended() || before + steered >= options_.max_arcs) {
            return Failure{FailureKind::interrupted, "no farther ahead"};
        }
        arc.step = step + ++steered;
        arc.equilibrium = counters_.equilibria;
        arc.arc = before + steered;
        arc.stress = stress;
        return std::nullopt;
    };
    calls.end = [](ArcRecord<Dim>&, const Packing<Dim>&) { return std::optional<Failure>(); };
    calls.arrived = [&](PlainArrival<Dim> arrival) { proofs.hand_out(std::move(arrival)); };
    calls.random_bits = [&] { return bits_for(options_.rule_seed, step + steered); };
    CandidateList<Dim> candidates = candidates_;
    auto end = [&] {
        const CountingIn counting(&by_steering);
        PlainSteering<Dim> steering(start.packing, start.structure, start.factorisation, way.opening, way.kind, load,
                                    options_, candidates);
        while (true) {
            if (auto done = steering.step(calls)) {
                return std::move(*done);
            }
        }
    }();
    // The equilibrium, if it is one, is proved anew from nothing while the last proofs go on.
    std::unique_ptr<Vertex<Dim>> anew;
    CandidateList<Dim> listed;
    InverseBoundCache cache;
    WorkCounts by_anew{};
    if (end.ok() && !end.value().fresh_hold.valid() && !proofs.ended()) {
        const CountingIn counting(&by_anew);
        auto made = Vertex<Dim>::make(end.value().packing, end.value().contacts, load, cache);
        if (made.ok()) {
            anew = std::move(made.value());
            listed = find_candidates(anew->packing, candidate_fraction, candidates.triangulation);
        }
    }
    proofs.finish();
    record();
    if (failure) {
        return failure;
    }
    const int proved = way.arcs - before;
    add_work(by_proofs);
    add_work(proved < steered ? before_arc[static_cast<std::size_t>(proved)] : by_steering);
    way.by_steps = proved == 0;
    if (proved == 0 || (stopped() && proofs.next())) { // what was proved after the stop is not recorded
        way.by_steps = true;
        return std::nullopt;
    }
    way.here = std::move(last);
    way.last_hold = last_hold;
    if (decision.opening) {
        way.opening = *decision.opening;
        way.kind = kind_of(*way.here, way.opening);
        return std::nullopt;
    }
    count(DecisionKind::equilibrium, decision.margin, decision.rung, nullptr, decision.perturbed);
    way.ended = true;
    if (anew && proved == steered) {
        add_work(by_anew);
        way.anew = std::move(anew);
        candidates_ = std::move(listed);
        bound_cache_ = std::move(cache);
    }
    return std::nullopt;
}

template <int Dim>
std::optional<Failure> Run<Dim>::rearrange(Opening opening, const std::string& kind, const LimitLoad<Dim>& limit) {
    const Load<Dim>& load = limit.load;
    const double stress = limit.stress();
    if (options_.certify == CertifyLevel::plain) {
        return rearrange_plainly(opening, kind, load);
    }
    fresh_caches(vertex_->packing);
    Way way;
    way.opening = opening;
    way.kind = kind;
    bool descends = false;          // the work of the last arc was proved positive
    std::vector<ContactId> resting; // holds at `from` whose multipliers are 0 as far as their turns are located
    std::vector<ContactId> zeros;   // forces at the end that vanish in the base
    while (!way.ended) {
        if (steers_ahead() && !way.by_steps && resting.empty()) {
            if (auto failure = go_ahead(way, load)) {
                return failure;
            }
            continue;
        }
        way.by_steps = false;
        const Vertex<Dim>* from = way.here ? way.here.get() : vertex_.get();
        if (options_.stop != nullptr && options_.stop->load()) {
            return Failure{
                FailureKind::interrupted,
                fmt::format("stopped after {} arcs of a rearrangement at sigma = {:.17g}", way.arcs, stress)};
        }
        if (way.arcs >= options_.max_arcs) {
            return Failure{FailureKind::cap_reached,
                           fmt::format("no equilibrium after {} arcs at sigma = {:.17g}: the sample fails here (cap "
                                       "max_arcs)",
                                       way.arcs, stress)};
        }
        ++way.arcs;
        ArcRecord<Dim> record;
        record.step = ++counters_.steps;
        record.equilibrium = counters_.equilibria;
        record.arc = way.arcs;
        record.kind = way.kind;
        record.opened = from->structure.contacts()[way.opening.contact.index()];
        record.stress = stress;
        record.force = way.opening.force.value;
        record.margin = infinity;
        record.decided_by = Rung::combinatorial;
        if (way.arcs == 1) {
            take_log(*vertex_, record.perturbed);
        }
        count(DecisionKind::opening, way.opening.margin, way.opening.rung, &record, way.opening.perturbed);
        const bool at_limit = way.arcs == 1 && kind == "limit";
        const std::string where = fmt::format("arc {} of the rearrangement at sigma = {:.17g}", way.arcs, stress);
        auto made = follow(*from, way.opening, at_limit, limit, record);
        if (!made.ok()) {
            return located(made.failure(), where);
        }
        std::unique_ptr<Vertex<Dim>> next = std::move(made.value());
        const auto unproved = check_arc(*from, *next, way.opening, load, record, descends,
                                        [&](DecisionKind about, double margin, Rung rung, bool perturbed) {
                                            count(about, margin, rung, &record, perturbed);
                                        });
        const bool turned_back = record.power_turn && record.closed == record.opened;
        if (way.kind == "release" && !descends && (turned_back || unproved)) {
            // It turned back where it stood, or went up: its multiplier is noise, and there is no descent. Released
            // once more it would do so for ever.
            resting.push_back(way.opening.contact);
            --counters_.steps;
            --way.arcs;
            ZeroHolds zero{std::nullopt, resting};
            if (way.last_hold.valid()) {
                zero.fresh = way.last_hold;
            }
            auto again = decide_opening(way.here->statics, stress, options_.rule, zero,
                                        bits_for(options_.rule_seed, counters_.steps), way.here->first_order());
            if (!again.ok()) {
                return located(again.failure(), where);
            }
            if (!again.value().opening) {
                return Failure{FailureKind::undecided,
                               fmt::format("{}: every force is positive, and the multiplier of {} is 0 as far as the "
                                           "power turn is located: whether and where it moves is not decided",
                                           where, to_string<Dim>(record.opened))};
            }
            way.opening = *again.value().opening;
            way.kind = kind_of(*way.here, way.opening);
            continue;
        }
        if (unproved) {
            return located(*unproved, where);
        }
        resting.clear();
        if (options_.certify == CertifyLevel::arcs) {
            const double seconds = certify(*from, *next, way.opening, at_limit, load, record);
            tally(*record.certificate, seconds);
        }
        record_strain(record, *next, load);
        const ContactId fresh_hold = record.power_turn ? way.opening.contact : ContactId();
        auto decision = decide_opening(next->statics, stress, options_.rule, fresh_hold,
                                       bits_for(options_.rule_seed, counters_.steps), next->first_order());
        take_log(*next, record.perturbed);
        observer_.on_arc(record);
        if (!decision.ok()) {
            return located(decision.failure(), where);
        }
        counters_.tally.structural_ties += decision.value().opening && decision.value().opening->straight_strut ? 1 : 0;
        way.here = std::move(next);
        way.last_hold = fresh_hold;
        if (std::abs(record.strain) > options_.max_strain) {
            return too_far(record);
        }
        if (!decision.value().opening) {
            count(DecisionKind::equilibrium, decision.value().margin, decision.value().rung, nullptr,
                  decision.value().perturbed);
            zeros = decision.value().zeros;
            break;
        }
        way.opening = *decision.value().opening;
        way.kind = kind_of(*way.here, way.opening);
    }
    // The equilibrium itself is proved anew, from nothing that the way to it left: full exact elimination, fresh
    // factors and bound. A resumed run starts from the same bits.
    if (way.anew == nullptr) {
        fresh_caches(way.here->packing);
        // The load is again the stored one, if the forces allow it.
        auto anew = make_vertex(way.here->packing, way.here->structure.contacts(), load);
        if (!anew.ok()) {
            return located(anew.failure(), fmt::format("equilibrium at sigma = {:.17g}", stress));
        }
        way.anew = std::move(anew.value());
    }
    vertex_ = std::move(way.anew);
    auto gaps = vertex_->check_gaps(candidates_, kept_, perturbs());
    if (!gaps.ok()) {
        return located(gaps.failure(), fmt::format("equilibrium at sigma = {:.17g}", stress));
    }
    if (gaps.value().negative) {
        return Failure{FailureKind::overlap, fmt::format("equilibrium at sigma = {:.17g}: {} overlap", stress,
                                                         to_string<Dim>(*gaps.value().negative))};
    }
    if (perturbs()) {
        std::optional<Failure> failure = first_order_->settle_load(*vertex_, limit, zeros);
        if (!failure) {
            failure = settle_touching(*vertex_, gaps.value().zero);
        }
        if (failure) {
            return located(*failure, fmt::format("equilibrium at sigma = {:.17g}", stress));
        }
    }
    record_.min_gap = gaps.value().smallest;
    record_.min_gap_contact = gaps.value().where;
    if (!perturbs()) { // otherwise `still_equilibrium` insists on the answer
        auto again = decide_opening(vertex_->statics, stress, options_.rule, way.last_hold, 0);
        if (!again.ok() || again.value().opening) {
            return Failure{
                FailureKind::undecided,
                fmt::format("equilibrium at sigma = {:.17g}: not found again with fresh factors and bounds{}", stress,
                            again.ok() ? "" : ": " + again.failure().message)};
        }
    }
    // The questions that `start` asks after a resume: the statics then stand on the same rung.
    if (auto failure = still_equilibrium(stress)) {
        return failure;
    }
    state_.load = load;
    state_.packing = vertex_->packing;
    state_.contacts = vertex_->structure.contacts();
    return report(way.arcs);
}

template <int Dim>
typename Run<Dim>::PlainProof Run<Dim>::prove_plain_end(typename Vertex<Dim>::Beginning beginning,
                                                        const Load<Dim>& load, ContactId fresh_hold,
                                                        std::uint64_t random_bits) {
    const double stress = sigma_of(load);
    bound_cache_.forget();
    PlainProof proof{Vertex<Dim>::make(std::move(beginning), load, bound_cache_), {}, {}, {}};
    if (!proof.vertex.ok()) {
        return proof;
    }
    Vertex<Dim>& vertex = *proof.vertex.value();
    proof.gaps = vertex.check_gaps(candidates_, kept_);
    if (!proof.gaps->ok() || proof.gaps->value().negative) {
        return proof;
    }
    proof.decision = decide_opening(vertex.statics, stress, options_.rule, fresh_hold, random_bits);
    if (proof.decision->ok() && !proof.decision->value().opening) {
        // The questions that `start` asks after a resume: the statics then stand on the same rung.
        (void)decide_opening(vertex.statics, stress, options_.rule, ContactId(), 0);
        proof.description = describe(vertex, load);
    }
    return proof;
}

/// Whether it is worth while to begin the next rearrangement while the end of this one is proved.
template <int Dim> bool Run<Dim>::goes_on(const PlainEnd<Dim>& end) const {
    const bool last = segment_wanted_->equilibria && made_ + 1 >= *segment_wanted_->equilibria;
    return threads() > 1 && !last && std::none_of(end.contacts.begin(), end.contacts.end(), [](const Contact& c) {
               return c.kind == ContactKind::held;
           });
}

/// The rearrangement that follows an equilibrium at this load, as forces in plain double precision tell: whoever
/// proves the limit throws it away when another contact opens, or at another load. False: there is none to follow.
template <int Dim> bool Run<Dim>::set_out(PlainWay& way, const Load<Dim>& load) {
    const int direction = segment_wanted_->direction;
    const double stress = sigma_of(load);
    const InverseBound unknown;
    const Statics<Dim> statics(way.origin->packing, load, way.origin->structure, way.origin->factorisation, unknown);
    double smallest = infinity;
    for (int index = 0; index < statics.structure().size(); ++index) {
        const ContactId l(index);
        const double rate = direction * statics.slope(l).value;
        const double distance = rate < 0 ? statics.force(l, stress).value / -rate : infinity;
        if (distance < smallest) {
            smallest = distance;
            way.opens = l;
        }
    }
    const double limit = stress + direction * smallest;
    const std::optional<double>& to = segment_wanted_->to_stress;
    if (!way.opens.valid() || (to && !(direction * (limit - *to) < 0))) {
        return false;
    }
    way.load = load;
    set_sigma(way.load, limit);
    Opening opening;
    opening.contact = way.opens;
    way.steering =
        std::make_unique<PlainSteering<Dim>>(way.origin->packing, way.origin->structure, way.origin->factorisation,
                                             opening, "limit", way.load, options_, way.candidates);
    return true;
}

/// Until it ends, or `enough`.
template <int Dim> void Run<Dim>::steer_unseen(PlainWay& way, const std::function<bool()>& enough) {
    const CountingIn counting(&way.work);
    PlainCalls<Dim> calls;
    calls.begin = [](ArcRecord<Dim>&) { return std::optional<Failure>(); };
    calls.end = [&](ArcRecord<Dim>& record, const Packing<Dim>& packing) {
        record.strain = strain(way.load, packing);
        way.unseen.push_back(record);
        return std::optional<Failure>();
    };
    calls.random_bits = [&] {
        return bits_for(options_.rule_seed, counters_.steps + static_cast<long>(way.unseen.size()));
    };
    while (!way.end && !enough() && way.unseen.size() < static_cast<std::size_t>(options_.max_arcs)) {
        way.end = way.steering->step(calls);
    }
}

/// Level `plain`: the way is steered without bounds, the end is proved. When the proof finds a negative force there,
/// steering goes on with it. With two threads the end is proved beside the first arcs of the next way.
template <int Dim>
std::optional<Failure> Run<Dim>::rearrange_plainly(Opening opening, const std::string& kind, const Load<Dim>& load) {
    const double stress = sigma_of(load);
    int arcs = 0;
    const auto where = [&] { return fmt::format("arc {} of the rearrangement at sigma = {:.17g}", arcs, stress); };
    const auto begin = [&](ArcRecord<Dim>& record) -> std::optional<Failure> {
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
    const auto show = [&](const ArcRecord<Dim>& record) -> std::optional<Failure> {
        observer_.on_arc(record);
        if (std::abs(record.strain) > options_.max_strain) {
            return Failure{FailureKind::cap_reached,
                           fmt::format("|eps_2| = {:.6g}: the sample fails here (cap max_strain = {:.6g})",
                                       std::abs(record.strain), options_.max_strain)};
        }
        return std::nullopt;
    };
    PlainCalls<Dim> calls;
    calls.begin = begin;
    calls.end = [&](ArcRecord<Dim>& record, const Packing<Dim>& packing) {
        record.strain = strain(load, packing);
        return show(record);
    };
    calls.random_bits = [&] { return bits_for(options_.rule_seed, counters_.steps); };

    std::unique_ptr<PlainWay> way = std::move(ahead_);
    const bool begun = way && kind == "limit" && way->opens == opening.contact && sigma_of(way->load) == stress;
    if (!begun) {
        way = std::make_unique<PlainWay>();
        way->steering = std::make_unique<PlainSteering<Dim>>(
            vertex_->packing, vertex_->structure, vertex_->factorisation, opening, kind, load, options_, candidates_);
    }
    while (true) {
        add_work(way->work);
        for (ArcRecord<Dim>& record : way->unseen) {
            auto failure = begin(record);
            failure = failure ? failure : show(record);
            if (failure) {
                return located(*failure, where());
            }
        }
        while (!way->end) {
            way->end = way->steering->step(calls);
        }
        if (!way->end->ok()) {
            return located(way->end->failure(), where());
        }
        PlainEnd<Dim> end = std::move(way->end->value());
        way.reset();
        const auto at_equilibrium = [&](const Failure& failure) {
            return located(failure, fmt::format("equilibrium at sigma = {:.17g}", stress));
        };
        const bool on = goes_on(end);
        Promised<CandidateList<Dim>> listed([packing = end.packing, from = candidates_.triangulation] {
            return find_candidates(packing, candidate_fraction, from);
        });
        auto beginning = Vertex<Dim>::begin(std::move(end.packing), std::move(end.contacts));
        candidates_ = listed.take();
        if (!beginning.ok()) {
            return at_equilibrium(beginning.failure());
        }
        if (on) { // with copies of what the proof uses
            const auto& b = beginning.value();
            ahead_ = std::make_unique<PlainWay>();
            ahead_->origin.emplace(
                typename PlainWay::Origin{b.packing, b.rank.unproved(), b.factorisation.fresh_copy()});
            ahead_->candidates = candidates_;
        }
        Promised<PlainProof> promised(
            [this, &load, hold = end.fresh_hold, bits = calls.random_bits(),
             from = std::make_shared<typename Vertex<Dim>::Beginning>(std::move(beginning.value()))] {
                return prove_plain_end(std::move(*from), load, hold, bits);
            });
        if (on && set_out(*ahead_, load)) {
            steer_unseen(*ahead_,
                         [&] { return !promised.underway() || (options_.stop != nullptr && options_.stop->load()); });
        } else {
            ahead_.reset();
        }
        PlainProof proof = promised.take();
        if (!proof.vertex.ok()) {
            return at_equilibrium(proof.vertex.failure());
        }
        if (!proof.gaps->ok()) {
            return at_equilibrium(proof.gaps->failure());
        }
        const auto& gaps = proof.gaps->value();
        if (gaps.negative) {
            return at_equilibrium({FailureKind::undecided, fmt::format("plain steering went past a contact, {} overlap",
                                                                       to_string<Dim>(*gaps.negative))});
        }
        if (!proof.decision->ok()) {
            return located(proof.decision->failure(), where());
        }
        const OpeningDecision& decision = proof.decision->value();
        record_.min_gap = gaps.smallest;
        record_.min_gap_contact = gaps.where;
        vertex_ = std::move(proof.vertex.value());
        if (!decision.opening) {
            count(DecisionKind::gaps, gaps.margin, gaps.rung);
            count(DecisionKind::equilibrium, decision.margin, decision.rung);
            state_.load = load;
            state_.packing = vertex_->packing;
            state_.contacts = vertex_->structure.contacts();
            return report(arcs, std::move(proof.description));
        }
        ahead_.reset(); // no equilibrium after all
        way = std::make_unique<PlainWay>();
        way->steering = std::make_unique<PlainSteering<Dim>>(
            vertex_->packing, vertex_->structure, vertex_->factorisation, *decision.opening,
            kind_of(*vertex_, *decision.opening), load, options_, candidates_);
    }
}

template <int Dim> std::optional<Failure> Run<Dim>::report(int arcs, std::optional<Result<Description<Dim>>> known) {
    auto described = known ? std::move(*known) : describe(*vertex_, state_.load);
    if (!described.ok()) {
        return located(described.failure(), fmt::format("equilibrium at sigma = {:.17g}", sigma()));
    }
    EquilibriumRecord<Dim>& record = described.value().record;
    limits_ = described.value().limit;
    // No two grains overlap by more than the uncertainty of the stored configuration, all pairs included.
    const double allowance = 4 * vertex_->enclosure.distance();
    const Admissibility admissible = certify_admissible(vertex_->packing, allowance, &candidates_);
    if (admissible.verdict != Verdict::proved) {
        return Failure{FailureKind::overlap,
                       fmt::format("equilibrium at sigma = {:.17g}: {} overlap, gap {:.6g}", sigma(),
                                   to_string<Dim>(admissible.worst), admissible.worst_gap)};
    }
    record_smallest_gap(described.value(), vertex_->packing, record_.min_gap_contact, record_.min_gap);
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
    if (perturbs()) {
        first_order_->store(*vertex_);
    }
    counters_.seconds = elapsed();
    observer_.on_equilibrium(record, state_, finite_forces(*vertex_, state_.load));
    return observer_.objection();
}

template <int Dim> std::optional<Failure> Run<Dim>::start() {
    fresh_caches(state_.packing);
    bool touching = false; // a choice at first order was made
    if (perturbs()) {
        auto chosen = choose_start();
        if (!chosen.ok()) {
            return chosen.failure();
        }
        touching = chosen.value();
    }
    auto made = make_vertex(state_.packing, state_.contacts, state_.load);
    if (!made.ok()) {
        return located(made.failure(), "start");
    }
    vertex_ = std::move(made.value());
    auto gaps = vertex_->check_gaps(candidates_, kept_, perturbs());
    if (!gaps.ok()) {
        return located(gaps.failure(), "start");
    }
    if (gaps.value().negative) {
        return Failure{FailureKind::overlap, fmt::format("start: {} overlap", to_string<Dim>(*gaps.value().negative))};
    }
    if (perturbs()) {
        if (auto failure = first_order_->resume(*vertex_, gaps.value().zero)) {
            return located(*failure, "start");
        }
        touching = touching || !gaps.value().zero.empty();
    }
    record_.min_gap = gaps.value().smallest;
    record_.min_gap_contact = gaps.value().where;
    if (counters_.equilibria != 0 || counters_.steps != 0) {
        // The same questions as when the equilibrium was found: the statics then stand on the same rung, and the run
        // goes on with the same bits.
        if (auto failure = still_equilibrium(sigma())) {
            return failure;
        }
        auto described = describe(*vertex_, state_.load);
        if (!described.ok()) {
            return located(described.failure(), "start");
        }
        described.value().record.min_gap = record_.min_gap;
        described.value().record.min_gap_contact = record_.min_gap_contact;
        record_ = described.value().record;
        limits_ = described.value().limit;
        return std::nullopt;
    }
    count(DecisionKind::gaps, gaps.value().margin, gaps.value().rung);
    auto decision = decide_opening(vertex_->statics, sigma(), options_.rule, ContactId(),
                                   bits_for(options_.rule_seed, 0), vertex_->first_order());
    if (!decision.ok()) {
        return located(decision.failure(), "start");
    }
    if (decision.value().opening) {
        const Opening& opening = *decision.value().opening;
        return rearrange(opening, opening.infinitesimal ? "rattler" : "tension", {state_.load, nullptr, 0, {0, 0}});
    }
    if (vertex_->perturbed) {
        vertex_->perturbed->zeros = decision.value().zeros;
        vertex_->perturbed->statics.log.clear();
    }
    count(DecisionKind::equilibrium, decision.value().margin, decision.value().rung, nullptr,
          decision.value().perturbed || touching);
    return report(0);
}

template <int Dim> SegmentOutcome Run<Dim>::play(const Segment& segment) {
    SegmentOutcome outcome;
    segment_wanted_ = &segment;
    made_ = -1; // a start that is no equilibrium yet makes one that does not count
    if (auto failure = start()) {
        outcome.failure = failure;
        return outcome;
    }
    made_ = 0;
    while (true) {
        if (segment.equilibria && made_ >= *segment.equilibria) {
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
        if (vertex_->perturbed) {
            vertex_->perturbed->statics.log.clear();
        }
        // Where the statics have climbed since, the same question has an answer with other bits; a resumed run, whose
        // statics climb at other moments, must find the same. Under `perturb` ties are written to the log once more.
        const std::optional<LoadLimit>& known = limits_[segment.direction > 0 ? 1 : 0];
        auto found = known && !perturbs() && vertex_->statics.rung() == Rung::double_bound
                         ? Result<LoadLimit>(*known)
                         : find_limit(vertex_->statics, sigma(), segment.direction, vertex_->first_order());
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
                if (perturbs()) {
                    if (auto failure = reload()) {
                        outcome.failure = failure;
                        return outcome;
                    }
                }
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
        opening.perturbed = limit.perturbed;
        LimitLoad<Dim> at_limit{state_.load, nullptr, 0, {0, 0}};
        at_limit.set_stress(limit.stress);
        if (perturbs()) {
            at_limit.shift = vertex_->statics.zero_of(limit.opens, limit.stress);
            at_limit.error = limit.stress_error;
            at_limit.stress_rate =
                vertex_->perturbed->statics.limit_rate(limit.opens, limit.stress, limit.stress_error);
        }
        const RunCounters before = counters_;
        ++counters_.equilibria;
        if (auto failure = rearrange(opening, "limit", at_limit)) {
            counters_.equilibria = before.equilibria; // the steps stay counted: their records are written
            counters_.seconds = elapsed();
            outcome.failure = failure;
            return outcome;
        }
        ++made_;
    }
}

} // namespace

template <int Dim>
SegmentOutcome run_segment(State<Dim>& state, const Segment& segment, int segment_number, const RunOptions& options,
                           RunCounters& counters, RunObserver<Dim>& observer) {
    require_floating_point();
    return Run<Dim>(state, segment_number, options, counters, observer).run(segment);
}

template SegmentOutcome run_segment<2>(State<2>&, const Segment&, int, const RunOptions&, RunCounters&,
                                       RunObserver<2>&);

} // namespace isostat
