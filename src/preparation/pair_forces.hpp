#pragma once
/// \file
/// The arithmetic of soft contacts on contiguous arrays, written for vector units.

#include <cstddef>

namespace isostat::preparation {

/// A stretch of the pair list.
struct PairStretch {
    std::size_t count = 0;
    const int* first = nullptr;    ///< grain i of each pair
    const int* second = nullptr;   ///< grain j
    const double* range = nullptr; ///< R_i + R_j
};

/// For each pair: overlap f = max(0, R_i + R_j - |d|) with d = x_j - x_i (0 also for d = 0), push = f d / |d|, and its
/// share of the virials, push_a d_a / length_a. `push` and `virial` hold as many numbers per pair as there are axes,
/// `q` as many of each grain. Every pair is computed, in contact or not: no branch, and the same bits on every
/// instruction set, since each lane does the same roundings as a scalar would.
void pair_forces(int dimension, const PairStretch& pairs, const double* q, const double* length, double* overlap,
                 double* push, double* virial);

} // namespace isostat::preparation
