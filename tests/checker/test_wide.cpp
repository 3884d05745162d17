// Integers of fixed length against GMP, and what is proved with them against what is proved without.
#include "checker/evidence.hpp"
#include "checker/forces.hpp"
#include "checker/replay.hpp"
#include "checker/small_states.hpp"
#include "checker/wide.hpp"

#include <cfenv>

using namespace isostat::checker;
using isostat::State;

BOOST_AUTO_TEST_CASE(wide_and_broad_integers_agree_with_GMP) {
    std::mt19937_64 random(1);
    const auto any = [&random] { // below 2^125
        const auto all = static_cast<Wide>(static_cast<WideMagnitude>(random()) << 64U | random());
        return all >> (3 + random() % 125);
    };
    for (int sample = 0; sample < 20000; ++sample) {
        const Wide a = any();
        const Wide b = any();
        const Integer exact_a = integer_of(a);
        BOOST_REQUIRE(number<Wide>(exact_a) == a);
        BOOST_REQUIRE(bits(a) == bits(exact_a));
        Broad p;
        Broad q;
        multiply(p, a, b);
        multiply(q, any(), any());
        const Integer exact_p = exact_a * integer_of(b);
        const Integer exact_q = integer_of(q);
        BOOST_REQUIRE((integer_of(p) == exact_p));
        BOOST_REQUIRE((integer_of(number<Broad>(exact_q)) == exact_q));
        BOOST_REQUIRE((integer_of(Broad(p) += q) == exact_p + exact_q));
        BOOST_REQUIRE((integer_of(Broad(p) -= q) == exact_p - exact_q));
        BOOST_REQUIRE((p < q) == (exact_p < exact_q));
        BOOST_REQUIRE((integer_of(magnitude(p)) == abs(exact_p)));
        BOOST_REQUIRE(bits(p) == bits(exact_p));
        BOOST_REQUIRE(std::abs(approximate(p, -bits(p)) - approximate(exact_p, -bits(p))) < 0x1p-50);
    }
}

// Also where a force is in the range of double and not the force per length, and where both are beyond this range.
BOOST_AUTO_TEST_CASE(sizes_of_forces_are_within_the_range_of_double) {
    for (const auto& [length, force] : {std::pair(-40, 1000), {40, -1000}, {0, 1023}}) {
        State state = ::crafted::one_disk(std::ldexp(1, force), std::ldexp(1, force));
        for (auto* const lengths : {&state.packing.q, &state.packing.radius}) {
            std::transform(lengths->begin(), lengths->end(), lengths->begin(),
                           [by = length](double x) { return std::ldexp(x, by); });
        }
        const double more = force == 1023 ? 4 : 1; // the product of stress and length is beyond double
        state.load.reference_length[0] *= more;
        state.load.reference_length[1] *= more;
        const Evidence evidence(state, isostat::CheckerArithmetic::automatic);
        const double expected = force == 1023 ? std::numeric_limits<double>::max() : std::ldexp(1, force);
        BOOST_TEST(largest_force(evidence.forces) == expected, boost::test_tools::tolerance(1e-9));
    }
}

// Beyond the range of double too, where two modes round to its end and not to infinity.
BOOST_AUTO_TEST_CASE(doubles_around_a_force_hold_it_in_every_rounding_mode) {
    const Problem problem(::crafted::three_disks(1, 1.1, 1.3, 1, 1.5), false, few_digits);
    std::mt19937_64 random(1);
    const auto any = [&random] { // below 2^125
        return static_cast<Wide>(static_cast<WideMagnitude>(random()) << 64U | random()) >> (3 + random() % 125);
    };
    for (int sample = 0; sample < 20000; ++sample) {
        const auto exponent = static_cast<long>(random() % 2200) - 1150;
        const Wide around = sample % 4 == 0 ? 0 : static_cast<Wide>(magnitude(any()));
        const std::vector<Wide> middle(problem.rows.size(), any());
        const ContactForces forces(problem, middle, around, exponent);
        const std::size_t l = random() % middle.size();
        const Range exact = forces[l];
        std::fesetround(std::array{FE_TONEAREST, FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}[random() % 4]);
        const auto [lower, upper] = forces.bounds(l);
        std::fesetround(FE_TONEAREST);
        BOOST_TEST_REQUIRE((lower == -HUGE_VAL || Rational(lower) <= exact.lower));
        BOOST_TEST_REQUIRE((upper == HUGE_VAL || Rational(upper) >= exact.upper));
    }
}

BOOST_AUTO_TEST_CASE(forces_in_128_bits_agree_with_those_of_GMP) {
    const State state = ::crafted::three_disks(1, 1.1, 1.3, 1, 1.5);
    const Problem problem(state, false, few_digits);
    BOOST_REQUIRE(problem.stored.narrow());
    BOOST_REQUIRE(!Problem(state, false, more_digits).stored.narrow());
    const Solver solver(problem);
    const InverseBound inverse = bound_inverse(problem, solver, isostat::CheckerArithmetic::singular_value);
    TrueVertex vertex = find_vertex(problem, solver, inverse);
    BOOST_REQUIRE(vertex.found);
    const auto forces = [&] {
        return contact_forces(problem, solver, inverse, vertex, finite_load(problem, state, vertex));
    };
    const ContactForces narrow = forces();
    vertex.middle = std::vector<Integer>(vertex.middle);
    const ContactForces any = forces();
    for (std::size_t l = 0; l < any.size(); ++l) {
        BOOST_TEST(narrow.positive(l) == any[l].positive());
        BOOST_TEST(narrow.has_zero(l) == any[l].has_zero());
        BOOST_TEST((narrow[l].lower <= any[l].upper && any[l].lower <= narrow[l].upper)); // of the same number
        BOOST_TEST((narrow[l].upper - narrow[l].lower <= 2 * (any[l].upper - any[l].lower)));
        for (const ContactForces* forces_of : {&narrow, &any}) { // between doubles that are some roundings apart
            const auto [lower, upper] = forces_of->bounds(l);
            BOOST_TEST((Rational(lower) <= (*forces_of)[l].lower && Rational(upper) >= (*forces_of)[l].upper));
            BOOST_TEST(upper - lower < 32 * 0x1p-52 * std::abs(upper));
        }
    }
}
