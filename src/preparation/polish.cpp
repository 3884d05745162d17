#include "preparation/polish.hpp"

#include "contact/candidates.hpp"
#include "contact/words.hpp"
#include "statics/decisions.hpp"
#include "verified/configuration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace isostat::preparation {

namespace {

constexpr int max_newton = 30;

double largest_gap(const Packing& packing, const std::vector<Contact>& contacts) {
    double largest = 0;
    for (const Contact& contact : contacts) {
        largest = std::max(largest, std::abs(gap(packing, contact)));
    }
    return largest;
}

/// A cell that keeps its shape: the rest of it follows the last period, the only one that moves. `step`: that of the
/// degrees of freedom with the rest at rest. With the rest stretched by beta it is step + beta * answer, and beta is
/// the stretch of the last period.
void keep_shape(Packing& packing, const std::vector<Contact>& contacts, const Factorisation& factorisation,
                std::vector<double>& step) {
    const std::size_t first = packing.length_at(0);
    const std::size_t leads = packing.length_at(packing.axes() - 1);
    std::vector<double> answer(contacts.size(), 0.0);
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const GapGradient g = gap_gradient(packing, contacts[l]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(g.count); ++k) {
            const auto coordinate = static_cast<std::size_t>(g.coordinate[k]);
            answer[l] += coordinate >= first && coordinate != leads ? g.value[k] * packing.q[coordinate] : 0;
        }
    }
    factorisation.solve_velocities(answer);
    const double beta = step.back() / (packing.q[leads] - answer.back()); // no other coordinate of the cell moves
    for (std::size_t mu = 0; mu < step.size(); ++mu) {
        step[mu] += beta * answer[mu];
    }
    for (std::size_t k = first; k < packing.q.size(); ++k) {
        packing.q[k] *= k == leads ? 1 : 1 + beta;
    }
}

/// One step; failure when the matrix is not proved regular.
std::optional<Failure> newton_step(Packing& packing, const std::vector<Contact>& contacts) {
    const auto structure = IsostaticStructure::prove(packing, contacts);
    if (!structure.ok()) {
        return structure.failure();
    }
    const Factorisation factorisation(structure.value());
    std::vector<double> step(contacts.size());
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        step[l] = gap(packing, contacts[l]); // approach by the gap
    }
    factorisation.solve_velocities(step);
    if (packing.cell.keeps_shape) {
        keep_shape(packing, contacts, factorisation, step);
    }
    const DofMap& dofs = structure.value().dofs();
    for (std::size_t mu = 0; mu < step.size(); ++mu) {
        packing.q[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)))] += step[mu];
    }
    return std::nullopt;
}

} // namespace

std::optional<Failure> newton(Packing& packing, const std::vector<Contact>& contacts, long& iterations) {
    double before = largest_gap(packing, contacts);
    for (int k = 0; k < max_newton; ++k) {
        Packing next = packing;
        if (auto failure = newton_step(next, contacts)) {
            return failure;
        }
        ++iterations;
        const double now = largest_gap(next, contacts);
        if (!(now < before)) {
            // Rounding level when the gaps are within a few grid steps; otherwise the start was too far.
            if (before <= 64 * grid_step(packing)) {
                return std::nullopt;
            }
            return failed(FailureKind::not_converged, "Newton on the gaps stopped at {:.3g} after {} steps", before,
                          k + 1);
        }
        packing = std::move(next);
        before = now;
        if (now <= grid_step(packing)) {
            return std::nullopt;
        }
    }
    return failed(FailureKind::not_converged, "Newton on the gaps: still {:.3g} after {} steps", before, max_newton);
}

namespace {

/// Every candidate beside the contacts has a positive gap at the true vertex: proved, or named.
Result<double> check_other_gaps(const Packing& packing, const IsostaticStructure& structure,
                                const Factorisation& factorisation, const InverseBound& inverse,
                                VertexEnclosure vertex) {
    const std::vector<Contact>& contacts = structure.contacts(); // sorted by the caller
    std::vector<Contact> others;
    for (const Contact& candidate : find_candidates(packing, pivot_reach).contacts) {
        if (!std::binary_search(contacts.begin(), contacts.end(), candidate)) {
            others.push_back(candidate);
        }
    }
    double smallest = std::numeric_limits<double>::infinity();
    for (const bool extended : {false, true}) {
        if (extended) {
            vertex = enclose_vertex_double_double(packing, structure, factorisation, inverse);
        }
        std::vector<Contact> doubtful;
        for (const Contact& other : others) {
            const Enclosure h = gap_at_vertex(packing, vertex, other);
            if (h.negative()) {
                return failed(FailureKind::overlap, "{} overlap by {:.3g}", named(other), -h.value);
            }
            if (h.positive()) {
                smallest = std::min(smallest, h.value);
            } else {
                doubtful.push_back(other);
            }
        }
        others = std::move(doubtful);
        if (others.empty()) {
            return smallest;
        }
    }
    const Enclosure h = gap_at_vertex(packing, vertex, others.front());
    return failed(FailureKind::tie,
                  "{} more gaps than the {} contacts kept are 0 as far as double-double arithmetic can tell, first {} "
                  "({:.3g}, known to {:.3g})",
                  others.size(), contacts.size(), named(others.front()), h.value, h.radius);
}

int count_rattlers(const Packing& packing, const Statics& statics) {
    std::vector<unsigned char> carries(packing.radius.size(), 0);
    const std::vector<Contact>& contacts = statics.structure().contacts();
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (!statics.is_structural_zero(ContactId(l))) {
            carries[static_cast<std::size_t>(contacts[l].i)] = 1;
            if (contacts[l].kind == ContactKind::disk_disk) {
                carries[static_cast<std::size_t>(contacts[l].j)] = 1;
            }
        }
    }
    return static_cast<int>(std::count(carries.begin(), carries.end(), static_cast<unsigned char>(0)));
}

/// The true vertex near a packing, with as many digits as it takes.
Result<VertexEnclosure> enclosed(const Packing& packing, const IsostaticStructure& structure,
                                 const Factorisation& factorisation, const InverseBound& inverse) {
    VertexEnclosure vertex = enclose_vertex(packing, structure, inverse);
    if (vertex.verdict != Verdict::proved) { // large packings: gaps at the rounding of the coordinates are too many
        vertex = enclose_vertex_double_double(packing, structure, factorisation, inverse);
    }
    if (vertex.verdict != Verdict::proved) {
        return failed(FailureKind::undecided,
                      "no true vertex was proved near the stored one: largest |gap| {:.3g}, smallest singular "
                      "value at least {:.3g}",
                      vertex.max_gap, inverse.sigma_min);
    }
    return vertex;
}

/// The candidate list is complete for an admissible packing (T6): that comes first. The contacts themselves are within
/// `max_gap` of touching, as computed; the grid steps cover the error of computing it. Other pairs that touch at the
/// true vertex are within twice its distance; their gaps there are looked at one by one.
std::optional<Failure> overlaps(const Packing& packing, const VertexEnclosure& vertex) {
    const double open = std::max(vertex.max_gap, vertex.distance());
    const Admissibility admissible = certify_admissible(packing, 2 * open + 4 * grid_step(packing));
    if (admissible.verdict == Verdict::proved) {
        return std::nullopt;
    }
    const bool overlap = admissible.verdict == Verdict::refuted;
    return failed(overlap ? FailureKind::overlap : FailureKind::undecided, "{}: {} has gap {:.3g}",
                  overlap ? "overlap" : "non-overlap was not proved", named(admissible.worst), admissible.worst_gap);
}

/// The smallest force that is not a structural zero; a failure when one is not compressive.
Result<double> smallest_force(Statics& statics, double sigma) {
    const std::vector<Contact>& contacts = statics.structure().contacts();
    const Result<OpeningDecision> decision = decide_opening(statics, sigma, OpeningRule::most_negative, ContactId(), 0);
    if (!decision.ok()) {
        return decision.failure();
    }
    if (decision.value().opening) {
        const Opening& opening = *decision.value().opening;
        return failed(FailureKind::not_converged, "{}force {:.3g} in contact {} is not compressive",
                      opening.infinitesimal ? "infinitesimal " : "", opening.force.value,
                      named(contacts[opening.contact.index()]));
    }
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (!statics.is_structural_zero(ContactId(l))) {
            smallest = std::min(smallest, statics.force(ContactId(l), sigma).value);
        }
    }
    return smallest;
}

} // namespace

Result<Polished> polish(Packing packing, std::vector<Contact> contacts, Load load, long& iterations) {
    std::sort(contacts.begin(), contacts.end());
    if (auto failure = newton(packing, contacts, iterations)) {
        return *failure;
    }
    snap_to_grid(packing);
    const auto proved = IsostaticStructure::prove(packing, contacts);
    if (!proved.ok()) {
        return proved.failure();
    }
    const IsostaticStructure& structure = proved.value();
    const Factorisation factorisation(structure);
    InverseBoundCache cache;
    const InverseBound inverse = bound_inverse(structure, factorisation, cache);
    if (inverse.verdict != Verdict::proved) {
        return Failure{FailureKind::undecided,
                       "no bound of the inverse of the contact matrix was proved in double precision"};
    }
    auto vertex = enclosed(packing, structure, factorisation, inverse);
    if (!vertex.ok()) {
        return vertex.failure();
    }
    if (auto failure = overlaps(packing, vertex.value())) {
        return *failure;
    }
    const Result<double> others = check_other_gaps(packing, structure, factorisation, inverse, vertex.value());
    if (!others.ok()) {
        return others.failure();
    }
    load.refer_to(packing);
    Statics statics(packing, load, structure, factorisation, inverse);
    const double sigma = load.loaded_stress();
    const Result<double> force = smallest_force(statics, sigma);
    if (!force.ok()) {
        return force.failure();
    }
    Polished result;
    result.max_gap = vertex.value().max_gap;
    result.min_gap = others.value();
    result.sigma_min_bound = inverse.sigma_min;
    result.min_force = force.value();
    result.rattlers = count_rattlers(packing, statics);
    result.state.packing = std::move(packing);
    result.state.load = std::move(load);
    result.state.contacts = std::move(contacts);
    return result;
}

} // namespace isostat::preparation
