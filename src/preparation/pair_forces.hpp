#pragma once
/// \file
/// The arithmetic of soft contacts on contiguous arrays, written for vector units.

#include <cstddef>

namespace isostat::preparation {

/// A contiguous part of the pair list.
struct PairStretch {
    std::size_t count = 0;
    const int* first = nullptr;    ///< grain i of each pair
    const int* second = nullptr;   ///< grain j
    const double* range = nullptr; ///< R_i + R_j
};

/// For each pair: overlap f = max(0, R_i + R_j - |d|) with d = x_j - x_i (0 also for d = 0), push = f d / |d|, and its
/// share of the virials, push_a d_a / length_a. `push` and `virial` hold one number per pair and axis, `q` one per
/// grain and axis. Every pair is computed, in contact or not: there is no branch, and every instruction set gives the
/// same bits, because each lane does the same roundings as scalar code.
void pair_forces(int dimension, const PairStretch& pairs, const double* q, const double* length, double* overlap,
                 double* push, double* virial);

} // namespace isostat::preparation
