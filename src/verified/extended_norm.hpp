#pragma once
// The length of a vector in double-double over the whole range of double: private to the room.

#include <qd/dd_real.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace isostat {

/// Divides d by a power of two so that its largest component is in [1/2, 1), and returns the exponent (0 for 0): then
/// the exact products of libqd keep their low parts.
template <std::size_t Dim> int normalise(std::array<dd_real, Dim>& d) {
    double largest = 0;
    for (const dd_real& c : d) {
        largest = std::max(largest, std::abs(c.x[0]));
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (dd_real& c : d) {
        c = ldexp(c, -exponent);
    }
    return exponent;
}

template <std::size_t Dim> dd_real length(const std::array<dd_real, Dim>& d) {
    dd_real square = 0.0;
    for (const dd_real& c : d) {
        square += c * c;
    }
    return sqrt(square);
}

} // namespace isostat
