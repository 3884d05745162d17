#pragma once
/// \file
/// From the contacts of a linear programme to a proved vertex, or the reason why the contacts give none.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <vector>

namespace isostat::preparation {

/// Reach of candidates that are no contacts, in smallest radii; T6 allows up to 0.82.
inline constexpr double pivot_reach = 0.5;

/// The vertex and the figures of its proof.
struct Polished {
    State state;
    double max_gap = 0;   ///< largest |gap| of a contact, as computed
    double min_gap = 0;   ///< smallest gap of the other candidates at the true vertex
    double min_force = 0; ///< smallest backbone force
    double sigma_min_bound = 0;
    int rattlers = 0;
};

/// `to_vertex` from `packing`, then coordinates to the grid and the checks promised by `find_vertex`. `state.load` must
/// hold kind, stress and infinitesimal loads; its reference lengths are set to the lengths found.
/// Failures: `not_isostatic`; `not_converged` (Newton stopped early, or a named
/// force is not compressive); `overlap` (of another pair); `tie` (another gap cannot
/// be told from 0); `undecided` (a bound that would prove the rest was not found).
Result<Polished> polish(Packing packing, std::vector<Contact> contacts, Load load, long& iterations);

} // namespace isostat::preparation
