// Ties: stopped, or settled at first order in R_i + eps rho_i. The same packings with radii that are really changed by
// a small eps, run under `stop`, must open and close the same contacts in the same order.
#include "support/agreement.hpp"
#include "support/mirror.hpp"
#include "support/segments.hpp"

using namespace isostat;
using namespace ::crafted;

BOOST_AUTO_TEST_CASE(a_tie_of_two_forces_stops_the_run_and_names_them) {
    const Course course = follow_load(mirror_forces(), -1, 1, Ties::stop);
    BOOST_TEST(course.end() == "tie");
    BOOST_TEST(mentions(course, "1-bottom"));
    BOOST_TEST(mentions(course, "2-bottom"));
    BOOST_TEST(mentions(course, "exactly equal"));
}

BOOST_AUTO_TEST_CASE(a_tie_of_two_gaps_stops_the_run_and_names_them) {
    State state = mirror_gaps();
    state.load.disk_force[3] = -1.25; // its lower end is no tie then; the motion is the same
    const Course course = follow_load(state, +1, 1, Ties::stop);
    BOOST_TEST(course.end() == "tie");
    BOOST_TEST((mentions(course, "1-bottom") || mentions(course, "2-bottom")));
    BOOST_TEST(mentions(course, "bits"));
}

BOOST_AUTO_TEST_CASE(a_tie_of_two_forces_is_settled_by_the_radii_and_so_is_the_force_that_stays_at_zero) {
    int first_opens = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Course course = follow_load(mirror_forces(), -1, 1, Ties::first_order, seed);
        BOOST_TEST(course.end() == "completed");
        BOOST_TEST_REQUIRE(course.arcs.size() >= 1U);
        BOOST_TEST(settled_as(course, "limit"));
        const bool first = course.arcs[0].opened == bottom(1);
        BOOST_TEST((first || course.arcs[0].opened == bottom(2)));
        first_opens += first ? 1 : 0;
        // By symmetry the other one has force 0 at the limit, and is kept: its first-order term is positive.
        const State& reached = course.states.back();
        BOOST_TEST_REQUIRE(reached.perturbation.has_value());
        BOOST_TEST_REQUIRE(reached.perturbation->zero.size() == 1U);
        BOOST_TEST((reached.perturbation->zero[0].first == bottom(first ? 2 : 1)));
        BOOST_TEST(reached.perturbation->zero[0].second.positive());
        BOOST_TEST((reached.perturbation->load_zero == bottom(first ? 2 : 1)));
    }
    BOOST_TEST(first_opens > 0); // rho decides: both happen
    BOOST_TEST(first_opens < 8);
}

BOOST_AUTO_TEST_CASE(a_tie_of_two_gaps_is_settled_by_the_radii_and_the_other_gap_stays_open_at_first_order) {
    int first_closes = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Course course = follow_load(mirror_gaps(), +1, 1, Ties::first_order, seed);
        BOOST_TEST(course.end() == "completed");
        BOOST_TEST_REQUIRE(course.arcs.size() == 1U);
        BOOST_TEST(settled_as(course, "gap"));
        BOOST_TEST((course.arcs[0].opened == pair(1, 2)));
        const bool first = course.arcs[0].closed == bottom(1);
        BOOST_TEST((first || course.arcs[0].closed == bottom(2)));
        first_closes += first ? 1 : 0;
        BOOST_TEST_REQUIRE(course.states.back().perturbation->open.size() == 1U);
        BOOST_TEST((course.states.back().perturbation->open[0].first == bottom(first ? 2 : 1)));
        BOOST_TEST(course.states.back().perturbation->open[0].second.positive());
        BOOST_TEST(course.counters.tally.perturbed[static_cast<std::size_t>(DecisionKind::gaps)] == 1);
    }
    BOOST_TEST(first_closes > 0);
    BOOST_TEST(first_closes < 8);
}

BOOST_AUTO_TEST_CASE(the_same_contacts_open_and_close_when_the_radii_are_really_changed_mirror_images) {
    for (const LoadKind kind : {LoadKind::nominal, LoadKind::true_stress}) {
        int settled = 0;
        int events = 0;
        int undecided = 0;
        for (State state : {mirror_gaps(), mirror_forces()}) {
            state.load.kind = kind;
            for (const int direction : {+1, -1}) {
                const Agreement a = agree(state, direction, 3, 6);
                events += a.events;
                settled += a.settled;
                undecided += a.undecided;
            }
        }
        // Under true stresses the load is that of the stored configuration, and few bits say that two forces are equal.
        BOOST_TEST(settled > 10);
        BOOST_TEST((kind == LoadKind::true_stress || undecided == 0));
        BOOST_TEST_MESSAGE("events " << events << ", settled " << settled << ", undecided " << undecided);
    }
}

BOOST_AUTO_TEST_CASE(the_same_contacts_open_and_close_when_the_radii_are_really_changed_lattices) {
    int events = 0;
    std::set<std::string> kinds;
    for (const int direction : {+1, -1}) {
        for (const auto& [columns, rows] : {std::pair{2, 2}, std::pair{3, 2}, std::pair{2, 3}, std::pair{3, 3}}) {
            const Agreement a = agree(triangular(columns, rows), direction, 4, 4);
            events += a.events;
            kinds.insert(a.kinds.begin(), a.kinds.end());
            BOOST_TEST_MESSAGE(columns << " x " << rows << ": events " << a.events << ", settled " << a.settled
                                       << ", undecided " << a.undecided);
        }
    }
    BOOST_TEST(events > 10);
    std::string met;
    for (const std::string& kind : kinds) {
        met += kind + "; ";
    }
    BOOST_TEST_MESSAGE("settled: " << met);
    for (const char* kind : {"force", "gap", "step", "zero all along"}) {
        BOOST_TEST(kinds.contains(kind), kind);
    }
}

BOOST_AUTO_TEST_CASE(a_hyperstatic_start_is_followed_with_the_contacts_that_the_changed_radii_keep) {
    int first = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const State state = equal_pair();
        RunOptions options;
        settle(options, Ties::first_order);
        options.ties_seed = seed;
        Course course;
        course.follow(state, until(-1, 0.5), options);
        BOOST_TEST(course.outcome.completed);
        const std::vector<double> rho = tie_direction(state.packing.radius, seed);
        // The larger one bears the top wall; the other is pressed to the bottom by a contact that is tilted O(eps).
        const int bearer = rho[0] > rho[1] ? 0 : 1;
        first += bearer == 0 ? 1 : 0;
        BOOST_TEST_REQUIRE(course.states.size() == 2U);
        const RadiusPerturbation& found = *course.states[0].perturbation;
        BOOST_TEST_REQUIRE(found.open.size() == 1U);
        BOOST_TEST((found.open[0].first == top(1 - bearer)));
        BOOST_TEST(std::abs(found.open[0].second.value - 2 * std::abs(rho[0] - rho[1])) <= found.open[0].second.radius);
        BOOST_TEST_REQUIRE(found.zero.size() == 1U);
        BOOST_TEST((found.zero[0].first == bottom(1 - bearer)));
        // f1 = sigma1 L2 (rho_bearer - rho_other) / 2R
        BOOST_TEST(std::abs(found.zero[0].second.value - 2 * std::abs(rho[0] - rho[1]) / 2) <=
                   found.zero[0].second.radius + 1e-15);
        BOOST_TEST(course.counters.tally.perturbed[static_cast<std::size_t>(DecisionKind::equilibrium)] > 0);
    }
    BOOST_TEST(first > 0);
    BOOST_TEST(first < 8);
}

BOOST_AUTO_TEST_CASE(equal_forces_that_stay_equal_at_first_order_are_undecided_not_guessed) {
    const Course course = follow_load(square(), +1, 2, Ties::first_order, 1);
    BOOST_TEST(course.end() == "undecided");
    BOOST_TEST(mentions(course, "first"));
}

BOOST_AUTO_TEST_CASE(without_ties_perturb_changes_nothing) {
    const Course stop = follow_load(three_disks(1, 1.1, 1.5, 1, 1), -1, 2, Ties::stop);
    const Course perturb = follow_load(three_disks(1, 1.1, 1.5, 1, 1), -1, 2, Ties::first_order);
    BOOST_TEST(stop.events == perturb.events, boost::test_tools::per_element());
    BOOST_TEST(stop.end() == perturb.end());
    for (std::size_t k = 0; k < std::min(stop.states.size(), perturb.states.size()); ++k) {
        BOOST_TEST(stop.states[k].packing.q == perturb.states[k].packing.q, boost::test_tools::per_element());
        BOOST_TEST(perturb.states[k].perturbation->open.empty());
        BOOST_TEST(perturb.states[k].perturbation->zero.empty());
    }
    for (const long count : perturb.counters.tally.perturbed) {
        BOOST_TEST(count == 0);
    }
}
