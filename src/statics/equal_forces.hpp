#pragma once
// Contacts that carry the same force: two walls in an edge of a box (statement S6, proofs/stability.md), two members of
// one body that lie level (S7), and the contacts of a strut whose disks are in a straight line at a power turn (S4).

#include "statics/decisions.hpp"
#include "statics/statics.hpp"

#include <memory>
#include <vector>

namespace isostat {

/// A contact whose force equals that of another one by counting, whatever the other forces are.
struct EqualForce {
    ContactId contact;
    Enclosure excess; ///< its force minus the other one, per unit of the infinitesimal loads
};

/// Contacts whose forces are that of `of` at the true vertex, for every load. In space the wall of another axis at the
/// same sphere (S6), for all radii, at most two. In the plane the contact of one grain with the other member of a dimer
/// of equal ones that lies level at a wall (S7). Empty when the force of `of` is a structural zero. Cost: O(N).
[[nodiscard]] std::vector<EqualForce> equal_by_place(const Statics& statics, ContactId of);

/// A vertex where coordinates are held without a finite force. Uses the graph of the contacts and their normals; the
/// only forces used are the infinitesimal ones of `zero.others`. Cost: two depth-first searches, O(N), and as much
/// again for each call of `mates`.
class Turn {
  public:
    /// `statics` must outlive it.
    Turn(const Statics& statics, ZeroHolds zero);
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    ~Turn();

    /// At the exact turn the force of the contact is 0: it alone joins some disks without load to the rest, or it is
    /// one of just two contacts, not in one line, that hold such a disk when contacts of this kind are left out (S4
    /// (c)). The computed force only shows how the turn was rounded. False proves nothing: a larger group of disks that
    /// carries nothing is not found.
    [[nodiscard]] bool carries_nothing(ContactId contact) const;

    /// The contacts of the strut to which `of` belongs: each of them, together with `of`, cuts a group of free disks
    /// without finite load off the other grains, where contacts that carry nothing do not count. Coordinates held with
    /// a force hold their disks. Empty when there is no strut. `excess` is S4 (b); its radius includes the deviation of
    /// the stored strut from a line, and is infinite when one of `zero.others` that is no structural zero holds a disk
    /// of the strut at a fresh turn.
    [[nodiscard]] std::vector<EqualForce> mates(ContactId of) const;

  private:
    struct Parts;
    const Statics& statics_;
    ZeroHolds zero_;
    std::unique_ptr<const Parts> parts_;
};

} // namespace isostat
