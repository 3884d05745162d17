#pragma once
// What a prepared state must be, checked without the code that made it: all pairs by brute force, forces by dense
// elimination in long double.

#include "contact/candidates.hpp"
#include "oracle/pairs.hpp"
#include "oracle/truth.hpp"
#include "support/test.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/trajectory/trajectory.hpp>

namespace check {

using namespace isostat;

inline void forces_are_compressive(const State& state) {
    const oracle::TruthIn<long double> truth(state, oracle::At::stored);
    BOOST_REQUIRE_MESSAGE(truth.known, truth.why);
    for (std::size_t l = 0; l < truth.force.size(); ++l) {
        BOOST_TEST(truth.sign(l) == 1, "contact " << to_string(state.contacts[l]) << " f0 " << truth.force[l] << " f1 "
                                                  << truth.infinitesimal[l]);
    }
}

/// The contract of `prepare` and `find_vertex`.
inline void is_proved_vertex(const State& state, double stress) {
    const Packing& packing = state.packing;
    const auto dofs = static_cast<std::size_t>(2 * packing.disk_count() + 2);
    BOOST_REQUIRE_EQUAL(state.contacts.size(), dofs);
    BOOST_TEST(std::ranges::is_sorted(state.contacts));
    BOOST_TEST((std::ranges::adjacent_find(state.contacts) == state.contacts.end()));
    BOOST_TEST(state.load.stress[0] == stress);
    BOOST_TEST(state.load.stress[1] == stress);
    BOOST_TEST(state.load.reference_length[0] == packing.length(0));
    BOOST_TEST(state.load.reference_length[1] == packing.length(1));
    Packing snapped = packing;
    snap_to_grid(snapped);
    BOOST_TEST((snapped.q == packing.q));

    const double rounding = 8 * grid_step(packing);
    double largest = 0;
    double smallest_other = std::numeric_limits<double>::infinity();
    for (const Contact& pair : oracle::all_pairs(packing)) {
        const double h = gap(packing, pair);
        if (std::ranges::binary_search(state.contacts, pair)) {
            largest = std::max(largest, std::abs(h));
        } else {
            smallest_other = std::min(smallest_other, h);
        }
    }
    BOOST_TEST(largest <= rounding);
    BOOST_TEST(smallest_other > rounding);
    BOOST_TEST((certify_admissible(packing, rounding).verdict == Verdict::proved));

    const Inspection inspection = required(inspect_vertex(state));
    BOOST_TEST(inspection.equilibrium, inspection.remark);
    if (packing.disk_count() <= 20) {
        forces_are_compressive(state);
    }
}

} // namespace check
