#include "packing/cell_wrap.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

Wrapped wrap_into_cell(Packing& packing) {
    Wrapped out;
    const std::size_t d = packing.axes();
    out.periods.resize(packing.radius.size());
    const double unit = 0x1p-51 * static_cast<double>(d - 1); // a coordinate moves up to d times, three roundings each
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        double* const x = &packing.q[d * i];
        PerAxis<double> within{}; // what is left of x when it is written in period vectors
        const auto left = [&](std::size_t a) {
            double rest = x[a];
            for (std::size_t b = a + 1; b < d; ++b) {
                const double tilt = packing.lattice(a, b);
                rest -= tilt != 0 ? within[b] * (tilt / packing.lattice(b, b)) : 0;
            }
            return rest;
        };
        for (std::size_t a = d; a-- > 0;) { // a step along a period moves the coordinates before it too
            const double periods = packing.cell.periodic[a] ? std::floor(left(a) / packing.lattice(a, a)) : 0;
            out.periods[i][a] = periods;
            for (std::size_t b = 0; b <= a && periods != 0; ++b) {
                const double before = x[b];
                x[b] -= periods * packing.lattice(b, a);
                out.rounding = std::max(out.rounding, unit * (std::abs(before) + std::abs(x[b])));
            }
            within[a] = left(a);
        }
    }
    return out;
}

} // namespace isostat
