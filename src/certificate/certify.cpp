#include "certificate/parts.hpp"
#include "certificate/true_vertex.hpp"
#include "contact/candidates.hpp"
#include "contact/images.hpp"
#include "contact/other_pairs.hpp"
#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "verified/to_vertex.hpp"
#include "verified/vertex_bounds.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace isostat {

namespace {

using roundoff::infinity;
using roundoff::u;

/// Words for the first force that is negative, and for the first whose sign is not known; empty: there is none.
struct SignFailures {
    std::string negative;
    std::string doubtful;
};

/// Bound of |gap| of a contact at the stored coordinates.
double largest_gap(const ProvedStructure& at) {
    double largest = 0;
    for (const Contact& contact : at.structure.contacts()) {
        const double h = std::abs(gap(at.packing, contact));
        // 8: bounds.md V4 (8u of a gap); 4: precision.md B1 (last operations)
        largest = std::max(largest, (h + 8 * u * (h + target(at.packing, contact))) * (1 + 4 * u));
    }
    return largest;
}

/// Makes the claims one after the other; what one needs of those before it is checked where it is used.
class Prover {
  public:
    Prover(const State& state, const CertifyOptions& options, const ProvedStructure* proved = nullptr)
        : state_(state), options_(options),
          proved_(proved != nullptr && proved->is_of(state.packing, state.contacts) ? proved : nullptr) {}

    Certification run() {
        result_.dimension = state_.packing.dimension;
        if (prove_counting() && put_on_grid() && prove_vertex()) {
            const bool forces = prove_forces();
            const bool gaps = prove_gaps();
            if (forces) {
                prove_load_interval();
            } else {
                absent("load interval", "the forces are not all proved positive");
            }
            prove_stability(forces, gaps);
        }
        const CertificateClaims& c = result_.claims;
        const bool all =
            (c.counting && c.vertex && c.forces && c.gaps && c.load_interval && c.stable) || c.minimum.has_value();
        result_.verdict = !result_.refuted.empty() ? Verdict::refuted : all ? Verdict::proved : Verdict::undecided;
        return std::move(result_);
    }

    /// As `finite_forces`; `state` is the one that this was made of.
    std::vector<std::vector<Interval>> under(State& state, std::span<const PerAxis<double>> stresses) {
        std::vector<std::vector<Interval>> forces;
        if (!prove_counting() || !put_on_grid() || !prove_vertex()) {
            return forces;
        }
        for (const PerAxis<double>& stress : stresses) {
            state.load.stress = stress;
            subject_ = std::make_unique<Subject>(state_, stored_->structure);
            if (!exists_on_some_rung()) {
                return {};
            }
            prove_forces();
            forces.push_back(std::move(result_.finite));
        }
        return forces;
    }

  private:
    void absent(const char* claim, const std::string& reason) {
        result_.claims.undecided.push_back(fmt::format("{}: {}", claim, reason));
    }
    void refute(const char* claim, const std::string& reason) {
        absent(claim, reason);
        result_.refuted.push_back(result_.claims.undecided.back());
    }
    void absent_from_vertex_on(const std::string& reason) {
        for (const char* claim : {"vertex", "forces", "gaps", "load interval", "stability"}) {
            absent(claim, reason);
        }
    }
    [[nodiscard]] std::string named(const Contact& contact) const {
        return to_string(contact, state_.packing.dimension);
    }
    [[nodiscard]] std::string fixed_and_overlap(const Contact& pair) const {
        return fmt::format("{} overlap, and cannot move", named(pair));
    }
    /// With all digits: shorter ones would be other numbers.
    static std::string shown(const Interval& interval) {
        return fmt::format("[{:.17g}, {:.17g}]", interval.lower, interval.upper);
    }
    [[nodiscard]] double shortest_side() const {
        double shortest = infinity;
        for (int a = 0; a < centre_->packing.dimension; ++a) {
            shortest = std::min(shortest, centre_->packing.length(a));
        }
        return shortest;
    }
    [[nodiscard]] std::string in_contact(std::size_t l, const Interval& f) const {
        return fmt::format("in contact {} is in {}", named(state_.contacts[l]), shown(f));
    }

    bool prove_counting();
    bool claim_regular(int rows);
    void claim_minimum();
    [[nodiscard]] std::optional<Contact> held_under_load() const;
    void claim_that_nothing_moves();
    void claim_other_counts();
    bool put_on_grid();
    bool prove_vertex();
    [[nodiscard]] std::unique_ptr<ProvedStructure> downhill() const;
    bool prove_forces();
    ForceSigns look_at(const std::vector<Interval>& finite, SignFailures& failures) const;
    void look_at_zeros(ForcesClaim& claim, SignFailures& failures) const;
    bool prove_gaps();
    void prove_load_interval();
    void prove_stability(bool forces, bool gaps);

    /// The next rung around the same centre; false when there is none, or when none is allowed.
    bool climb();
    /// Climbs to a rung on which the vertex exists.
    bool exists_on_some_rung();

    const State& state_;
    CertifyOptions options_;
    const ProvedStructure* proved_; ///< null: nothing was proved before
    Certification result_;
    std::unique_ptr<ProvedStructure> stored_; ///< at the stored coordinates; in a cell, these on the grid
    double rounded_away_ = 0;                 ///< what that changed of a gap, at most
    std::unique_ptr<ProvedStructure> moved_;  ///< at the end of a Newton iteration, when that is wanted
    const ProvedStructure* centre_ = nullptr; ///< one of them
    std::unique_ptr<Subject> subject_;
    std::unique_ptr<TrueVertex> vertex_;
};

bool Prover::climb() {
    if (vertex_->rung() >= options_.highest || vertex_->rung() == Rung::multiprecision) {
        return false;
    }
    vertex_ = vertex_->rung() == Rung::double_bound ? in_double_double(*subject_, *centre_)
                                                    : in_multiprecision(*subject_, *centre_);
    return vertex_->exists() || climb();
}

bool Prover::exists_on_some_rung() {
    vertex_ = in_double(*subject_, *centre_);
    return vertex_->exists() || climb();
}

bool Prover::prove_counting() {
    if (const auto reason = beyond_claims(state_)) {
        result_.counting = count_contacts(state_.packing, state_.contacts);
        absent("counting", *reason);
        absent_from_vertex_on(*reason);
        return false;
    }
    const int dof_count = DofMap(state_.packing).dof_count();
    const int count = static_cast<int>(state_.contacts.size());
    if (count == 0 && dof_count == 0) {
        claim_that_nothing_moves();
        return false;
    }
    if (proved_ != nullptr) {
        stored_ = proved_->shared();
        return claim_regular(count);
    }
    if (dof_count == count) {
        auto made = ProvedStructure::make(state_.packing, state_.contacts);
        if (made.ok()) {
            stored_ = std::move(made.value());
            return claim_regular(count);
        }
    }
    claim_other_counts();
    return false;
}

/// With as many rows as degrees of freedom, all independent: what is held makes up for free motions, and does nothing
/// else (proofs/clumps.md, U2).
bool Prover::claim_regular(int rows) {
    const std::vector<Contact>& list = state_.contacts;
    const int bars = bar_count(list);
    const int held =
        static_cast<int>(std::ranges::count_if(list, [](const Contact& c) { return c.kind == ContactKind::held; }));
    const int contacts = rows - bars - held;
    result_.counting = {rows - bars, contacts, contacts, 0, held, Verdict::proved, {}};
    if (const auto bears = held > 0 ? held_under_load() : std::nullopt) {
        const std::string reason = fmt::format("the load may act on a mechanism ({})", named(*bears));
        absent("counting", reason);
        absent_from_vertex_on(reason);
        claim_minimum();
        return false;
    }
    result_.claims.counting = CountingClaim{rows - bars, contacts, contacts, 0, held, Rung::exact};
    return true;
}

/// Along mechanisms that the load reaches (U8). The claims leave room for a checker with other bounds.
void Prover::claim_minimum() {
    // choice: room of the claim of a minimum for a checker with other bounds, which checks it
    constexpr double room = 16;
    if (!state_.load.infinitesimal.empty()) {
        return;
    }
    const auto found = inspect_mechanism(state_, result_.counting);
    if (found.ok() && !found.value().form.empty()) {
        const MechanismInspection& minimum = found.value();
        result_.claims.minimum = MinimumClaim{room * minimum.away, minimum.curvature / 2, minimum.held, minimum.form};
        result_.claims.undecided = {"all other claims: of an isostatic structure, and the load acts on mechanisms"};
    }
}

/// The first held coordinate that the load may act on; infinitesimal loads may act on any.
std::optional<Contact> Prover::held_under_load() const {
    const std::vector<double>& g = state_.load.infinitesimal;
    const bool pressed = std::ranges::any_of(g, [](double x) { return x != 0; });
    const Subject subject(state_, stored_->structure);
    for (std::size_t l = 0; l < state_.contacts.size(); ++l) {
        if (state_.contacts[l].kind == ContactKind::held && (subject.zero[l] == 0 || pressed)) {
            return state_.contacts[l];
        }
    }
    return std::nullopt;
}

void Prover::claim_that_nothing_moves() {
    result_.claims.counting = CountingClaim{};
    result_.counting.rank_exact = Verdict::proved;
    const std::string reason = "N_f = 0: there are no degrees of freedom, no grain can move";
    refute("vertex", reason);
    for (const char* claim : {"forces", "gaps", "load interval", "stability"}) {
        absent(claim, reason);
    }
    if (const auto pair = fixed_overlap(state_.packing)) {
        refute("gaps", fixed_and_overlap(*pair));
    }
}

/// Of a structure that is not isostatic, or not proved to be.
void Prover::claim_other_counts() {
    if (std::ranges::any_of(state_.contacts, [](const Contact& c) { return c.kind == ContactKind::held; })) {
        result_.counting = count_contacts(state_.packing, state_.contacts);
        const std::string reason = "coordinates are held, and the list with these is not proved regular";
        absent("counting", reason);
        absent_from_vertex_on(reason);
        return;
    }
    const Counting counting = exact_counting(state_);
    result_.counting = counting;
    const std::string numbers =
        fmt::format("N_f = {}, N = {}, rank {}{}, h {} {}, k {} {}", counting.dof_count, counting.contact_count,
                    counting.rank_exact == Verdict::proved ? "" : "at least ", counting.rank,
                    counting.rank_exact == Verdict::proved ? "=" : "<=", counting.hyperstaticity,
                    counting.rank_exact == Verdict::proved ? "=" : "<=", counting.mechanisms);
    if (counting.rank_exact == Verdict::proved) {
        result_.claims.counting = CountingClaim{counting.dof_count,      counting.contact_count, counting.rank,
                                                counting.hyperstaticity, counting.mechanisms,    Rung::exact};
    } else {
        absent("counting", "the rank of the stored matrix was only bounded: " + numbers);
    }
    const std::string reason = "the structure is not isostatic: " + numbers;
    if (counting.rank_exact == Verdict::proved || counting.dof_count != counting.contact_count) {
        refute("vertex", reason);
    } else {
        absent("vertex", reason);
    }
    for (const char* claim : {"forces", "gaps", "load interval", "stability"}) {
        absent(claim, "the structure is not isostatic, or not proved to be");
    }
}

/// The bounds of the true vertex ask for exact differences: in a cell, for coordinates on the grid.
bool Prover::put_on_grid() {
    if (!state_.packing.cell.any()) {
        return true;
    }
    double moved = 0;
    auto snapped = on_grid(state_.packing, state_.contacts, moved);
    if (!snapped) {
        absent_from_vertex_on(
            fmt::format("a period or tilt that cannot move is not on the grid of the packing, or an image is more "
                        "than {} periods away",
                        farthest_image));
        return false;
    }
    if (moved == 0) {
        return true; // they are there already
    }
    auto made = stored_->moved(std::move(*snapped), moved);
    if (!made.ok()) {
        absent_from_vertex_on("where the coordinates are on the grid the contact matrix is not proved regular");
        return false;
    }
    stored_ = std::move(made.value());
    const int d = stored_->packing.dimension;
    // cells.md C4 (stored and grid)
    const double weight = 2 + 3 * (d + 1); // |delta gap| for offsets up to 3, component by component
    rounded_away_ = d * weight * moved;
    return true;
}

/// Where the gaps are visibly open, the stored place says less than the end of Newton's method. Either will do.
std::unique_ptr<ProvedStructure> Prover::downhill() const {
    constexpr double visible = 1e-10; // guess: when a centre is sought by Newton
    constexpr double reach = 0.1;     // of the smallest radius; guess: the centre may be any doubles (true_vertex.md)
    Packing end = stored_->packing;
    end.cell.keeps_shape = false; // only the period that moves was asked about
    long steps = 0;
    if (worst_gap_ratio(stored_->packing, stored_->structure.contacts()) < visible ||
        to_vertex(end, state_.contacts, steps, reach * end.min_radius())) {
        return nullptr;
    }
    end.cell = stored_->packing.cell;
    double moved = 0;
    const auto snapped = end.cell.any() ? on_grid(end, state_.contacts, moved) : std::optional(end);
    auto made =
        snapped ? ProvedStructure::make(*snapped, state_.contacts) : Failure{FailureKind::undecided, "off the grid"};
    return made.ok() ? std::move(made.value()) : nullptr;
}

bool Prover::prove_vertex() {
    centre_ = stored_.get();
    result_.stored_gap = largest_gap(*centre_) + rounded_away_;
    subject_ = std::make_unique<Subject>(state_, stored_->structure);
    if (centre_->inverse.verdict != Verdict::proved) {
        absent_from_vertex_on("no bound of the inverse of the contact matrix was found");
        return false;
    }
    moved_ = downhill();
    centre_ = moved_ ? moved_.get() : stored_.get();
    bool exists = exists_on_some_rung();
    if (!exists && moved_) {
        vertex_.reset();
        centre_ = stored_.get();
        exists = exists_on_some_rung();
    }
    if (!exists) {
        absent_from_vertex_on(
            fmt::format("no configuration in which all gaps of the contacts are 0 was proved to exist, and to be "
                        "alone, near the stored "
                        "one (largest |gap| of a contact {:.3g}, smallest singular value at least {:.3g})",
                        result_.stored_gap, stored_->inverse.sigma_min));
        return false;
    }
    result_.claims.vertex = VertexClaim{vertex_->radius(), vertex_->unique_radius(), vertex_->rung()};
    result_.smallest_sigma = vertex_->sigma_min();
    return true;
}

bool Prover::prove_forces() {
    ForcesClaim claim;
    result_.structural_zero = subject_->zero;
    for (std::size_t l = 0; l < state_.contacts.size(); ++l) {
        if (subject_->zero[l] != 0) {
            claim.structural_zeros.push_back(static_cast<int>(l));
        }
    }
    SignFailures failures;
    do {
        claim.rung = vertex_->rung();
        claim.finite = vertex_->forces();
        failures = {};
        result_.signs = look_at(claim.finite, failures);
        result_.finite = claim.finite;
        look_at_zeros(claim, failures);
    } while (failures.negative.empty() && !failures.doubtful.empty() && climb());
    if (!failures.negative.empty()) {
        refute("forces", failures.negative + ": not an equilibrium at this load");
        return false;
    }
    if (!failures.doubtful.empty()) {
        absent("forces", fmt::format("{} ({})", failures.doubtful, to_string(vertex_->rung())));
        return false;
    }
    result_.claims.forces = std::move(claim);
    return true;
}

/// A run that settles ties at first order, or chooses, calls that an equilibrium of the finite loads.
bool left_at_zero(const State& state, const Contact& contact) {
    return state.perturbation &&
           std::ranges::any_of(state.perturbation->zero, [&](const auto& left) { return left.first == contact; });
}

/// Its load is the one at which a force vanishes, not the double nearest to that, which is stored.
bool load_is_exact(const State& state) {
    return state.perturbation && state.perturbation->load_zero.i >= 0;
}

ForceSigns Prover::look_at(const std::vector<Interval>& finite, SignFailures& failures) const {
    ForceSigns signs;
    for (std::size_t l = 0; l < finite.size(); ++l) {
        const Interval& f = finite[l];
        if (!state_.contacts[l].is_unilateral()) {
            continue; // of either sign
        }
        if (subject_->zero[l] != 0) {
            ++signs.structural_zero;
        } else if (f.lower > 0) {
            ++signs.positive;
        } else if (f.upper < 0 && load_is_exact(state_) && left_at_zero(state_, state_.contacts[l])) {
            ++signs.undecided;
            failures.doubtful =
                "the run left the force at 0, at another load than the double stored; it " + in_contact(l, f);
        } else if (f.upper < 0) {
            ++signs.negative;
            failures.negative = failures.negative.empty() ? "the force " + in_contact(l, f) : failures.negative;
        } else {
            ++signs.undecided;
            failures.doubtful = failures.doubtful.empty() ? "the force " + in_contact(l, f) : failures.doubtful;
        }
    }
    return signs;
}

/// The infinitesimal forces, where the finite ones are exactly 0.
void Prover::look_at_zeros(ForcesClaim& claim, SignFailures& failures) const {
    claim.infinitesimal.clear();
    if (claim.structural_zeros.empty()) {
        return;
    }
    const std::vector<Interval> infinitesimal = vertex_->infinitesimal();
    for (const int zero : claim.structural_zeros) {
        const auto l = static_cast<std::size_t>(zero);
        const Interval& f = infinitesimal[l];
        claim.infinitesimal.push_back(f);
        if (!state_.contacts[l].is_unilateral()) {
            continue;
        }
        if (f.upper < 0 && left_at_zero(state_, state_.contacts[l])) {
            failures.doubtful = "the run left the force at 0, and the infinitesimal one " + in_contact(l, f);
        } else if (f.upper < 0 && failures.negative.empty()) {
            failures.negative = "the finite force is exactly 0 and the infinitesimal one " + in_contact(l, f);
        } else if (!(f.lower > 0) && failures.doubtful.empty()) {
            failures.doubtful = "the finite force is exactly 0 and the infinitesimal one " + in_contact(l, f);
        }
    }
}

/// By more than `room`. A pair with the same interval as the nearest one need not have the same gap.
bool another_may_be_nearer(const std::vector<Interval>& gaps, std::size_t nearest, double room) {
    for (std::size_t k = 0; k < gaps.size(); ++k) {
        if (k != nearest && gaps[k].lower < gaps[nearest].upper - room) {
            return true;
        }
    }
    return false;
}

bool Prover::prove_gaps() {
    if (const auto pair = fixed_overlap(state_.packing)) {
        refute("gaps", fixed_and_overlap(*pair));
        return false;
    }
    const OtherPairs pairs = other_pairs(centre_->packing, state_.contacts);
    if (pairs.far() || any_far(pairs.near)) {
        absent("gaps",
               fmt::format("a grain may touch an image more than {} periods away: put the grains into the cell, or "
                           "take a basis of short periods",
                           farthest_image));
        return false;
    }
    const ArcBodies arcs(centre_->packing);
    std::string doubtful;
    do {
        if (const auto joint = beyond_sectors(arcs, state_.contacts, vertex_->distance())) {
            doubtful = *joint;
            continue;
        }
        // Pairs that are not listed: their gap changes by at most so much times the distance to the true vertex.
        const double weight = far_weight(centre_->packing, pairs.reach);
        // precision.md B1 (last operations)
        GapsClaim claim{(pairs.reach - weight * vertex_->distance()) * (1 - 0x1p-50), Contact(), vertex_->rung()};
        claim.smallest = arcs.below(claim.smallest);
        std::vector<Interval> gaps;
        std::size_t nearest = 0; // place in these
        doubtful.clear();
        for (const Contact& pair : pairs.near) {
            Interval h = vertex_->gap(pair);
            h = {arcs.below(h.lower), -arcs.below(-h.upper)}; // beside a joint the other arc may be farther out
            gaps.push_back(h);
            if (h.upper < 0) {
                refute("gaps", fmt::format("{} overlap: the gap is in {}", named(pair), shown(h)));
                return false;
            }
            if (!(h.lower > 0) && doubtful.empty()) {
                doubtful = fmt::format("the gap of {} is in {}", named(pair), shown(h));
            }
            claim.smallest = std::min(claim.smallest, h.lower);
            if (gaps.size() == 1 || h.upper < gaps[nearest].upper) {
                nearest = gaps.size() - 1;
                claim.where = pair;
            }
        }
        // checker.md K9, half of what the claim leaves open: another pair may be nearer than the one named by more
        const double room = 0x1p-47 * largest_length(state_.packing);
        if (doubtful.empty() && another_may_be_nearer(gaps, nearest, room)) {
            doubtful = "which pair comes nearest is not known";
        }
        if (doubtful.empty() && claim.smallest > 0) {
            result_.claims.gaps = claim;
            return true;
        }
    } while (climb());
    absent("gaps", fmt::format("{} ({})", doubtful.empty() ? "the vertex is not known well enough" : doubtful,
                               to_string(vertex_->rung())));
    return false;
}

/// The end is not known to a millionth of it, or of the largest stress of the load.
bool is_vague(const LoadEndClaim& end, double largest) {
    constexpr double millionth = 1e-6; // cost: a vaguer end of the interval is asked for again with more digits
    const Interval& at = end.stress;
    return !end.unbounded &&
           !(at.upper - at.lower <= millionth * std::max({std::abs(at.lower), std::abs(at.upper), largest}));
}

/// Climbs until both ends are proved, and well known where the rungs reach that. So many forces that double-double does
/// not order are as a rule copies of one another, which no digits order: the end then stays undecided.
void Prover::prove_load_interval() {
    constexpr int copies = 100; // cost: then the end of the interval is undecided
    std::optional<LoadIntervalClaim>& claim = result_.claims.load_interval;
    const double stresses = largest(state_.load.stress);
    std::string open;
    bool hopeless = false;
    do {
        const LoadEndAnswer low = vertex_->load_end(-1);
        const LoadEndAnswer high = vertex_->load_end(+1);
        if (low.claim && high.claim) {
            claim = LoadIntervalClaim{*low.claim, *high.claim, vertex_->rung()};
        }
        if (claim && !is_vague(claim->low, stresses) && !is_vague(claim->high, stresses)) {
            return;
        }
        open = fmt::format("{}{}{} ({})", low.open_question,
                           !low.open_question.empty() && !high.open_question.empty() ? "; " : "", high.open_question,
                           to_string(vertex_->rung()));
        hopeless = vertex_->rung() == Rung::double_double && low.ties + high.ties > copies;
    } while (!hopeless && climb());
    if (!claim) {
        absent("load interval", open);
    }
}

void Prover::prove_stability(bool forces, bool gaps) {
    const Load& load = state_.load;
    if (!forces || !gaps) {
        absent("stability", "it needs positive forces and no overlap");
    } else if (load.kind == LoadKind::nominal) {
        result_.claims.stable = true;
        result_.potential = "the potential of the load";
    } else if (std::ranges::any_of(load.disk_force, [](double f) { return f != 0; })) {
        absent("stability", "true stresses together with forces on disks have no potential");
    } else if (!(shortest_side() > vertex_->distance())) {
        absent("stability", "the potential of true stresses needs positive lengths");
    } else {
        result_.claims.stable = true;
        result_.potential = "sum sigma_a ln L_a, the potential of the true stresses";
    }
}

} // namespace

Certification certify(const State& state, const CertifyOptions& options, const ProvedStructure* proved) {
    require_floating_point();
    return Prover(state, options, proved).run();
}

std::vector<std::vector<Interval>> finite_forces(State state, std::span<const PerAxis<double>> stresses) {
    require_floating_point();
    return Prover(state, {}).under(state, stresses);
}

} // namespace isostat
