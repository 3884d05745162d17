// Ties in periodic cells, settled at first order in R_i + eps rho_i: against radii that are really changed by a small
// eps, run under `stop`.
#include "support/agreement.hpp"
#include "support/mirror_cells.hpp"

using namespace isostat;
using namespace ::crafted;

namespace {

/// h = 1: periodic along x.
State hyperstatic_pair() {
    return cells::unfolded(two_disks(1, 2, 1, 1), 0);
}
State hyperstatic_three() {
    return cells::unfolded(three_disks(1, 1.1, 1.5, 1, 1), 0);
}

} // namespace

BOOST_AUTO_TEST_CASE(a_tie_in_a_cell_stops_the_run_and_names_the_contacts) {
    const Course course = follow_load(cells::mirror_pairs(), +1, 1, Ties::stop);
    BOOST_TEST(course.end() == "tie");
    BOOST_TEST(mentions(course, "0-1(0,1)"), course.why());
    BOOST_TEST(mentions(course, "3-4"), course.why());
    BOOST_TEST(mentions(course, "4096 bits"));
}

BOOST_AUTO_TEST_CASE(the_same_contacts_open_and_close_in_cells_when_the_radii_are_really_changed,
                     *boost::unit_test::label("slow")) {
    std::set<std::string> kinds;
    int events = 0;
    int undecided = 0;
    for (const State& start : {cells::mirror_pairs(), hyperstatic_pair(), hyperstatic_three()}) {
        for (const int direction : {+1, -1}) {
            const Agreement a = agree(start, direction, 3, 6);
            kinds.insert(a.kinds.begin(), a.kinds.end());
            events += a.events;
            undecided += a.undecided;
        }
    }
    BOOST_TEST(events > 100);
    BOOST_TEST(undecided < 10); // unloading to sigma2 = 0, where nothing holds the cell
    for (const char* kind : {"force", "gap", "limit", "step", "opening"}) {
        BOOST_TEST(kinds.contains(kind), kind);
    }
}

BOOST_AUTO_TEST_CASE(lattices_in_cells_are_followed_where_ties_are_chosen) {
    for (const bool tilts : {false, true}) {
        for (const auto& [columns, rows] : {std::pair{2, 1}, std::pair{3, 1}, std::pair{3, 2}, std::pair{4, 2}}) {
            const State start = cells::loaded_lattice(columns, rows, tilts);
            const Course stop = follow_load(start, +1, 1, Ties::stop);
            BOOST_TEST(stop.end() == "not isostatic");
            const Course course = follow_load(start, +1, 1, Ties::choose);
            BOOST_TEST_REQUIRE(course.states.size() >= 1U);
            const int freedoms = DofMap(start.packing).dof_count();
            BOOST_TEST(static_cast<int>(course.states[0].contacts.size()) == freedoms);
            BOOST_TEST(course.states[0].perturbation->open.size() ==
                       start.contacts.size() - course.states[0].contacts.size());
            BOOST_TEST(course.end() == "cap reached", course.why());
            BOOST_TEST_REQUIRE(course.arcs.size() >= 1U);
        }
    }
}
