#pragma once
// The true vertex to 80 digits, by dense Newton iteration and elimination: nothing of the library is used but the
// types.

#include <isostat/contact/state.hpp>

#include <boost/multiprecision/cpp_dec_float.hpp>
#include <boost/test/unit_test.hpp>

#include <vector>

namespace reference {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_dec_float<100>, boost::multiprecision::et_off>;
using Vector = std::vector<Real>;
using Dense = std::vector<Vector>;
using isostat::Contact;
using isostat::ContactKind;
using isostat::State;

/// A x = b by Gauss elimination with partial pivoting.
inline Vector solve(Dense a, Vector b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < n; ++i) {
            pivot = abs(a[i][k]) > abs(a[pivot][k]) ? i : pivot;
        }
        BOOST_REQUIRE(abs(a[pivot][k]) > Real("1e-60"));
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const Real factor = a[i][k] / a[k][k];
            if (factor != 0) {
                for (std::size_t j = k; j < n; ++j) {
                    a[i][j] -= factor * a[k][j];
                }
                b[i] -= factor * b[k];
            }
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= a[k][k];
    }
    return b;
}

class Vertex {
  public:
    explicit Vertex(const State<2>& state) : state_(state), dofs_(state.packing) {
        for (const double x : state.packing.q) {
            q.emplace_back(x);
        }
        for (int iteration = 0; iteration < 12; ++iteration) {
            Vector f;
            for (const Contact& contact : state.contacts) {
                f.push_back(gap(contact));
            }
            const Vector step = solve(gradients(), f);
            for (std::size_t mu = 0; mu < step.size(); ++mu) {
                q[coordinate(mu)] -= step[mu];
            }
        }
        for (const Contact& contact : state.contacts) {
            BOOST_REQUIRE(abs(gap(contact)) <
                          Real("1e-80") * state.packing.radius[static_cast<std::size_t>(contact.i)]);
        }
    }

    Vector q; ///< coordinates, as in Packing

    [[nodiscard]] Real gap(const Contact& c) const {
        const Real ri(state_.packing.radius[static_cast<std::size_t>(c.i)]);
        switch (c.kind) {
        case ContactKind::disk_disk:
            return sqrt(d(c, 0) * d(c, 0) + d(c, 1) * d(c, 1)) -
                   (ri + Real(state_.packing.radius[static_cast<std::size_t>(c.j)]));
        case ContactKind::lower_wall: return at(2 * c.i + c.j) - ri;
        case ContactKind::upper_wall: return at(2 * state_.packing.disk_count() + c.j) - at(2 * c.i + c.j) - ri;
        case ContactKind::held: break;
        }
        return 0;
    }

    /// Forces at the loaded stress sigma (infinitesimal loads left out).
    [[nodiscard]] Vector forces(const Real& sigma) const {
        Vector load(state_.contacts.size(), Real(0));
        for (std::size_t k = 0; k < state_.load.disk_force.size(); ++k) {
            add(load, k, Real(state_.load.disk_force[k]));
        }
        const auto walls = static_cast<std::size_t>(2 * state_.packing.disk_count());
        for (std::size_t a = 0; a < 2; ++a) {
            const bool loaded = static_cast<int>(a) == state_.load.loaded_axis;
            const Real stress = loaded ? sigma : Real(state_.load.stress[a]);
            const Real length = state_.load.kind == isostat::LoadKind::nominal
                                    ? Real(state_.load.reference_length[1 - a])
                                    : q[walls + 1 - a];
            add(load, walls + a, -stress * length);
        }
        return solve(contact_matrix(), load);
    }
    [[nodiscard]] Vector forces() const { return forces(Real(state_.load.loaded_stress())); }
    [[nodiscard]] Vector infinitesimal() const {
        Vector load(state_.contacts.size(), Real(0));
        for (std::size_t k = 0; k < state_.load.infinitesimal.size(); ++k) {
            add(load, k, Real(state_.load.infinitesimal[k]));
        }
        return solve(contact_matrix(), load);
    }

    /// Where the first force that decreases with direction * sigma vanishes, and which; -1: none decreases by more
    /// than rounding to 80 digits.
    [[nodiscard]] std::pair<int, Real> limit(int direction) const {
        const Real sigma(state_.load.loaded_stress());
        const Real change = abs(Real(state_.load.stress[0])) + abs(Real(state_.load.stress[1]));
        const Vector f = forces();
        const Vector g = forces(sigma + change);
        int first = -1;
        Real nearest = 0;
        for (std::size_t l = 0; l < f.size(); ++l) {
            const Real rate = direction * (g[l] - f[l]) / change;
            if (rate < -Real("1e-70") && (first < 0 || f[l] / -rate < nearest)) {
                nearest = f[l] / -rate;
                first = static_cast<int>(l);
            }
        }
        return {first, sigma + direction * nearest};
    }

    /// Largest difference of a coordinate from the stored one.
    [[nodiscard]] Real distance() const {
        Real largest = 0;
        for (std::size_t k = 0; k < q.size(); ++k) {
            largest = std::max(largest, Real(abs(q[k] - Real(state_.packing.q[k]))));
        }
        return largest;
    }

  private:
    [[nodiscard]] const Real& at(int coordinate) const { return q[static_cast<std::size_t>(coordinate)]; }
    [[nodiscard]] Real d(const Contact& c, int axis) const { return at(2 * c.j + axis) - at(2 * c.i + axis); }
    [[nodiscard]] std::size_t coordinate(std::size_t mu) const {
        return static_cast<std::size_t>(dofs_.coordinate_of(static_cast<int>(mu)));
    }
    void add(Vector& on_dofs, std::size_t coordinate, const Real& value) const {
        if (dofs_.dof_of(coordinate) >= 0) {
            on_dofs[static_cast<std::size_t>(dofs_.dof_of(coordinate))] += value;
        }
    }
    /// Rows: gap gradients.
    [[nodiscard]] Dense gradients() const {
        Dense rows;
        for (const Contact& c : state_.contacts) {
            Vector row(state_.contacts.size(), Real(0));
            const auto k = [](int coordinate) { return static_cast<std::size_t>(coordinate); };
            if (c.kind == ContactKind::disk_disk) {
                const Real length = sqrt(d(c, 0) * d(c, 0) + d(c, 1) * d(c, 1));
                for (int a = 0; a < 2; ++a) {
                    add(row, k(2 * c.i + a), -d(c, a) / length);
                    add(row, k(2 * c.j + a), d(c, a) / length);
                }
            } else if (c.kind == ContactKind::lower_wall) {
                add(row, k(2 * c.i + c.j), Real(1));
            } else {
                add(row, k(2 * c.i + c.j), Real(-1));
                add(row, k(2 * state_.packing.disk_count() + c.j), Real(1));
            }
            rows.push_back(row);
        }
        return rows;
    }
    /// H: minus the transpose.
    [[nodiscard]] Dense contact_matrix() const {
        const Dense g = gradients();
        Dense h(g.size(), Vector(g.size()));
        for (std::size_t i = 0; i < g.size(); ++i) {
            for (std::size_t j = 0; j < g.size(); ++j) {
                h[i][j] = -g[j][i];
            }
        }
        return h;
    }

    const State<2>& state_;
    isostat::DofMap<2> dofs_;
};

} // namespace reference
