#pragma once
/// \file
/// The forces that a hyperstatic vertex admits: no single choice of them is the truth.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

#include <vector>

namespace isostat {

/// Forces f >= 0 on all pairs that touch which balance the load: a face of dimension at most h, the number of
/// `touching` (proofs/degenerate.md). Dry grains without friction choose none of them. Units of force of the load.
struct ForceFace {
    std::vector<Contact> pairs; ///< the contacts of the list, then the others that touch
    /// One per `touching` pair: force 1 in it, and what that changes in the others.
    std::vector<std::vector<double>> self_stresses;
    std::vector<double> least; ///< of each pair's force on the face
    std::vector<double> most;  ///< the same
};

/// \pre `contacts` are regular and, with `touching`, closed; a pair is in one of them, once.
/// Linear programmes (Clp) and solves in double at the coordinates as they are stored: computed, not proved, accurate
/// to some 1e-7 of the largest force. Failure: `undecided` when Clp finds no forces >= 0, or no end of one
/// (there is one in the box without fixed grains),
/// `not_isostatic` when the contacts are not proved regular. Cost: two programmes per force that is not unique, each
/// from the basis of the one before.
Result<ForceFace> force_face(const Packing& packing, const Load& load, const std::vector<Contact>& contacts,
                             const std::vector<Contact>& touching);

} // namespace isostat
