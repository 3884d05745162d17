#pragma once
/// \file
/// The motion between two vertices, followed in double. Its
/// results are not trusted; proofs use them as guesses.

#include "checker/solver.hpp"

#include <isostat/contact/state.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

/// One arc as its record describes it.
struct Motion {
    std::size_t opened = 0; ///< position in the contact list
    int direction = +1;     ///< -1: a held coordinate that falls
    Contact closed;         ///< the contact that closes, or the coordinate that is held at a power turn
    double held_at = 0;     ///< value of the held coordinate there
    double displacement = 0;
    // choice: step of the way that is looked at (checker.md)
    double step = 0.02; ///< longest step, in units of the smallest radius
    int doublings = 0;  ///< number of times that the step doubles, from a shorter first step
    int zooms = 0;      ///< number of times that the last step is repeated in steps a sixteenth as long
    /// Per coordinate, at given coordinates (because true stresses change
    /// with the lengths): the load whose power must stay positive.
    std::function<std::vector<double>(const std::vector<double>&)> power_load;
    std::shared_ptr<const Solver> solver; ///< factors at the start, or null
    std::vector<Contact> touching;        ///< pairs that touch at the start without being contacts
};

struct Followed {
    std::optional<std::vector<double>> end; ///< coordinates; empty: the motion was not found to end as recorded
    std::string wrong;                      ///< what seems to happen before that end, if anything
    std::shared_ptr<const Solver> solver{}; ///< factors of the contact list at the end, nearby
};

/// At each step every pair of grains that may touch is checked, and the power of the load. A pair that closes and opens
/// again within a step is missed, and a long step may land on another branch, so `wrong` refutes nothing.
Followed follow(const State& from, const Motion& motion);

} // namespace isostat::checker
