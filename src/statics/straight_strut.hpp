#pragma once
// Contacts that carry the same force at a power turn because the disks between them stand in a straight line
// (statement S4, proofs/stability.md).

#include <isostat/statics/statics.hpp>

#include <span>
#include <vector>

namespace isostat {

/// A contact whose force equals that of another one at the turn, whatever the other forces are.
struct StrutMate {
    ContactId contact;
    Enclosure excess; ///< of its force over that of the other one, per unit of the infinitesimal loads
};

/// The contacts of the strut to which `of` belongs: those that, together with it, cut a group of free disks without
/// finite load off everything else. `zero_holds`: the coordinate held at the turn, whose multiplier is 0 there (or
/// several); other held coordinates hold their disks. Empty when there is no such contact. Uses the graph of the
/// contacts only, but for `excess` (S4 (b)), whose radius counts how far the stored strut is from straight. Cost: two
/// depth-first searches, O(N).
template <int Dim>
std::vector<StrutMate> strut_mates(const Statics<Dim>& statics, ContactId of, std::span<const ContactId> zero_holds);

extern template std::vector<StrutMate> strut_mates<2>(const Statics<2>&, ContactId, std::span<const ContactId>);

} // namespace isostat
