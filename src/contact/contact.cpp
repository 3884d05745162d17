#include "contact/separation.hpp"
#include "core/dot.hpp"
#include "packing/words.hpp"

#include <isostat/contact/state.hpp>

#include <fmt/format.h>

#include <cmath>
#include <span>

namespace isostat {

namespace {

/// "(1,-1)", or empty.
std::string image_text(const Image& image, int dimension) {
    std::string text;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension) && !image.is_here(); ++a) {
        text += fmt::format("{}{}", a == 0 ? "(" : ",", static_cast<int>(image.m[a]));
    }
    return text.empty() ? text : text + ")";
}

/// No square of a relevant component under- or overflows.
bool in_range(double norm) {
    return norm > 0x1p-450 && norm < 0x1p500; // precision.md B13
}

/// Multiplies d by a power of two, exactly, so that its largest
/// component is in [1/2, 1); returns the exponent that undoes this.
int normalise(PerAxis<double>& d) {
    int exponent = 0;
    std::frexp(largest(d), &exponent);
    for (double& c : d) {
        c = std::ldexp(c, -exponent);
    }
    return exponent;
}

double norm(PerAxis<double> d) {
    const double plain = euclidean_norm(d);
    if (in_range(plain)) {
        return plain;
    }
    const int exponent = normalise(d);
    return std::ldexp(euclidean_norm(d), exponent);
}

} // namespace

PerAxis<double> direction(PerAxis<double> d) {
    double length = euclidean_norm(d);
    if (!in_range(length)) {
        normalise(d); // squares under- or overflow
        length = euclidean_norm(d);
    }
    for (double& component : d) {
        component /= length;
    }
    return d;
}

std::string to_string(const Contact& contact, int dimension) {
    if (contact.of_disks()) {
        return fmt::format("{}{}-{}{}", contact.kind == ContactKind::bar ? "bar " : "", contact.i, contact.j,
                           image_text(contact.image, dimension));
    }
    if (contact.is_wall()) {
        return fmt::format("{}-{}", contact.i, wall_name(contact));
    }
    return fmt::format("held {} of grain {}", axis_names[static_cast<std::size_t>(contact.i % dimension)],
                       contact.i / dimension);
}

double gap(const Packing& packing, const Contact& contact) {
    if (contact.of_disks()) {
        return norm(separation(packing.layout(), packing.q, contact)) - zero_distance(packing, contact);
    }
    return contact.is_wall()
               ? wall_distance(packing.layout(), packing.q, contact) - touching_distance(packing.radius, contact)
               : 0;
}

GapGradient::Rate GapGradient::rate(const std::vector<double>& velocity, double from) const {
    Rate sum{from, std::abs(from)};
    for_each([&](std::size_t k, double component) {
        const double term = component * velocity[k];
        sum.value += term;
        sum.terms += std::abs(term);
    });
    return sum;
}

GapGradient gap_gradient(const Packing& packing, const Contact& contact) {
    PerAxis<double> normal; // without the sign; 1 for a wall
    normal.fill(1);
    if (contact.of_disks()) {
        normal = direction(separation(packing.layout(), packing.q, contact));
    }
    GapGradient g;
    Separation(contact, packing.layout()).for_each_coordinate([&](std::size_t coordinate, std::size_t a, int multiple) {
        const auto entry = static_cast<std::size_t>(g.count++);
        g.coordinate[entry] = static_cast<int>(coordinate);
        g.value[entry] = multiple * normal[a];
    });
    return g;
}

double gap_curvature(const Packing& packing, const Contact& contact, const double* v) {
    if (!contact.of_disks()) {
        return 0;
    }
    const PerAxis<double> d = separation(packing.layout(), packing.q, contact);
    const PerAxis<double> u = separation(packing.layout(), std::span(v, packing.q.size()), contact);
    const double length = norm(d);
    double speed = 0;
    double square = 0;
    for (std::size_t a = 0; a < most_axes; ++a) {
        speed += u[a] * d[a] / length;
        square += u[a] * u[a];
    }
    return (square - speed * speed) / length;
}

} // namespace isostat
