// Linear gaps against closed forms and against the exact path.
// The reference of 320 bits that errors are measured against: closed forms, and certificates that must not be given.
#include "oracle/reference_path.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"
#include "support/regular.hpp"
#include "support/shortcuts/small_displacements.hpp"

using namespace isostat;
using namespace crafted;
using oracle::Reference;

namespace {

LinearEvent event_of(const State& state, const Contact& opened) {
    const auto structure = crafted::Regular::proved(state);
    const Factorisation factorisation(structure);
    const auto at = std::ranges::find(state.contacts, opened) - state.contacts.begin();
    const auto pairs = find_candidates(state.packing, 0.8).contacts;
    return required(
        find_linear_event(state.packing, structure, factorisation, ContactId(static_cast<int>(at)), +1, pairs));
}

std::vector<Reference> lifted(const std::vector<double>& q) {
    return {q.begin(), q.end()};
}

} // namespace

BOOST_AUTO_TEST_CASE(the_linear_event_of_two_disks_errs_with_the_square_of_the_arc) {
    // Disk 1 leaves the bottom and rolls on disk 0 until it meets the left wall: (x1 - R0, y1 - R0) goes from
    // (X, Y) = (2 sqrt(R0 R1), R1 - R0) to (Y, X). The tangent at the start is (-Y, X) / |.|.
    std::vector<double> error, arc;
    for (const double distance : {1e-1, 1e-2, 1e-3}) {
        const double r1 = (3 + 2 * std::sqrt(2.0)) * (1 - distance);
        const LinearEvent event = event_of(two_disks(1, r1, 1, 1), bottom(1));
        BOOST_TEST((event.closed == left(1)));
        const double x = 2 * std::sqrt(r1);
        const double y = r1 - 1;
        BOOST_TEST(event.displacement[2] == y - x, boost::test_tools::tolerance(1e-9));
        BOOST_TEST(event.displacement[3] == (x - y) * x / y, boost::test_tools::tolerance(1e-9));
        arc.push_back(x - y);
        error.push_back(std::abs(event.displacement[3] - (x - y)));
    }
    BOOST_TEST(std::log(error[0] / error[1]) / std::log(arc[0] / arc[1]) == 2.0, boost::test_tools::tolerance(0.05));
    BOOST_TEST(std::log(error[1] / error[2]) / std::log(arc[1] / arc[2]) == 2.0, boost::test_tools::tolerance(0.05));
}

BOOST_AUTO_TEST_CASE(the_drift_of_the_first_arc_is_the_curvature_of_the_gaps) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const State start = prepared(30, seed);
        const auto run = load_with_linear_gaps(start, LinearGeometry::moved, 1, 1);
        BOOST_REQUIRE(run.arcs.size() == 1U);
        std::vector<double> moved(start.packing.q.size());
        for (std::size_t k = 0; k < moved.size(); ++k) {
            moved[k] = run.coordinates[0][k] - start.packing.q[k];
        }
        double expected = 0;
        for (const Contact& c : start.contacts) {
            if (c != run.arcs[0].opened) {
                expected = std::max(expected, 0.5 * gap_curvature(start.packing, c, moved.data()));
            }
        }
        Packing end = start.packing;
        end.q = run.coordinates[0];
        double drift = 0;
        for (const Contact& c : start.contacts) {
            drift = c == run.arcs[0].opened ? drift : std::max(drift, std::abs(gap(end, c)));
        }
        BOOST_TEST(drift == expected, boost::test_tools::tolerance(0.1));
        BOOST_TEST(run.arcs[0].drift * start.packing.min_radius() >= drift);
    }
}

BOOST_AUTO_TEST_CASE(a_frozen_geometry_keeps_its_linear_gaps_closed_and_the_load_works) {
    int arcs = 0, changes = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        const State start = prepared(20, seed);
        const auto run = load_with_linear_gaps(start, LinearGeometry::frozen, 6, 300);
        std::vector<Contact> contacts = start.contacts;
        std::vector<double> before = start.packing.q;
        for (std::size_t a = 0; a < run.arcs.size(); ++a, ++arcs) {
            *std::ranges::find(contacts, run.arcs[a].opened) = run.arcs[a].closed;
            const std::vector<double>& q = run.coordinates[a];
            for (const Contact& c : contacts) {
                const auto g = gap_gradient(start.packing, c);
                double h = gap(start.packing, c);
                for (int e = 0; e < g.count; ++e) {
                    const auto k = static_cast<std::size_t>(g.coordinate[static_cast<std::size_t>(e)]);
                    h += g.value[static_cast<std::size_t>(e)] * (q[k] - start.packing.q[k]);
                }
                BOOST_TEST(std::abs(h) < 1e-9);
            }
            Load load = start.load;
            load.stress[1] = run.arcs[a].stress;
            const auto force = load.external_force(start.packing);
            double work = 0;
            for (std::size_t k = 0; k < q.size(); ++k) {
                work += force[k] * (q[k] - before[k]);
            }
            BOOST_TEST(work > -1e-9); // rattlers' arcs and the first of a rearrangement do none
            before = q;
        }
        for (std::size_t e = 1; e < run.equilibria.size(); ++e) {
            BOOST_TEST(run.equilibria[e].stress == run.equilibria[e - 1].stress_high,
                       boost::test_tools::tolerance(1e-9));
            BOOST_TEST(run.equilibria[e].stress > run.equilibria[e - 1].stress); // never taken back
            changes += run.equilibria[e].stress > 1.0001 * run.equilibria[e - 1].stress ? 1 : 0;
        }
    }
    BOOST_TEST(arcs > 10);
    BOOST_TEST(changes > 5);
}

BOOST_AUTO_TEST_CASE(geometry_that_moves_follows_the_exact_path_for_some_arcs_and_then_drifts) {
    const State start = prepared(30, 1);
    const Played exact = completed(play(start, +1, 5));
    const auto run = load_with_linear_gaps(start, LinearGeometry::moved, 5, 1000);
    BOOST_REQUIRE(!run.arcs.empty());
    // The first limit is that of the exact path, to rounding: no arc was approximated before it.
    BOOST_TEST(run.arcs[0].stress == exact.records.arcs[0].stress, boost::test_tools::tolerance(1e-9));
    BOOST_TEST((run.arcs[0].opened == exact.records.arcs[0].opened));
    BOOST_TEST(run.arcs.back().drift > run.arcs.front().drift);
    BOOST_TEST(run.arcs.back().drift > 1e-9); // it is an approximation
}

BOOST_AUTO_TEST_CASE(the_reference_of_two_disks_is_their_closed_form) {
    const State state = two_disks(1, 2, 1, 1);
    const auto polished = oracle::polish(state.packing, lifted(state.packing.q), state.contacts, 1e-93);
    BOOST_TEST(polished.converged);
    const auto certificate = oracle::certify_vertex(state.packing, polished.q, state.contacts);
    BOOST_REQUIRE(certificate.proved());
    BOOST_TEST(certificate.radius < 1e-88);
    const Reference x = 1 + 2 * sqrt(Reference(2));
    BOOST_TEST(static_cast<double>(abs(polished.q[2] - x)) <= certificate.radius);
    BOOST_TEST(static_cast<double>(abs(polished.q[4] - x - 2)) <= certificate.radius);
    // The force at the bottom of disk 1 is F2 - F1 / (2 sqrt 2): zero at F2 = 1 / (2 sqrt 2).
    const auto fixed = state.load.fixed_force(state.packing);
    const auto unit = state.load.unit_force(state.packing);
    const auto limit = oracle::certified_limit(state.packing, polished.q, certificate, state.contacts, fixed, unit, 5);
    BOOST_TEST(limit.bound < 1e-80);
    BOOST_TEST(static_cast<double>(abs(limit.stress - 1 / (2 * sqrt(Reference(2))))) <= limit.bound);
    BOOST_TEST(limit.lowest > -1e-80);
    // The force below disk 0 does not depend on F2: no limit there.
    BOOST_TEST(!std::isfinite(
        oracle::certified_limit(state.packing, polished.q, certificate, state.contacts, fixed, unit, 1).bound));
}

BOOST_AUTO_TEST_CASE(the_certificate_contains_the_truth_when_the_point_is_off) {
    const State state = two_disks(1, 2, 1, 1);
    const auto polished = oracle::polish(state.packing, lifted(state.packing.q), state.contacts, 1e-93);
    for (const double off : {1e-60, 1e-20, 1e-8, 1e-4}) {
        auto moved = polished.q;
        moved[2] += off;
        const auto certificate = oracle::certify_vertex(state.packing, moved, state.contacts);
        BOOST_REQUIRE(certificate.proved());
        BOOST_TEST(certificate.radius >= off);
        BOOST_TEST(certificate.radius <= 100 * off);
    }
    auto moved = polished.q;
    moved[2] += 0.5; // too far: nothing is proved
    BOOST_TEST(!oracle::certify_vertex(state.packing, moved, state.contacts).proved());
}

BOOST_AUTO_TEST_CASE(no_certificate_where_the_contact_matrix_is_singular) {
    // Two disks side by side between the walls, in line: the contacts of disk 1 with disk 0 and right wall and left
    // wall of disk 0 are horizontal; 0-1 twice the vertical support of disk 1 is missing.
    State state =
        in_box({{1, 1, 1}, {1, 3, 1}}, 4, 2, 1, 1, {left(0), bottom(0), top(0), pair(0, 1), right(1), left(0)});
    BOOST_TEST(!oracle::certify_vertex(state.packing, lifted(state.packing.q), state.contacts).proved());
}

BOOST_AUTO_TEST_CASE(every_event_of_a_short_trajectory_is_certified) {
    const oracle::ReferencePath path = oracle::reference_path(prepared(30, 1), 6);
    BOOST_TEST(path.stopped == "");
    BOOST_REQUIRE(path.arcs.size() >= 5U);
    BOOST_REQUIRE(path.limits.size() == 5U);
    BOOST_TEST(path.worst_bound < 1e-85);
    BOOST_TEST(path.worst_limit_bound < 1e-80);
    BOOST_TEST(path.lowest_gap > 0);
    BOOST_TEST(path.lowest_force > -1e-80);
    BOOST_TEST(path.certified == static_cast<int>(path.arcs.size()));
    for (const auto& e : path.equilibria) {
        BOOST_TEST((e.verdict == Verdict::proved));
    }
    // The program's limits are those of the reference, to what doubles can say of them.
    int compared = 0;
    for (const auto& arc : path.arcs) {
        if (arc.limit >= 0) {
            const auto& record = path.equilibria[static_cast<std::size_t>(arc.equilibrium)];
            const double exact = static_cast<double>(path.limits[static_cast<std::size_t>(arc.limit)].stress);
            BOOST_TEST(record.stress_high == exact, boost::test_tools::tolerance(1e-11));
            ++compared;
        }
    }
    BOOST_TEST(compared == 5);
}
