#pragma once
/// \file
/// An arc as its record tells it, followed in double: where to look, nothing more.

#include "checker/follow.hpp"
#include "checker/run_records.hpp"

namespace isostat::checker {

/// How an arc leaves a vertex.
struct Opening {
    std::size_t contact = 0; ///< position in the contact list
    int direction = +1;      ///< -1: a held coordinate that falls
    bool rattles = false;    ///< under the infinitesimal loads
    bool operator==(const Opening&) const = default;
};

/// Where an arc starts. `solver`: factors there.
struct ArcStart {
    const State& state;
    std::shared_ptr<const Solver> solver;
    std::vector<Contact> touching{}; ///< pairs that touch there without being contacts
};

/// Before a contact opens, lists may have been exchanged where they are (C3, C5, proofs/degenerate.md): by entries of
/// this kind.
bool exchanges_list(const TieRecord& tie);
/// The list with which the contact opens; nothing: the record names what cannot be exchanged.
std::optional<std::vector<Contact>> list_that_opens(const State& state, const EventRecord& event);
/// The list from which these arcs, with their exchanges, lead to `list`; nothing: they do not.
std::optional<std::vector<Contact>> list_before(std::vector<Contact> list, const std::vector<const EventRecord*>& arcs,
                                                const Packing& packing);

/// How the record says that its arc begins, as far as doubles tell; nothing: something is unusual.
std::optional<Opening> opening_of(const ArcStart& from, const EventRecord& event);

/// From the opening to the end that the record names; where that was not found with steps a sixteenth as long, then
/// with a sixteenth of these. `slowly`: only with those, and shorter ones near the end. \pre `event.closed` names a
/// contact of the packing.
Followed follow(const ArcStart& from, const EventRecord& event, const Opening& opening, bool slowly = false);

} // namespace isostat::checker
