#pragma once
// The only maker of `RegularityProof`: private to the room, so that each call site is next to its argument.

#include "rigidity/isostatic.hpp"

namespace isostat {

struct RegularityProver {
    /// \pre sigma_min > 0 was proved to be a lower bound of the smallest singular value of the exact matrix.
    static RegularityProof proof(const sparse::Matrix<double>& matrix, double sigma_min) {
        return RegularityProof(matrix, sigma_min);
    }
};

} // namespace isostat
