#include "support/bad_input.hpp"
#include "support/crafted.hpp"
#include "support/scratch.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/scene/scene.hpp>

using namespace isostat;

namespace {

void refuses_start(const State& state, const std::vector<std::string>& words) {
    expect_bad_input([&] { check_start(state, "start.json"); }, words);
}

} // namespace

BOOST_AUTO_TEST_CASE(isostatic_starts_pass) {
    BOOST_CHECK_NO_THROW(check_start(::crafted::two_disks(1, 2, 1, 1), "start.json"));
    BOOST_CHECK_NO_THROW(check_start(::crafted::three_disks(1, 1, 1.5, 1, 1), "start.json"));
    BOOST_CHECK_NO_THROW(check_start(read_state(scratch::data("vertex100.txt")).state, "vertex100.txt"));
}

BOOST_AUTO_TEST_CASE(a_self_stress_is_refused_with_the_numbers) {
    refuses_start(::crafted::square_lattice(3), {"start.json", "N_f = 20", "N = 24", "rank 20", "h = 4", "k = 0"});
}

BOOST_AUTO_TEST_CASE(a_mechanism_is_refused_with_the_numbers) {
    State state = ::crafted::two_disks(1, 2, 1, 1);
    state.contacts.pop_back();
    refuses_start(state, {"N_f = 6", "N = 5", "h = 0", "k = 1"});
}

BOOST_AUTO_TEST_CASE(overlaps_are_named) {
    State state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.q[2] -= 0.5; // disk 1 into disk 0
    refuses_start(state, {"overlap", "0-1", "-0.4659"});
    state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.length(1) -= 0.01; // the top wall into disk 1
    refuses_start(state, {"disk 1", "larger than the box"});
    state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.q[1] -= 0.01; // disk 0 into the bottom
    refuses_start(state, {"overlap", "0-bottom", "-0.01"});
}

BOOST_AUTO_TEST_CASE(an_open_contact_is_named) {
    State state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.length(0) += 0.25;
    refuses_start(state, {"1-right", "0.25", "expected 0"});
}
