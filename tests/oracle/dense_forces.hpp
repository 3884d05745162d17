#pragma once
// Forces at the vertex that a stored configuration stands for, by Newton and dense elimination in 400 bits: no code in
// common with the program but the meaning of a contact.

#include <isostat/contact/state.hpp>

#include <boost/multiprecision/mpfr.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace isostat::oracle {

using Real =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<120>, boost::multiprecision::et_off>;

using Vector = std::vector<Real>;
using Matrix = std::vector<Vector>;

/// One row per contact: its gap's derivative with respect to every coordinate of q; the gaps go to `gaps`.
inline Matrix gap_derivatives(const State<2>& state, const Vector& q, Vector& gaps) {
    const std::vector<double>& radius = state.packing.radius;
    const std::size_t walls = 2 * radius.size();
    Matrix rows;
    gaps.clear();
    for (const Contact& contact : state.contacts) {
        Vector& row = rows.emplace_back(q.size(), Real(0));
        const auto disk = static_cast<std::size_t>(contact.i);
        const auto other = static_cast<std::size_t>(contact.j); // a disk or an axis
        const std::size_t i = 2 * disk;
        if (contact.kind == ContactKind::disk_disk) {
            const std::size_t j = 2 * other;
            const Real x = q[j] - q[i];
            const Real y = q[j + 1] - q[i + 1];
            const Real d = sqrt(Real(x * x + y * y));
            row[j] = x / d;
            row[j + 1] = y / d;
            row[i] = -row[j];
            row[i + 1] = -row[j + 1];
            gaps.push_back(d - Real(radius[disk]) - Real(radius[other]));
        } else if (contact.kind == ContactKind::lower_wall) {
            row[i + other] = 1;
            gaps.push_back(q[i + other] - Real(radius[disk]));
        } else {
            row[i + other] = -1;
            row[walls + other] = 1;
            gaps.push_back(q[walls + other] - q[i + other] - Real(radius[disk]));
        }
    }
    return rows;
}

/// Solves a square system with the right-hand sides appended as columns, in place (one row per unknown on return, the
/// solutions in the last columns); false when it is singular to 10^-80.
inline bool solve(Matrix& a) {
    const std::size_t size = a.size();
    for (std::size_t c = 0; c < size; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c; r < size; ++r) {
            pivot = abs(a[r][c]) > abs(a[pivot][c]) ? r : pivot;
        }
        if (abs(a[pivot][c]) < Real("1e-80")) {
            return false;
        }
        std::swap(a[pivot], a[c]);
        for (std::size_t r = 0; r < size; ++r) {
            if (r == c || a[r][c] == 0) {
                continue;
            }
            const Real factor = a[r][c] / a[c][c];
            for (std::size_t k = c; k < a[r].size(); ++k) {
                if (a[c][k] != 0) {
                    a[r][k] -= factor * a[c][k];
                }
            }
        }
    }
    for (std::size_t c = 0; c < size; ++c) {
        for (std::size_t k = size; k < a[c].size(); ++k) {
            a[c][k] /= a[c][c];
        }
    }
    return true;
}

/// The vertex that the stored coordinates stand for: all gaps of the contacts 0 to 10^-60, by Newton's method; nothing
/// when it does not converge or the matrix is singular.
inline std::optional<Vector> true_vertex(const State<2>& state) {
    const DofMap<2> dofs(state.packing);
    const auto size = static_cast<std::size_t>(dofs.dof_count());
    if (state.contacts.size() != size) {
        return std::nullopt;
    }
    Vector q(state.packing.q.begin(), state.packing.q.end());
    const Real small = Real("1e-60") * state.packing.min_radius();
    for (int iteration = 0; iteration < 12; ++iteration) {
        Vector gaps;
        const Matrix rows = gap_derivatives(state, q, gaps);
        if (std::all_of(gaps.begin(), gaps.end(), [&](const Real& g) { return abs(g) < small; })) {
            return q;
        }
        Matrix a;
        for (std::size_t l = 0; l < size; ++l) {
            Vector& row = a.emplace_back();
            for (std::size_t r = 0; r < size; ++r) {
                row.push_back(rows[l][static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(r)))]);
            }
            row.push_back(gaps[l]);
        }
        if (!solve(a)) {
            return std::nullopt;
        }
        for (std::size_t r = 0; r < size; ++r) {
            q[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(r)))] -= a[r][size];
        }
    }
    return std::nullopt;
}

/// f0 (under the stresses) and f1 (under the infinitesimal loads) at a configuration, one pair per contact; nothing
/// when the matrix is singular to 10^-80 or not square.
inline std::optional<std::vector<std::pair<Real, Real>>> forces(const State<2>& state, const Vector& q) {
    const DofMap<2> dofs(state.packing);
    const auto size = static_cast<std::size_t>(dofs.dof_count());
    if (state.contacts.size() != size) {
        return std::nullopt;
    }
    Vector gaps;
    const Matrix derivative = gap_derivatives(state, q, gaps);
    const std::vector<double> load = state.load.external_force(state.packing);
    Matrix a(size, Vector(size + 2, Real(0)));
    for (std::size_t r = 0; r < size; ++r) {
        const auto c = static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(r)));
        for (std::size_t l = 0; l < size; ++l) {
            a[r][l] = -derivative[l][c];
        }
        a[r][size] = load[c];
        a[r][size + 1] = c < state.load.infinitesimal.size() ? state.load.infinitesimal[c] : 0.0;
    }
    if (!solve(a)) {
        return std::nullopt;
    }
    std::vector<std::pair<Real, Real>> result;
    for (const Vector& row : a) {
        result.emplace_back(row[size], row[size + 1]);
    }
    return result;
}

/// The same at the true vertex, or where the coordinates are stored when there is none.
inline std::optional<std::vector<std::pair<Real, Real>>> forces(const State<2>& state) {
    const auto vertex = true_vertex(state);
    return forces(state, vertex ? *vertex : Vector(state.packing.q.begin(), state.packing.q.end()));
}

/// -1, 0 or +1 of every force in lexicographic order; a part below 10^-60 of the largest of its kind counts as 0.
inline std::vector<int> signs(const std::vector<std::pair<Real, Real>>& forces) {
    Real first = 0;
    Real second = 0;
    for (const auto& f : forces) {
        first = std::max(first, Real(abs(f.first)));
        second = std::max(second, Real(abs(f.second)));
    }
    const Real small("1e-60");
    const auto sign = [](const Real& x, const Real& unit) { return abs(x) <= unit ? 0 : x > 0 ? 1 : -1; };
    std::vector<int> result;
    for (const auto& f : forces) {
        const int s = sign(f.first, small * first);
        result.push_back(s != 0 ? s : sign(f.second, small * second));
    }
    return result;
}

} // namespace isostat::oracle
