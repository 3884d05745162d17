#pragma once
// Two walls that bear the same force in an edge of a box (statement S6, proofs/stability.md).

#include "statics/statics.hpp"

#include <vector>

namespace isostat {

/// A contact whose force equals that of another one by counting, whatever the other forces are.
struct EqualForce {
    ContactId contact;
    Enclosure excess; ///< its force minus the other one, per unit of the infinitesimal loads
};

/// The wall of another axis whose force on the same sphere is that of `of` at the true vertex, for every load and all
/// radii (S6); at most two. Empty in the plane, and when the force of `of` is a structural zero. Cost: O(N), O(1)
/// when `of` is no wall.
[[nodiscard]] std::vector<EqualForce> equal_in_edge(const Statics& statics, ContactId of);

} // namespace isostat
