#include "trajectory/vertex.hpp"

#include "contact/images.hpp"
#include "contact/words.hpp"
#include "verified/inverse_bound.hpp"

#include <algorithm>
#include <limits>

namespace isostat {

Vertex::Vertex(Packing p, IsostaticStructure s, Factorisation factors, const InverseBound& bound, const Load& load,
               StaticsHints hints)
    : ProvedStructure(std::move(p), std::move(s), std::move(factors), bound),
      enclosure(enclose_vertex(packing, structure, factorisation, inverse)),
      statics(packing, load, structure, factorisation, inverse,
              {hints.ladder, &enclosure, hints.near, std::move(hints.forces)}),
      ladder(hints.ladder) {}

namespace {

/// Bounds of a vertex need exact differences (proofs/cells.md, C2), and entries of the contact matrix that are
/// multiples by a power of two.
std::optional<Failure> is_not_exact(const Packing& packing, const std::vector<Contact>& contacts) {
    const auto far =
        std::find_if(contacts.begin(), contacts.end(), [](const Contact& c) { return is_beyond(c, farthest_contact); });
    if (far != contacts.end()) {
        return failed(FailureKind::undecided,
                      "a run takes contacts with images up to {} periods away, and {} is farther: write the state with "
                      "its disks put into the cell",
                      farthest_contact, named(*far));
    }
    if (!is_on_grid(packing)) {
        return failed(FailureKind::undecided, "a part of the cell that does not move is not on the grid of the "
                                              "packing, which became coarser as the cell grew: no bound holds");
    }
    return std::nullopt;
}

} // namespace

std::optional<Failure> Vertex::lacking() {
    if (packing.cell.any()) {
        if (auto failure = is_not_exact(packing, structure.contacts())) {
            return failure;
        }
    }
    if (inverse.verdict != Verdict::proved) {
        return Failure{FailureKind::undecided, "no bound of the inverse of the contact matrix was proved: no sign "
                                               "of a force can be decided"};
    }
    if (enclosure.verdict != Verdict::proved) {
        enclosure = enclose_vertex_double_double(packing, structure, factorisation, inverse);
    }
    if (enclosure.verdict != Verdict::proved) {
        return failed(
            FailureKind::undecided,
            "no true configuration with exactly these contacts was proved to exist near the stored one: largest "
            "|gap| of a contact {:.3g}, smallest singular value at least {:.3g}",
            enclosure.max_gap, inverse.sigma_min);
    }
    return std::nullopt;
}

Result<Vertex::Beginning> Vertex::begin(Packing packing, std::vector<Contact> contacts) {
    auto rank = RankProof::begin(packing, std::move(contacts));
    if (!rank.ok()) {
        return rank.failure();
    }
    Factorisation factors(rank.value().unproved());
    return Beginning{std::move(packing), std::move(rank.value()), std::move(factors)};
}

Result<std::unique_ptr<Vertex>> Vertex::make(Packing packing, std::vector<Contact> contacts, const Load& load,
                                             InverseBoundCache& cache, LadderOptions options) {
    auto begun = begin(std::move(packing), std::move(contacts));
    if (!begun.ok()) {
        return begun.failure();
    }
    return make(std::move(begun.value()), load, cache, options);
}

Result<std::unique_ptr<Vertex>> Vertex::make(Beginning beginning, const Load& load, InverseBoundCache& cache,
                                             LadderOptions options) {
    RankProof& rank = beginning.rank;
    const InverseBound bound =
        bound_inverse(rank.unproved(), beginning.factorisation, cache, [&] { return rank.is_regular(); });
    std::unique_ptr<Vertex> vertex(new Vertex(std::move(beginning.packing), rank.unproved(),
                                              std::move(beginning.factorisation), bound, load, {options}));
    auto proved = rank.conclude();
    if (!proved.ok()) {
        return proved.failure();
    }
    vertex->structure = std::move(proved.value());
    if (vertex->inverse.verdict != Verdict::proved) { // small structures: with as many bits as needed
        vertex->inverse = bound_inverse_multiprecision(vertex->packing, vertex->structure);
        vertex->enclosure = enclose_vertex(vertex->packing, vertex->structure, vertex->factorisation, vertex->inverse);
    }
    if (auto failure = vertex->lacking()) {
        return *failure;
    }
    return vertex;
}

Result<std::unique_ptr<Vertex>> Vertex::exchanged(const Vertex& from, Exchange to, const Load& load,
                                                  InverseBoundCache& cache, LadderOptions options) {
    if (to.contacts) {
        auto made = prove(from, to, load, cache, options);
        if (!made.ok() || made.value() != nullptr) {
            return made;
        }
    }
    std::vector<Contact> contacts = from.structure.contacts();
    contacts[to.leaves.index()] = to.enters;
    options.first_accuracy = 0;
    return make(std::move(to.end), std::move(contacts), load, cache, options); // this gives the reason for a failure
}

/// Null when no bound was proved in doubles.
Result<std::unique_ptr<Vertex>> Vertex::prove(const Vertex& from, Exchange& to, const Load& load,
                                              InverseBoundCache& cache, LadderOptions options) {
    std::vector<double> mechanism(static_cast<std::size_t>(from.structure.size()), 0.0);
    for (std::size_t mu = 0; mu < mechanism.size() && !to.tangent.empty(); ++mu) {
        mechanism[mu] = to.tangent[from.structure.dofs().coordinate_of(mu)];
    }
    auto bound = carry_bound(from.structure, from.inverse, *to.contacts, *to.approximate, std::move(mechanism));
    if (!bound) {
        bound = bound_exchanged(*to.contacts, *to.approximate, cache);
    }
    if (!bound) {
        return std::unique_ptr<Vertex>();
    }
    auto structure = IsostaticStructure::exchanged(std::move(*to.contacts), bound->proof);
    Factorisation factors(structure, std::move(*to.approximate));
    std::unique_ptr<Vertex> vertex(new Vertex(std::move(to.end), std::move(structure), std::move(factors), bound->bound,
                                              load, {options, nullptr, &from.statics, std::move(to.forces)}));
    vertex->cost_before = to.cost_before;
    if (auto failure = vertex->lacking()) {
        return *failure;
    }
    return vertex;
}

namespace {

/// Null: the contact is not among the pairs.
const ZeroGaps::value_type* find(const ZeroGaps& pairs, const Contact& contact) {
    const auto pair = std::find_if(pairs.begin(), pairs.end(), [&](const auto& zero) { return zero.first == contact; });
    return pair == pairs.end() ? nullptr : &*pair;
}

/// A candidate with an image that is farther away than the grid allows (C2).
std::optional<Failure> too_far(const Packing& packing, const std::vector<Contact>& candidates) {
    const auto far = packing.cell.any() ? std::find_if(candidates.begin(), candidates.end(),
                                                       [](const Contact& c) { return is_beyond(c, farthest_image); })
                                        : candidates.end();
    if (far == candidates.end()) {
        return std::nullopt;
    }
    return failed(FailureKind::undecided,
                  "{} may touch, more than {} periods away: write the state with its disks put into the cell",
                  named(*far), farthest_image);
}

} // namespace

Result<Vertex::Gaps> Vertex::check_gaps(CandidateList& candidates, KeptCandidates& kept, const ZeroGaps* known) {
    if (!candidates.covers(packing, 1.001 * enclosure.distance())) {
        candidates = find_candidates(packing, candidate_fraction, candidates.triangulation);
    }
    if (auto far = too_far(packing, candidates.contacts)) {
        return *far;
    }
    const std::vector<unsigned char>& is_kept = kept.of(candidates.contacts, structure.contacts());
    Gaps gaps;
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
    };
    for (std::size_t k = 0; k < is_kept.size(); ++k) {
        if (is_kept[k] == 0) {
            look(candidates.contacts[k]);
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
    if (auto tie = settle_gaps(doubtful, known, gaps)) {
        return *tie;
    }
    return gaps;
}

std::optional<Failure> Vertex::settle_gaps(const std::vector<Contact>& doubtful, const ZeroGaps* known,
                                           Gaps& gaps) const {
    const auto told = [known](const Contact& contact) { // the pair is known to touch
        return known == nullptr ? nullptr : find(*known, contact);
    };
    std::vector<Contact> asked;
    std::copy_if(doubtful.begin(), doubtful.end(), std::back_inserter(asked),
                 [&](const Contact& contact) { return told(contact) == nullptr; });
    const std::vector<Order> orders = // with as many bits as the ladder has
        asked.empty() ? std::vector<Order>()
                      : gap_signs_at_vertex(packing, structure, factorisation, inverse, asked, ladder);
    Words names;
    auto answer = orders.begin();
    for (const Contact& contact : doubtful) {
        if (const auto* zero = told(contact)) {
            gaps.zero.push_back(*zero);
            continue;
        }
        const Order& order = *answer++;
        if (order.decided && order.sign != 0) {
            gaps.rung = std::max(gaps.rung, order.rung);
            gaps.margin = std::min(gaps.margin, order.margin);
            if (order.sign < 0) {
                gaps.negative = contact;
            }
            continue;
        }
        if (known != nullptr && is_tie(order, packing.min_radius())) {
            gaps.zero.emplace_back(contact, order);
            continue;
        }
        names += words("{}{} ({})", names.empty() ? "" : ", ", named(contact),
                       order.decided ? Words("exactly 0") : words("0 to {} bits", order.bits));
    }
    if (!names.empty()) {
        return failed(known != nullptr ? FailureKind::undecided : FailureKind::tie,
                      "gaps that are zero beside those of the contacts kept: {}", names);
    }
    return std::nullopt;
}

} // namespace isostat
