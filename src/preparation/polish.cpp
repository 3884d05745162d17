#include "preparation/polish.hpp"

#include "contact/candidates.hpp"
#include "contact/other_pairs.hpp"
#include "contact/words.hpp"
#include "statics/decisions.hpp"
#include "verified/configuration.hpp"
#include "verified/to_vertex.hpp"

#include <isostat/rigidity/counting.hpp>

#include <algorithm>
#include <limits>
#include <optional>

namespace isostat::preparation {

namespace {

/// The smallest gap of the other candidates at the true vertex when all are proved positive, else a failure naming one.
Result<double> check_other_gaps(const ProvedStructure& at, VertexEnclosure vertex) {
    const Packing& packing = at.packing;
    const std::vector<Contact>& contacts = at.structure.contacts();
    std::vector<Contact> others =
        without(find_candidates(packing, pivot_reach).contacts, contacts, packing.disk_count());
    double smallest = std::numeric_limits<double>::infinity();
    for (const bool extended : {false, true}) {
        if (extended) {
            vertex = enclose_vertex_double_double(at.packing, at.structure, at.factorisation, at.inverse);
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

/// The true vertex near a packing, with as many digits as the proof requires.
Result<VertexEnclosure> enclosed(const ProvedStructure& at) {
    if (at.inverse.verdict != Verdict::proved) {
        return Failure{FailureKind::undecided,
                       "no bound of the inverse of the contact matrix was proved in double precision"};
    }
    VertexEnclosure vertex = enclose_vertex(at.packing, at.structure, at.inverse);
    if (vertex.verdict != Verdict::proved) { // in large packings too many gaps are at the rounding of the coordinates
        vertex = enclose_vertex_double_double(at.packing, at.structure, at.factorisation, at.inverse);
    }
    if (vertex.verdict != Verdict::proved) {
        return failed(FailureKind::undecided,
                      "no true vertex was proved near the stored one: largest |gap| {:.3g}, smallest singular "
                      "value at least {:.3g}",
                      vertex.max_gap, at.inverse.sigma_min);
    }
    return vertex;
}

/// First an admissible packing is proved, because then the candidate list is complete (T6). The gaps of the contacts
/// are at most `max_gap` as computed, and the grid steps bound the error of computing them. Other pairs that touch at
/// the true vertex are within twice its distance here, and each of their gaps is decided later.
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

/// The smallest force that is not a structural zero; a failure when a force is not compressive.
Result<double> smallest_force(Statics& statics, double sigma) {
    const std::vector<Contact>& contacts = statics.structure().contacts();
    const Result<OpeningDecision> decision = decide_opening(statics, sigma, OpeningRule::most_negative, {}, 0);
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

Result<std::unique_ptr<ProvedStructure>> centre_at_vertex(Packing& packing, const std::vector<Contact>& contacts,
                                                          long& iterations) {
    if (auto failure = to_vertex(packing, contacts, iterations)) {
        return *failure;
    }
    snap_to_grid(packing);
    return ProvedStructure::make(packing, contacts);
}

Result<Polished> polish(Packing packing, std::vector<Contact> contacts, Load load, long& iterations) {
    std::ranges::sort(contacts);
    const auto made = centre_at_vertex(packing, contacts, iterations);
    if (!made.ok()) {
        return made.failure();
    }
    const ProvedStructure& at = *made.value();
    const auto vertex = enclosed(at);
    if (!vertex.ok()) {
        return vertex.failure();
    }
    if (auto failure = overlaps(packing, vertex.value())) {
        return *failure;
    }
    const Result<double> others = check_other_gaps(at, vertex.value());
    if (!others.ok()) {
        return others.failure();
    }
    load.refer_to(packing);
    Statics statics(packing, load, at.structure, at.factorisation, at.inverse);
    const double sigma = load.loaded_stress();
    const Result<double> force = smallest_force(statics, sigma);
    if (!force.ok()) {
        return force.failure();
    }
    Polished result;
    result.max_gap = vertex.value().max_gap;
    result.min_gap = others.value();
    result.sigma_min_bound = at.inverse.sigma_min;
    result.min_force = force.value();
    result.rattlers = static_cast<int>(untouched(packing.disk_count(), statics.carrying()).size());
    result.state.packing = std::move(packing);
    result.state.load = std::move(load);
    result.state.contacts = std::move(contacts);
    return result;
}

} // namespace isostat::preparation
