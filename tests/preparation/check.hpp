#pragma once
// What a prepared state must be, checked without the code that made it: all pairs by brute force, forces by dense
// elimination in long double.

#include "contact/candidates.hpp"

#include <isostat/certificate/inspect.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace check {

using namespace isostat;

/// Every pair of grains of the box, as contacts.
inline std::vector<Contact> all_pairs(const Packing<2>& packing) {
    std::vector<Contact> pairs;
    const int n = packing.disk_count();
    for (int i = 0; i < n; ++i) {
        for (int j = i + 1; j < n; ++j) {
            pairs.push_back({ContactKind::disk_disk, i, j});
        }
        for (int a = 0; a < 2; ++a) {
            pairs.push_back({ContactKind::lower_wall, i, a});
            pairs.push_back({ContactKind::upper_wall, i, a});
        }
    }
    return pairs;
}

/// Solution of H f = F by Gaussian elimination with row pivoting.
inline std::vector<long double> dense_forces(const State<2>& state, const std::vector<double>& force) {
    const std::size_t m = force.size();
    std::vector<std::vector<long double>> h(m, std::vector<long double>(m + 1, 0));
    for (std::size_t l = 0; l < m; ++l) {
        const GapGradient<2> g = gap_gradient(state.packing, state.contacts[l]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(g.count); ++k) {
            h[static_cast<std::size_t>(g.coordinate[k])][l] = -g.value[k];
        }
    }
    for (std::size_t r = 0; r < m; ++r) {
        h[r][m] = force[r];
    }
    for (std::size_t c = 0; c < m; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c + 1; r < m; ++r) {
            pivot = std::abs(h[r][c]) > std::abs(h[pivot][c]) ? r : pivot;
        }
        std::swap(h[c], h[pivot]);
        for (std::size_t r = 0; r < m; ++r) {
            const long double factor = r == c ? 0 : h[r][c] / h[c][c];
            for (std::size_t k = c; factor != 0 && k <= m; ++k) {
                h[r][k] -= factor * h[c][k];
            }
        }
    }
    std::vector<long double> f(m);
    for (std::size_t c = 0; c < m; ++c) {
        f[c] = h[c][m] / h[c][c];
    }
    return f;
}

inline void forces_are_compressive(const State<2>& state) {
    std::vector<double> g(state.packing.q.size(), 0.0);
    std::copy(state.load.infinitesimal.begin(), state.load.infinitesimal.end(), g.begin());
    const std::vector<long double> f0 = dense_forces(state, state.load.external_force(state.packing));
    const std::vector<long double> f1 = dense_forces(state, g);
    const long double unit = state.load.stress[0] * state.packing.max_radius();
    for (std::size_t l = 0; l < f0.size(); ++l) {
        const bool carries = std::abs(f0[l]) > 1e-13L * unit;
        BOOST_TEST_CONTEXT("contact " << to_string<2>(state.contacts[l]) << " f0 " << f0[l] << " f1 " << f1[l]) {
            BOOST_TEST((carries ? f0[l] > 0 : f1[l] > 0));
        }
    }
}

/// The contract of `prepare` and `find_vertex`.
inline void is_proved_vertex(const State<2>& state, double stress) {
    const Packing<2>& packing = state.packing;
    const auto dofs = static_cast<std::size_t>(2 * packing.disk_count() + 2);
    BOOST_REQUIRE_EQUAL(state.contacts.size(), dofs);
    BOOST_TEST(std::is_sorted(state.contacts.begin(), state.contacts.end()));
    BOOST_TEST((std::adjacent_find(state.contacts.begin(), state.contacts.end()) == state.contacts.end()));
    BOOST_TEST(state.load.stress[0] == stress);
    BOOST_TEST(state.load.stress[1] == stress);
    BOOST_TEST(state.load.reference_length[0] == packing.length(0));
    BOOST_TEST(state.load.reference_length[1] == packing.length(1));
    Packing<2> snapped = packing;
    snap_to_grid(snapped);
    BOOST_TEST((snapped.q == packing.q));

    const double rounding = 8 * grid_step(packing);
    double largest = 0;
    double smallest_other = std::numeric_limits<double>::infinity();
    for (const Contact& pair : all_pairs(packing)) {
        const double h = gap(packing, pair);
        if (std::binary_search(state.contacts.begin(), state.contacts.end(), pair)) {
            largest = std::max(largest, std::abs(h));
        } else {
            smallest_other = std::min(smallest_other, h);
        }
    }
    BOOST_TEST(largest <= rounding);
    BOOST_TEST(smallest_other > rounding);
    BOOST_TEST((certify_admissible(packing, rounding).verdict == Verdict::proved));

    const Result<Inspection<2>> inspection = inspect_vertex(state);
    BOOST_REQUIRE_MESSAGE(inspection.ok(), (inspection.ok() ? "" : inspection.failure().message()));
    BOOST_TEST(inspection.value().equilibrium, inspection.value().remark);
    if (packing.disk_count() <= 20) {
        forces_are_compressive(state);
    }
}

} // namespace check
