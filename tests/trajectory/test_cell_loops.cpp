// A run in a channel that comes back to where it began: two states, each the only one beyond a ratio of the stresses.
#include "support/cells.hpp"

using namespace isostat;
using crafted::Played;

BOOST_AUTO_TEST_CASE(two_disks_in_a_channel_go_round_a_loop) {
    for (const auto& [large, small] : {std::pair(2.0, 1.0), {1.5, 0.8}, {1.0, 0.75}}) {
        BOOST_TEST_INFO_SCOPE("radii " << large << ", " << small);
        const double rise = std::sqrt((large + small) * (large + small) - large * large);
        const Contact own = cells::across(0, 0, 1, 0);
        const State start = cells::with_infinitesimal_loads(cells::between_images(large, small));
        const Played down = crafted::play(start, -1, 1);
        crafted::check_arc(down, crafted::bottom(0), own, (large - small) / std::sqrt(large * small));
        BOOST_TEST(down.state.packing.length(0) == 2 * large, boost::test_tools::tolerance(1e-12));
        BOOST_TEST(down.state.packing.length(1) == large + rise + small, boost::test_tools::tolerance(1e-12));

        const Played up = crafted::play(down.state, +1, 1);
        crafted::check_arc(up, own, crafted::bottom(0), 2 * rise / large);
        for (std::size_t k = 0; k < start.packing.q.size(); ++k) {
            BOOST_TEST(std::abs(up.state.packing.q[k] - start.packing.q[k]) < 1e-12);
        }
    }
}
