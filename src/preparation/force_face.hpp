#pragma once
/// \file
/// The forces that a hyperstatic vertex admits; no one of them is distinguished.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

#include <vector>

namespace isostat {

/// Forces f >= 0 on all touching pairs that balance the load: a face of dimension at most h, the number of `touching`
/// (proofs/degenerate.md). Dry grains without friction determine no point of this face. Units of force of the load.
struct ForceFace {
    std::vector<Contact> pairs; ///< the contacts of the list, then the others that touch
    /// One per `touching` pair: force 1 in that pair, and the resulting changes of the other forces.
    std::vector<std::vector<double>> self_stresses;
    std::vector<double> least; ///< smallest force of each pair on the face
    std::vector<double> most;  ///< largest force of each pair
};

/// \pre `contacts` are regular and, like `touching`, closed; every pair is in one list only, once. Linear programmes
/// (Clp) and solves in double at the stored coordinates: computed, not proved, accurate to some 1e-7 of the largest
/// force. Failure: `undecided` when Clp finds no forces >= 0, or no end of one (an end exists in the box without fixed
/// grains), `not_isostatic` when the contacts are not proved
/// regular. Cost: two programmes per force that is not unique,
/// each from the basis of the previous one.
Result<ForceFace> force_face(const Packing& packing, const Load& load, const std::vector<Contact>& contacts,
                             const std::vector<Contact>& touching);

} // namespace isostat
