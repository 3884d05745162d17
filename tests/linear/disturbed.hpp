#pragma once
// Matrices that are a little off, as those of an earlier vertex.

#include "sparse/pattern.hpp"

#include <cmath>

/// Entries off by the relative `size`, up and down.
inline isostat::sparse::Matrix<double> disturbed(isostat::sparse::Matrix<double> matrix, double size) {
    for (std::size_t e = 0; e < matrix.value.size(); ++e) {
        matrix.value[e] *= 1 + size * std::sin(static_cast<double>(e));
    }
    return matrix;
}
