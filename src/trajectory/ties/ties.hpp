#pragma once
/// \file
/// Ties under `ties = "choose"`: the decisions of a vertex at first order in eps. Private to the room.

#include "trajectory/ties/second_order.hpp"

namespace isostat {

/// What becomes of the pairs that touch at the start of an arc besides the contacts.
struct Departure {
    std::vector<Contact> leaving; ///< proved to separate at once
    std::vector<Contact>
        resting; ///< they keep touching: grains of one body (R1), or where ties are chosen a linkage (R2)
    /// Where ties are chosen: neither rate nor second derivative is told from 0, and no count says why. They are taken
    /// to keep touching; the end of the arc tells (C4).
    std::vector<Contact> taken_to_rest;
    /// The first pair to close, when some approach: the way is of length O(eps), the configuration stays.
    std::optional<Contact> closes;
    /// Where ties are chosen and none closes: the first by name of the pairs that would overlap at second order. Before
    /// anything moves the list is to be another (C3).
    std::optional<BentPair> overlaps;
    std::vector<TieDecision> settled;
};
/// Failure: `undecided` when a rate is not told from 0, or two pairs close at once to first order; where ties are
/// chosen the first of these by name closes (C1).
Result<Departure> depart(const Vertex& from, ContactId opened, int direction);

/// The way that ends at a vertex.
struct Way {
    ContactId slot;                      ///< of the new contact
    bool stays;                          ///< its length is O(eps)
    const std::vector<Contact>& resting; ///< pairs that touch all along, or are taken to
    bool overlapped;                     ///< pairs that touch at its start overlap at first order
};

/// Judges the pairs that touch at the end of a way: `touching` of `to` is set. Those that moved must be proved to close
/// there, not to graze. Where ties are chosen a pair whose first-order gap is not told from 0 stays watched, and so
/// does one that grazes, as far as its second derivative is proved positive, or touched all along, whatever its
/// first-order gap is (C1). Success: nothing, or the pair that closed first of those that did before the new contact.
struct Arrival {
    std::optional<Contact> earlier;
    std::vector<TieDecision> settled;
};
Result<Arrival> arrive(Vertex& to, const ZeroGaps& zero, const Way& way);

/// At a start: `touching` is set. Failure, where ties are not chosen: `overlap` naming the pairs that overlap at first
/// order.
std::optional<Failure> settle_touching(Vertex& vertex, const ZeroGaps& zero);

/// What was settled at a vertex since the last call goes into a record.
inline void take_log(Vertex& vertex, std::vector<TieDecision>& into) {
    if (vertex.perturbed) {
        std::vector<TieDecision>& log = vertex.perturbed->statics.log;
        into.insert(into.end(), log.begin(), log.end());
        log.clear();
    }
}

} // namespace isostat
