#pragma once
/// \file
/// The motion between two vertices, followed in double: nothing that comes out of here is trusted, it only says where
/// to look.

#include "checker/solver.hpp"

#include <isostat/contact/state.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

/// One arc as a record tells it.
struct Motion {
    std::size_t opened = 0; ///< position in the contact list
    int direction = +1;     ///< -1: a held coordinate that falls
    Contact closed;         ///< the contact that closes, or the coordinate that is held at a power turn
    double held_at = 0;     ///< its value there
    double displacement = 0;
    double step = 0.02; ///< in units of the smallest radius
    int doublings = 0;  ///< of the step: the first ones are shorter
    int zooms = 0;      ///< so often the last step is made anew in steps a sixteenth as long
    /// Per coordinate, at given coordinates (true stresses change with the lengths): the load whose power must stay
    /// positive.
    std::function<std::vector<double>(const std::vector<double>&)> power_load;
    std::shared_ptr<const Solver> solver; ///< factors at the start, or nothing
    std::vector<Contact> touching;        ///< pairs that touch at the start without being contacts
};

struct Followed {
    std::optional<std::vector<double>> end; ///< coordinates; none: the motion was not found to end as it is told
    std::string wrong;                      ///< what seems to happen before that end, if something does
    std::shared_ptr<const Solver> solver{}; ///< factors of the contact list at the end, near that
};

/// At each step every pair of grains that may touch is looked at, and the power of the load. A pair that closes and
/// opens again within a step is not seen, and a long step may land on another branch: `wrong` refutes nothing.
Followed follow(const State& from, const Motion& motion);

} // namespace isostat::checker
