#include "contact/separation.hpp"
#include "core/roundoff.hpp"
#include "verified/configuration.hpp"
#include "verified/norm.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

namespace isostat {

namespace {

using roundoff::u;

/// a + b = sum + error, exactly.
struct Pair {
    double sum;
    double error = 0;
};
Pair exact_sum(double a, double b) {
    const double sum = a + b;
    const double part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}
/// a * a = sum + error, exactly unless it underflows (halves of 26 bits).
Pair exact_square(double a) {
    constexpr double split = 134217729.0; // exact: 2^27 + 1
    const double t = split * a;
    const double high = t - (t - a);
    const double low = a - high;
    const double square = a * a;
    return {square, ((high * high - square) + 2 * high * low) + low * low};
}

/// The numbers of V4 on the gaps of the stored configuration, from one pass over the contacts. Lengths are
/// multiplied by `scale`, a power of two that brings the largest near 1.
struct Constraints {
    std::vector<double> f;     ///< F_l
    std::vector<double> error; ///< bound of its error
    double worst = 0;          ///< largest |gap| / D of disks, from above
    double largest = 0;        ///< largest |gap|, as computed; in the unit of the packing
    double lipschitz = 0;      ///< of the derivative of F, scaled (V4 (a))
    double rows = 0;           ///< relative rounding of a row times a vector
};

/// F of one contact, and the bound of its error.
struct Constraint {
    double f = 0;
    double error = 0;
};

/// F of two disks from the coordinates `distance` of their relative position; d = R_i + R_j.
Constraint between_disks(std::span<const Pair> distance, Pair d) {
    // bounds.md V4 (Newton step)
    constexpr double underflow = 0x1p-1000; // far above 16 * 2^-1074, which is slow to multiply with
    const Pair target_square = exact_square(d.sum);
    Pair value{-target_square.sum, -(target_square.error + 2 * d.sum * d.error)};
    for (const Pair& x : distance) {
        const Pair square = exact_square(x.sum);
        const Pair sum = exact_sum(value.sum, square.sum);
        value = {sum.sum, value.error + (sum.error + (square.error + 2 * x.sum * x.error))};
    }
    const double inverse = 1 / d.sum;
    const double f = (value.sum + value.error) * 0.5 * inverse;              // exact: a half
    return {f, 4 * u * std::abs(f) + 0x1p-98 * d.sum + underflow * inverse}; // bounds.md V4 (Newton step)
}

/// x_j - x_i + A m; for an image the difference is one double, exact on the grid (proofs/cells.md, C2).
template <class At, class Minus>
PerAxis<Pair> distance_of(const Separation& separation, const Contact& contact, At at, Minus minus) {
    if (contact.image.is_here()) [[likely]] {
        return separation.of_centres(at, minus);
    }
    const auto r = separation.of_disks(at, std::minus<>());
    PerAxis<Pair> distance{};
    std::transform(r.begin(), r.end(), distance.begin(), [](double x) { return Pair{x}; });
    return distance;
}

/// \pre with periodic axes: the packing is on its grid
Constraints constraints(const Packing& packing, const std::vector<Contact>& contacts, double scale) {
    const std::size_t n = contacts.size();
    Constraints result{std::vector<double>(n), std::vector<double>(n)};
    // 5u (5.51u) of the entries, products and sums: of seven terms at most, in space of twelve.
    result.rows = (packing.dimension == plane ? 16 : 22) * u; // bounds.md V4 (Newton step)
    std::vector<int> count(packing.radius.size(), 0);
    const auto at = [scale, q = packing.q.data()](std::size_t k) { return scale * q[k]; };
    const auto minus = [](double a, double b) { return exact_sum(a, -b); };
    const double* const radius = packing.radius.data();
    double smallest = roundoff::infinity;
    double ratio = 0;
    double largest = 0;
    for (std::size_t l = 0; l < n; ++l) {
        const auto i = static_cast<std::size_t>(contacts[l].i);
        const Separation separation(contacts[l], packing.layout());
        Constraint found;
        if (contacts[l].of_disks()) {
            const auto j = static_cast<std::size_t>(contacts[l].j);
            const Pair d = contacts[l].kind == ContactKind::bar
                               ? Pair{scale * packing.bar_length(contacts[l].i, contacts[l].j)}
                               : exact_sum(scale * radius[i], scale * radius[j]);
            const auto distance = distance_of(separation, contacts[l], at, minus);
            found = between_disks(std::span(distance).first(packing.axes()), d);
            ratio = std::max(ratio, std::abs(found.f) * (1 / d.sum));
            smallest = std::min(smallest, d.sum);
            ++count[i];
            ++count[j];
        } else if (contacts[l].is_wall() && contacts[l].wall().at_length) {
            const double length = scale * packing.length(contacts[l].j);
            const Pair x = separation.of_wall_at_length(at, minus);
            const Pair sum = exact_sum(x.sum, -(scale * radius[i]));
            const double f = sum.sum + (sum.error + x.error);
            found = {f, 4 * u * std::abs(f) + 0x1p-98 * std::abs(length)}; // bounds.md V4 (Newton step, walls)
        } else if (contacts[l].is_wall()) {
            const double f = separation.of_wall(at, std::minus<>()) - scale * radius[i];
            found = {f, 2 * u * std::abs(f)};
        }
        result.f[l] = found.f;
        result.error[l] = found.error;
        largest = std::max(largest, std::abs(found.f));
    }
    // From |F| to the gap: F = g (1 + g / 2D) gives |g| <= |F| (1 + |F| / D) while |F| / D < 1/4.
    result.worst = ratio * 1.0011 + 0x1p-90; // bounds.md V4 (Newton step)
    result.largest = largest / scale;
    const int most = count.empty() ? 0 : *std::max_element(count.begin(), count.end());
    result.lipschitz = packing.cell.any() ? lipschitz_in_cell(packing, contacts) / scale
                       : most == 0        ? 0
                                   // precision.md B1 (last operations)
                                   : 2 * std::sqrt(most) / smallest * (1 + 0x1p-49);
    return result;
}

/// What a step leaves of F: the residual r = F - approach, and a bound of what the step leaves of the exact F.
struct Rest {
    std::vector<double> r;
    std::vector<double> bound;

    explicit Rest(std::size_t n) : r(n), bound(n) {}

    void after(const std::vector<double>& step, const Constraints& at, const sparse::Matrix<double>& h) {
        const double* const value = h.value.data();
        const int* const row = h.row.data();
        for (std::size_t l = 0; l < r.size(); ++l) {
            double approach = 0;
            double size = 0;
            const int end = h.start[l + 1];
            for (int e = h.start[l]; e < end; ++e) {
                const double term = value[e] * step[static_cast<std::size_t>(row[e])];
                approach += term;
                size += std::abs(term);
            }
            r[l] = at.f[l] - approach;
            // The row of DF is that of G times d / D.
            // bounds.md V4 (Newton step)
            bound[l] = std::abs(r[l]) * (1 + 2 * u) + at.error[l] + (at.rows + 1.01 * at.worst) * size;
        }
    }
};

/// Power of two that brings the largest coordinate near 1; empty when F cannot be computed in that range.
std::optional<double> scale_of(const std::vector<double>& q) {
    double longest = 0;
    for (const double x : q) {
        longest = std::max(longest, std::abs(x));
    }
    int exponent = 0;
    std::frexp(longest, &exponent);
    // cost: then without scaling
    return std::abs(exponent) > 400 ? std::nullopt : std::optional(std::ldexp(1.0, -exponent));
}

/// Takes steps of Newton's method from the stored configuration,
/// each with its proved enclosure (V4); lengths have the unit of `at`.
VertexEnclosure newton(const Constraints& at, const sparse::Matrix<double>& h, const Factorisation& factorisation,
                       double inverse_norm) {
    constexpr int max_passes = 4; // cost: passes
    constexpr double enough = 2;  // further passes divide the radius by 3 at most
    VertexEnclosure vertex;
    vertex.radius = roundoff::infinity;
    std::vector<double> step = at.f; // approach velocities equal to the gaps that they close
    factorisation.approximate().velocities(step);
    Rest left(step.size());
    for (int pass = 1; pass <= max_passes; ++pass) {
        left.after(step, at, h);
        const double length = norm_above(step);
        const double rest = inverse_norm * norm_above(left.bound) * (1 + 4 * u); // precision.md B1 (last operations)
        const double eta = (length + rest) * (1 + 4 * u);                        // precision.md B1 (last operations)
        const double product = inverse_norm * at.lipschitz * eta * (1 + 8 * u);  // precision.md B1 (last operations)
        // precision.md B1 (last operations)
        const double radius = eta * (1 + product) * (1 + 8 * u); // (1 - sqrt(1 - 2h)) / h <= 1 + h up to 1/4
        if (product <= 0.25 && radius < vertex.radius) {         // 0.25: bounds.md V4 (e)
            vertex.verdict = Verdict::proved;
            vertex.radius = radius;
        }
        // The exact step ends within `rest` of this one, and the vertex is at most eta * product from its end.
        // 0.25: bounds.md V4 (e); 8: precision.md B1 (last operations)
        vertex.step_radius = product <= 0.25 ? (rest + eta * product) * (1 + 8 * u) : roundoff::infinity;
        if (!(rest > enough * length) || pass == max_passes) {
            break;
        }
        factorisation.approximate().velocities(left.r);
        for (std::size_t l = 0; l < step.size(); ++l) {
            step[l] += left.r[l];
        }
    }
    vertex.step = std::move(step);
    return vertex;
}

} // namespace

VertexEnclosure enclose_vertex(const Packing& packing, const IsostaticStructure& structure,
                               const Factorisation& factorisation, const InverseBound& inverse) {
    const std::optional<double> scale = scale_of(packing.q);
    const bool rounded = packing.cell.any() && !is_on_grid(packing);
    if (inverse.verdict != Verdict::proved || !scale || rounded) {
        return enclose_vertex(packing, structure, inverse);
    }
    const Constraints at = constraints(packing, structure.contacts(), *scale);
    if (!(at.worst < 1e-3)) { // bounds.md V4 (test of the gaps)
        return enclose_vertex(packing, structure, inverse);
    }
    const double inverse_norm = 1 / inverse.sigma_min * (1 + 2 * at.worst + 8 * u); // bounds.md V4 (b)
    VertexEnclosure vertex = newton(at, structure.matrix(), factorisation, inverse_norm);
    if (vertex.verdict != Verdict::proved) {
        return enclose_vertex(packing, structure, inverse);
    }
    vertex.max_gap = at.largest;
    vertex.lipschitz = at.lipschitz * *scale;
    vertex.radius /= *scale; // a power of two
    vertex.step_radius /= *scale;
    for (double& s : vertex.step) {
        s /= *scale;
    }
    return vertex;
}

} // namespace isostat
