// Ties that first-order terms leave: chosen by the infinitesimal loads, then by the names (proofs/degenerate.md, C1).
// Mirror images whose rho are mirror images too, so that nothing of first order in the radii tells them apart.
#include "support/course.hpp"
#include "support/mirror.hpp"
#include "support/segments.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/preparation/preparation.hpp>

using namespace isostat;
using namespace ::crafted;

namespace {

/// The infinitesimal loads of the mirror image, in which disks 1 and 2 change places.
State mirror_image(State state) {
    std::vector<double>& g = state.load.infinitesimal;
    std::swap(g[2], g[4]);
    std::swap(g[3], g[5]);
    for (std::size_t k = 0; k < 6; k += 2) {
        g[k] = -g[k];
    }
    return state;
}

/// Loads that are their own mirror image.
State symmetric(State state) {
    std::vector<double>& g = state.load.infinitesimal;
    g[0] = 0;
    g[4] = -g[2];
    g[5] = g[3];
    return state;
}

std::vector<TieDecision> choices(const Course& course) {
    std::vector<TieDecision> list = course.ties();
    std::erase_if(list, [](const TieDecision& tie) { return tie.choice == TieChoice::none; });
    return list;
}

State prepared_equal_disks(int disks, std::uint64_t seed) {
    PreparationOptions options{.disks = disks};
    options.diameters.kind = RadiiLaw::equal;
    options.seed = seed;
    PreparationReport report;
    const auto result = prepare(options, report);
    BOOST_TEST_REQUIRE((result.ok() || report.candidate));
    return result.ok() ? result.value() : *report.candidate;
}

/// Loaded over some equilibria.
Course equal_disks(int disks, std::uint64_t seed, int equilibria) {
    return follow_load(prepared_equal_disks(disks, seed), +1, equilibria, Ties::choose);
}

} // namespace

BOOST_AUTO_TEST_CASE(what_first_order_leaves_tied_is_chosen_by_loads_then_names_and_recorded) {
    const State state = alike(mirror_forces());
    const Course open = follow_load(state, -1, 1, Ties::first_order);
    BOOST_TEST(open.end() == "undecided");
    BOOST_TEST(mentions(open, "tied at first order too"));

    std::vector<Contact> opened;
    for (const State& start : {state, mirror_image(state)}) {
        const Course course = follow_load(start, -1, 1, Ties::choose);
        BOOST_TEST(course.end() == "completed", course.why());
        const auto found = choices(course);
        BOOST_TEST_REQUIRE(found.size() >= 1U);
        BOOST_TEST(found[0].what == "limit");
        BOOST_TEST((found[0].choice == TieChoice::loads));
        BOOST_TEST(found[0].exponent < -1000); // how the tie was proved
        BOOST_TEST((found[0].chosen == course.arcs[0].opened));
        opened.push_back(course.arcs[0].opened);
        BOOST_TEST(course.counters.tally.choices == static_cast<long>(found.size()));
    }
    // The mirror image of the loads chooses the mirror image.
    BOOST_TEST((opened[0] == bottom(1)) == (opened[1] == bottom(2)));
    BOOST_TEST((opened[0] == bottom(2)) == (opened[1] == bottom(1)));

    const Course by_name = follow_load(symmetric(state), -1, 1, Ties::choose);
    const auto found = choices(by_name);
    BOOST_TEST_REQUIRE(found.size() >= 1U, by_name.why());
    BOOST_TEST((found[0].choice == TieChoice::names));
    BOOST_TEST((found[0].chosen == bottom(1)));
    BOOST_TEST((found[0].against == bottom(2)));
}

BOOST_AUTO_TEST_CASE(of_gaps_that_close_together_one_enters_and_the_other_is_watched) {
    const State state = alike(mirror_gaps());
    const Course open = follow_load(state, +1, 1, Ties::first_order);
    BOOST_TEST(open.end() == "undecided");
    const Course course = follow_load(state, +1, 1, Ties::choose);
    BOOST_TEST(course.end() == "completed", course.why());
    BOOST_TEST_REQUIRE(course.arcs.size() == 1U);
    const bool first = course.arcs[0].closed == bottom(1);
    BOOST_TEST((first || course.arcs[0].closed == bottom(2)));
    const auto found = choices(course);
    BOOST_TEST_REQUIRE(found.size() == 1U);
    BOOST_TEST(found[0].what == "gap");
    BOOST_TEST((found[0].choice == TieChoice::zero));
    BOOST_TEST((found[0].against == bottom(first ? 2 : 1)));
    // The configuration is the mirror image of itself, whichever entered.
    const std::vector<double>& q = course.states.back().packing.q;
    BOOST_TEST(std::abs(q[3] - q[5]) < 1e-12);
    BOOST_TEST(std::abs(q[2] + q[4] - 20) < 1e-12);
    BOOST_TEST_REQUIRE(course.states.back().perturbation->open.size() == 1U);
}

BOOST_AUTO_TEST_CASE(where_first_order_tells_nothing_is_chosen) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        for (const auto& [state, direction] : {std::pair{mirror_forces(), -1}, std::pair{mirror_gaps(), +1}}) {
            const Course perturb = follow_load(state, direction, 1, Ties::first_order, seed);
            const Course choose = follow_load(state, direction, 1, Ties::choose, seed);
            BOOST_TEST(choose.end() == "completed");
            BOOST_TEST(choose.events == perturb.events, boost::test_tools::per_element());
            BOOST_TEST(choose.states.back().packing.q == perturb.states.back().packing.q,
                       boost::test_tools::per_element());
            BOOST_TEST(choices(choose).empty());
        }
    }
}

BOOST_AUTO_TEST_CASE(choices_do_not_depend_on_the_threads) {
    const int before = threads();
    std::vector<Course> courses;
    for (const int count : {1, 2, 3}) {
        set_threads(count);
        courses.push_back(follow_load(alike(mirror_forces()), -1, 2, Ties::choose));
    }
    set_threads(before);
    for (const Course& course : courses) {
        BOOST_TEST(course.events == courses[0].events, boost::test_tools::per_element());
        BOOST_TEST(course.states.back().packing.q == courses[0].states.back().packing.q,
                   boost::test_tools::per_element());
    }
}

/// Four equal disks in the box, in a square: rows and columns carry the load, whatever it is. Pairs that touch besides
/// the list part by their second derivative, as the motions are at right angles to them.
BOOST_AUTO_TEST_CASE(a_square_of_disks_supports_every_load_and_pairs_that_only_bend_away_are_followed) {
    const Course open = follow_load(square(), +1, 3, Ties::first_order);
    BOOST_TEST(open.end() == "undecided");
    const Course course = follow_load(square(), +1, 3, Ties::choose);
    BOOST_TEST(course.end() == "no limit", course.why());
    BOOST_TEST_REQUIRE(!course.equilibria.empty());
    const std::vector<double>& length = course.equilibria.back().length;
    BOOST_TEST(std::abs(length[1] - 4) < 1e-12); // the columns are straight still
}

BOOST_AUTO_TEST_CASE(a_run_chooses_as_often_as_it_may_and_then_ends_undecided) {
    const State start = prepared_equal_disks(20, 15);
    const Course all = follow_load(start, +1, 3, Ties::choose);
    const long most = all.counters.tally.choices;
    BOOST_TEST_REQUIRE(most > 5);
    const auto capped = [&](long cap) {
        Course course;
        course.follow(start, towards(3), {.ties = TiePolicy::choose, .ties_seed = 1, .max_choices = cap});
        return course;
    };
    const Course as_many = capped(most);
    BOOST_TEST(as_many.end() == all.end());
    BOOST_TEST(as_many.events == all.events, boost::test_tools::per_element());
    for (const long cap : {0L, 1L, 2L, most - 1}) {
        const Course fewer = capped(cap);
        const auto made = static_cast<long>(choices(fewer).size());
        BOOST_TEST(fewer.end() == "undecided");
        BOOST_TEST((cap == 0 || mentions(fewer, "max_choices")), fewer.why());
        BOOST_TEST(made <= cap);
        BOOST_TEST(fewer.counters.tally.choices == made);
        BOOST_TEST_REQUIRE(fewer.events.size() < all.events.size());
        BOOST_TEST((cap == 0 || std::equal(fewer.events.begin(), fewer.events.end(), all.events.begin())));
    }
}

/// In the first one a gap falls like s^4 to 0 where an arc ends; in the other one its dip is met at the end itself.
BOOST_AUTO_TEST_CASE(patches_of_equal_disks_are_followed_past_gaps_that_graze_until_they_support_every_load) {
    for (const auto& [disks, seed] : {std::pair(36, 17), std::pair(20, 15)}) {
        const Course course = equal_disks(disks, static_cast<std::uint64_t>(seed), 30);
        BOOST_TEST(mentions(course, "supports every load"), disks << " disks, seed " << seed << ": " << course.why());
        BOOST_TEST(!course.equilibria.empty());
    }
}

/// At the twelfth equilibrium the load is known in double to less than what tells the smallest force from 0.
BOOST_AUTO_TEST_CASE(a_small_force_at_a_limit_is_told_from_0_with_more_digits, *boost::unit_test::label("slow")) {
    const Course course = equal_disks(100, 4, 12);
    BOOST_TEST(course.end() == "completed", course.why());
}
