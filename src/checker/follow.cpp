#include "checker/follow.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

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
        if (c.kind == ContactKind::disk_disk) {
            const double dx = q[2 * i] - q[2 * j];
            const double dy = q[2 * i + 1] - q[2 * j + 1];
            const double sum = r[i] + r[j];
            return (dx * dx + dy * dy - sum * sum) / 2;
        }
        return (c.kind == ContactKind::lower_wall ? q[2 * i + j] : q[2 * r.size() + j] - q[2 * i + j]) - r[i];
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
    std::vector<Contact> contacts_;
    std::vector<int> dof_;
    std::vector<std::size_t> coordinate_;
};

} // namespace

std::optional<std::vector<double>> follow(const State<2>& from, std::size_t opened, const Contact& closed,
                                          double distance) {
    System kept(from, from.contacts);
    std::vector<Contact> contacts = from.contacts;
    contacts[opened] = closed;
    System end(from, contacts);
    if (!kept.square() || !(distance > 0) || !std::isfinite(distance)) {
        return {};
    }
    const double step = std::min(distance / 4, 0.02 * from.packing.min_radius());
    const auto steps = static_cast<long>(std::min(8 * distance / step + 16, 1e5));
    std::vector<double> q = from.packing.q;
    Eigen::VectorXd previous;
    for (long k = 0; k < steps; ++k) {
        // The motion: contact `opened` opens in the first step; later it goes on in the same sense.
        Eigen::VectorXd b = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kept.size()));
        b(static_cast<Eigen::Index>(opened)) = 1;
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
        std::vector<double> next = q;
        for (std::size_t d = 0; d < kept.size(); ++d) {
            next[kept.coordinate(static_cast<int>(d))] += step * v(static_cast<Eigen::Index>(d));
        }
        if (!kept.newton(next, std::pair{opened, static_cast<int>(fastest)})) {
            return {};
        }
        const double before = kept.value(q, closed);
        const double after = kept.value(next, closed);
        if (after <= 0) {
            const double part = before > 0 ? before / (before - after) : 1;
            for (std::size_t i = 0; i < q.size(); ++i) {
                q[i] += part * (next[i] - q[i]);
            }
            if (!end.newton(q, {})) {
                return {};
            }
            return q;
        }
        q = std::move(next);
    }
    return {};
}

} // namespace isostat::checker
