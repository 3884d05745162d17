#include "checker/follow.hpp"

#include "checker/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace isostat::checker {

namespace {

/// Pairs of grains that may touch before a coordinate has moved by `reach`.
std::vector<Contact> near_pairs(const Packing<2>& packing, const std::vector<double>& q, double reach) {
    std::vector<Contact> pairs;
    const auto n = packing.radius.size();
    const auto fixed = [&](std::size_t i) { return !packing.fixed.empty() && packing.fixed[i] != 0; };
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return q[2 * i] < q[2 * j]; });
    const double widest = 2 * packing.max_radius() + 3 * reach;
    for (std::size_t p = 0; p < n; ++p) {
        const std::size_t i = order[p];
        for (std::size_t k = p + 1; k < n && q[2 * order[k]] - q[2 * i] < widest; ++k) {
            const std::size_t j = order[k];
            if (std::abs(q[2 * i + 1] - q[2 * j + 1]) >= widest) {
                continue;
            }
            const double distance = std::hypot(q[2 * i] - q[2 * j], q[2 * i + 1] - q[2 * j + 1]);
            if (distance - packing.radius[i] - packing.radius[j] < 3 * reach && !(fixed(i) && fixed(j))) {
                pairs.push_back(
                    {ContactKind::disk_disk, static_cast<int>(std::min(i, j)), static_cast<int>(std::max(i, j))});
            }
        }
        for (std::size_t a = 0; a < 2 && !fixed(i); ++a) {
            if (packing.walls.lower[a] != WallKind::absent && q[2 * i + a] - packing.radius[i] < 3 * reach) {
                pairs.push_back({ContactKind::lower_wall, static_cast<int>(i), static_cast<int>(a)});
            }
            if (packing.walls.upper[a] != WallKind::absent &&
                q[2 * n + a] - q[2 * i + a] - packing.radius[i] < 3 * reach) {
                pairs.push_back({ContactKind::upper_wall, static_cast<int>(i), static_cast<int>(a)});
            }
        }
    }
    return pairs;
}

/// The gap of a pair.
double gap_at(const Packing<2>& packing, const std::vector<double>& q, const Contact& c) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    const auto& r = packing.radius;
    if (c.kind == ContactKind::disk_disk) {
        return std::hypot(q[2 * i] - q[2 * j], q[2 * i + 1] - q[2 * j + 1]) - r[i] - r[j];
    }
    return (c.kind == ContactKind::lower_wall ? q[2 * i + j] : q[2 * r.size() + j] - q[2 * i + j]) - r[i];
}

} // namespace

Followed follow(const State<2>& from, const Motion& motion) {
    const bool turns = motion.closed.kind == ContactKind::held;
    const std::size_t opened = motion.opened;
    System kept(from.packing, from.contacts, motion.solver);
    std::vector<Contact> contacts = from.contacts;
    contacts[opened] = motion.closed;
    System end(from.packing, contacts);
    if (turns) {
        end.hold(motion.closed, motion.held_at);
    }
    if (!kept.square() || !(motion.displacement > 0) || !std::isfinite(motion.displacement)) {
        return {};
    }
    const double unit = from.packing.min_radius();
    const double step = std::min(motion.displacement / 4, motion.step * unit);
    const auto steps = static_cast<long>(std::min(8 * motion.displacement / step + 16, 1e5));
    const double tolerance = 1e-9 * unit; // of gaps that are looked at, not proved
    constexpr double between = 0x1p-40;   // accuracy of the points on the way
    const double reach = 0.2 * unit;
    std::vector<double> q = from.packing.q;
    std::vector<double> listed_at;
    std::vector<Contact> pairs;
    Eigen::VectorXd opening; // the motion on which the gap alone grows
    Eigen::VectorXd previous;
    bool powered = false;
    double power = 0;
    for (long k = 0; k < steps; ++k) {
        // The motion: contact `opened` opens in the first step; later it goes on in the same sense.
        if (!kept.motion(q, opened, opening)) {
            return {};
        }
        Eigen::Index fastest = 0;
        Eigen::VectorXd v = motion.direction * opening / opening.cwiseAbs().maxCoeff(&fastest);
        if (previous.size() > 0 && v.dot(previous) < 0) {
            v = -v;
        }
        previous = v;
        double size = 0;
        power = 0;
        const std::vector<double> load_here = motion.power_load(q);
        for (std::size_t d = 0; d < kept.size(); ++d) {
            const double part = load_here[kept.coordinate(d)] * v(static_cast<Eigen::Index>(d));
            power += part;
            size += std::abs(part);
        }
        powered = powered || power > 1e-9 * size;
        std::vector<double> next = q;
        for (std::size_t d = 0; d < kept.size(); ++d) {
            next[kept.coordinate(d)] += step * v(static_cast<Eigen::Index>(d));
        }
        if (!kept.newton(next, System::Way{opened, fastest}, between)) {
            return {};
        }
        double moved = listed_at.empty() ? reach : 0;
        for (std::size_t c = 0; c < listed_at.size(); ++c) {
            moved = std::max(moved, std::abs(next[c] - listed_at[c]));
        }
        if (moved >= reach) {
            pairs = near_pairs(from.packing, q, 2 * reach);
            listed_at = q;
        }
        bool closes = false;
        if (turns) {
            // The power at the next point, with the motion there.
            if (!kept.motion(next, opened, opening)) {
                return {};
            }
            Eigen::VectorXd ahead = opening;
            if (ahead.dot(v) < 0) {
                ahead = -ahead;
            }
            double there = 0;
            const std::vector<double> load_there = motion.power_load(next);
            for (std::size_t d = 0; d < kept.size(); ++d) {
                there += load_there[kept.coordinate(d)] * ahead(static_cast<Eigen::Index>(d));
            }
            closes = powered && there <= 0;
            if (closes) {
                const auto c = static_cast<std::size_t>(motion.closed.i);
                const double way = next[c] - q[c];
                // The turn is within this step, or next to it as far as the power is rounded.
                const double room = std::abs(way) + tolerance;
                if (motion.held_at < std::min(q[c], next[c]) - room ||
                    motion.held_at > std::max(q[c], next[c]) + room) {
                    return {{},
                            fmt::format("the power of the load turns near {}, but {} is held at {}", q[c],
                                        to_string<2>(motion.closed), motion.held_at)};
                }
                const double part = way != 0 ? (motion.held_at - q[c]) / way : 0;
                for (std::size_t i = 0; i < q.size(); ++i) {
                    q[i] += std::clamp(part, 0.0, 1.0) * (next[i] - q[i]);
                }
            }
        } else {
            if (powered && power < -1e-6 * size) {
                return {{},
                        fmt::format("the power of the load vanishes before {} closes", to_string<2>(motion.closed))};
            }
            const double before = kept.value(q, motion.closed);
            const double after = kept.value(next, motion.closed);
            // The opened contact itself, or one that touched from the start, must have opened first.
            const bool from_start = k == 0 && (motion.closed == from.contacts[opened] ||
                                               std::find(motion.touching.begin(), motion.touching.end(),
                                                         motion.closed) != motion.touching.end());
            closes = after <= 0 && !from_start;
            if (closes) {
                const double part = before > 0 ? before / (before - after) : 1;
                for (std::size_t i = 0; i < q.size(); ++i) {
                    q[i] += part * (next[i] - q[i]);
                }
            }
        }
        if (closes) {
            if (!end.newton(q, {}, 0x1p-46)) {
                return {};
            }
            for (std::size_t l = 0; l < contacts.size(); ++l) { // held means held, rounding apart
                if (contacts[l].kind == ContactKind::held) {
                    q[static_cast<std::size_t>(contacts[l].i)] = end.held_value(contacts[l]);
                }
            }
            return {q, {}, end.solver()};
        }
        for (const Contact& pair : pairs) {
            if (pair == motion.closed || gap_at(from.packing, next, pair) >= -tolerance ||
                (std::find(from.contacts.begin(), from.contacts.end(), pair) != from.contacts.end() &&
                 pair != from.contacts[opened])) {
                continue;
            }
            return {{}, fmt::format("{} close before {}", to_string<2>(pair), to_string<2>(motion.closed))};
        }
        q = std::move(next);
    }
    return {};
}

} // namespace isostat::checker
