#pragma once
/// \file
/// Exchanges of the list before a contact opens, where a touching pair would overlap at second order, and where
/// contacts would be dependent at the end of the arc (C3, C5, proofs/degenerate.md). Private to the room.

#include "trajectory/steering.hpp"
#include "trajectory/vertex.hpp"

namespace isostat {

/// A touching pair whose gap has rate 0 on the motion that opens a contact.
struct BentPair {
    Contact pair;
    Enclosure rate; ///< below 2^-tie_bits
    Enclosure bend; ///< second derivative of its gap: proved negative
};

/// The contact `enters` replaces the contact `leaves` in the list, before another contact opens.
struct ListExchange {
    ContactId leaves;
    Contact enters;
    TieDecision decision; ///< the decision that records show
};

/// The contact that leaves the list for a pair that would overlap at second order. Among the contacts whose coefficient
/// a_l in the row of the pair is proved positive, this is the one with the smallest f_l / a_l, where f_l is the force
/// that the rule compares; among quotients that cannot be told apart, the first contact by name. Contacts in tension
/// leave only where no other contact can. `opening`: what the motion opens, no held coordinate. Failure: `undecided`,
/// no coefficient is proved positive. Cost: one solve, and one per contact with a coefficient.
Result<ListExchange> give_way(const Vertex& from, const Opening& opening, const BentPair& bent, double stress);

/// Another list for an arc that was followed and whose contacts are dependent at its end, judged in double: a pair that
/// keeps touching, or is assumed to, replaces a contact that bears a self-stress there. One exchange; the rank grows by
/// 1. The first pair by name that can enter does; the contact that leaves is chosen as in `give_way`. Nothing: no pair
/// can, a held coordinate opens, or there are more than 1000 contacts. Cost: two dense factorisations, and `give_way`.
std::optional<ListExchange> list_for_the_end(const Vertex& from, const ArcProposal& arc, double stress);

} // namespace isostat
