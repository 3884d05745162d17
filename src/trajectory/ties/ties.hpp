#pragma once
/// \file
/// Ties under `ties = "choose"`: the decisions of a vertex at first order in eps. Private to the room.

#include "trajectory/ties/second_order.hpp"

namespace isostat {

/// What the touching pairs outside the list do at the start of an arc.
struct Departure {
    std::vector<Contact> leaving; ///< pairs proved to separate at once
    std::vector<Contact>
        kept_touching; ///< pairs that keep touching: grains of one body (R1), or where ties are chosen a linkage (R2)
    /// Where ties are chosen: pairs whose rate and second derivative cannot be told from 0, without a count that
    /// explains this. They are assumed to keep touching; the end of the arc confirms or refutes this (C4).
    std::vector<Contact> assumed_touching;
    /// The first pair to close, when some approach: the path is then of length O(eps), and the configuration stays.
    std::optional<Contact> closes;
    /// Where ties are chosen and no pair closes: the first by name of the pairs that would overlap at second order. The
    /// list has to be exchanged before anything moves (C3).
    std::optional<BentPair> overlaps;
    std::vector<TieDecision> settled;
};
/// Failure: `undecided` when a rate cannot be told from 0, or two pairs close together to first order; where ties are
/// chosen the first of the two by name closes (C1).
Result<Departure> depart(const Vertex& from, ContactId opened, int direction);

/// The path that ends at a vertex.
struct Way {
    ContactId slot;                       ///< slot of the new contact
    bool stays;                           ///< its length is O(eps)
    const std::vector<Contact>& touching; ///< pairs that touch all along, or are assumed to
    bool overlapped;                      ///< pairs that touch at its start overlap at first order
};

/// Judges the pairs that touch at the end of a path and sets `touching` of `to`. Pairs that moved must be proved to
/// close there, not to graze. Where ties are chosen, three kinds of pairs stay watched (C1): a pair whose first-order
/// gap cannot be told from 0; a grazing pair whose second derivative is proved positive; a pair that touched all along,
/// whatever its first-order gap. Success: nothing, or the first of the pairs that closed before the new contact.
struct Arrival {
    std::optional<Contact> earlier;
    std::vector<TieDecision> settled;
};
Result<Arrival> arrive(Vertex& to, const ZeroGaps& zero, const Way& way);

/// Sets `touching` at a start. Failure, where ties are not chosen:
/// `overlap`, naming the pairs that overlap at first order.
std::optional<Failure> settle_touching(Vertex& vertex, const ZeroGaps& zero);

/// Moves the decisions made at a vertex since the last call into a record.
inline void take_log(Vertex& vertex, std::vector<TieDecision>& into) {
    if (vertex.perturbed) {
        std::vector<TieDecision>& log = vertex.perturbed->statics.log;
        into.insert(into.end(), log.begin(), log.end());
        log.clear();
    }
}

} // namespace isostat
