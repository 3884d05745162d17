#include "contact/gap_sign.hpp"
#include "verified/extended_norm.hpp"
#include "verified/norm.hpp"
#include "verified/refined_vertex.hpp"
#include "verified/vertex_bounds.hpp"

#include <isostat/verified/configuration.hpp>

#include <qd/dd_real.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;
constexpr double coordinate_unit =
    0x1p-100;                       // rounding of a difference of corrected coordinates, per unit of the coordinates
constexpr double dd_unit = 0x1p-98; // granted to one operation of libqd (its own bounds are 2^-104 to 2^-102)

/// Kantorovich with |F| <= residual, |DF^-1| <= inverse_norm: radius of existence, or NaN when the test fails.
double kantorovich_radius(double residual, double inverse_norm, double lipschitz_constant) {
    const double eta = inverse_norm * residual * (1 + 4 * u);
    const double product = inverse_norm * lipschitz_constant * eta * (1 + 8 * u);
    return product <= 0.25 ? 2 * eta : std::numeric_limits<double>::quiet_NaN(); // (1 - sqrt(1-2h)) / h <= 2
}

template <int Dim>
dd_real gap_dd(const Packing<Dim>& packing, const std::vector<double>& correction, const Contact& contact) {
    const auto at = [&](int coordinate) {
        const auto k = static_cast<std::size_t>(coordinate);
        return dd_real(packing.q[k]) + correction[k];
    };
    const double ri = packing.radius[static_cast<std::size_t>(contact.i)];
    switch (contact.kind) {
    case ContactKind::disk_disk: {
        std::array<dd_real, static_cast<std::size_t>(Dim)> d;
        for (int a = 0; a < Dim; ++a) {
            d[static_cast<std::size_t>(a)] = at(Dim * contact.j + a) - at(Dim * contact.i + a);
        }
        const int exponent = normalise(d);
        return ldexp(length(d), exponent) - (dd_real(ri) + packing.radius[static_cast<std::size_t>(contact.j)]);
    }
    case ContactKind::lower_wall: return at(Dim * contact.i + contact.j) - ri;
    case ContactKind::upper_wall:
        return at(Dim * packing.disk_count() + contact.j) - at(Dim * contact.i + contact.j) - ri;
    case ContactKind::held: return 0.0;
    }
    return 0.0;
}

/// F_l in double-double from the gap: F = gap (1 + gap / (2 D)).
template <int Dim>
dd_real quadratic_dd(const Packing<Dim>& packing, const std::vector<double>& correction, const Contact& contact) {
    const dd_real h = contact.kind == ContactKind::held ? dd_real(correction[static_cast<std::size_t>(contact.i)])
                                                        : gap_dd(packing, correction, contact);
    return contact.kind == ContactKind::disk_disk ? h * (1.0 + h / (2 * target(packing, contact))) : h;
}

} // namespace

double VertexEnclosure::distance() const {
    std::vector<double> size;
    size.reserve(correction.size());
    for (const double c : correction) {
        size.push_back(std::abs(c));
    }
    return (radius + norm_above(size)) * (1 + 0x1p-50);
}

template <int Dim>
VertexEnclosure enclose_vertex(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                               const InverseBound& inverse) {
    VertexEnclosure vertex;
    vertex.radius = std::numeric_limits<double>::infinity();
    std::vector<double> bounds;
    double worst_ratio = 0;
    for (const Contact& contact : structure.contacts()) {
        const double h = gap(packing, contact);
        const double d = target(packing, contact);
        vertex.max_gap = std::max(vertex.max_gap, std::abs(h));
        if (d > 0) {
            worst_ratio = std::max(worst_ratio, std::abs(h) / d);
        }
        // |F| <= |h| (1 + |h|/2D), and |h|/D is checked below; the computed gap is off by less than 8u D.
        bounds.push_back(std::abs(h) * 1.001 + 8 * u * d + underflow_unit);
    }
    if (inverse.verdict != Verdict::proved || !(worst_ratio < 1e-3)) {
        return vertex;
    }
    const double inverse_norm = 1 / inverse.sigma_min * (1 + 2 * worst_ratio + 8 * u);
    const double radius =
        kantorovich_radius(norm_above(bounds), inverse_norm, lipschitz(packing, structure.contacts()));
    if (radius >= 0) {
        vertex.verdict = Verdict::proved;
        vertex.radius = radius;
    }
    return vertex;
}

template <int Dim>
VertexEnclosure enclose_vertex_double_double(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                                             const Factorisation& factorisation, const InverseBound& inverse) {
    VertexEnclosure vertex = enclose_vertex(packing, structure, inverse);
    if (inverse.verdict != Verdict::proved) {
        return vertex;
    }
    double worst_ratio = 0; // |DF^-1| <= |G^-1| max D / |d|: the gaps must be small against D, as on the double rung
    double largest = 0;
    for (const Contact& contact : structure.contacts()) {
        const double d = target(packing, contact);
        worst_ratio = d > 0 ? std::max(worst_ratio, std::abs(gap(packing, contact)) / d) : worst_ratio;
    }
    for (const double x : packing.q) {
        largest = std::max(largest, std::abs(x));
    }
    if (!(worst_ratio < 1e-3)) {
        return vertex;
    }
    const DofMap<Dim>& dofs = structure.dofs();
    const double k = lipschitz(packing, structure.contacts());
    const auto n = static_cast<std::size_t>(structure.size());
    std::vector<double> correction(packing.q.size(), 0.0);
    std::vector<double> f(n);
    std::vector<double> bounds(n);
    constexpr int max_iterations = 6;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        for (std::size_t l = 0; l < n; ++l) {
            const Contact& contact = structure.contacts()[l];
            const dd_real value = quadratic_dd(packing, correction, contact);
            f[l] = value.x[0];
            bounds[l] = std::abs(f[l]) * (1 + 2 * u) + 16 * dd_unit * target(packing, contact) +
                        coordinate_unit * largest + 16 * underflow_unit;
        }
        std::vector<double> shifts(correction.size());
        std::transform(correction.begin(), correction.end(), shifts.begin(), [](double c) { return std::abs(c); });
        const double shift = norm_above(shifts);
        // |DF^-1| at the corrected point: |DF^-1(q)| / (1 - |DF^-1(q)| K |correction|).
        const double at_q = 1 / inverse.sigma_min * (1 + 2 * worst_ratio + 8 * u);
        const double lost = at_q * k * shift;
        const double radius = lost < 0.5 ? kantorovich_radius(norm_above(bounds), at_q / (1 - lost) * (1 + 1e-10), k)
                                         : std::numeric_limits<double>::quiet_NaN();
        if (radius >= 0 && radius < vertex.radius) {
            vertex.verdict = Verdict::proved;
            vertex.radius = radius;
            vertex.correction = correction;
            vertex.rung = Rung::double_double;
        } else if (iteration > 2) {
            break;
        }
        factorisation.solve_velocities(f); // approach velocities equal to the gaps close them
        for (std::size_t mu = 0; mu < n; ++mu) {
            correction[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)))] += f[mu];
        }
    }
    return vertex;
}

template <int Dim>
Enclosure gap_at_vertex(const Packing<Dim>& packing, const VertexEnclosure& vertex, const Contact& contact) {
    constexpr double root2 = 1.4142135623731;
    if (contact.kind == ContactKind::held) {
        return {0, 0};
    }
    if (vertex.correction.empty()) {
        const double h = gap(packing, contact);
        const double d = target(packing, contact);
        return {h, (root2 * vertex.radius + 8 * u * (std::abs(h) + d)) * (1 + 4 * u)};
    }
    const dd_real h = gap_dd(packing, vertex.correction, contact);
    const double value = h.x[0];
    const double d = target(packing, contact);
    double size = 0; // of the coordinates whose differences were formed
    for (int a = 0; a < Dim; ++a) {
        size += std::abs(packing.coordinate(DiskId(contact.i), a));
        size += std::abs(contact.kind == ContactKind::disk_disk ? packing.coordinate(DiskId(contact.j), a)
                                                                : packing.length(a));
    }
    return {value, (root2 * vertex.radius + 16 * dd_unit * (std::abs(value) + d) + coordinate_unit * size +
                    2 * u * std::abs(value)) *
                       (1 + 4 * u)};
}

template <int Dim>
Order gap_sign_at_vertex(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                         const Factorisation& factorisation, const InverseBound& inverse, const Contact& contact,
                         const LadderOptions& options) {
    Order order;
    std::vector<Real> start = exact_coordinates(packing.q, {});
    for (int bits = options.first_bits; bits <= options.max_bits; bits *= 2) {
        const RefinedVertex vertex = refine_vertex(packing, structure, factorisation, inverse, start, bits);
        if (vertex.verdict != Verdict::proved) {
            break;
        }
        order.rung = Rung::multiprecision;
        order.bits = bits;
        const Real h = precise_gap(packing, vertex.coordinate, contact, bits);
        Real radius(64);
        mpfr_abs(radius.get(), h.get(), MPFR_RNDU);
        mpfr_add_d(radius.get(), radius.get(), target(packing, contact), MPFR_RNDU);
        mpfr_mul_2si(radius.get(), radius.get(), 4 - bits, MPFR_RNDU);
        Real moved(64);
        mpfr_mul_d(moved.get(), vertex.radius.get(), 1.4142135623731, MPFR_RNDU);
        mpfr_add(radius.get(), radius.get(), moved.get(), MPFR_RNDU);
        const PreciseInterval gap_there(h, radius, bits);
        if (gap_there.positive() || gap_there.negative()) {
            order.decided = true;
            order.sign = gap_there.positive() ? 1 : -1;
            order.margin = gap_there.margin();
            return order;
        }
        const PreciseInterval absolute = magnitude(gap_there);
        mpfr_log2(moved.get(), absolute.high.get(), MPFR_RNDU);
        order.exponent = moved.above();
        start = vertex.coordinate;
    }
    // A stored configuration that closes every kept gap exactly is the true vertex.
    const bool exact = std::all_of(structure.contacts().begin(), structure.contacts().end(), [&](const Contact& c) {
        return c.kind == ContactKind::held || gap_sign(packing, c, 0) == 0;
    });
    if (exact && order.rung != Rung::none) { // unique there, by the enclosure
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const int sign = gap_sign(packing, contact, 0);
        order = {true, sign, infinity, Rung::exact, 0, sign == 0 ? -infinity : infinity};
    }
    return order;
}

template Order gap_sign_at_vertex<2>(const Packing<2>&, const IsostaticStructure<2>&, const Factorisation&,
                                     const InverseBound&, const Contact&, const LadderOptions&);
template VertexEnclosure enclose_vertex<2>(const Packing<2>&, const IsostaticStructure<2>&, const InverseBound&);
template VertexEnclosure enclose_vertex_double_double<2>(const Packing<2>&, const IsostaticStructure<2>&,
                                                         const Factorisation&, const InverseBound&);
template Enclosure gap_at_vertex<2>(const Packing<2>&, const VertexEnclosure&, const Contact&);

} // namespace isostat
