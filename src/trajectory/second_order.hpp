#pragma once
/// \file
/// Lists exchanged where a pair that touches would overlap at second order (C3, proofs/degenerate.md). Private to the
/// room.

#include "trajectory/vertex.hpp"

namespace isostat {

/// A pair that touches and whose rate vanishes on the motion that opens a contact.
struct BentPair {
    Contact pair;
    Enclosure rate; ///< below 2^-tie_bits
    Enclosure bend; ///< second derivative of its gap: proved negative
};

/// A list for another: `enters` takes the place of the contact `leaves`.
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
template <int Dim>
Result<ListExchange> give_way(const Vertex<Dim>& from, const Opening& opening, const BentPair& bent, double stress);

extern template Result<ListExchange> give_way<2>(const Vertex<2>&, const Opening&, const BentPair&, double);

} // namespace isostat
