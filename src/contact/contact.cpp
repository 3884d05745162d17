#include "contact/separation.hpp"

#include <isostat/contact/contact.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace isostat {

namespace {

constexpr std::array<const char*, 3> lower_name{"left", "bottom", "back"};
constexpr std::array<const char*, 3> upper_name{"right", "top", "front"};
constexpr std::array<const char*, 3> axis_name{"x", "y", "z"};

template <int Dim> double plain_norm(const std::array<double, Dim>& d) {
    double square = 0;
    for (const double c : d) {
        square += c * c;
    }
    return std::sqrt(square);
}

/// "(1,-1)", or nothing.
template <int Dim> std::string image_text(const Image& image) {
    std::string text;
    for (std::size_t a = 0; a < Dim && !image.is_here(); ++a) {
        text += fmt::format("{}{}", a == 0 ? "(" : ",", static_cast<int>(image.m[a]));
    }
    return text.empty() ? text : text + ")";
}

/// No square of a component that matters under- or overflows.
bool in_range(double norm) {
    return norm > 0x1p-450 && norm < 0x1p500;
}

/// Multiplies d by a power of two, exactly, so that its largest component is in [1/2, 1); returns the exponent that
/// goes back.
template <int Dim> int normalise(std::array<double, Dim>& d) {
    double largest = 0;
    for (const double c : d) {
        largest = std::max(largest, std::abs(c));
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (double& c : d) {
        c = std::ldexp(c, -exponent);
    }
    return exponent;
}

template <int Dim> double norm(std::array<double, Dim> d) {
    const double plain = plain_norm<Dim>(d);
    if (in_range(plain)) {
        return plain;
    }
    const int exponent = normalise<Dim>(d);
    return std::ldexp(plain_norm<Dim>(d), exponent);
}

} // namespace

template <int Dim> std::array<double, Dim> direction(std::array<double, Dim> d) {
    double length = plain_norm<Dim>(d);
    if (!in_range(length)) {
        normalise<Dim>(d); // squares under- or overflow
        length = plain_norm<Dim>(d);
    }
    for (double& component : d) {
        component /= length;
    }
    return d;
}

template <int Dim> std::string to_string(const Contact& contact) {
    const auto axis = static_cast<std::size_t>(contact.kind == ContactKind::disk_disk ? 0 : contact.j);
    switch (contact.kind) {
    case ContactKind::disk_disk: return fmt::format("{}-{}{}", contact.i, contact.j, image_text<Dim>(contact.image));
    case ContactKind::lower_wall: return fmt::format("{}-{}", contact.i, lower_name[axis]);
    case ContactKind::upper_wall: return fmt::format("{}-{}", contact.i, upper_name[axis]);
    case ContactKind::held:
        return fmt::format("held {} of grain {}", axis_name[static_cast<std::size_t>(contact.i % Dim)],
                           contact.i / Dim);
    }
    return {};
}

template <int Dim> double gap(const Packing<Dim>& packing, const Contact& contact) {
    switch (contact.kind) {
    case ContactKind::disk_disk:
        return norm<Dim>(separation<Dim>(packing.q, contact)) - touching_distance(packing.radius, contact);
    case ContactKind::lower_wall:
    case ContactKind::upper_wall:
        return wall_distance<Dim>(packing.q, contact) - touching_distance(packing.radius, contact);
    case ContactKind::held: return 0;
    }
    return 0;
}

template <int Dim> GapGradient<Dim> gap_gradient(const Packing<Dim>& packing, const Contact& contact) {
    std::array<double, Dim> normal; // but for the sign; of a wall 1
    normal.fill(1);
    if (contact.kind == ContactKind::disk_disk) {
        normal = direction<Dim>(separation<Dim>(packing.q, contact));
    }
    GapGradient<Dim> g;
    Separation<Dim>(contact, packing.disk_count())
        .for_each_coordinate([&](std::size_t coordinate, std::size_t a, int multiple) {
            const auto entry = static_cast<std::size_t>(g.count++);
            g.coordinate[entry] = static_cast<int>(coordinate);
            g.value[entry] = multiple * normal[a];
        });
    return g;
}

template <int Dim> double gap_curvature(const Packing<Dim>& packing, const Contact& contact, const double* v) {
    if (contact.kind != ContactKind::disk_disk) {
        return 0;
    }
    const std::array<double, Dim> d = separation<Dim>(packing.q, contact);
    const std::array<double, Dim> u = separation<Dim>(std::span(v, packing.q.size()), contact);
    const double length = norm<Dim>(d);
    double speed = 0;
    double square = 0;
    for (std::size_t a = 0; a < Dim; ++a) {
        speed += u[a] * d[a] / length;
        square += u[a] * u[a];
    }
    return (square - speed * speed) / length;
}

template std::array<double, 2> direction<2>(std::array<double, 2>);
template std::string to_string<2>(const Contact&);
template double gap<2>(const Packing<2>&, const Contact&);
template GapGradient<2> gap_gradient<2>(const Packing<2>&, const Contact&);
template double gap_curvature<2>(const Packing<2>&, const Contact&, const double*);

} // namespace isostat
