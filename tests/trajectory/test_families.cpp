// Families that approach a degeneracy: the right answer on either side however small delta is, and a tie at 0.
#include "support/families.hpp"

using families::Answer;

namespace {

template <class Ask>
void has_opposite_answers_and_a_tie(const char* name, Ask ask, std::initializer_list<int> decades) {
    BOOST_TEST_INFO_SCOPE(name);
    const int orientation = ask(+1, 1).sign;
    BOOST_TEST_REQUIRE(orientation != 0, ask(+1, 1).why);
    for (const int decade : decades) {
        for (const int sign : {+1, -1}) {
            const Answer answer = ask(sign, decade);
            BOOST_TEST(answer.sign == sign * orientation, sign << "e-" << decade << ": " << answer.why);
            BOOST_TEST(answer.margin > 1);
        }
    }
    const Answer zero = ask(+1, 0);
    BOOST_TEST(zero.sign == 0, zero.why);
    BOOST_TEST((zero.rung != isostat::Rung::none), zero.why); // a tie, not a failure
}

auto of_double(Answer (*ask)(double)) {
    return [ask](int sign, int decade) { return ask(decade == 0 ? 0.0 : sign * std::pow(10.0, -decade)); };
}

} // namespace

BOOST_AUTO_TEST_CASE(two_tractions_are_told_apart_by_the_lowest_rung_that_can) {
    using isostat::Rung;
    for (int decade = 1; decade <= 300; decade += decade < 30 ? 1 : 30) {
        const Rung expected = decade < 11 ? Rung::double_bound : Rung::multiprecision;
        for (const double sign : {1.0, -1.0}) {
            const Answer answer = families::tractions(sign * std::pow(10.0, -decade));
            BOOST_TEST(answer.sign == sign, "1e-" << decade);
            BOOST_TEST(answer.margin > 1);
            if (decade < 11 || decade > 33) { // not at the seams, nor between them
                BOOST_TEST((answer.rung == expected), "1e-" << decade << ": " << to_string(answer.rung));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(unequal_radii_are_ordered_as_long_as_they_differ_at_all) {
    const int orientation = families::notch(0.5).sign;
    for (int bits = 1; bits <= 51; bits += 2) {
        for (const int sign : {1, -1}) {
            const Answer answer = families::notch(std::ldexp(sign, -bits));
            BOOST_TEST(answer.sign == sign * orientation, sign << " 2^-" << bits);
            BOOST_TEST(answer.sign != 0);
        }
    }
}

BOOST_AUTO_TEST_CASE(families_whose_delta_is_a_double_are_decided_down_to_1e_300) {
    const auto decades = {2, 8, 13, 16, 18, 25, 40, 100, 300};
    has_opposite_answers_and_a_tie("tractions", of_double(families::tractions), decades);
    has_opposite_answers_and_a_tie("forces that vanish", of_double(families::limits), decades);
    has_opposite_answers_and_a_tie("strut", of_double(families::strut), decades);
}

BOOST_AUTO_TEST_CASE(families_of_lengths_are_decided_down_to_the_last_bit_of_a_double) {
    const auto decades = {2, 5, 8, 11, 13, 14, 15};
    has_opposite_answers_and_a_tie("notch", of_double(families::notch), decades);
    has_opposite_answers_and_a_tie("grazing", of_double(families::grazing), decades);
    has_opposite_answers_and_a_tie("closings", of_double(families::closings), decades);
    has_opposite_answers_and_a_tie("ends", of_double(families::ends), decades);
}

BOOST_AUTO_TEST_CASE(families_of_lengths_are_decided_down_to_1e_300_in_exact_coordinates) {
    const auto decades = {2, 8, 15, 16, 17, 18, 30, 100, 300};
    has_opposite_answers_and_a_tie("notch", families::exact_notch, decades);
    has_opposite_answers_and_a_tie("grazing", families::exact_grazing, decades);
    has_opposite_answers_and_a_tie("closings", families::exact_closings, decades);
    has_opposite_answers_and_a_tie("ends", families::exact_ends, decades);
    has_opposite_answers_and_a_tie("lattice", families::exact_lattice, decades);
}

BOOST_AUTO_TEST_CASE(exact_and_stored_families_agree_where_both_exist) {
    for (const int decade : {1, 3, 6}) {
        for (const int sign : {+1, -1}) {
            const double delta = sign * std::pow(10.0, -decade);
            BOOST_TEST(families::exact_grazing(sign, decade).sign == families::grazing(delta).sign);
            BOOST_TEST(families::exact_notch(sign, decade).sign == families::notch(delta).sign);
        }
    }
}

BOOST_AUTO_TEST_CASE(three_disks_with_equal_bases_end_in_the_tie_that_symmetry_asks_for) {
    using namespace ::crafted;
    for (const double delta : {1e-1, 1e-5, 1e-9, 1e-13, 1e-15}) {
        // A larger third disk comes down to the bottom; under a smaller one the wall meets both others at once.
        const Played large = play(three_disks(1, 1, 1 + delta, 1, 1), +1, 1);
        BOOST_TEST_REQUIRE(!large.records.arcs.empty(), large.why());
        BOOST_TEST((large.records.arcs[0].closed == bottom(2)), "delta = " << delta);
        for (const double radius : {1 - delta, 1.0}) {
            const Played tie = play(three_disks(1, 1, radius, 1, 1), +1, 1);
            fails(tie.outcome.failure, isostat::FailureKind::tie, {"-top"});
            BOOST_TEST(tie.records.arcs.empty());
        }
    }
}
