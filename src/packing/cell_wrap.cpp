#include "packing/cell_wrap.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

Wrapped wrap_into_cell(Packing& packing) {
    Wrapped out;
    out.periods.resize(packing.radius.size());
    const double lean = packing.cell.all() ? packing.lattice(0, 1) / packing.lattice(1, 1) : 0;
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        for (const std::size_t a : {1U, 0U}) { // a step along the second period moves x too
            if (!packing.cell.periodic[a]) {
                continue;
            }
            const double x = packing.q[2 * i + a] - (a == 0 ? packing.q[2 * i + 1] * lean : 0);
            const double periods = std::floor(x / packing.lattice(a, a));
            out.periods[i][a] = periods;
            for (std::size_t b = 0; b <= a && periods != 0; ++b) {
                double& moved = packing.q[2 * i + b];
                const double before = moved;
                moved -= periods * packing.lattice(b, a);
                out.rounding = std::max(out.rounding, 0x1p-51 * (std::abs(before) + std::abs(moved)));
            }
        }
    }
    return out;
}

} // namespace isostat
