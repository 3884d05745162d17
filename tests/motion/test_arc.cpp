// Arcs with known ends: a free disk rolls over a fixed one past obstacles.
#include "motion/arc.hpp"
#include "motion/event_scan.hpp"
#include "motion/rolling.hpp"

using namespace isostat;
using namespace crafted;

namespace {

struct Rolling : RollingDisk {
    std::vector<Contact> contacts{pair(0, 2), pair(1, 2)};

    Result<Arc> roll(double step_fraction, bool precisely = false) {
        snap_to_grid(packing);
        const auto structure = required(IsostaticStructure::prove(packing, contacts));
        const Factorisation factorisation(structure);
        CandidateList candidates = find_candidates(packing, candidate_fraction);
        ArcOptions options;
        options.step_fraction = step_fraction;
        options.precisely = precisely;
        return follow_arc(ArcOrigin{packing, structure, factorisation, ContactId(1)}, PowerLoad{&load, false, false},
                          candidates, options);
    }
    static double angle(const Arc& arc) { return std::atan2(arc.end.q[5], arc.end.q[4]); }
};

} // namespace

BOOST_AUTO_TEST_CASE(an_arc_ends_where_the_closed_form_says) {
    for (const double fraction : {0.5, 0.1, 0.003}) {
        Rolling rolling;
        rolling.stop(2.0);
        rolling.push(-1, 0.1);
        const auto arc = required(rolling.roll(fraction));
        BOOST_TEST((arc.closed == pair(2, 3)));
        BOOST_TEST(Rolling::angle(arc) == 2.0, boost::test_tools::tolerance(1e-14));
        BOOST_TEST(std::abs(gap(arc.end, pair(0, 2))) < 1e-14);
    }
}

BOOST_AUTO_TEST_CASE(a_grazing_dip_counts_and_a_near_miss_does_not) {
    for (const double clearance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
        for (const double sign : {+1.0, -1.0}) {
            for (const double fraction : {0.5, 0.05}) {
                Rolling rolling;
                rolling.obstacle(1.0, 0.25, sign * clearance);
                rolling.stop(2.0);
                rolling.push(-1, 0.1);
                const auto arc = rolling.roll(fraction);
                BOOST_TEST_REQUIRE(arc.ok(), "clearance " << sign * clearance << ": "
                                                          << (arc.ok() ? "" : arc.failure().message()));
                BOOST_TEST((arc.value().closed == (sign > 0 ? pair(2, 4) : pair(2, 3))),
                           "clearance " << sign * clearance << " step " << fraction);
            }
        }
    }
}

/// An obstacle of radius 2 at (0, 5 - overlap), below which the rolling disk comes to rest, or not.
struct Grazing : Rolling {
    explicit Grazing(double overlap) {
        obstacle(std::numbers::pi / 2, 2, 0);
        packing.q[6] = 0;
        packing.q[7] = 5 - overlap;
    }
    /// From a rough end on top of the fixed disk, rolling up to it (+1) or back (-1).
    [[nodiscard]] std::optional<Packing> end(double direction) {
        snap_to_grid(packing);
        const auto structure = required(IsostaticStructure::prove(packing, contacts));
        Packing top = packing;
        top.q[4] = 0;
        top.q[5] = 2;
        std::vector<double> tangent(top.q.size(), 0.0);
        tangent[4] = -direction;
        return precise_end(RoughEnd{structure, ContactId(1), pair(2, 3), top, tangent, 0.1});
    }
};

BOOST_AUTO_TEST_CASE(the_first_of_two_ends_is_found_where_double_sees_a_stretch) {
    const double overlap = 0x1p-49;
    const double d = 5 - overlap; // exact
    // Law of cosines, 1 - cos = 2 sin^2 of half the angle: no cancellation.
    const double angle = 2 * std::asin(std::sqrt(overlap * (6 - overlap) / (8 * d)));
    BOOST_TEST(angle > 3e-8);
    for (const double direction : {+1.0, -1.0}) {
        const auto end = required(Grazing(overlap).end(direction));
        BOOST_TEST(std::abs(end.q[4] - direction * 2 * std::sin(angle)) < 1e-15);
    }
    BOOST_TEST(!Grazing(-overlap).end(1).has_value(), "it passes by");
    BOOST_TEST(!Grazing(0).end(0).has_value(), "on top the contacts are singular: no step is a number");
}

BOOST_AUTO_TEST_CASE(an_exactly_grazing_gap_is_never_followed_by_a_guess_beyond_rounding) {
    Rolling rolling;
    rolling.obstacle(1.0, 0.25, 0);
    rolling.stop(2.0);
    rolling.push(-1, 0.1);
    const auto arc = rolling.roll(0.1);
    if (arc.ok()) {
        // Whatever side the stored numbers are on, no gap is below rounding on the way and the end is one of the two.
        BOOST_TEST((arc.value().closed == pair(2, 3) || arc.value().closed == pair(2, 4)));
    } else {
        BOOST_TEST((arc.failure().kind == FailureKind::undecided || arc.failure().kind == FailureKind::not_converged),
                   arc.failure().message());
    }
}

/// It overlaps the obstacle on the last part of the way, and leaves it where the arc would end.
BOOST_AUTO_TEST_CASE(a_gap_that_dips_and_comes_back_to_0_where_an_arc_would_end_closes_before) {
    for (const double half : {0.02, 0.005, 0.001}) {
        for (const double fraction : {0.5, 0.1}) {
            Rolling rolling;
            const double nearest =
                2 * std::cos(half) + std::sqrt(4 * std::cos(half) * std::cos(half) - 4 + 1.25 * 1.25);
            rolling.obstacle(2.0 - half, 0.25, nearest - 3.25);
            rolling.stop(2.0);
            rolling.push(-1, 0.1);
            const auto arc = required(rolling.roll(fraction));
            BOOST_TEST((arc.closed == pair(2, 3)), half << ", steps of " << fraction);
            BOOST_TEST(Rolling::angle(arc) == 2.0 - 2 * half, boost::test_tools::tolerance(1e-12));
        }
    }
}

/// Its rate there is 0 to rounding, on either side: the proof of the end judges it, and the arc is followed to its end.
BOOST_AUTO_TEST_CASE(a_gap_that_grazes_where_an_arc_ends_does_not_keep_it_from_its_end) {
    for (int k = 0; k < 100; ++k) {
        Rolling rolling;
        const double angle = 1.5 + 0.01 * k;
        rolling.obstacle(angle, 0.25, 0);
        rolling.stop(angle);
        rolling.push(-1, 0.1);
        const auto arc = rolling.roll(0.1);
        BOOST_TEST_REQUIRE(arc.ok(), angle << ": " << (arc.ok() ? "" : arc.failure().message()));
        BOOST_TEST(Rolling::angle(arc.value()) == angle, boost::test_tools::tolerance(1e-7));
        BOOST_TEST(arc.value().steps < 1000);
    }
}

/// Equal disks that rest in a corner of fixed ones: to doubles their third gap is 0. That it is positive the vertex
/// says.
BOOST_AUTO_TEST_CASE(a_gap_of_0_to_rounding_that_an_arc_does_not_move_is_no_event) {
    Rolling rolling;
    rolling.stop(2.0);
    auto& q = rolling.packing.q;
    q.insert(q.end() - 2, {20, 20, 22, 20, 21, 20 + std::sqrt(3), 23, 20 + std::sqrt(3)});
    rolling.packing.radius.insert(rolling.packing.radius.end(), 4, 1.0);
    rolling.packing.fixed.insert(rolling.packing.fixed.end(), {1, 1, 0, 1});
    rolling.load.disk_force.insert(rolling.load.disk_force.end(), 8, 0.0);
    rolling.contacts.insert(rolling.contacts.end(), {pair(4, 6), pair(5, 6)});
    rolling.push(-1, 0.1);
    const auto arc = required(rolling.roll(0.1));
    BOOST_TEST(gap(rolling.packing, pair(6, 7)) <= 0);
    BOOST_TEST((arc.closed == pair(2, 3)));
    BOOST_TEST(Rolling::angle(arc) == 2.0, boost::test_tools::tolerance(1e-14));
}

/// Rates of rounding, first together and then apart, make no dip; rates that are none do.
BOOST_AUTO_TEST_CASE(a_gap_that_stays_0_to_rounding_within_a_step_does_not_dip) {
    Packing at;
    at.walls = Walls::none();
    at.radius = {1, 1, 1};
    at.q = {0, 0, 2, 0, 0, 5, 0, 0};
    at.fixed = {1, 0, 0};
    CandidateList candidates = find_candidates(at, candidate_fraction);
    const Contact opened = pair(0, 2);
    const Contact nothing{ContactKind::held, -1, 0}; // closes
    constexpr double step = 0.05, noise = 1e-13;
    for (const double rate : {1e-14, 1e-4}) {
        EventScan scan(opened, ArcOptions(), candidates, {pair(0, 1)});
        const CurveCourse course{at, {0, 0, -rate, 0, 0, 1, 0, 0}, std::vector<double>(8, 0.0), 5};
        const GapEvent event = scan.first_event(course, step, noise, true);
        BOOST_TEST((event.contact == pair(0, 1) && event.s == 0) == (rate > noise), rate);
        const auto dip = scan.suspicious_dip({at, at, step, nothing}, {0, 0, rate, 0, 0, 1, 0, 0}, noise);
        BOOST_TEST(dip.has_value() == (rate > noise), rate);
    }
}

namespace {

/// A disk at rest between two fixed ones that leave it hardly any room: its contacts are parallel to 1e-7.
struct Squeezed : Rolling {
    std::size_t first; ///< coordinate of the two

    explicit Squeezed(double slope) {
        constexpr double apart = 4 - 1e-14;
        stop(2.0);
        first = packing.q.size() - 2;
        packing.q.insert(packing.q.end() - 2,
                         {-7, -7, -7 + apart * std::cos(slope), -7 + apart * std::sin(slope), 0, 0});
        packing.radius.insert(packing.radius.end(), 3, 1.0);
        packing.fixed.insert(packing.fixed.end(), {1, 1, 0});
        load.disk_force.insert(load.disk_force.end(), 6, 0.0);
        contacts.insert(contacts.end(), {pair(4, 6), pair(5, 6)});
        push(-1, 0.1);
        snap_to_grid(packing);
        double* const q = &packing.q[first];
        const long double x = static_cast<long double>(q[2]) - q[0];
        const long double y = static_cast<long double>(q[3]) - q[1];
        const long double square = x * x + y * y;
        BOOST_TEST_REQUIRE(static_cast<double>(16 - square) > 1e-14);
        const long double aside = std::sqrt((16 - square) / square) / 2; // of the line of the two
        q[4] = static_cast<double>(q[0] + x / 2 - aside * y);
        q[5] = static_cast<double>(q[1] + y / 2 + aside * x);
    }
};

} // namespace

/// Rounding of the gaps in double moves the disk, which is at rest.
BOOST_AUTO_TEST_CASE(contacts_that_are_nearly_singular_are_followed_with_residuals_in_double_double) {
    constexpr double at_rest = 1e-11;
    int astray = 0;
    for (int k = 0; k < 20; ++k) {
        Squeezed squeezed(0.3 + 0.05 * k);
        const auto moved = [&](const Arc& arc) {
            const auto along = [&](std::size_t c) { return arc.end.q[c] - squeezed.packing.q[c]; };
            return std::hypot(along(squeezed.first + 4), along(squeezed.first + 5));
        };
        const auto in_double = squeezed.roll(0.1);
        astray += in_double.ok() && moved(in_double.value()) < at_rest ? 0 : 1;
        const auto arc = required(squeezed.roll(0.1, true));
        BOOST_TEST((arc.closed == pair(2, 3)));
        BOOST_TEST(Rolling::angle(arc) == 2.0, boost::test_tools::tolerance(1e-13));
        BOOST_TEST(moved(arc) < at_rest);
    }
    BOOST_TEST(astray > 0, "in double");
}

BOOST_AUTO_TEST_CASE(the_power_of_the_load_turns_before_the_next_contact) {
    Rolling rolling;
    rolling.stop(2.0);
    rolling.push(0, 1); // power cos(angle): vanishes at pi / 2
    const auto arc = required(rolling.roll(0.1));
    BOOST_TEST((arc.kind == ArcEnd::power_turn));
    BOOST_TEST((arc.closed == Contact{ContactKind::held, 4, 0}), "the fastest coordinate at the top is x of disk 2");
    BOOST_TEST(Rolling::angle(arc) == std::numbers::pi / 2, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(the_opened_contact_may_close_again_from_the_other_side) {
    Rolling rolling; // once around the fixed disk: every coordinate turns, the opening gap grows and falls
    const auto arc = required(rolling.roll(0.2));
    BOOST_TEST((arc.closed == pair(1, 2)));
    // Mirror image of the start in the line through the centres of the two fixed disks.
    const double line = std::atan2(rolling.packing.q[3], rolling.packing.q[2]);
    const double expected = 2 * line - start_angle + 2 * std::numbers::pi;
    const double reached = Rolling::angle(arc);
    BOOST_TEST(std::cos(reached - expected) == 1.0, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(arc.steps > 10);
}

BOOST_AUTO_TEST_CASE(a_motion_without_end_is_reported) {
    Rolling rolling;
    rolling.packing.q[2] = 50; // the opened contact is far away and nothing else is there: rolls for ever
    rolling.contacts = {pair(0, 2), {ContactKind::held, 5, 0}};
    snap_to_grid(rolling.packing);
    const auto structure = required(IsostaticStructure::prove(rolling.packing, rolling.contacts));
    const Factorisation factorisation(structure);
    CandidateList candidates = find_candidates(rolling.packing, candidate_fraction);
    ArcOptions options;
    options.max_steps = 500;
    fails(follow_arc(ArcOrigin{rolling.packing, structure, factorisation, ContactId(1)},
                     PowerLoad{&rolling.load, false, false}, candidates, options),
          FailureKind::unbounded);
}
