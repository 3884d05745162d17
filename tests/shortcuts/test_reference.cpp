// The reference of 320 bits that errors are measured against: closed forms, and certificates that must not be given.
#include "oracle/reference_path.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"

using namespace isostat;
using namespace crafted;
using oracle::Reference;

namespace {

std::vector<Reference> lifted(const std::vector<double>& q) {
    return {q.begin(), q.end()};
}

} // namespace

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
