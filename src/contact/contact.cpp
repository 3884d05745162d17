#include <isostat/contact/contact.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

constexpr std::array<const char*, 3> lower_name{"left", "bottom", "back"};
constexpr std::array<const char*, 3> upper_name{"right", "top", "front"};
constexpr std::array<const char*, 3> axis_name{"x", "y", "z"};

template <int Dim> std::array<double, Dim> centre_line(const Packing<Dim>& packing, const Contact& contact) {
    std::array<double, Dim> d{};
    for (std::size_t a = 0; a < Dim; ++a) {
        d[a] = packing.q[static_cast<std::size_t>(Dim * contact.j) + a] -
               packing.q[static_cast<std::size_t>(Dim * contact.i) + a];
    }
    return d;
}

template <int Dim> double plain_norm(const std::array<double, Dim>& d) {
    double square = 0;
    for (const double c : d) {
        square += c * c;
    }
    return std::sqrt(square);
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

template <int Dim> std::string to_string(const Contact& contact) {
    const auto axis = static_cast<std::size_t>(contact.kind == ContactKind::disk_disk ? 0 : contact.j);
    switch (contact.kind) {
    case ContactKind::disk_disk: return fmt::format("{}-{}", contact.i, contact.j);
    case ContactKind::lower_wall: return fmt::format("{}-{}", contact.i, lower_name[axis]);
    case ContactKind::upper_wall: return fmt::format("{}-{}", contact.i, upper_name[axis]);
    case ContactKind::held:
        return fmt::format("held {} of grain {}", axis_name[static_cast<std::size_t>(contact.i % Dim)],
                           contact.i / Dim);
    }
    return {};
}

template <int Dim> double gap(const Packing<Dim>& packing, const Contact& contact) {
    const auto i = static_cast<std::size_t>(contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    switch (contact.kind) {
    case ContactKind::disk_disk:
        return norm<Dim>(centre_line(packing, contact)) - (packing.radius[i] + packing.radius[j]);
    case ContactKind::lower_wall: return packing.q[Dim * i + j] - packing.radius[i];
    case ContactKind::upper_wall: return packing.length(contact.j) - packing.q[Dim * i + j] - packing.radius[i];
    case ContactKind::held: return 0;
    }
    return 0;
}

template <int Dim> GapGradient<Dim> gap_gradient(const Packing<Dim>& packing, const Contact& contact) {
    GapGradient<Dim> g;
    if (contact.kind == ContactKind::disk_disk) {
        const std::array<double, Dim> d = centre_line(packing, contact);
        const double length = plain_norm<Dim>(d);
        if (in_range(length)) {
            for (int a = 0; a < Dim; ++a) {
                const auto k = static_cast<std::size_t>(a);
                const double normal = d[k] / length;
                g.coordinate[k] = Dim * contact.i + a;
                g.coordinate[Dim + k] = Dim * contact.j + a;
                g.value[k] = -normal;
                g.value[Dim + k] = normal;
            }
            g.count = 2 * Dim;
            return g;
        }
    }
    const auto add = [&g](int coordinate, double value) {
        g.coordinate[static_cast<std::size_t>(g.count)] = coordinate;
        g.value[static_cast<std::size_t>(g.count)] = value;
        ++g.count;
    };
    switch (contact.kind) {
    case ContactKind::disk_disk: {
        std::array<double, Dim> d = centre_line(packing, contact);
        normalise<Dim>(d); // squares under- or overflow
        const double length = plain_norm<Dim>(d);
        for (int a = 0; a < Dim; ++a) {
            add(Dim * contact.i + a, -d[static_cast<std::size_t>(a)] / length);
        }
        for (int a = 0; a < Dim; ++a) {
            add(Dim * contact.j + a, d[static_cast<std::size_t>(a)] / length);
        }
        break;
    }
    case ContactKind::lower_wall: add(Dim * contact.i + contact.j, 1); break;
    case ContactKind::upper_wall:
        add(Dim * contact.i + contact.j, -1);
        add(Dim * packing.disk_count() + contact.j, 1);
        break;
    case ContactKind::held: add(contact.i, 1); break;
    }
    return g;
}

template <int Dim> double gap_curvature(const Packing<Dim>& packing, const Contact& contact, const double* v) {
    if (contact.kind != ContactKind::disk_disk) {
        return 0;
    }
    const std::array<double, Dim> d = centre_line(packing, contact);
    const double length = norm<Dim>(d);
    double speed = 0;
    double square = 0;
    for (std::size_t a = 0; a < Dim; ++a) {
        const double u =
            v[static_cast<std::size_t>(Dim * contact.j) + a] - v[static_cast<std::size_t>(Dim * contact.i) + a];
        speed += u * d[a] / length;
        square += u * u;
    }
    return (square - speed * speed) / length;
}

template std::string to_string<2>(const Contact&);
template double gap<2>(const Packing<2>&, const Contact&);
template GapGradient<2> gap_gradient<2>(const Packing<2>&, const Contact&);
template double gap_curvature<2>(const Packing<2>&, const Contact&, const double*);

} // namespace isostat
