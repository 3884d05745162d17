#pragma once
// Gaps and their derivatives along a motion, inline for the inner loops: private to the room.

#include "contact/separation.hpp"

#include <cmath>
#include <optional>

namespace isostat {

/// Line of the centres of a pair of disks.
template <int Dim> struct CentreLine {
    std::array<double, Dim> d;
    double length;
};

/// Nothing for other contacts, and where squares under- or overflow: the general functions of the room contact serve.
template <int Dim> inline std::optional<CentreLine<Dim>> centre_line(const Packing<Dim>& at, const Contact& contact) {
    if (contact.kind != ContactKind::disk_disk) {
        return std::nullopt;
    }
    CentreLine<Dim> line{separation<Dim>(at.q, contact), 0};
    double square = 0;
    for (const double component : line.d) {
        square += component * component;
    }
    line.length = std::sqrt(square);
    if (!(line.length > 0x1p-450 && line.length < 0x1p500)) {
        return std::nullopt;
    }
    return line;
}

template <int Dim> inline double gap_of(const Packing<Dim>& at, const Contact& contact, const CentreLine<Dim>& line) {
    return line.length - touching_distance(at.radius, contact);
}

/// The same bits as `gap`.
template <int Dim> inline double quick_gap(const Packing<Dim>& at, const Contact& contact) {
    const auto line = centre_line(at, contact);
    return line ? gap_of(at, contact, *line) : gap(at, contact);
}

/// Rate of the gap along v (on coordinates) times the length of the line.
template <int Dim>
inline double along(const CentreLine<Dim>& line, const Contact& contact, const std::vector<double>& v, double& square) {
    const std::array<double, Dim> relative = separation<Dim>(v, contact);
    double sum = 0;
    square = 0;
    for (std::size_t a = 0; a < Dim; ++a) {
        sum += line.d[a] * relative[a];
        square += relative[a] * relative[a];
    }
    return sum;
}

template <int Dim>
inline double rate_of(const CentreLine<Dim>& line, const Contact& contact, const std::vector<double>& v) {
    double square = 0;
    return along(line, contact, v, square) / line.length;
}

template <int Dim>
inline double gap_rate(const Packing<Dim>& at, const Contact& contact, const std::vector<double>& v) {
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
inline double quick_curvature(const Packing<Dim>& at, const Contact& contact, const std::vector<double>& v) {
    if (const auto line = centre_line(at, contact)) {
        double square = 0;
        const double rate = along(*line, contact, v, square) / line->length;
        return (square - rate * rate) / line->length;
    }
    return gap_curvature(at, contact, v.data());
}

/// Separation over a contact of any kind: all components for two disks, else the first one, of a wall or a coordinate.
template <int Dim>
inline std::array<double, Dim> separation_over(const std::vector<double>& x, const Contact& contact) {
    std::array<double, Dim> d{};
    switch (contact.kind) {
    case ContactKind::disk_disk: return separation<Dim>(x, contact);
    case ContactKind::lower_wall:
    case ContactKind::upper_wall: d[0] = wall_distance<Dim>(x, contact); break;
    case ContactKind::held: d[0] = x[static_cast<std::size_t>(contact.i)]; break;
    }
    return d;
}

/// Gap, and its first two derivatives along a curve with this velocity and acceleration.
struct GapCourse {
    double value, rate, bend;
};
template <int Dim>
inline GapCourse gap_course(const Packing<Dim>& at, const Contact& contact, const std::vector<double>& velocity,
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
