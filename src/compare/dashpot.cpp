#include "compare/frame.hpp"
#include "core/dot.hpp"

#include <Eigen/QR>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::compare {

namespace {

/// The speed of a wall is at most this times the speed of the fastest disk.
constexpr double fast_wall = 10;
/// Largest residual of the least squares, as a share of the largest force of a dashpot, because other programs store
/// velocities of half a step later.
constexpr double left_over = 0.1;

/// The weight w for one `power` of radii; with `hertz` times the root of the overlap and of R_i R_j / (R_i + R_j).
double weight(const Packing& packing, const Contact& c, int power, bool hertz) {
    const double r = packing.radius[static_cast<std::size_t>(c.i)];
    const double s = c.of_disks() ? packing.radius[static_cast<std::size_t>(c.j)] : HUGE_VAL;
    const auto reduced = [&](int p) {
        const double a = std::pow(r, p), b = std::pow(s, p);
        return std::isinf(b) ? a : a * b / (a + b);
    };
    const double mass = power == 0 ? 1 : reduced(power);
    return hertz ? mass * std::sqrt(std::max(0.0, -gap(packing, c)) * reduced(1)) : mass;
}

/// One row per contact: the force that a constant of 1 makes of the velocities of the disks, then the force of a speed
/// of 1 of each coordinate beyond the disks.
Eigen::MatrixXd equations(const Frame& frame, const std::map<Contact, double>& beyond, int power, bool hertz) {
    const Packing& packing = frame.packing;
    const std::size_t disks = packing.length_at(0);
    Eigen::MatrixXd a =
        Eigen::MatrixXd::Zero(static_cast<int>(beyond.size()), 1 + static_cast<int>(packing.q.size() - disks));
    int row = 0;
    for (const auto& [contact, force] : beyond) {
        const double w = weight(packing, contact, power, hertz);
        gap_gradient(packing, contact).for_each([&](std::size_t k, double g) {
            const double value = -w * g;
            if (k < disks) {
                a(row, 0) += value * frame.velocity[k];
            } else {
                a(row, 1 + static_cast<int>(k - disks)) += value;
            }
        });
        ++row;
    }
    return a;
}

} // namespace

std::string Dashpot::words() const {
    return fmt::format("the forces are those of the law and of a dashpot, {:.4g} times the speed{}", constant,
                       power == 0 ? "" : fmt::format(" and the reduced mass (R^{})", power));
}

std::optional<Dashpot> find_dashpot(const Frame& frame, const std::map<Contact, double>& beyond, ForceLaw law,
                                    double allowance) {
    if (frame.velocity.empty() || beyond.empty()) {
        return std::nullopt;
    }
    Eigen::VectorXd b(static_cast<int>(beyond.size()));
    std::ranges::transform(beyond, b.begin(), [](const auto& entry) { return entry.second; });
    const double fastest = largest(frame.velocity);
    double least = allowance + left_over * b.cwiseAbs().maxCoeff();
    std::optional<Dashpot> out;
    for (const bool hertz : {false, true}) {
        for (const int power : {3, 2, 0}) {
            const Eigen::MatrixXd a = equations(frame, beyond, power, hertz);
            if ((hertz && law != ForceLaw::hertz) || a.rows() < 2 * a.cols()) {
                continue;
            }
            const Eigen::VectorXd x = a.colPivHouseholderQr().solve(b);
            const double sides = x.tail(x.size() - 1).cwiseAbs().maxCoeff();
            const double off = (a * x - b).cwiseAbs().maxCoeff();
            if (x[0] > 0 && sides <= fast_wall * x[0] * fastest && off <= least) {
                least = off;
                out = Dashpot{x[0], power};
            }
        }
    }
    return out;
}

} // namespace isostat::compare
