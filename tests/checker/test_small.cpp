// Certificates of small packings whose answers are known in closed form, or that need something special.
#include "checker/claims.hpp"
#include "checker/maker.hpp"
#include "checker/small_states.hpp"
#include "support/cells.hpp"
#include "support/units.hpp"

using namespace claims;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

double number_of(const Verification& verification, const std::string& claim, const std::string& name) {
    for (const auto& [key, value] : answer_to(verification, claim).numbers) {
        if (key == name) {
            return value;
        }
    }
    BOOST_ERROR("no number " << name << " of " << claim);
    return std::nan("");
}

/// The doubles next to a number.
Interval neighbours(double value) {
    return {std::nextafter(value, -inf), std::nextafter(value, inf)};
}

} // namespace

BOOST_AUTO_TEST_CASE(every_arithmetic_proves_small_boxes_and_cells) {
    std::vector<State> states{
        crafted::one_disk(1, 2),        crafted::two_disks(1, 2, 1, 1),    crafted::three_disks(1, 1.1, 1.3, 1, 1),
        small_states::with_a_rattler(), small_states::with_a_fixed_disk(), small_states::in_a_corner()};
    const std::vector<State> in_cells = cells::small();
    states.insert(states.end(), in_cells.begin(), in_cells.end());
    for (const State& state : states) {
        for (const CheckerArithmetic arithmetic : every_arithmetic) {
            are_proved(verify(maker::certificate(state), arithmetic));
        }
    }
    // A sample of another program, with what it can be asked in some seconds.
    const Certificate sample = maker::certificate(read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state);
    for (const CheckerArithmetic arithmetic :
         {CheckerArithmetic::singular_value, CheckerArithmetic::fixed64, CheckerArithmetic::gmp}) {
        are_proved(verify(sample, arithmetic));
    }
}

// Case 2: every force, gap and stress within one unit in the last place of the closed form; beside it: refuted.
BOOST_AUTO_TEST_CASE(two_disks_with_the_tightest_claims) {
    Certificate certificate = maker::certificate(crafted::two_disks(1, 2, 1, 1.5));
    const double t = 1 / (2 * std::sqrt(2.0)); // (R2 - R1) / (2 sqrt(R1 R2))
    const double pair = std::sqrt(1 + t * t);  // 1 / cos
    const std::vector<double> forces{1, t, pair, 1, 1.5, 1.5 - t};
    ForcesClaim& claim = *certificate.claims.forces;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        claim.finite[l] = neighbours(forces[l]);
    }
    certificate.claims.load_interval->low.stress = neighbours(t);
    BOOST_TEST((certificate.claims.load_interval->low.opens == crafted::bottom(1)));
    BOOST_TEST(certificate.claims.load_interval->high.unbounded);
    // Disk 1 and the left wall: R1 + 2 sqrt(R1 R2) - R2. Disk 0 and the upper walls are further away.
    const double gap = 2 * std::sqrt(2.0) - 1;
    certificate.claims.gaps->smallest = std::nextafter(gap, 0);
    certificate.claims.gaps->where = crafted::left(1);
    const Verification tight = verify(certificate);
    BOOST_TEST((tight.verdict == Verdict::proved));
    for (std::size_t l = 0; l < forces.size(); ++l) {
        Certificate beside = certificate;
        beside.claims.forces->finite[l] = {std::nextafter(std::nextafter(forces[l], inf), inf), 10};
        BOOST_TEST((verdict_on(verify(beside), "forces") == Verdict::refuted), "force " << l);
        beside.claims.forces->finite[l] = {-1, std::nextafter(std::nextafter(forces[l], -inf), -inf)};
        BOOST_TEST((verdict_on(verify(beside), "forces") == Verdict::refuted), "force " << l);
    }
    certificate.claims.gaps->smallest = std::nextafter(gap, 2);
    BOOST_TEST((verdict_on(verify(certificate), "gaps") == Verdict::refuted));
}

// The distance to the true vertex is known in closed form: both sides of it are told apart.
// Disks 3 and 4 stand at gaps 1 and 1 + d from disk 2, which rests exactly on two fixed ones; pairs of fixed disks do
// not count.
BOOST_AUTO_TEST_CASE(the_pair_named_is_the_nearest_to_2_to_the_minus_46_of_the_largest_coordinate) {
    for (const auto& [units, verdict] : {std::pair(-1, Verdict::proved), std::pair(1, Verdict::proved),
                                         std::pair(3, Verdict::refuted), std::pair(100, Verdict::refuted)}) {
        State state = small_states::between_two(1);
        state.packing.radius = {3, 3, 2, 1, 1};
        state.packing.q = {-3, 0, 3, 0, 0, 4, 0, 8, 4 + units * 0x1p-47 * 8, 4, 0, 0};
        state.packing.fixed = {1, 1, 0, 1, 1};
        state.load.disk_force = {0, 0, 0, 0, 0, -1, 0, 0, 0, 0};
        state.load.infinitesimal.clear();
        Certificate certificate = maker::certificate(state);
        certificate.claims.gaps = GapsClaim{1 - 0x1p-40, crafted::pair(2, 4), Rung::exact};
        BOOST_TEST((verdict_on(verify(certificate), "gaps") == verdict), units);
    }
}

BOOST_AUTO_TEST_CASE(the_distance_to_the_true_vertex_is_known_from_both_sides) {
    State state = crafted::two_disks(1, 2, 1, 1.5);
    const double shift = 0x1p-12;
    state.packing.q[0] += shift; // the disk in the corner is off the wall by this much; nothing else must move
    Certificate certificate = maker::certificate(state);
    certificate.claims.vertex->radius = shift * (1 + 1e-12);
    BOOST_TEST((verdict_on(verify(certificate), "vertex") == Verdict::proved));
    certificate.claims.vertex->radius = shift * (1 - 1e-12);
    BOOST_TEST((verdict_on(verify(certificate), "vertex") == Verdict::refuted));
    BOOST_TEST(number_of(verify(certificate), "vertex", "radius") == shift, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(a_configuration_far_from_any_vertex_is_undecided) {
    Certificate certificate = maker::certificate(crafted::two_disks(1, 2, 1, 1.5));
    for (double& x : certificate.state.packing.q) {
        x += x > 2 ? 1 : 0;
    }
    const Verification verification = verify(certificate);
    BOOST_TEST((verdict_on(verification, "vertex") != Verdict::proved));
    BOOST_TEST((verification.verdict != Verdict::proved));
}

BOOST_AUTO_TEST_CASE(a_negative_force_refutes_the_forces_and_the_stability) {
    const Verification verification = verify(maker::certificate(crafted::two_disks(1, 2, 1, 0.3)));
    BOOST_TEST((verdict_on(verification, "vertex") == Verdict::proved));
    BOOST_TEST((verdict_on(verification, "forces") == Verdict::refuted));
    BOOST_TEST((verdict_on(verification, "stable") == Verdict::refuted));
}

// Case 3: under less vertical load the pair of the base would open at a higher stress than the bottoms at a lower one.
BOOST_AUTO_TEST_CASE(a_contact_that_opens_later_is_refuted_as_the_end_of_the_interval) {
    Certificate certificate = maker::certificate(crafted::three_disks(1, 1.1, 1.3, 1, 1));
    BOOST_TEST((certificate.claims.load_interval->low.opens == crafted::pair(0, 1)) == false);
    BOOST_TEST((certificate.claims.load_interval->high.opens == crafted::pair(0, 1)));
    const Verification right = verify(certificate);
    BOOST_TEST((verdict_on(right, "load_interval") == Verdict::proved));
    int refuted = 0;
    for (const Contact& contact : certificate.state.contacts) {
        certificate.claims.load_interval->low = {false, {-inf, inf}, contact};
        refuted += verdict_on(verify(certificate), "load_interval") == Verdict::refuted ? 1 : 0;
    }
    BOOST_TEST(refuted >= 4);
}

BOOST_AUTO_TEST_CASE(true_stresses_have_forces_and_a_potential_of_their_own) {
    State state = crafted::three_disks(1, 1.1, 1.3, 1, 1);
    state.load.kind = LoadKind::true_stress;
    const Verification verification = verify(maker::certificate(state));
    for (const char* claim : {"counting", "vertex", "forces", "gaps", "load_interval", "stable"}) {
        BOOST_TEST((verdict_on(verification, claim) == Verdict::proved), claim);
    }
}

BOOST_AUTO_TEST_CASE(held_coordinates_are_undecided) {
    State state = crafted::two_disks(1, 2, 1, 1.5);
    Certificate certificate = maker::certificate(state);
    certificate.state.contacts[0] = {ContactKind::held, 0, 0};
    for (const ClaimCheck& check : verify(certificate).checks) {
        BOOST_TEST((check.verdict == Verdict::undecided));
        BOOST_TEST((check.detail.find("held x") != std::string::npos), check.detail);
    }
}

BOOST_AUTO_TEST_CASE(absent_claims_are_undecided_and_nothing_may_speak_of_a_vertex_that_is_not_claimed) {
    Certificate certificate = maker::certificate(crafted::three_disks(1, 1.1, 1.3, 1, 1));
    certificate.claims.vertex = {};
    const Verification verification = verify(certificate);
    BOOST_TEST((verdict_on(verification, "counting") == Verdict::proved));
    for (const char* claim : {"vertex", "forces", "gaps", "load_interval", "stable"}) {
        BOOST_TEST((verdict_on(verification, claim) == Verdict::undecided), claim);
    }
    certificate.claims = {};
    BOOST_TEST((verify(certificate).verdict == Verdict::undecided));
}

// Case 4: h = 2m - 2. The rank is eliminated exactly when the matrix is not square.
BOOST_AUTO_TEST_CASE(the_rank_of_a_hyperstatic_lattice_is_exact) {
    Certificate certificate;
    certificate.state = crafted::square_lattice(4);
    certificate.claims.counting = CountingClaim{34, 40, 34, 6, 0, Rung::exact};
    BOOST_TEST((verdict_on(verify(certificate), "counting") == Verdict::proved));
    certificate.claims.counting = CountingClaim{34, 40, 33, 7, 1, Rung::exact};
    BOOST_TEST((verdict_on(verify(certificate), "counting") == Verdict::refuted));
}

// A disk that is nearly on the line of its two contacts. Above the line the matrix is regular, on it singular: the
// first must be proved down to heights that no double factorisation survives, the second never.
BOOST_AUTO_TEST_CASE(a_family_that_approaches_a_singular_matrix) {
    Certificate certificate;
    for (const int exponent : {-1, -10, -26, -40, -52, -60, -100, -500, -1000}) {
        certificate.state = small_states::between_two(std::ldexp(1.0, exponent));
        certificate.claims.counting = CountingClaim{2, 2, 2, 0, 0, Rung::exact};
        BOOST_TEST((verdict_on(verify(certificate), "counting") == Verdict::proved), "2^" << exponent);
        certificate.claims.counting = CountingClaim{2, 2, 1, 1, 1, Rung::exact};
        BOOST_TEST((verdict_on(verify(certificate), "counting") == Verdict::refuted), "2^" << exponent);
    }
    certificate.state = small_states::between_two(0);
    for (const CheckerArithmetic arithmetic : every_arithmetic) {
        certificate.claims.counting = CountingClaim{2, 2, 2, 0, 0, Rung::exact};
        BOOST_TEST((verdict_on(verify(certificate, arithmetic), "counting") == Verdict::refuted));
        certificate.claims.counting = CountingClaim{2, 2, 1, 1, 1, Rung::exact};
        BOOST_TEST((verdict_on(verify(certificate, arithmetic), "counting") == Verdict::proved));
    }
}

// Scaled by powers of two, moved far from the origin: the same answers.
BOOST_AUTO_TEST_CASE(scales_from_tiny_to_huge) {
    for (const int exponent : {-900, -400, -60, 60, 400, 900}) {
        State state = small_states::with_a_rattler();
        units::stretch(state.packing, std::ldexp(1.0, exponent));
        Certificate certificate = maker::certificate(small_states::with_a_rattler());
        certificate.state = state;
        certificate.claims.vertex->radius = std::ldexp(certificate.claims.vertex->radius, exponent);
        certificate.claims.vertex->unique_radius = std::ldexp(certificate.claims.vertex->unique_radius, exponent);
        certificate.claims.gaps->smallest = std::ldexp(certificate.claims.gaps->smallest, exponent);
        BOOST_TEST_INFO_SCOPE("2^" << exponent);
        are_proved(verify(certificate));
    }
}
