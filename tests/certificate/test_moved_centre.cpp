// Rank and bound where a centre was moved by rounding (V5), against singular values that are computed there.
#include "certificate/averages.hpp"
#include "oracle/random.hpp"
#include "support/test.hpp"
#include "verified/proved_structure.hpp"
#include "verified/vertex_bounds.hpp"

#include <isostat/io/state_file.hpp>

using namespace isostat;

BOOST_AUTO_TEST_CASE(a_bound_that_moves_with_the_coordinates_loses_what_the_move_may_take_or_is_made_anew) {
    const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state;
    const auto from = std::move(ProvedStructure::make(state.packing, state.contacts).value());
    const double turning = lipschitz(state.packing, state.contacts);
    oracle::Random random(7);
    int carried = 0, anew = 0;
    for (double farthest = 1e-10; farthest < 1e-3; farthest *= 4) {
        Packing there = state.packing;
        for (double& c : there.q) {
            c += random.real(-farthest, farthest);
        }
        const double loss = std::sqrt(static_cast<double>(there.q.size())) * farthest * turning;
        const auto moved = std::move(from->moved(std::move(there), farthest).value());
        BOOST_TEST(moved->inverse.sigma_min < smallest_singular_values(moved->structure, 1).front() * 1.001);
        if (moved->structure.evidence() == RegularityEvidence::singular_value) {
            ++carried;
            BOOST_TEST(moved->inverse.sigma_min <= from->inverse.sigma_min - loss);
            BOOST_TEST(moved->inverse.sigma_min >= from->inverse.sigma_min / 2);
        } else {
            ++anew;
            BOOST_TEST(1.03 * loss > std::min(from->inverse.sigma_min / 2, 1e-3));
        }
    }
    BOOST_TEST(carried > 3);
    BOOST_TEST(anew > 1);
}
