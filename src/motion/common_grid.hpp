#pragma once
// One grid for a whole arc in a cell: private to the room (statement C11, proofs/cells.md).

#include <isostat/packing/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace isostat {

/// Whether separations of up to 3 periods are exact at multiples of `step`: no intermediate sum has more than 2^53 such
/// multiples. \pre there are periodic axes
inline bool fits_grid(const Packing& packing, double step) {
    double farthest = 0;
    for (std::size_t k = 0; k < packing.length_at(0); ++k) {
        farthest = std::max(farthest, std::abs(packing.q[k]));
    }
    double period = 0; // largest row sum of |A|
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        double row = 0;
        for (std::size_t b = a; b < packing.axes(); ++b) {
            row += std::abs(packing.lattice(a, b));
        }
        period = std::max(period, row);
    }
    // 3: cells.md C11 (three periods); 0x1p53: cells.md C11 (exact separations)
    return 2 * farthest + 3 * period <= 0x1p53 * step;
}

/// Rounds the coordinates that move to the grid of another configuration, so that the others stay; false: this
/// configuration is too large for that grid. \pre there are periodic axes
inline bool put_on_grid_of(const Packing& other, const DofMap& dofs, Packing& packing) {
    const double step = grid_step(other);
    for (int mu = 0; mu < dofs.dof_count(); ++mu) {
        double& x = packing.q[static_cast<std::size_t>(dofs.coordinate_of(mu))];
        x = std::nearbyint(x / step) * step;
    }
    return fits_grid(packing, step);
}

} // namespace isostat
