#pragma once
/// \file
/// An arc as its record describes it, followed in double: a guess for proofs.

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

/// The start of an arc. `solver`: factors there.
struct ArcStart {
    const State& state;
    std::shared_ptr<const Solver> solver;
    std::vector<Contact> touching{}; ///< pairs that touch there without being contacts
};

/// Whether an entry says that the list was exchanged
/// before a contact opened (C3, C5, proofs/degenerate.md).
bool exchanges_list(const TieRecord& tie);
/// The list with which the contact opens; nothing: the record names an exchange that is impossible.
std::optional<std::vector<Contact>> list_that_opens(const State& state, const EventRecord& event);
/// The list from which these arcs, with their exchanges, lead to `list`; nothing: no list does.
std::optional<std::vector<Contact>> list_before(std::vector<Contact> list, const std::vector<const EventRecord*>& arcs,
                                                const Packing& packing);

/// The beginning of an arc according to its record, computed in double; nothing: something is unusual.
std::optional<Opening> opening_of(const ArcStart& from, const EventRecord& event);

/// Follows an arc from the opening to the end that the record names; if this is not found, again with steps a sixteenth
/// as long, then with a sixteenth of these. `slowly`: only with the last, and shorter ones near the end. \pre
/// `event.closed` names a contact of the packing.
Followed follow(const ArcStart& from, const EventRecord& event, const Opening& opening, bool slowly = false);

} // namespace isostat::checker
