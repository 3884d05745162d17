#pragma once
// Gaps and their derivatives along a motion, inline for the inner loops: private to the room.

#include <isostat/contact/contact.hpp>

#include <cmath>
#include <optional>

namespace isostat {

/// Line of the centres of a pair of disks.
template <int Dim> struct CentreLine {
    std::array<double, Dim> d;
    double length;
};

/// Nothing for other contacts, and where squares under- or overflow: the general functions of the room contact serve.
template <int Dim> std::optional<CentreLine<Dim>> centre_line(const Packing<Dim>& at, const Contact& contact) {
    if (contact.kind != ContactKind::disk_disk) {
        return std::nullopt;
    }
    CentreLine<Dim> line;
    double square = 0;
    for (std::size_t a = 0; a < Dim; ++a) {
        line.d[a] =
            at.q[static_cast<std::size_t>(Dim * contact.j) + a] - at.q[static_cast<std::size_t>(Dim * contact.i) + a];
        square += line.d[a] * line.d[a];
    }
    line.length = std::sqrt(square);
    if (!(line.length > 0x1p-450 && line.length < 0x1p500)) {
        return std::nullopt;
    }
    return line;
}

template <int Dim> double gap_of(const Packing<Dim>& at, const Contact& contact, const CentreLine<Dim>& line) {
    return line.length -
           (at.radius[static_cast<std::size_t>(contact.i)] + at.radius[static_cast<std::size_t>(contact.j)]);
}

/// The same bits as `gap`.
template <int Dim> double quick_gap(const Packing<Dim>& at, const Contact& contact) {
    const auto line = centre_line(at, contact);
    return line ? gap_of(at, contact, *line) : gap(at, contact);
}

/// Rate of the gap along v (on coordinates) times the length of the line.
template <int Dim>
double along(const CentreLine<Dim>& line, const Contact& contact, const std::vector<double>& v, double& square) {
    double sum = 0;
    square = 0;
    for (std::size_t a = 0; a < Dim; ++a) {
        const double u =
            v[static_cast<std::size_t>(Dim * contact.j) + a] - v[static_cast<std::size_t>(Dim * contact.i) + a];
        sum += line.d[a] * u;
        square += u * u;
    }
    return sum;
}

template <int Dim> double rate_of(const CentreLine<Dim>& line, const Contact& contact, const std::vector<double>& v) {
    double square = 0;
    return along(line, contact, v, square) / line.length;
}

template <int Dim> double gap_rate(const Packing<Dim>& at, const Contact& contact, const std::vector<double>& v) {
    if (const auto line = centre_line(at, contact)) {
        return rate_of(*line, contact, v);
    }
    const GapGradient<Dim> g = gap_gradient(at, contact);
    double sum = 0;
    for (int k = 0; k < g.count; ++k) {
        const auto e = static_cast<std::size_t>(k);
        sum += g.value[e] * v[static_cast<std::size_t>(g.coordinate[e])];
    }
    return sum;
}

/// Second derivative of the gap along a velocity.
template <int Dim>
double quick_curvature(const Packing<Dim>& at, const Contact& contact, const std::vector<double>& v) {
    if (const auto line = centre_line(at, contact)) {
        double square = 0;
        const double rate = along(*line, contact, v, square) / line->length;
        return (square - rate * rate) / line->length;
    }
    return gap_curvature(at, contact, v.data());
}

/// Gap, and its first two derivatives along a curve with this velocity and acceleration.
struct GapCourse {
    double value, rate, bend;
};
template <int Dim>
GapCourse gap_course(const Packing<Dim>& at, const Contact& contact, const std::vector<double>& velocity,
                     const std::vector<double>& acceleration) {
    if (const auto line = centre_line(at, contact)) {
        double square = 0;
        double unused = 0;
        const double rate = along(*line, contact, velocity, square) / line->length;
        const double bend = along(*line, contact, acceleration, unused) / line->length;
        return {gap_of(at, contact, *line), rate, bend + (square - rate * rate) / line->length};
    }
    return {gap(at, contact), gap_rate(at, contact, velocity),
            gap_rate(at, contact, acceleration) + gap_curvature(at, contact, velocity.data())};
}

} // namespace isostat
