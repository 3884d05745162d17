#pragma once
// Segments of a run.

#include <isostat/trajectory/trajectory.hpp>

#include <cstdlib>

/// So many equilibria up, or down where `equilibria` is negative.
inline isostat::Segment towards(int equilibria) {
    isostat::Segment segment;
    segment.direction = equilibria < 0 ? -1 : 1;
    segment.equilibria = std::abs(equilibria);
    return segment;
}

/// Up (+1) or down (-1), until the loaded stress is reached.
inline isostat::Segment until(int direction, double stress) {
    isostat::Segment segment;
    segment.direction = direction;
    segment.to_stress = stress;
    return segment;
}
