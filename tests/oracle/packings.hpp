#pragma once
// Packings to test with: random ones full of contacts and near contacts, lattices full of ties.

#include "oracle/random.hpp"

#include <isostat/packing/packing.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat::oracle {

inline void append(Packing& packing, double x, double y, double radius) {
    packing.q.insert(packing.q.end() - 2, {x, y});
    packing.radius.push_back(radius);
}

inline Packing empty_cluster() {
    Packing packing;
    packing.walls = Walls::none();
    packing.q = {0, 0};
    return packing;
}

/// Gap of two disks in extended precision.
inline long double plain_gap(const Packing& packing, std::size_t i, std::size_t j) {
    const long double dx = static_cast<long double>(packing.q[2 * j]) - packing.q[2 * i];
    const long double dy = static_cast<long double>(packing.q[2 * j + 1]) - packing.q[2 * i + 1];
    return std::hypot(dx, dy) - packing.radius[i] - packing.radius[j];
}

/// n disks with radii in [1, ratio] (log-uniform); each is put at a distance of `spacing()` >= 0 from two earlier ones,
/// without overlap beyond rounding. Many pairs are tangent to rounding when spacing() gives 0.
template <class Spacing> Packing grown_cluster(int n, double ratio, Random& random, Spacing spacing) {
    Packing packing = empty_cluster();
    const auto radius = [&] { return std::exp(random.real(0, std::log(ratio))); };
    append(packing, random.real(-1, 1), random.real(-1, 1), radius());
    for (int tries = 0; packing.disk_count() < n && tries < 200 * n; ++tries) {
        const double r = radius();
        // Two hosts among the latest disks, or anywhere.
        const int count = packing.disk_count();
        const auto i = static_cast<std::size_t>(random.integer(count));
        const auto j = static_cast<std::size_t>(count == 1 ? 0 : random.integer(count));
        const double a = packing.radius[i] + r + spacing();
        const double xi = packing.q[2 * i];
        const double yi = packing.q[2 * i + 1];
        double angle = random.real(0, 2 * std::numbers::pi);
        if (i != j) {
            const double dx = packing.q[2 * j] - xi;
            const double dy = packing.q[2 * j + 1] - yi;
            const double d = std::hypot(dx, dy);
            const double b = packing.radius[j] + r + spacing();
            const double cosine = (a * a + d * d - b * b) / (2 * a * d);
            if (std::abs(cosine) < 1) {
                angle = std::atan2(dy, dx) + std::acos(cosine);
            } else if (random.integer(4) != 0) {
                continue;
            }
        }
        append(packing, xi + a * std::cos(angle), yi + a * std::sin(angle), r);
        const std::size_t last = packing.radius.size() - 1;
        for (std::size_t k = 0; k < last; ++k) {
            if (plain_gap(packing, k, last) < -1e-14L * r) {
                packing.radius.pop_back();
                packing.q.erase(packing.q.end() - 4, packing.q.end() - 2);
                break;
            }
        }
    }
    return packing;
}

/// m x m disks of radius 1 on a square lattice of the given step: every elementary square is cocircular.
inline Packing square_lattice(int m, double step) {
    Packing packing = empty_cluster();
    for (int a = 0; a < m; ++a) {
        for (int b = 0; b < m; ++b) {
            append(packing, step * a, step * b, 1);
        }
    }
    return packing;
}

/// Rows of a triangular lattice of disks of radius 1, coordinates rounded.
inline Packing triangular_lattice(int m, double step) {
    Packing packing = empty_cluster();
    for (int a = 0; a < m; ++a) {
        for (int b = 0; b < m; ++b) {
            append(packing, step * (b + 0.5 * (a % 2)), step * std::sqrt(0.75) * a, 1);
        }
    }
    return packing;
}

/// Puts the four walls around a cluster, at the given distance from the outermost disks.
inline void enclose(Packing& packing, double distance) {
    packing.walls = Walls::box();
    for (std::size_t a = 0; a < 2; ++a) {
        double low = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            low = std::min(low, packing.q[2 * i + a] - packing.radius[i]);
        }
        double high = 0;
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            packing.q[2 * i + a] += distance - low;
            high = std::max(high, packing.q[2 * i + a] + packing.radius[i]);
        }
        packing.length(static_cast<int>(a)) = high + distance;
    }
}

} // namespace isostat::oracle
