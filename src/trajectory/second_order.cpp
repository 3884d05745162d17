#include "trajectory/second_order.hpp"

#include "contact/words.hpp"
#include "statics/rule_key.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

struct Sharer {
    ContactId contact;
    Enclosure share;
    Enclosure force;
    [[nodiscard]] Enclosure bears() const { return quotient(force, share); }
};

/// With rattlers that move the infinitesimal loads decide, and the finite ones only among contacts that bear these.
template <int Dim>
std::vector<Sharer> sharers(const Vertex<Dim>& from, const Opening& opening, const Contact& pair, double stress) {
    constexpr double seen = 1e-8; // a share that is not: another contact gives way
    const std::vector<double> shares = from.perturbed->first.shares(pair);
    std::vector<Sharer> all;
    bool rattles = false;
    for (std::size_t l = 0; l < shares.size(); ++l) {
        const ContactId id(l);
        if (id == opening.contact || shares[l] < seen || from.structure.contacts()[l].kind == ContactKind::held) {
            continue;
        }
        const Enclosure share = from.perturbed->first.rate(id, +1, pair);
        if (share.positive()) {
            const bool idle = opening.infinitesimal && from.statics.is_structural_zero(id);
            all.push_back({id, share, idle ? from.statics.infinitesimal(id) : from.statics.force(id, stress)});
            rattles = rattles || idle;
        }
    }
    if (rattles) {
        std::erase_if(all, [&](const Sharer& s) { return !from.statics.is_structural_zero(s.contact); });
    }
    const auto pulled = [](const Sharer& s) { return s.force.negative(); };
    if (!std::all_of(all.begin(), all.end(), pulled)) {
        std::erase_if(all, pulled);
    }
    return all;
}

} // namespace

template <int Dim>
Result<ListExchange> give_way(const Vertex<Dim>& from, const Opening& opening, const BentPair& bent, double stress) {
    const std::vector<Sharer> all = sharers(from, opening, bent.pair, stress);
    const auto& contacts = from.structure.contacts();
    if (all.empty()) {
        return failed(FailureKind::undecided,
                      "{} touch without being a contact, and would overlap when {} opens, at second order; no contact "
                      "is proved to give way",
                      named<Dim>(bent.pair), named<Dim>(contacts[opening.contact.index()]));
    }
    const auto unbeaten = [&](const Sharer& a) {
        return std::none_of(all.begin(), all.end(),
                            [&](const Sharer& b) { return (a.bears() - b.bears()).positive(); });
    };
    std::vector<Sharer> least;
    std::copy_if(all.begin(), all.end(), std::back_inserter(least), unbeaten);
    const auto first = std::min_element(least.begin(), least.end(), [&](const Sharer& a, const Sharer& b) {
        return contacts[a.contact.index()] < contacts[b.contact.index()];
    });
    const double zero = std::abs(bent.rate.value) + bent.rate.radius;
    TieDecision decision{"second order", bent.pair,       bent.bend, contacts[first->contact.index()],
                         first->share,   std::log2(zero), 0};
    decision.choice = least.size() > 1 ? TieChoice::names : TieChoice::none;
    return ListExchange{first->contact, bent.pair, std::move(decision)};
}

template Result<ListExchange> give_way<2>(const Vertex<2>&, const Opening&, const BentPair&, double);

} // namespace isostat
