// One arc and one mechanism, against the closed form of two disks: x_1 - x_0 = 2 sqrt 2, y_1 - y_0 = 1.
#include "support/crafted.hpp"

#include <isostat/rigidity/counting.hpp>

using namespace isostat;
using namespace ::crafted;

BOOST_AUTO_TEST_CASE(the_mechanism_of_two_disks_keeps_all_contacts_but_one_closed) {
    const State state = two_disks(1, 2, 1, 1);
    const std::vector<double> velocity = required(mechanism(state, bottom(1)));
    const double slope = -1 / (2 * std::sqrt(2.0)); // of the way of disk 1 around disk 0
    const std::vector<double> expected{0, 0, slope, 1, slope, 1};
    BOOST_TEST(velocity == expected, boost::test_tools::tolerance(1e-14) << boost::test_tools::per_element());
    const SparseColumns h = contact_matrix(state);
    BOOST_TEST((h.rows == 6 && h.columns == 6));
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        double closing = 0;
        for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
            closing += h.value[e] * velocity[static_cast<std::size_t>(h.row[e])];
        }
        BOOST_TEST(std::abs(closing + (state.contacts[l] == bottom(1) ? 1 : 0)) < 1e-15);
    }
}

BOOST_AUTO_TEST_CASE(what_has_no_single_mechanism_is_refused) {
    State state = two_disks(1, 2, 1, 1);
    BOOST_CHECK_THROW((void)mechanism(state, top(0)), Error);
    state.contacts.pop_back();
    fails(mechanism(state, state.contacts[0]), FailureKind::not_isostatic);
}

BOOST_AUTO_TEST_CASE(one_arc_of_two_disks_ends_at_the_wall) {
    const ArcRecord arc = required(first_arc(two_disks(1, 2, 1, 1), -1));
    BOOST_TEST((arc.opened == bottom(1)));
    BOOST_TEST((arc.closed == left(1)));
    BOOST_TEST(arc.stress == 1 / (2 * std::sqrt(2.0)), boost::test_tools::tolerance(1e-13));
    fails(first_arc(two_disks(1, 2, 1, 1), +1), FailureKind::no_limit);
}
