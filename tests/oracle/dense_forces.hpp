#pragma once
// Forces of a stored configuration by dense elimination in 400 bits: no code in common with the program but the meaning
// of a contact.

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

/// One row per contact: the derivative of its gap with respect to every coordinate of q.
inline std::vector<std::vector<Real>> gap_derivatives(const State<2>& state) {
    const std::vector<double>& q = state.packing.q;
    const std::size_t walls = 2 * state.packing.radius.size();
    std::vector<std::vector<Real>> rows;
    for (const Contact& contact : state.contacts) {
        std::vector<Real>& row = rows.emplace_back(q.size(), Real(0));
        const auto i = 2 * static_cast<std::size_t>(contact.i);
        const auto axis = static_cast<std::size_t>(contact.j);
        if (contact.kind == ContactKind::disk_disk) {
            const auto j = 2 * static_cast<std::size_t>(contact.j);
            const Real x = Real(q[j]) - Real(q[i]);
            const Real y = Real(q[j + 1]) - Real(q[i + 1]);
            const Real d = sqrt(Real(x * x + y * y));
            row[j] = x / d;
            row[j + 1] = y / d;
            row[i] = -row[j];
            row[i + 1] = -row[j + 1];
        } else if (contact.kind == ContactKind::lower_wall) {
            row[i + axis] = 1;
        } else {
            row[i + axis] = -1;
            row[walls + axis] = 1;
        }
    }
    return rows;
}

/// f0 (under the stresses) and f1 (under the infinitesimal loads), one pair per contact; nothing when the matrix is
/// singular to 10^-80 or not square.
inline std::optional<std::vector<std::pair<Real, Real>>> forces(const State<2>& state) {
    const DofMap<2> dofs(state.packing);
    const auto size = static_cast<std::size_t>(dofs.dof_count());
    if (state.contacts.size() != size) {
        return std::nullopt;
    }
    const auto derivative = gap_derivatives(state);
    const std::vector<double> load = state.load.external_force(state.packing);
    std::vector<std::vector<Real>> a(size, std::vector<Real>(size + 2, Real(0)));
    for (std::size_t r = 0; r < size; ++r) {
        const auto c = static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(r)));
        for (std::size_t l = 0; l < size; ++l) {
            a[r][l] = -derivative[l][c];
        }
        a[r][size] = load[c];
        a[r][size + 1] = c < state.load.infinitesimal.size() ? state.load.infinitesimal[c] : 0.0;
    }
    std::vector<std::size_t> row_of(size);
    std::vector<char> used(size, 0);
    for (std::size_t c = 0; c < size; ++c) {
        std::size_t pivot = size;
        for (std::size_t r = 0; r < size; ++r) {
            if (used[r] == 0 && (pivot == size || abs(a[r][c]) > abs(a[pivot][c]))) {
                pivot = r;
            }
        }
        if (abs(a[pivot][c]) < Real("1e-80")) {
            return std::nullopt;
        }
        used[pivot] = 1;
        row_of[c] = pivot;
        for (std::size_t r = 0; r < size; ++r) {
            if (r == pivot || a[r][c] == 0) {
                continue;
            }
            const Real factor = a[r][c] / a[pivot][c];
            for (std::size_t k = c; k < size + 2; ++k) {
                if (a[pivot][k] != 0) {
                    a[r][k] -= factor * a[pivot][k];
                }
            }
        }
    }
    std::vector<std::pair<Real, Real>> result;
    for (std::size_t l = 0; l < size; ++l) {
        const std::size_t r = row_of[l];
        result.emplace_back(a[r][size] / a[r][l], a[r][size + 1] / a[r][l]);
    }
    return result;
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
