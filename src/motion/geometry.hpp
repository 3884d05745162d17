#pragma once
// Gaps and their derivatives along a motion, inline for the inner loops: private to the room.

#include "contact/separation.hpp"

#include <cmath>
#include <optional>

namespace isostat {

/// a . b. In the plane inner loops leave out the third components, which are 0.
inline double dot(const Layout& layout, const PerAxis<double>& a, const PerAxis<double>& b) {
    const double sum = a[0] * b[0] + a[1] * b[1];
    return layout.dimension > plane ? sum + a[2] * b[2] : sum;
}

/// Line of the centres of a pair of disks.
struct CentreLine {
    PerAxis<double> d;
    double length;
};

/// Empty for other contacts, and where squares under- or overflow: then the functions of the room contact are used.
inline std::optional<CentreLine> centre_line(const Packing& at, const Contact& contact) {
    if (!contact.of_disks()) {
        return std::nullopt;
    }
    CentreLine line{separation(at.layout(), at.q, contact), 0};
    line.length = std::sqrt(dot(at.layout(), line.d, line.d));
    if (!(line.length > 0x1p-450 && line.length < 0x1p500)) { // precision.md B13
        return std::nullopt;
    }
    return line;
}

inline double gap_of(const Packing& at, const Contact& contact, const CentreLine& line) {
    return line.length - zero_distance(at, contact);
}

/// The same bits as `gap`.
inline double quick_gap(const Packing& at, const Contact& contact) {
    const auto line = centre_line(at, contact);
    return line ? gap_of(at, contact, *line) : gap(at, contact);
}

/// Rate of the gap along v (on coordinates) times the length of the line.
inline double along(const Layout& layout, const CentreLine& line, const Contact& contact, const std::vector<double>& v,
                    double& square) {
    const PerAxis<double> relative = separation(layout, v, contact);
    square = dot(layout, relative, relative);
    return dot(layout, line.d, relative);
}

inline double rate_of(const Layout& layout, const CentreLine& line, const Contact& contact,
                      const std::vector<double>& v) {
    double square = 0;
    return along(layout, line, contact, v, square) / line.length;
}

inline double gap_rate(const Packing& at, const Contact& contact, const std::vector<double>& v) {
    if (const auto line = centre_line(at, contact)) {
        return rate_of(at.layout(), *line, contact, v);
    }
    return gap_gradient(at, contact).rate(v).value;
}

/// Second derivative of the gap along a velocity.
inline double quick_curvature(const Packing& at, const Contact& contact, const std::vector<double>& v) {
    if (const auto line = centre_line(at, contact)) {
        double square = 0;
        const double rate = along(at.layout(), *line, contact, v, square) / line->length;
        return (square - rate * rate) / line->length;
    }
    return gap_curvature(at, contact, v.data());
}

/// Separation over a contact of any kind: all components for two disks, else one component, of a wall or a coordinate.
inline PerAxis<double> separation_over(const Layout& layout, const std::vector<double>& x, const Contact& contact) {
    if (contact.of_disks()) {
        return separation(layout, x, contact);
    }
    return {contact.is_wall() ? wall_distance(layout, x, contact) : x[static_cast<std::size_t>(contact.i)]};
}

/// Gap, and its first two derivatives along a curve with this velocity and acceleration.
struct GapCourse {
    double value, rate, bend;
};
inline GapCourse gap_course(const Packing& at, const Contact& contact, const std::vector<double>& velocity,
                            const std::vector<double>& acceleration) {
    if (const auto line = centre_line(at, contact)) {
        double square = 0;
        double unused = 0;
        const double rate = along(at.layout(), *line, contact, velocity, square) / line->length;
        const double bend = along(at.layout(), *line, contact, acceleration, unused) / line->length;
        return {gap_of(at, contact, *line), rate, bend + (square - rate * rate) / line->length};
    }
    return {gap(at, contact), gap_rate(at, contact, velocity),
            gap_rate(at, contact, acceleration) + gap_curvature(at, contact, velocity.data())};
}

} // namespace isostat
