// Pairs that touch, move alike at first order and would overlap at second: the list is exchanged (C3,
// proofs/degenerate.md). The path is known: two disks roll on crests of different curvature.
#include "support/course.hpp"
#include "support/mirror.hpp"
#include "support/really_perturbed.hpp"

using namespace isostat;
using namespace ::crafted;

namespace {

/// Where disk 1 touches both fixed disks 3 and 4.
struct EndOfCrests {
    double x, y;
    EndOfCrests() {
        const double ax = 3;
        const double ay = 6;
        const double d = std::hypot(1.9, 1.5);
        const double along = (4 * 4 - 2.3 * 2.3 + d * d) / (2 * d);
        const double across = std::sqrt(4 * 4 - along * along);
        x = ax + (1.9 * along + 1.5 * across) / d;
        y = ay + (1.5 * along - 1.9 * across) / d;
    }
};

std::vector<TieDecision> exchanges(const Course& course) {
    std::vector<TieDecision> list = course.ties();
    std::erase_if(list, [](const TieDecision& tie) { return tie.what != "second order"; });
    return list;
}

void ends_at_the_fixed_disk(const Course& course, double accuracy) {
    BOOST_TEST(course.end() == "completed", course.why());
    BOOST_TEST_REQUIRE(!course.states.empty());
    const EndOfCrests end;
    const Packing& packing = course.states.back().packing;
    BOOST_TEST(std::abs(packing.q[2] - end.x) < accuracy);
    BOOST_TEST(std::abs(packing.q[3] - end.y) < accuracy);
    BOOST_TEST(std::abs(packing.length(0) - (end.x + 2)) < accuracy);
    BOOST_TEST(std::abs(packing.length(1) - (end.y + 2)) < accuracy);
}

} // namespace

BOOST_AUTO_TEST_CASE(a_pair_that_would_overlap_at_second_order_enters_the_list) {
    const Course course = follow_load(two_crests(true), -1, 1, Ties::choose);
    ends_at_the_fixed_disk(course, 1e-12);
    BOOST_TEST_REQUIRE(!course.arcs.empty());
    BOOST_TEST((course.arcs[0].opened == bottom(0)));
    BOOST_TEST(std::abs(course.arcs[0].stress - 1.5 / 9) < 1e-15);
    const std::vector<TieDecision> found = exchanges(course);
    BOOST_TEST_REQUIRE(found.size() == 1U);
    BOOST_TEST((found[0].chosen == right(1)));
    BOOST_TEST((found[0].against == right(0))); // it bears 1, and 0-2 bears 2
    BOOST_TEST(std::abs(found[0].first.value + 1.0 / 12) <= found[0].first.radius + 1e-16);
    BOOST_TEST(found[0].first.radius < 1e-12);
    BOOST_TEST(std::abs(found[0].other.value - 1) <= found[0].other.radius);
    BOOST_TEST(found[0].exponent < -1000);
    BOOST_TEST((found[0].choice == TieChoice::none)); // the forces tell which gives way
}

BOOST_AUTO_TEST_CASE(a_pair_that_parts_at_second_order_stays_out_of_the_list_and_the_path_is_the_same) {
    const Course course = follow_load(two_crests(false), -1, 1, Ties::choose);
    ends_at_the_fixed_disk(course, 1e-12);
    BOOST_TEST(exchanges(course).empty());
}

BOOST_AUTO_TEST_CASE(a_pair_that_would_overlap_at_second_order_is_undecided_where_nothing_is_chosen) {
    const Course course = follow_load(two_crests(true), -1, 1, Ties::first_order);
    BOOST_TEST(course.end() == "undecided");
    BOOST_TEST(mentions(course, "not told from 0"));
}

BOOST_AUTO_TEST_CASE(radii_that_are_really_changed_end_at_the_same_place) {
    constexpr double eps = 1e-8;
    for (const bool larger : {true, false}) {
        const State state = two_crests(larger);
        const State changed = really_perturbed(state, state.perturbation->rho, eps);
        ends_at_the_fixed_disk(follow_load(changed, -1, 1, Ties::stop), 20 * eps);
    }
}
