#pragma once
// What the potential loses from one true vertex to the next (statements T10, S5, proofs/stability.md).

#include "trajectory/vertex.hpp"

#include <limits>

namespace isostat {

/// Dead loads have one, and so have true stresses without forces on disks, and whatever moves rattlers only.
template <int Dim> bool has_potential(const Load<Dim>& load, bool infinitesimal);

/// Of dead loads W(from) - W(to), W = -F.q; of true stresses Phi(from) - Phi(to), Phi = sum sigma_a ln L_a over the
/// movable walls; when `infinitesimal` (only rattlers moved) -g.q in place of W, whatever the finite load. `value` is
/// the decrease between the two true vertices, to within `radius`. While the sign is open it climbs to
/// double-double, then to MPFR with 256 to 4096 bits; to double-double where `radius` would be above `wanted`, too.
/// \pre `has_potential`, and both enclosures proved.
/// Cost: O(n); in double-double two solves at each end, in MPFR one for every 30 bits or so.
template <int Dim>
Enclosure potential_decrease(const Vertex<Dim>& from, const Vertex<Dim>& to, const Load<Dim>& load, bool infinitesimal,
                             double wanted = std::numeric_limits<double>::infinity());

/// The work of dead loads between the two true vertices, whatever moved. Cost: O(n).
template <int Dim> Enclosure work_between(const Vertex<Dim>& from, const Vertex<Dim>& to, const Load<Dim>& load);

/// F(from) . (to - from) as records show it, in double: of dead loads the decrease of W. `size`: of the terms. No
/// bound.
struct WorkOfArc {
    double value = 0;
    double size = 0;
};
template <int Dim> WorkOfArc work_of(const Load<Dim>& load, const Packing<Dim>& from, const Packing<Dim>& to);

extern template Enclosure work_between<2>(const Vertex<2>&, const Vertex<2>&, const Load<2>&);
extern template WorkOfArc work_of<2>(const Load<2>&, const Packing<2>&, const Packing<2>&);
extern template bool has_potential<2>(const Load<2>&, bool);
extern template Enclosure potential_decrease<2>(const Vertex<2>&, const Vertex<2>&, const Load<2>&, bool, double);

} // namespace isostat
