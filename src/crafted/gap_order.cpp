#include "crafted/gap_order.hpp"

#include "contact/images.hpp"
#include "contact/separation.hpp"
#include "core/roundoff.hpp"

#include <boost/multiprecision/gmp.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace isostat::crafted {

namespace {

using Integer = boost::multiprecision::number<boost::multiprecision::gmp_int, boost::multiprecision::et_off>;

using roundoff::u;
/// Relative rounding of a gap computed from lengths (four operations and hypot, below 1 ulp), with a margin for the
/// rounding of the bound itself and of the comparison.
constexpr double relative_bound = 16 * u;
constexpr int mantissa_bits = 53;

/// Exponent of the lowest bit of a finite double; the largest integer for 0.
int lowest_exponent(double x) {
    if (x == 0) {
        return std::numeric_limits<int>::max();
    }
    int exponent = 0;
    auto mantissa = static_cast<long long>(std::ldexp(std::frexp(x, &exponent), mantissa_bits));
    exponent -= mantissa_bits;
    while (mantissa % 2 == 0) {
        mantissa /= 2;
        ++exponent;
    }
    return exponent;
}

/// sqrt(square) - sum, in units of 2^exponent (square: 4^exponent).
struct Root {
    Integer square, sum;
};

int sign(const Integer& x) {
    return x.sign();
}

/// Sign of sqrt(a) - sqrt(b) - c for a, b >= 0, by comparing squares of sides that are known not to be negative, twice.
int root_sign(const Integer& a, const Integer& b, const Integer& c) {
    const Integer cc = c * c;
    if (c < 0 && b < cc) {
        return 1; // sqrt(b) + c < 0 <= sqrt(a)
    }
    const Integer rest = a - b - cc; // the sign is that of rest - 2 c sqrt(b)
    const int left = sign(rest);
    const int right = b == 0 ? 0 : sign(c);
    if (left != right) {
        return left > right ? 1 : -1;
    }
    return left * sign(rest * rest - 4 * cc * b);
}

} // namespace

struct GapOrder::Exact {
    int exponent = 0; ///< every coordinate and radius is an integer multiple of 2^exponent

    [[nodiscard]] Integer integer(double x) const {
        int e = 0;
        const auto mantissa = static_cast<long long>(std::ldexp(std::frexp(x, &e), mantissa_bits));
        e -= mantissa_bits + exponent;
        Integer out = mantissa;
        return e >= 0 ? out << e : out >> -e; // the right shift drops only zeros
    }

    [[nodiscard]] Root root(const Packing& packing, const Contact& contact) const {
        const Separation separation(contact, packing.layout());
        const auto at = [&](std::size_t k) { return integer(packing.q[k]); };
        const auto minus = [](const Integer& a, const Integer& b) -> Integer { return a - b; };
        const Integer r = integer(packing.radius[static_cast<std::size_t>(contact.i)]);
        if (contact.of_disks()) {
            const auto [dx, dy, dz] = separation.of_disks(at, minus);
            return {dx * dx + dy * dy + dz * dz, r + integer(packing.radius[static_cast<std::size_t>(contact.j)])};
        }
        return {0, r - separation.of_wall(at, minus)};
    }
};

GapOrder::GapOrder(const Packing& packing) : packing_(&packing), exact_(std::make_unique<Exact>()) {
    exact_->exponent = std::numeric_limits<int>::max();
    for (const auto* values : {&packing.q, &packing.radius}) {
        for (const double x : *values) {
            exact_->exponent = std::min(exact_->exponent, lowest_exponent(x));
        }
    }
}

GapOrder::~GapOrder() = default;
GapOrder::GapOrder(GapOrder&&) noexcept = default;

GapOrder::Item GapOrder::item(const Contact& contact) const {
    const std::vector<double>& q = packing_->q;
    const double touching = touching_distance(packing_->radius, contact);
    if (contact.of_disks()) {
        const auto [dx, dy, dz] = separation(packing_->layout(), q, contact);
        const double distance = std::hypot(dx, dy, dz);
        return {contact, distance - touching,
                relative_bound * (distance + touching + lengths_of_image(*packing_, contact))};
    }
    double size = touching;
    Separation(contact, packing_->layout()).for_each_coordinate([&](std::size_t k, std::size_t, int) {
        size += std::abs(q[k]);
    });
    return {contact, wall_distance(packing_->layout(), q, contact) - touching, relative_bound * size};
}

int GapOrder::compare(const Item& a, const Item& b) const {
    const double difference = a.gap - b.gap;
    if (std::abs(difference) > a.error + b.error) {
        return difference > 0 ? 1 : -1;
    }
    const Root s = exact_->root(*packing_, a.contact);
    const Root t = exact_->root(*packing_, b.contact);
    return root_sign(s.square, t.square, s.sum - t.sum);
}

int GapOrder::compare(const Item& a, double threshold) const {
    const double difference = a.gap - threshold;
    if (std::abs(difference) > a.error + relative_bound * std::abs(threshold)) {
        return difference > 0 ? 1 : -1;
    }
    return gap_sign(*packing_, a.contact, -threshold);
}

double GapOrder::threshold_of(const Item& a) const {
    // Bisection over the doubles in their order, because very many doubles are near a gap of 0.
    const auto rank = [](double x) {
        const auto bits = std::bit_cast<std::int64_t>(x);
        return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
    };
    const auto value = [](std::int64_t r) {
        return std::bit_cast<double>(r >= 0 ? r : std::numeric_limits<std::int64_t>::min() - r);
    };
    std::int64_t below = rank(a.gap - 2 * a.error) - 1; // a double below the gap
    std::int64_t above = rank(a.gap + 2 * a.error) + 1; // a double above it
    // Two doubles of different sign may be farther apart than 2^63 in this order.
    for (auto middle = std::midpoint(below, above); middle != below && middle != above;
         middle = std::midpoint(below, above)) {
        (compare(a, value(middle)) > 0 ? below : above) = middle;
    }
    return value(above) == 0 ? 0 : value(above);
}

} // namespace isostat::crafted
