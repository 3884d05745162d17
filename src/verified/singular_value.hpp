#pragma once
// The first and the last step of V1, around a factorisation of fl(H): private to the room.

#include "core/roundoff.hpp"
#include "sparse/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace isostat {

/// Factors of degrees of freedom, powers of two at most 1. They are needed because a wall has so many contacts that the
/// rounding of its row would exceed the small singular values of the other rows.
inline std::vector<double> row_scales(const sparse::Matrix<double>& h) {
    // cost: rows that are scaled (bounds.md V1)
    constexpr double many = 16; // sum of squares of unit normals: more contacts than most disks have
    std::vector<double> scale(static_cast<std::size_t>(h.rows), 0.0);
    for (std::size_t e = 0; e < h.row.size(); ++e) {
        scale[static_cast<std::size_t>(h.row[e])] += h.value[e] * h.value[e];
    }
    for (double& c : scale) {
        c = c > many ? std::ldexp(1.0, -static_cast<int>(std::ceil(0.5 * std::log2(c)))) : 1.0; // exact: a half
    }
    return scale;
}

/// |H - fl(H)|_2: every entry of fl(H) has the relative error of V0, |.|_2 <= sqrt(|.|_1 |.|_inf).
inline double rounding_of_entries(const sparse::Matrix<double>& h, int dimension) {
    using roundoff::u;
    std::vector<double> row_sum(static_cast<std::size_t>(h.rows), 0.0);
    double column_norm = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(h.cols); ++j) {
        double sum = 0;
        for (int e = h.start[j]; e < h.start[j + 1]; ++e) {
            const double a = std::abs(h.value[static_cast<std::size_t>(e)]);
            sum += a;
            row_sum[static_cast<std::size_t>(h.row[static_cast<std::size_t>(e)])] += a;
        }
        column_norm = std::max(column_norm, sum);
    }
    const double row_norm = *std::max_element(row_sum.begin(), row_sum.end());
    return roundoff::entry_units(dimension) * u * std::sqrt(column_norm * row_norm);
}

/// Lower bound of sigma_min(H) from one of sigma_min(fl(H))^2 and |H - fl(H)|_2; if not positive, no bound.
inline double smallest_singular_value(double square, double entry_error) {
    using roundoff::u;
    return square > 0 ? std::sqrt(square) * (1 - 4 * u) - entry_error : 0; // bounds.md V1 (last operations)
}

} // namespace isostat
