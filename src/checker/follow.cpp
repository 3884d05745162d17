#include "checker/follow.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace isostat::checker {

namespace {

/// The polynomial system of a contact list in double. One row may be replaced: the coordinate `fixed` keeps its value.
class System {
  public:
    System(const State<2>& state, std::vector<Contact> contacts)
        : packing_(state.packing), contacts_(std::move(contacts)) {
        for (std::size_t k = 0; k < packing_.q.size(); ++k) {
            const std::size_t disk = k / 2;
            const bool moves = disk < packing_.radius.size() ? packing_.fixed.empty() || packing_.fixed[disk] == 0
                                                             : packing_.walls.upper[k % 2] == WallKind::movable;
            dof_.push_back(moves ? static_cast<int>(coordinate_.size()) : -1);
            if (moves) {
                coordinate_.push_back(k);
            }
        }
    }
    [[nodiscard]] bool square() const { return contacts_.size() == coordinate_.size(); }

    /// Solves A x = b (per contact) at q; b in the place of row `replaced` belongs to the fixed coordinate.
    bool solve(const std::vector<double>& q, const Eigen::VectorXd& b, Eigen::VectorXd& x,
               std::optional<std::pair<std::size_t, int>> replaced) {
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            if (replaced && replaced->first == l) {
                entries.emplace_back(static_cast<int>(l), replaced->second, 1.0);
                continue;
            }
            const Contact& c = contacts_[l];
            const auto add = [&](int coordinate, double value) {
                const int dof = dof_[static_cast<std::size_t>(coordinate)];
                if (dof >= 0) {
                    entries.emplace_back(static_cast<int>(l), dof, value);
                }
            };
            if (c.kind == ContactKind::disk_disk) {
                for (int a = 0; a < 2; ++a) {
                    const double d =
                        q[static_cast<std::size_t>(2 * c.i + a)] - q[static_cast<std::size_t>(2 * c.j + a)];
                    add(2 * c.i + a, d);
                    add(2 * c.j + a, -d);
                }
            } else if (c.kind == ContactKind::held) {
                add(c.i, 1);
            } else if (c.kind == ContactKind::lower_wall) {
                add(2 * c.i + c.j, 1);
            } else {
                add(2 * c.i + c.j, -1);
                add(2 * packing_.disk_count() + c.j, 1);
            }
        }
        const auto n = static_cast<Eigen::Index>(contacts_.size());
        Eigen::SparseMatrix<double> matrix(n, n);
        matrix.setFromTriplets(entries.begin(), entries.end());
        Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> lu;
        lu.compute(matrix);
        if (lu.info() != Eigen::Success) {
            return false;
        }
        x = lu.solve(b);
        return x.allFinite();
    }
    [[nodiscard]] double value(const std::vector<double>& q, const Contact& c) const {
        const auto i = static_cast<std::size_t>(c.i);
        const auto j = static_cast<std::size_t>(c.j);
        const auto& r = packing_.radius;
        if (c.kind == ContactKind::held) {
            return q[i] - held_value(c);
        }
        if (c.kind == ContactKind::disk_disk) {
            const double dx = q[2 * i] - q[2 * j];
            const double dy = q[2 * i + 1] - q[2 * j + 1];
            const double sum = r[i] + r[j];
            return (dx * dx + dy * dy - sum * sum) / 2;
        }
        return (c.kind == ContactKind::lower_wall ? q[2 * i + j] : q[2 * r.size() + j] - q[2 * i + j]) - r[i];
    }
    /// A coordinate that becomes held at a value of its own.
    void hold(const Contact& c, double at) { fresh_ = {c, at}; }
    [[nodiscard]] double held_value(const Contact& c) const {
        return fresh_ && fresh_->first == c ? fresh_->second : packing_.q[static_cast<std::size_t>(c.i)];
    }

    /// Newton's iteration for all contacts, with the coordinate at its value in place of contact `replaced`.
    bool newton(std::vector<double>& q, std::optional<std::pair<std::size_t, int>> replaced) {
        double last = std::numeric_limits<double>::infinity();
        for (int step = 0; step < 30; ++step) {
            Eigen::VectorXd b(static_cast<Eigen::Index>(contacts_.size()));
            for (std::size_t l = 0; l < contacts_.size(); ++l) {
                const bool out = replaced && replaced->first == l;
                b(static_cast<Eigen::Index>(l)) = out ? 0.0 : -value(q, contacts_[l]);
            }
            Eigen::VectorXd x;
            if (!solve(q, b, x, replaced)) {
                return false;
            }
            for (std::size_t k = 0; k < coordinate_.size(); ++k) {
                q[coordinate_[k]] += x(static_cast<Eigen::Index>(k));
            }
            const double size = x.lpNorm<Eigen::Infinity>();
            if (size <= 0x1p-46 * scale() || (size >= last && size <= 0x1p-38 * scale())) {
                return true;
            }
            if (step > 3 && size >= last) {
                return false;
            }
            last = size;
        }
        return false;
    }
    [[nodiscard]] double scale() const { return packing_.max_radius(); }
    [[nodiscard]] std::size_t coordinate(int dof) const { return coordinate_[static_cast<std::size_t>(dof)]; }
    [[nodiscard]] std::size_t size() const { return coordinate_.size(); }

  private:
    const Packing<2>& packing_;
    std::optional<std::pair<Contact, double>> fresh_;
    std::vector<Contact> contacts_;
    std::vector<int> dof_;
    std::vector<std::size_t> coordinate_;
};

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
    System kept(from, from.contacts);
    std::vector<Contact> contacts = from.contacts;
    contacts[opened] = motion.closed;
    System end(from, contacts);
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
    const double reach = 0.2 * unit;
    std::vector<double> q = from.packing.q;
    std::vector<double> listed_at;
    std::vector<Contact> pairs;
    Eigen::VectorXd previous;
    bool powered = false;
    double power = 0;
    for (long k = 0; k < steps; ++k) {
        // The motion: contact `opened` opens in the first step; later it goes on in the same sense.
        Eigen::VectorXd b = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kept.size()));
        b(static_cast<Eigen::Index>(opened)) = motion.direction;
        Eigen::VectorXd v;
        if (!kept.solve(q, b, v, {})) {
            return {};
        }
        Eigen::Index fastest = 0;
        v /= v.cwiseAbs().maxCoeff(&fastest);
        if (previous.size() > 0 && v.dot(previous) < 0) {
            v = -v;
        }
        previous = v;
        double size = 0;
        power = 0;
        const std::vector<double> load_here = motion.power_load(q);
        for (std::size_t d = 0; d < kept.size(); ++d) {
            const double part = load_here[kept.coordinate(static_cast<int>(d))] * v(static_cast<Eigen::Index>(d));
            power += part;
            size += std::abs(part);
        }
        powered = powered || power > 1e-9 * size;
        std::vector<double> next = q;
        for (std::size_t d = 0; d < kept.size(); ++d) {
            next[kept.coordinate(static_cast<int>(d))] += step * v(static_cast<Eigen::Index>(d));
        }
        if (!kept.newton(next, std::pair{opened, static_cast<int>(fastest)})) {
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
            Eigen::VectorXd ahead;
            if (!kept.solve(next, b, ahead, {})) {
                return {};
            }
            if (ahead.dot(v) < 0) {
                ahead = -ahead;
            }
            double there = 0;
            const std::vector<double> load_there = motion.power_load(next);
            for (std::size_t d = 0; d < kept.size(); ++d) {
                there += load_there[kept.coordinate(static_cast<int>(d))] * ahead(static_cast<Eigen::Index>(d));
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
            if (!end.newton(q, {})) {
                return {};
            }
            for (std::size_t l = 0; l < contacts.size(); ++l) { // held means held, rounding apart
                if (contacts[l].kind == ContactKind::held) {
                    q[static_cast<std::size_t>(contacts[l].i)] = end.held_value(contacts[l]);
                }
            }
            return {q, {}};
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
