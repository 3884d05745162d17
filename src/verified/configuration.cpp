#include "verified/configuration.hpp"

#include "contact/separation.hpp"
#include "core/roundoff.hpp"
#include "verified/enclosed_vertex.hpp"
#include "verified/norm.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace isostat {

namespace {

using roundoff::u;
/// Kantorovich's radius of existence for |F| <= residual and |DF^-1| <= inverse_norm, or NaN when its test fails.
double kantorovich_radius(double residual, double inverse_norm, double lipschitz_constant) {
    const double eta = inverse_norm * residual * (1 + 4 * u);                     // precision.md B1 (last operations)
    const double product = inverse_norm * lipschitz_constant * eta * (1 + 8 * u); // precision.md B1 (last operations)
    // bounds.md T9
    return product <= 0.25 ? 2 * eta : std::numeric_limits<double>::quiet_NaN(); // (1 - sqrt(1-2h)) / h <= 2
}

} // namespace

double VertexEnclosure::distance() const {
    std::vector<double> size;
    size.reserve(correction.size());
    for (const double c : correction) {
        size.push_back(std::abs(c));
    }
    return (radius + norm_above(size)) * (1 + 0x1p-50); // precision.md B1 (last operations)
}

VertexEnclosure enclose_vertex(const Packing& packing, const IsostaticStructure& structure,
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
        // 8: bounds.md V4 (8u of a gap, 8u of D/d); 1.001: bounds.md V4 (rounding, double)
        bounds.push_back(std::abs(h) * 1.001 + 8 * u * d + underflow_unit);
    }
    if (inverse.verdict != Verdict::proved || !(worst_ratio < 1e-3)) { // bounds.md V4 (test of the gaps)
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

VertexEnclosure enclose_vertex_double_double(const Packing& packing, const IsostaticStructure& structure,
                                             const Factorisation& factorisation, const InverseBound& inverse) {
    VertexEnclosure vertex = enclose_vertex(packing, structure, inverse);
    if (!in_range_of_products(packing)) {
        return vertex;
    }
    const EnclosedVertex<dd_real> found(Arithmetic<dd_real>(), packing, structure, factorisation,
                                        Neighbourhood::of(packing, structure.contacts(), inverse));
    std::vector<double> correction;
    std::vector<double> lost;
    for (const dd_real& p : found.at().correction()) {
        correction.push_back(p.x[0]);
        lost.push_back(p.x[1]);
    }
    const double radius = (found.radius() + norm_above(lost)) * (1 + 4 * u); // precision.md B1 (last operations)
    if (found.exists() && radius < vertex.radius) {
        vertex.verdict = Verdict::proved;
        vertex.radius = radius;
        vertex.correction = std::move(correction);
        vertex.rung = Rung::double_double;
    }
    return vertex;
}

Enclosure gap_at_vertex(const Packing& packing, const VertexEnclosure& vertex, const Contact& contact) {
    if (contact.kind == ContactKind::held) {
        return {0, 0};
    }
    const double weight = separation_weight(contact);
    const double d = target(packing, contact);
    if (vertex.correction.empty()) {
        const double h = gap(packing, contact);
        // 4: precision.md B1 (last operations); 8: bounds.md V4 (8u of a gap)
        return {h, (weight * vertex.radius + 8 * u * (std::abs(h) + d)) * (1 + 4 * u)};
    }
    using A = Arithmetic<dd_real>;
    const CorrectedConfiguration<dd_real, std::span<const double>> at(A(), packing, vertex.correction);
    const double value = A::rounded(at.gap(contact));
    return {value,
            // precision.md B3 (16 e; four roundings)
            (weight * vertex.radius + 16 * A::unit() * (std::abs(value) + d) + 2 * u * std::abs(value)) * (1 + 4 * u)};
}

namespace {

/// Gap at an enclosed vertex.
PreciseInterval gap_at(const EnclosedVertex<Real>& vertex, const Contact& contact) {
    const Arithmetic<Real>& a = vertex.at().arithmetic();
    const Real h = vertex.at().gap(contact);
    const UpperBound radius = 16 * a.unit() * (a.size(h) + target(vertex.at().packing(), contact)) + // precision.md B3
                              separation_weight(contact) * vertex.radius();
    return {h, radius.real(), a.bits()};
}

/// The sign of a gap as far as one enclosure of the vertex decides the sign.
Order sign_at(const EnclosedVertex<Real>& vertex, const Contact& contact) {
    const PreciseInterval gap_there = gap_at(vertex, contact);
    Order order{false, 0, 0, Rung::multiprecision, vertex.at().arithmetic().bits()};
    if (gap_there.positive() || gap_there.negative()) {
        order.decided = true;
        order.sign = gap_there.positive() ? 1 : -1;
        order.margin = gap_there.margin();
        return order;
    }
    Real logarithm(64); // exact: bits of a bound
    mpfr_log2(logarithm.get(), magnitude(gap_there).high.get(), MPFR_RNDU);
    order.exponent = logarithm.above();
    return order;
}

} // namespace

std::vector<Order> gap_signs_at_vertex(const Packing& packing, const IsostaticStructure& structure,
                                       const Factorisation& factorisation, const InverseBound& inverse,
                                       const std::vector<Contact>& candidates, const LadderOptions& options) {
    std::vector<Order> orders(candidates.size());
    const auto open = [](const Order& order) { return !order.decided; };
    std::vector<Real> start;
    const Neighbourhood at_q = Neighbourhood::of(packing, structure.contacts(), inverse);
    for (int bits = options.first_bits; bits <= options.max_bits && std::any_of(orders.begin(), orders.end(), open);
         bits *= 2) {
        const EnclosedVertex<Real> vertex(Arithmetic<Real>(bits), packing, structure, factorisation, at_q, start);
        if (!vertex.exists()) {
            break;
        }
        for (std::size_t k = 0; k < orders.size(); ++k) {
            if (open(orders[k])) {
                orders[k] = sign_at(vertex, candidates[k]);
            }
        }
        start = vertex.at().correction();
    }
    // A stored configuration that closes every kept gap exactly is the true vertex.
    const auto& contacts = structure.contacts();
    const auto closed = [&](const Contact& c) { return c.kind == ContactKind::held || gap_sign(packing, c, 0) == 0; };
    const bool exact = std::any_of(orders.begin(), orders.end(), open) && // an enclosure proves it unique
                       std::all_of(contacts.begin(), contacts.end(), closed);
    for (std::size_t k = 0; k < orders.size() && exact; ++k) {
        if (open(orders[k]) && orders[k].rung != Rung::none) {
            constexpr double infinity = std::numeric_limits<double>::infinity();
            const int sign = gap_sign(packing, candidates[k], 0);
            orders[k] = {true, sign, infinity, Rung::exact, 0, sign == 0 ? -infinity : infinity};
        }
    }
    return orders;
}

} // namespace isostat
