#include "preparation/pair_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

// This file is compiled without errno, traps and changes of the rounding mode (src/CMakeLists.txt): no value depends on
// them, and each keeps compilers from using vector units for square roots or selections.
// Not under ThreadSanitizer: resolvers of clones run before it is ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define ISOSTAT_FOR_EACH_UNIT [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define ISOSTAT_FOR_EACH_UNIT
#endif

namespace isostat::preparation {

namespace {

constexpr std::size_t block = 256;

} // namespace

ISOSTAT_FOR_EACH_UNIT
void pair_forces(const PairStretch& pairs, const double* q, const double* length, double* overlap, double* push,
                 double* virial) {
    std::array<double, block> dx;
    std::array<double, block> dy;
    std::array<double, block> square;
    std::array<double, block> distance;
    std::array<double, block> depth;
    std::array<double, block> scale;
    const double lx = length[0];
    const double ly = length[1];
    for (std::size_t from = 0; from < pairs.count; from += block) {
        const std::size_t count = std::min(block, pairs.count - from);
        const int* const first = pairs.first + from;
        const int* const second = pairs.second + from;
        const double* const range = pairs.range + from;
        double* const f = overlap + from;
        double* const p = push + 2 * from;
        double* const v = virial + 2 * from;
        for (std::size_t k = 0; k < count; ++k) {
            const double* const a = q + 2 * static_cast<std::size_t>(first[k]);
            const double* const b = q + 2 * static_cast<std::size_t>(second[k]);
            dx[k] = b[0] - a[0];
            dy[k] = b[1] - a[1];
        }
        // Loops that are short enough for the compiler to keep free of branches.
        for (std::size_t k = 0; k < count; ++k) {
            square[k] = dx[k] * dx[k] + dy[k] * dy[k];
            distance[k] = std::sqrt(square[k]);
        }
        for (std::size_t k = 0; k < count; ++k) {
            depth[k] = range[k] - distance[k];
            scale[k] = depth[k] / distance[k];
        }
        for (std::size_t k = 0; k < count; ++k) {
            // Without a branch. NOLINTNEXTLINE(clang-diagnostic-bitwise-instead-of-logical)
            const bool touching = (square[k] < range[k] * range[k]) & (square[k] > 0);
            f[k] = touching ? depth[k] : 0.0;
            scale[k] = touching ? scale[k] : 0.0;
        }
        for (std::size_t k = 0; k < count; ++k) {
            const double px = scale[k] * dx[k];
            const double py = scale[k] * dy[k];
            p[2 * k] = px;
            p[2 * k + 1] = py;
            v[2 * k] = px * dx[k] / lx;
            v[2 * k + 1] = py * dy[k] / ly;
        }
    }
}

} // namespace isostat::preparation
