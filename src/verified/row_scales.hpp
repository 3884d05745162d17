#pragma once
// Scaling of a contact matrix before its smallest singular value is bounded (statement V1): private to the room.

#include "sparse/pattern.hpp"

#include <cmath>
#include <vector>

namespace isostat {

/// Factors of degrees of freedom, powers of two at most 1. They are needed because a wall has so many contacts that the
/// rounding of its row would exceed the small singular values of the other rows.
inline std::vector<double> row_scales(const sparse::Matrix<double>& h) {
    constexpr double many = 16; // sum of squares of unit normals: more contacts than most disks have
    std::vector<double> scale(static_cast<std::size_t>(h.rows), 0.0);
    for (std::size_t e = 0; e < h.row.size(); ++e) {
        scale[static_cast<std::size_t>(h.row[e])] += h.value[e] * h.value[e];
    }
    for (double& c : scale) {
        c = c > many ? std::ldexp(1.0, -static_cast<int>(std::ceil(0.5 * std::log2(c)))) : 1.0;
    }
    return scale;
}

} // namespace isostat
