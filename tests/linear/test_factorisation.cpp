// The gate is a fact of the types; the factors solve what they should.
#include "support/crafted.hpp"

#include <isostat/linear/factorisation.hpp>
#include <isostat/statics/statics.hpp>

#include <boost/test/unit_test.hpp>

#include <type_traits>

using namespace isostat;
using namespace crafted;

// Without a proved structure there is no factorisation, and no way to make a structure but `prove`.
static_assert(!std::is_default_constructible_v<IsostaticStructure<2>>);
static_assert(!std::is_constructible_v<IsostaticStructure<2>, const sparse::Matrix<double>&>);
static_assert(!std::is_constructible_v<IsostaticStructure<2>, const Packing<2>&, const std::vector<Contact>&>);
static_assert(!std::is_aggregate_v<IsostaticStructure<2>>);
static_assert(!std::is_default_constructible_v<Factorisation>);
static_assert(!std::is_constructible_v<Factorisation, const sparse::Matrix<double>&>);
static_assert(!std::is_constructible_v<Factorisation, const Packing<2>&>);
static_assert(std::is_constructible_v<Factorisation, const IsostaticStructure<2>&>);
static_assert(!std::is_constructible_v<Statics<2>, const Packing<2>&, const Load<2>&>);
// A verdict is not a truth value.
static_assert(!std::is_convertible_v<Verdict, bool>);

BOOST_AUTO_TEST_SUITE(linear)

BOOST_AUTO_TEST_CASE(several_right_hand_sides_are_solved_like_one_after_the_other) {
    const State<2> state = three_disks(1, 1.2, 1.4, 1, 1);
    const auto proved = IsostaticStructure<2>::prove(state.packing, state.contacts);
    BOOST_TEST_REQUIRE(proved.ok());
    const Factorisation factorisation(proved.value());
    const auto n = static_cast<std::size_t>(proved.value().size());
    std::vector<double> together(6 * n);
    for (std::size_t k = 0; k < together.size(); ++k) {
        together[k] = std::sin(static_cast<double>(k));
    }
    const std::vector<double> right_hand_sides = together;
    factorisation.solve_forces(together, 6);
    const sparse::Matrix<double>& h = proved.value().matrix();
    for (std::size_t s = 0; s < 6; ++s) {
        std::vector<double> residual(right_hand_sides.begin() + static_cast<long>(s * n),
                                     right_hand_sides.begin() + static_cast<long>((s + 1) * n));
        for (std::size_t l = 0; l < n; ++l) {
            for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
                const auto k = static_cast<std::size_t>(e);
                residual[static_cast<std::size_t>(h.row[k])] -= h.value[k] * together[s * n + l];
            }
        }
        for (const double r : residual) {
            BOOST_TEST(std::abs(r) < 1e-13);
        }
    }
}

BOOST_AUTO_TEST_CASE(factors_can_be_moved_and_outlive_their_structure) {
    const State<2> state = two_disks(1, 2, 1, 1);
    std::optional<Factorisation> kept;
    {
        const auto proved = IsostaticStructure<2>::prove(state.packing, state.contacts);
        BOOST_TEST_REQUIRE(proved.ok());
        Factorisation factorisation(proved.value());
        kept.emplace(std::move(factorisation));
    }
    std::vector<double> force(6, 0.0);
    force[4] = -1; // inward on the right wall
    kept->solve_forces(force);
    BOOST_TEST(force[0] == 1.0, boost::test_tools::tolerance(1e-14)); // the left wall answers
}

BOOST_AUTO_TEST_SUITE_END()
