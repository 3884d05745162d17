#pragma once
/// \file
/// Lists exchanged before a contact opens: where a pair that touches would overlap at second order, and where contacts
/// would be dependent at the end of the arc (C3, C5, proofs/degenerate.md). Private to the room.

#include "trajectory/steering.hpp"
#include "trajectory/vertex.hpp"

namespace isostat {

/// A pair that touches and whose rate vanishes on the motion that opens a contact.
struct BentPair {
    Contact pair;
    Enclosure rate; ///< below 2^-tie_bits
    Enclosure bend; ///< second derivative of its gap: proved negative
};

/// An exchange of one contact of the list before another one opens: `enters` takes the place of `leaves`.
struct ListExchange {
    ContactId leaves;
    Contact enters;
    TieDecision decision; ///< as records tell it
};

/// The contact that gives way to a pair that would overlap at second order: of those whose share a_l of the row of the
/// pair is proved positive, the one with the smallest f_l / a_l, f_l the force that the rule looks at; of quotients
/// that are not told apart that of the first contact by name. Contacts in tension give way only where there is no
/// other. `opening`: what the motion opens, no held coordinate. Failure: `undecided`, no share is proved positive.
/// Cost: one solve, and one per contact that has a share.
Result<ListExchange> give_way(const Vertex& from, const Opening& opening, const BentPair& bent, double stress);

/// Another list for an arc that was followed and whose contacts are dependent where it ends, as far as doubles tell: a
/// pair that rests, or is taken to, takes the place of a contact that bears a self-stress there. One exchange; the rank
/// grows by 1. The first pair by name that can; what gives way to it is chosen as in `give_way`. Nothing: no pair does,
/// a held coordinate opens, or there are more than 1000 contacts. Cost: two dense factorisations, and of `give_way`.
std::optional<ListExchange> list_for_the_end(const Vertex& from, const ArcProposal& arc, double stress);

} // namespace isostat
