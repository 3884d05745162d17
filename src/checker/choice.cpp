#include "checker/choice.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace isostat::checker {

namespace {

/// One of the members is proved to come before all others.
bool loads_order(const std::vector<std::size_t>& members, const ChoiceRule& rule) {
    return std::any_of(members.begin(), members.end(), [&](std::size_t a) {
        return std::all_of(members.begin(), members.end(),
                           [&](std::size_t b) { return a == b || rule.load(a).upper < rule.load(b).lower; });
    });
}

Objections check_member(const Place& place, const TieRecord& tie, std::size_t chosen, std::size_t other,
                        const ChoiceRule& rule) {
    const Evidence& e = *place.evidence;
    const std::string pair = fmt::format("{} and {}", e.name(chosen), e.name(other));
    if (!rule.tied(other)) {
        return Objection{true, fmt::format("a choice between {}, which are told apart", pair)};
    }
    if (tie.choice == "names") {
        const auto& contacts = place.state->contacts;
        return contacts[chosen] < contacts[other]
                   ? Objections()
                   : Objection{true,
                               fmt::format("{} is chosen by name, but {} comes first", e.name(chosen), e.name(other))};
    }
    const Range mine = rule.load(chosen);
    const Range its = rule.load(other);
    if (tie.choice != "infinitesimal loads" || its.upper < mine.lower) {
        return Objection{true, fmt::format("{} is chosen by '{}', but the infinitesimal loads take {}", e.name(chosen),
                                           tie.choice, e.name(other))};
    }
    return mine.upper < its.lower
               ? Objections()
               : Objection{false, fmt::format("the infinitesimal loads are not seen to order {}", pair)};
}

} // namespace

const TieRecord* recorded_choice(const std::vector<TieRecord>& ties, const std::string& what, const std::string& chosen,
                                 const std::string& against) {
    const auto tie = std::find_if(ties.begin(), ties.end(), [&](const TieRecord& t) {
        return !t.choice.empty() && t.what == what && t.contact == chosen && t.against == against;
    });
    return tie == ties.end() ? nullptr : &*tie;
}

Objections check_choice(const Place& place, const std::vector<TieRecord>& ties, std::size_t chosen,
                        const ChoiceRule& rule) {
    if (ties.empty()) {
        return {};
    }
    const Evidence& e = *place.evidence;
    std::vector<std::size_t> members{chosen};
    bool by_name = false;
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        const TieRecord* tie = l == chosen ? nullptr : recorded_choice(ties, rule.what, e.name(chosen), e.name(l));
        if (tie == nullptr) {
            continue;
        }
        if (Objections wrong = check_member(place, *tie, chosen, l, rule)) {
            return wrong;
        }
        members.push_back(l);
        by_name = by_name || tie->choice == "names";
    }
    if (by_name && loads_order(members, rule)) {
        return Objection{true, fmt::format("{} is chosen by name, but the infinitesimal loads tell which comes first",
                                           e.name(chosen))};
    }
    return {};
}

} // namespace isostat::checker
