#pragma once
/// \file
/// Residual of an equation of the kept curve next to a stored place, in double-double: private to the room.

#include "contact/separation.hpp"

#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>

#include <qd/dd_real.h>

#include <cmath>
#include <vector>

namespace isostat {

/// F_l at `centre` + `shift` (empty: 0) for a contact or for a held coordinate, which keeps its value in `start`; the
/// equation in units of length (A1, proofs/arcs.md). The radius bounds the error of the value.
/// \pre separations of both are exact (on their grids)
inline Enclosure shifted_equation(const Packing& start, const Packing& centre, const Contact& c,
                                  const std::vector<double>& shift) {
    constexpr double rounding = 0x1p-96; // bound for a few operations, each within 2^-98; arcs.md A8 (double-double)
    if (c.kind == ContactKind::held) {
        const auto k = static_cast<std::size_t>(c.i);
        const dd_real off = dd_real(centre.q[k]) - start.q[k] + (shift.empty() ? 0.0 : shift[k]);
        return {off.x[0], std::abs(off.x[1]) + rounding * std::abs(centre.q[k])};
    }
    const auto x = separation_over(centre.layout(), centre.q, c);
    const auto d = shift.empty() ? decltype(x){} : separation_over(centre.layout(), shift, c);
    const auto& radius = centre.radius;
    const auto i = static_cast<std::size_t>(c.i);
    if (!c.of_disks()) {
        const dd_real off = dd_real(x[0]) + d[0] - radius[i];
        return {off.x[0], std::abs(off.x[1]) + rounding * (std::abs(x[0]) + radius[i])};
    }
    const dd_real distance = c.kind == ContactKind::bar ? dd_real(centre.bar_length(c.i, c.j))
                                                        : dd_real(radius[i]) + radius[static_cast<std::size_t>(c.j)];
    dd_real square = 0.0;
    for (std::size_t a = 0; a < most_axes; ++a) {
        const dd_real component = dd_real(x[a]) + d[a];
        square += component * component;
    }
    const dd_real off = (square - distance * distance) / (2.0 * distance);
    return {off.x[0], std::abs(off.x[1]) + 8 * rounding * distance.x[0]}; // arcs.md A8 (double-double)
}

} // namespace isostat
