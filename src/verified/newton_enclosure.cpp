#include "verified/norm.hpp"
#include "verified/vertex_bounds.hpp"

#include <isostat/verified/configuration.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;

/// a + b = sum + error, exactly.
struct Pair {
    double sum;
    double error;
};
Pair exact_sum(double a, double b) {
    const double sum = a + b;
    const double part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}
/// a * a = sum + error, exactly unless it underflows (halves of 26 bits).
Pair exact_square(double a) {
    constexpr double split = 134217729.0;
    const double t = split * a;
    const double high = t - (t - a);
    const double low = a - high;
    const double square = a * a;
    return {square, ((high * high - square) + 2 * high * low) + low * low};
}

/// F_l of statement V4 at the stored configuration and a bound of its error. Lengths are multiplied by `scale`, a power
/// of two that brings the largest near 1.
template <int Dim> Pair constraint(const Packing<Dim>& packing, const Contact& contact, double scale) {
    const auto at = [&](int coordinate) { return scale * packing.q[static_cast<std::size_t>(coordinate)]; };
    const double ri =
        contact.kind == ContactKind::held ? 0 : scale * packing.radius[static_cast<std::size_t>(contact.i)];
    switch (contact.kind) {
    case ContactKind::disk_disk: {
        const Pair d = exact_sum(ri, scale * packing.radius[static_cast<std::size_t>(contact.j)]);
        const Pair target_square = exact_square(d.sum);
        Pair value{-target_square.sum, -(target_square.error + 2 * d.sum * d.error)};
        for (int a = 0; a < Dim; ++a) {
            const Pair x = exact_sum(at(Dim * contact.j + a), -at(Dim * contact.i + a));
            const Pair square = exact_square(x.sum);
            const Pair sum = exact_sum(value.sum, square.sum);
            value = {sum.sum, value.error + (sum.error + (square.error + 2 * x.sum * x.error))};
        }
        const double f = (value.sum + value.error) / (2 * d.sum);
        return {f, 4 * u * std::abs(f) + 0x1p-98 * d.sum + 16 * underflow_unit / d.sum};
    }
    case ContactKind::lower_wall: {
        const double f = at(Dim * contact.i + contact.j) - ri;
        return {f, 2 * u * std::abs(f)};
    }
    case ContactKind::upper_wall: {
        const double length = at(Dim * packing.disk_count() + contact.j);
        const Pair x = exact_sum(length, -at(Dim * contact.i + contact.j));
        const Pair sum = exact_sum(x.sum, -ri);
        const double f = sum.sum + (sum.error + x.error);
        return {f, 4 * u * std::abs(f) + 0x1p-98 * std::abs(length)};
    }
    case ContactKind::held: break;
    }
    return {0, 0};
}

} // namespace

template <int Dim>
VertexEnclosure enclose_vertex(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                               const Factorisation& factorisation, const InverseBound& inverse) {
    VertexEnclosure vertex = enclose_vertex(packing, structure, inverse);
    const double worst = worst_gap_ratio(packing, structure.contacts());
    double longest = 0;
    for (const double x : packing.q) {
        longest = std::max(longest, std::abs(x));
    }
    int exponent = 0;
    std::frexp(longest, &exponent);
    if (inverse.verdict != Verdict::proved || !(worst < 1e-3) || std::abs(exponent) > 1000) {
        return vertex;
    }
    const double scale = std::ldexp(1.0, -exponent);
    const sparse::Matrix<double>& h = structure.matrix();
    const auto n = static_cast<std::size_t>(structure.size());
    std::vector<double> f(n);
    std::vector<double> error(n);
    for (std::size_t l = 0; l < n; ++l) {
        const Pair value = constraint(packing, structure.contacts()[l], scale);
        f[l] = value.sum;
        error[l] = value.error;
    }
    const double inverse_norm = 1 / inverse.sigma_min * (1 + 2 * worst + 8 * u);
    const double k = lipschitz(packing, structure.contacts()) / scale;
    std::vector<double> step = f; // with approach velocities equal to the gaps they close
    factorisation.approximate().velocities(step);
    std::vector<double> r(n);
    std::vector<double> bound(n);
    constexpr int max_passes = 4;
    for (int pass = 1; pass <= max_passes; ++pass) {
        for (std::size_t l = 0; l < n; ++l) {
            double approach = 0;
            double size = 0;
            for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
                const double term = h.value[e] * step[static_cast<std::size_t>(h.row[e])];
                approach += term;
                size += std::abs(term);
            }
            r[l] = f[l] - approach;
            // 5u of the entries, products and sums; the row of DF is that of G times d / D.
            bound[l] = std::abs(r[l]) * (1 + 2 * u) + error[l] + (16 * u + 1.01 * worst) * size;
        }
        std::vector<double> size(n);
        std::transform(step.begin(), step.end(), size.begin(), [](double c) { return std::abs(c); });
        const double length = norm_above(size);
        const double rest = inverse_norm * norm_above(bound) * (1 + 4 * u);
        const double eta = (length + rest) * (1 + 4 * u);
        const double product = inverse_norm * k * eta * (1 + 8 * u);
        const double radius = eta * (1 + product) * (1 + 8 * u) / scale; // (1 - sqrt(1 - 2h)) / h <= 1 + h up to 1/4
        if (product <= 0.25 && (vertex.verdict != Verdict::proved || radius < vertex.radius)) {
            vertex.verdict = Verdict::proved;
            vertex.radius = radius;
        }
        if (!(rest > 0.5 * length) || pass == max_passes) {
            break;
        }
        factorisation.approximate().velocities(r);
        for (std::size_t l = 0; l < n; ++l) {
            step[l] += r[l];
        }
    }
    return vertex;
}

template VertexEnclosure enclose_vertex<2>(const Packing<2>&, const IsostaticStructure<2>&, const Factorisation&,
                                           const InverseBound&);

} // namespace isostat
