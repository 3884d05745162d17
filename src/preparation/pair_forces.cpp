#include "preparation/soft.hpp"

#include <isostat/core/contact.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// This file is compiled without errno, traps and changes of the rounding mode (src/CMakeLists.txt), because no value
// depends on them and each keeps compilers from using vector units for square roots or selections.
// ThreadSanitizer is excluded because resolvers of clones run before it is ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define ISOSTAT_FOR_EACH_UNIT [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define ISOSTAT_FOR_EACH_UNIT
#endif

namespace isostat::preparation {

namespace {

constexpr std::size_t block = 256;

/// The forces for a constant number of axes, so that the loops over the axes are unrolled.
template <std::size_t Axes>
[[gnu::always_inline]] inline void forces_along(const PairStretch& pairs, const double* q, const double* length,
                                                double* overlap, double* push, double* virial) {
    std::array<std::array<double, block>, Axes> d;
    std::array<double, block> square;
    std::array<double, block> distance;
    std::array<double, block> depth;
    std::array<double, block> scale;
    for (std::size_t from = 0; from < pairs.count; from += block) {
        const std::size_t count = std::min(block, pairs.count - from);
        const int* const first = pairs.first + from;
        const int* const second = pairs.second + from;
        const double* const range = pairs.range + from;
        double* const f = overlap + from;
        double* const p = push + Axes * from;
        double* const v = virial + Axes * from;
        for (std::size_t k = 0; k < count; ++k) {
            const double* const a = q + Axes * static_cast<std::size_t>(first[k]);
            const double* const b = q + Axes * static_cast<std::size_t>(second[k]);
            for (std::size_t axis = 0; axis < Axes; ++axis) {
                d[axis][k] = b[axis] - a[axis];
            }
        }
        // The loops are short enough for the compiler to keep them free of branches.
        for (std::size_t k = 0; k < count; ++k) {
            double sum = d[0][k] * d[0][k];
            for (std::size_t axis = 1; axis < Axes; ++axis) {
                sum += d[axis][k] * d[axis][k];
            }
            square[k] = sum;
            distance[k] = std::sqrt(sum);
        }
        for (std::size_t k = 0; k < count; ++k) {
            depth[k] = range[k] - distance[k];
            scale[k] = depth[k] / distance[k];
        }
        for (std::size_t k = 0; k < count; ++k) {
            // This has no branch. NOLINTNEXTLINE(clang-diagnostic-bitwise-instead-of-logical)
            const bool touching = (square[k] < range[k] * range[k]) & (square[k] > 0);
            f[k] = touching ? depth[k] : 0.0;
            scale[k] = touching ? scale[k] : 0.0;
        }
        for (std::size_t k = 0; k < count; ++k) {
            for (std::size_t axis = 0; axis < Axes; ++axis) {
                const double along = scale[k] * d[axis][k];
                p[Axes * k + axis] = along;
                v[Axes * k + axis] = along * d[axis][k] / length[axis];
            }
        }
    }
}

} // namespace

ISOSTAT_FOR_EACH_UNIT
void pair_forces(int dimension, const PairStretch& pairs, const double* q, const double* length, double* overlap,
                 double* push, double* virial) {
    if (dimension == plane) {
        forces_along<2>(pairs, q, length, overlap, push, virial);
    } else {
        forces_along<3>(pairs, q, length, overlap, push, virial);
    }
}

} // namespace isostat::preparation
