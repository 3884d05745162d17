#pragma once
// Certificates from plain approximations: Newton and dense LU factorisations in long double, brute force over pairs,
// zeros by size. Nothing here is rigorous, and nothing of it is shared with the checker: intervals are widened by a
// relative 1e-11, far more than the errors, so that the claims are true.

#include <isostat/io/certificate_file.hpp>

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <limits>

namespace maker {

using isostat::Certificate;
using isostat::Contact;
using isostat::ContactKind;
using isostat::Interval;
using isostat::State;
using Real = long double;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

inline constexpr double slack = 1e-11;

inline Interval around(Real value, Real width) {
    return {static_cast<double>(value - width), static_cast<double>(value + width)};
}

struct Approximation {
    explicit Approximation(const State<2>& s) : state(s), q(s.packing.q.begin(), s.packing.q.end()) {
        const auto& packing = s.packing;
        for (std::size_t k = 0; k < packing.q.size(); ++k) {
            const std::size_t disk = k / 2;
            const std::size_t behind = k - 2 * packing.radius.size();
            const auto& cell = packing.cell;
            const bool pinned = cell.any() && disk == static_cast<std::size_t>(cell.pin) && cell.periodic[k % 2];
            const bool moves = disk < packing.radius.size()
                                   ? !pinned && (packing.fixed.empty() || packing.fixed[disk] == 0)
                               : behind == 2           ? cell.tilt_moves[0]
                               : cell.periodic[behind] ? cell.period_moves[behind]
                                                       : packing.walls.upper[behind] == isostat::WallKind::movable;
            if (moves) {
                dof_coordinate.push_back(static_cast<int>(k));
            }
        }
    }
    const State<2>& state;
    std::vector<Real> q;
    std::vector<int> dof_coordinate;

    /// From the second disk, or its image, to the first.
    [[nodiscard]] std::array<Real, 2> between(const Contact& c) const {
        const auto i = static_cast<std::size_t>(c.i);
        const auto j = static_cast<std::size_t>(c.j);
        std::array<Real, 2> d{q[2 * i] - q[2 * j], q[2 * i + 1] - q[2 * j + 1]};
        if (state.packing.cell.any()) {
            const std::size_t cell = 2 * state.packing.radius.size();
            d[0] -= c.image.m[0] * q[cell] + c.image.m[1] * q[cell + 2];
            d[1] -= c.image.m[1] * q[cell + 1];
        }
        return d;
    }
    [[nodiscard]] Real gap(const Contact& c) const {
        const auto i = static_cast<std::size_t>(c.i);
        const auto j = static_cast<std::size_t>(c.j);
        const auto& r = state.packing.radius;
        if (c.kind == ContactKind::disk_disk) {
            const auto d = between(c);
            return std::hypot(d[0], d[1]) - (Real(r[i]) + Real(r[j]));
        }
        return (c.kind == ContactKind::lower_wall ? q[2 * i + j] : q[2 * r.size() + j] - q[2 * i + j]) - Real(r[i]);
    }
    /// Gradients of the gaps of the contacts, one row each.
    [[nodiscard]] Matrix gradient() const {
        const auto rows = static_cast<Eigen::Index>(state.contacts.size());
        Matrix all = Matrix::Zero(rows, static_cast<Eigen::Index>(q.size()));
        for (Eigen::Index l = 0; l < rows; ++l) {
            const Contact& c = state.contacts[static_cast<std::size_t>(l)];
            if (c.kind == ContactKind::disk_disk) {
                const std::array<Real, 2> d = between(c);
                const Real size = std::hypot(d[0], d[1]);
                const int cell = 2 * state.packing.disk_count();
                for (int a = 0; a < 2; ++a) {
                    const Real along = d[static_cast<std::size_t>(a)] / size;
                    all(l, 2 * c.i + a) += along;
                    all(l, 2 * c.j + a) -= along;
                    all(l, cell + a) -= c.image.m[static_cast<std::size_t>(a)] * along;
                }
                if (c.image.m[1] != 0) {
                    all(l, cell + 2) -= c.image.m[1] * d[0] / size;
                }
            } else if (c.kind == ContactKind::lower_wall) {
                all(l, 2 * c.i + c.j) = 1;
            } else {
                all(l, 2 * c.i + c.j) = -1;
                all(l, 2 * state.packing.disk_count() + c.j) = 1;
            }
        }
        Matrix own(rows, static_cast<Eigen::Index>(dof_coordinate.size()));
        for (std::size_t k = 0; k < dof_coordinate.size(); ++k) {
            own.col(static_cast<Eigen::Index>(k)) = all.col(dof_coordinate[k]);
        }
        return own;
    }
    void newton() {
        for (int step = 0; step < 6; ++step) {
            Vector gaps(static_cast<Eigen::Index>(state.contacts.size()));
            for (Eigen::Index l = 0; l < gaps.size(); ++l) {
                gaps(l) = gap(state.contacts[static_cast<std::size_t>(l)]);
            }
            const Vector move = gradient().partialPivLu().solve(gaps);
            for (std::size_t k = 0; k < dof_coordinate.size(); ++k) {
                q[static_cast<std::size_t>(dof_coordinate[k])] -= move(static_cast<Eigen::Index>(k));
            }
        }
    }
    /// Contact forces under a load given per coordinate.
    [[nodiscard]] Vector forces(const std::vector<Real>& load) const {
        Vector b(static_cast<Eigen::Index>(dof_coordinate.size()));
        for (std::size_t k = 0; k < dof_coordinate.size(); ++k) {
            b(static_cast<Eigen::Index>(k)) = -load[static_cast<std::size_t>(dof_coordinate[k])];
        }
        const Matrix balance = gradient().transpose();
        return balance.partialPivLu().solve(b);
    }
    [[nodiscard]] Real wall_force(int axis) const {
        const auto other = static_cast<std::size_t>(1 - axis);
        return state.load.kind == isostat::LoadKind::nominal ? Real(state.load.reference_length[other])
                                                             : q[2 * state.packing.radius.size() + other];
    }
    [[nodiscard]] std::vector<Real> per_coordinate(const std::vector<double>& disks) const {
        std::vector<Real> load(q.size(), 0);
        std::copy(disks.begin(), disks.end(), load.begin());
        return load;
    }
};

/// Every pair of grains that the box has, contacts included; in a cell those of images up to `far` periods away.
inline std::vector<Contact> all_pairs(const State<2>& state, int far = 4) {
    std::vector<Contact> pairs;
    const auto& walls = state.packing.walls;
    for (int i = 0; i < state.packing.disk_count(); ++i) {
        for (int a = 0; a < 2; ++a) {
            if (walls.lower[static_cast<std::size_t>(a)] != isostat::WallKind::absent) {
                pairs.push_back({ContactKind::lower_wall, i, a});
            }
            if (walls.upper[static_cast<std::size_t>(a)] != isostat::WallKind::absent) {
                pairs.push_back({ContactKind::upper_wall, i, a});
            }
        }
        const auto& periodic = state.packing.cell.periodic;
        const int along = periodic[0] ? far : 0;
        const int across = periodic[1] ? far : 0;
        for (int j = i; j < state.packing.disk_count(); ++j) {
            for (int m = -along; m <= along; ++m) {
                for (int p = -across; p <= across; ++p) {
                    const isostat::Image image{{static_cast<std::int8_t>(m), static_cast<std::int8_t>(p), 0}};
                    if (i < j || image > isostat::Image{}) {
                        pairs.push_back({ContactKind::disk_disk, i, j, image});
                    }
                }
            }
        }
    }
    return pairs;
}

inline isostat::LoadEndClaim load_end(const State<2>& state, const Vector& f, const Vector& u, int direction) {
    isostat::LoadEndClaim end{true, {}, {}};
    Real best = std::numeric_limits<Real>::infinity();
    const Real sigma = state.load.loaded_stress();
    const Real tiny = 1e-13L * u.lpNorm<Eigen::Infinity>();
    for (Eigen::Index l = 0; l < f.size(); ++l) {
        if (direction * u(l) < -tiny && -f(l) / (direction * u(l)) < best * (1 - 1e-12L)) {
            best = -f(l) / (direction * u(l));
            const Real stress = sigma + direction * best;
            end = {false, around(stress, slack * std::max<Real>(1, std::abs(stress))),
                   state.contacts[static_cast<std::size_t>(l)]};
        }
    }
    return end;
}

/// All claims about a state near an isostatic equilibrium.
inline Certificate certificate(const State<2>& state) {
    Certificate made;
    made.state = state;
    made.input = "state";
    made.input_hash = isostat::sha256("state");
    made.program = "approximations";
    Approximation at(state);
    at.newton();
    auto& claims = made.claims;

    const auto count = static_cast<int>(at.dof_coordinate.size());
    claims.counting =
        isostat::CountingClaim{count, static_cast<int>(state.contacts.size()), count, 0, 0, isostat::Rung::exact};
    Real moved = 0;
    for (std::size_t k = 0; k < at.q.size(); ++k) {
        moved = std::max(moved, std::abs(at.q[k] - Real(state.packing.q[k])));
    }
    const Matrix inverse = at.gradient().inverse();
    const Real norm = inverse.cwiseAbs().rowwise().sum().maxCoeff();
    const Real smallest_distance = (state.packing.cell.any() ? 0.5L : 2) * state.packing.min_radius();
    claims.vertex = isostat::VertexClaim{static_cast<double>(moved) * (1 + 1e-6) + 1e-15,
                                         static_cast<double>(smallest_distance / (10 * norm)), isostat::Rung::exact};

    std::vector<Real> load = at.per_coordinate(state.load.disk_force);
    std::vector<Real> unit(load.size(), 0);
    for (int a = 0; a < 2; ++a) {
        const auto wall = 2 * state.packing.radius.size() + static_cast<std::size_t>(a);
        load[wall] = -Real(state.load.stress[static_cast<std::size_t>(a)]) * at.wall_force(a);
        unit[wall] = a == state.load.loaded_axis ? -at.wall_force(a) : 0;
    }
    if (state.packing.cell.any()) {
        load.back() = -Real(state.load.shear[0]) * Real(state.load.reference_length[0]);
    }
    const Vector f = at.forces(load);
    const Vector u = at.forces(unit);
    const Vector g = at.forces(at.per_coordinate(state.load.infinitesimal));
    const Real large = f.lpNorm<Eigen::Infinity>();
    isostat::ForcesClaim forces;
    for (Eigen::Index l = 0; l < f.size(); ++l) {
        const bool zero = std::abs(f(l)) < 1e-13L * large;
        forces.finite.push_back(zero ? Interval{0, 0} : around(f(l), slack * f(l)));
        if (zero) {
            forces.structural_zeros.push_back(static_cast<int>(l));
            forces.infinitesimal.push_back(around(g(l), slack * std::abs(g(l))));
        }
    }
    claims.forces = forces;
    claims.load_interval =
        isostat::LoadIntervalClaim{load_end(state, f, u, -1), load_end(state, f, u, 1), isostat::Rung::exact};

    claims.gaps = isostat::GapsClaim{std::numeric_limits<double>::infinity(), {}, isostat::Rung::exact};
    const auto rigid = [&cell = state.packing.cell](const Contact& pair) { // a disk and its own image
        return pair.i == pair.j && pair.kind == ContactKind::disk_disk &&
               !(pair.image.m[0] != 0 && cell.period_moves[0]) &&
               !(pair.image.m[1] != 0 && (cell.period_moves[1] || cell.tilt_moves[0]));
    };
    const auto is_fixed = [&state](int i) {
        return !state.packing.fixed.empty() && state.packing.fixed[static_cast<std::size_t>(i)] != 0;
    };
    for (const Contact& pair : all_pairs(state)) {
        const bool listed = std::find(state.contacts.begin(), state.contacts.end(), pair) != state.contacts.end();
        const bool other_moves =
            pair.kind == ContactKind::disk_disk ? !is_fixed(pair.j)
            : pair.kind == ContactKind::upper_wall
                ? state.packing.walls.upper[static_cast<std::size_t>(pair.j)] == isostat::WallKind::movable
                : false;
        if (!listed && !rigid(pair) && (!is_fixed(pair.i) || other_moves) && at.gap(pair) < claims.gaps->smallest) {
            claims.gaps->smallest = static_cast<double>(at.gap(pair) * (1 - 1e-9L));
            claims.gaps->where = pair;
        }
    }
    claims.stable = true;
    return made;
}

} // namespace maker
