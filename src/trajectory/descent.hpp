#pragma once
// The decrease of the potential from one true vertex to the next (statements T10, S5, proofs/stability.md).

#include "trajectory/vertex.hpp"

#include <qd/dd_real.h>

#include <limits>

namespace isostat {

/// Dead loads have a potential, and so have true stresses without forces on disks, and loads that move only rattlers.
bool has_potential(const Load& load, bool infinitesimal);

/// Of dead loads W(from) - W(to), W = -F.q; of true stresses Phi(from) - Phi(to), Phi = sum sigma_a ln L_a over the
/// movable walls; when `infinitesimal` (only rattlers moved) -g.q in place of W, whatever the finite load. `value` is
/// the decrease between the two true vertices, to within `radius`. While the sign is open, the computation climbs to
/// double-double, then to MPFR with 256 to 4096 bits; it also climbs to double-double when `radius` would be above
/// `wanted`. \pre `has_potential`, and both enclosures proved. Cost: O(n); in double-double two solves at each end, in
/// MPFR one solve for about every 30 bits.
Enclosure potential_decrease(const Vertex& from, const Vertex& to, const Load& load, bool infinitesimal,
                             double wanted = std::numeric_limits<double>::infinity());

/// The work of dead loads between the two true vertices, whichever grains moved. Cost: O(n).
Enclosure work_between(const Vertex& from, const Vertex& to, const Load& load);

/// The exact stress of the wall times `length`, up to two roundings of double-double.
inline dd_real stress_times(const WallForce& wall, double length) {
    return wall.rest[0] == 0 ? dd_real::mul(wall.stress, length) : dd_real::add(wall.stress, wall.rest[0]) * length;
}

/// F(from) . (to - from) for records, in double and without a bound: for
/// dead loads the decrease of W. `size`: the sum of |F_k q_k|, q = to.
struct WorkOfArc {
    double value = 0;
    double size = 0;
};
WorkOfArc work_of(const Load& load, const Packing& from, const Packing& to);

} // namespace isostat
