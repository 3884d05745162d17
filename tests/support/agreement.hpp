#pragma once
// Ties settled at first order against radii that are really changed by a little.

#include "support/course.hpp"
#include "support/really_perturbed.hpp"

namespace crafted {

/// Both runs, for several directions rho: the symbolic one may end undecided where first order does not tell, and is
/// then the beginning of the real one.
struct Agreement {
    int events = 0, settled = 0, undecided = 0;
    std::set<std::string> kinds; ///< of decisions that were settled
};
inline Agreement agree(const State& state, int direction, int equilibria, int seeds) {
    Agreement sum;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto s = static_cast<std::uint64_t>(seed);
        const Course symbolic = follow_load(state, direction, equilibria, Ties::first_order, s);
        const std::vector<double> rho = isostat::tie_direction(state.packing.radius, s);
        for (const long count : symbolic.counters.tally.perturbed) {
            sum.settled += static_cast<int>(count);
        }
        sum.events += static_cast<int>(symbolic.events.size());
        for (const TieDecision& tie : symbolic.ties()) {
            sum.kinds.insert(tie.what);
        }
        const bool open = symbolic.end() == "undecided";
        sum.undecided += open ? 1 : 0;
        for (const double eps : {1e-6, 1e-8}) {
            const Course real = follow_load(really_perturbed(state, rho, eps), direction, equilibria, Ties::stop);
            std::vector<std::string> expected = real.events;
            if (open) {
                BOOST_TEST_REQUIRE(expected.size() >= symbolic.events.size());
                expected.resize(symbolic.events.size());
            } else {
                BOOST_TEST(symbolic.end() == real.end());
            }
            BOOST_TEST(symbolic.events == expected, boost::test_tools::per_element());
        }
    }
    return sum;
}

} // namespace crafted
