// Samples of the paper's programme that ended undecided once: a power that turned within the first step of an arc, a
// contact that closed again, the two ends of a straight strut. They go through.
#include "support/crafted.hpp"
#include "support/same_sequence.hpp"

using namespace isostat;
using namespace ::crafted;

namespace {

void goes_up_and_down(int disks, std::initializer_list<std::uint64_t> seeds) {
    for (const std::uint64_t seed : seeds) {
        BOOST_TEST_INFO_SCOPE(disks << " disks, seed " << seed);
        const Played up = completed(play(prepared(disks, seed), +1, {}, 1.1));
        const Played down = completed(play(up.state, -1, {}, 1.0));
        BOOST_TEST(up.counters.tally.undecided + down.counters.tally.undecided == 0);
    }
}

} // namespace

BOOST_AUTO_TEST_CASE(weak_samples_of_100_disks_go_through) {
    goes_up_and_down(100, {217, 294, 296});
}

BOOST_AUTO_TEST_CASE(weak_samples_of_225_and_484_disks_go_through, *boost::unit_test::label("slow")) {
    goes_up_and_down(225, {9, 56, 63, 72, 73, 97, 139});
    goes_up_and_down(484, {3, 22});
}
