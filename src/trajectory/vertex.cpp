#include "trajectory/vertex.hpp"

#include <isostat/contact/contact_set.hpp>
#include <isostat/motion/arc.hpp>
#include <isostat/verified/inverse_bound_multiprecision.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

template <int Dim>
Vertex<Dim>::Vertex(Packing<Dim> p, IsostaticStructure<Dim> s, const Load<Dim>& load, InverseBoundCache& cache)
    : packing(std::move(p)), structure(std::move(s)), factorisation(structure),
      inverse(bound_inverse(structure, factorisation, cache)), enclosure(enclose_vertex(packing, structure, inverse)),
      statics(packing, load, structure, factorisation, inverse, {}, &enclosure) {}

template <int Dim>
Result<std::unique_ptr<Vertex<Dim>>> Vertex<Dim>::make(Packing<Dim> packing, std::vector<Contact> contacts,
                                                       const Load<Dim>& load, InverseBoundCache& cache) {
    auto structure = IsostaticStructure<Dim>::prove(packing, std::move(contacts));
    if (!structure.ok()) {
        return structure.failure();
    }
    std::unique_ptr<Vertex> vertex(new Vertex(std::move(packing), std::move(structure.value()), load, cache));
    if (vertex->inverse.verdict != Verdict::proved) { // small structures: with as many bits as it takes
        vertex->inverse = bound_inverse_multiprecision(vertex->packing, vertex->structure);
        vertex->enclosure = enclose_vertex(vertex->packing, vertex->structure, vertex->inverse);
    }
    if (vertex->inverse.verdict != Verdict::proved) {
        return Failure{FailureKind::undecided, "no bound of the inverse of the contact matrix was proved: no sign "
                                               "of a force can be decided"};
    }
    if (vertex->enclosure.verdict != Verdict::proved) {
        vertex->enclosure =
            enclose_vertex_double_double(vertex->packing, vertex->structure, vertex->factorisation, vertex->inverse);
    }
    if (vertex->enclosure.verdict != Verdict::proved) {
        return Failure{
            FailureKind::undecided,
            fmt::format(
                "no true configuration with exactly these contacts was proved to exist near the stored one: largest "
                "|gap| of a contact {:.3g}, smallest singular value at least {:.3g}",
                vertex->enclosure.max_gap, vertex->inverse.sigma_min)};
    }
    return vertex;
}

template <int Dim> Result<typename Vertex<Dim>::Gaps> Vertex<Dim>::check_gaps(CandidateList<Dim>& candidates) {
    if (!candidates.covers(packing, 1.001 * enclosure.distance())) {
        candidates = find_candidates(packing, candidate_fraction);
    }
    const ContactSet kept(structure.contacts(), packing.disk_count());
    Gaps gaps;
    gaps.smallest = std::numeric_limits<double>::infinity();
    gaps.margin = std::numeric_limits<double>::infinity();
    std::vector<Contact> doubtful;
    const auto look = [&](const Contact& contact) {
        const Enclosure h = gap_at_vertex(packing, enclosure, contact);
        if (h.negative()) {
            gaps.negative = contact;
        } else if (!h.positive()) {
            doubtful.push_back(contact);
            return;
        }
        gaps.margin = std::min(gaps.margin, h.margin());
        if (h.value < gaps.smallest) {
            gaps.smallest = h.value;
            gaps.where = contact;
        }
    };
    for (const Contact& contact : candidates.contacts) {
        if (!kept.contains(contact)) {
            look(contact);
        }
    }
    if (!doubtful.empty()) {
        enclosure = enclose_vertex_double_double(packing, structure, factorisation, inverse);
        gaps.rung = Rung::double_double;
        const std::vector<Contact> again = std::move(doubtful);
        doubtful.clear();
        for (const Contact& contact : again) {
            look(contact);
        }
    }
    std::string names;
    for (const Contact& contact : doubtful) { // with as many bits as the ladder has
        const Order order = gap_sign_at_vertex(packing, structure, factorisation, inverse, contact);
        if (order.decided && order.sign != 0) {
            gaps.rung = std::max(gaps.rung, order.rung);
            gaps.margin = std::min(gaps.margin, order.margin);
            const double h = gap_at_vertex(packing, enclosure, contact).value;
            if (order.sign < 0) {
                gaps.negative = contact;
            } else if (h < gaps.smallest) {
                gaps.smallest = std::max(h, 0.0);
                gaps.where = contact;
            }
            continue;
        }
        names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", to_string<Dim>(contact),
                             order.decided ? std::string("exactly 0") : fmt::format("0 to {} bits", order.bits));
    }
    if (!names.empty()) {
        return Failure{FailureKind::tie, "gaps that are zero beside those of the contacts kept: " + names};
    }
    return gaps;
}

template class Vertex<2>;

} // namespace isostat
