#pragma once
// Contacts that carry the same force at a power turn because the disks between them stand in a straight line
// (statement S4, proofs/stability.md).

#include "statics/decisions.hpp"
#include "statics/edge.hpp"

#include <memory>
#include <vector>

namespace isostat {

/// A vertex where coordinates are held without a finite force. Uses the graph of the contacts and their normals, no
/// forces but for the infinitesimal ones of `zero.others`. Cost: two depth-first searches, O(N), and as much again for
/// each call of `mates`.
class Turn {
  public:
    /// `statics` must outlive it.
    Turn(const Statics& statics, ZeroHolds zero);
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    ~Turn();

    /// At the turn itself the force of the contact is 0: it alone joins some disks without load to the rest, or it is
    /// one of just two, not in one line, that hold such a disk when others of these are left out (S4 (c)). What the
    /// statics say its force is tells where the turn was rounded to. False says nothing: a larger group of disks that
    /// carries nothing is not found.
    [[nodiscard]] bool carries_nothing(ContactId contact) const;

    /// The contacts of the strut to which `of` belongs: those that, together with it, cut a group of free disks without
    /// finite load off everything else, contacts that carry nothing left out. Coordinates held with a force hold their
    /// disks. Empty when there is none. `excess` is S4 (b); its radius counts how far the stored strut is from
    /// straight, and is infinite when one of `zero.others` that is no structural zero holds a disk of the strut at a
    /// fresh turn.
    [[nodiscard]] std::vector<EqualForce> mates(ContactId of) const;

  private:
    struct Parts;
    const Statics& statics_;
    ZeroHolds zero_;
    std::unique_ptr<const Parts> parts_;
};

} // namespace isostat
