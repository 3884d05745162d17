#include "exact/field.hpp"

#include <bit>
#include <cassert>
#include <cmath>

namespace isostat::exact {

namespace {

/// x 2^k for x < 2^61, 0 <= k <= 61.
std::uint64_t rotate(std::uint64_t x, int k) {
    return ((x << k) & mersenne61) | (x >> (61 - k));
}

} // namespace

std::uint64_t multiply(std::uint64_t a, std::uint64_t b) {
    return canonical(fold_wide(static_cast<Wide>(a) * b));
}

std::uint64_t subtract(std::uint64_t a, std::uint64_t b) {
    return a >= b ? a - b : a + mersenne61 - b;
}

std::uint64_t inverse(std::uint64_t a) {
    assert(a != 0 && a < mersenne61);
    // Binary extended Euclid without reductions (Kaliski's almost inverse): a r = -e u 2^k and a s = e v 2^k mod p with
    // e = +-1, u s + v r = p, so that nothing overflows. At u = v = 1 only 2^k is left to divide by, a rotation. No
    // unpredictable branch.
    std::uint64_t u = mersenne61;
    int k = std::countr_zero(a);
    std::uint64_t v = a >> k;
    std::uint64_t r = 0;
    std::uint64_t s = 1;
    std::uint64_t negative = 0;
    for (std::uint64_t d = u - v; d != 0; d = u - v) {
        const std::uint64_t swap = u > v ? ~std::uint64_t{0} : 0; // then v is kept, the difference replaces u
        const int zeros = std::countr_zero(d);
        const std::uint64_t sum = r + s;
        r = (r ^ ((r ^ s) & swap)) << zeros;
        s = sum;
        u = v + (d & ~swap);
        v = ((d ^ ~swap) - ~swap) >> zeros;
        negative ^= swap;
        k += zeros;
    }
    const std::uint64_t x = rotate(s, 61 - k % 61);
    return negative != 0 ? mersenne61 - x : x;
}

std::uint64_t residue(double value) {
    assert(std::isfinite(value));
    if (value == 0) {
        return 0;
    }
    int exponent = 0;
    const double mantissa = std::frexp(std::abs(value), &exponent);
    const auto integer = static_cast<std::uint64_t>(std::ldexp(mantissa, 53)); // exact: 53 bits, also for denormals
    const std::uint64_t r = rotate(integer, ((exponent - 53) % 61 + 61) % 61); // 2^61 = 1: powers of two rotate
    return value < 0 ? mersenne61 - r : r;
}

} // namespace isostat::exact
