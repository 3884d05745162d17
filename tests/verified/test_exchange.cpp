// Bounds carried over an exchange of contacts (V8) and made anew for it (V1), against inverse iteration with fresh
// factors.
#include "oracle/random.hpp"
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/motion/arc.hpp>
#include <isostat/verified/inverse_bound.hpp>

#include <boost/test/unit_test.hpp>

#include <cmath>

using namespace isostat;
using namespace crafted;

namespace {

/// Smallest singular value by inverse iteration with factors of this very matrix: from above, converged to 1e-3.
double smallest_singular_value(const IsostaticStructure<2>& structure) {
    const Factorisation factorisation(structure);
    std::vector<double> x(static_cast<std::size_t>(structure.size()));
    for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] = std::sin(static_cast<double>(k * k));
    }
    double size = 0;
    for (int iteration = 0; iteration < 200; ++iteration) {
        size = 0;
        for (const double c : x) {
            size += c * c;
        }
        size = std::sqrt(size);
        for (double& c : x) {
            c /= size;
        }
        factorisation.solve_forces(x);
        factorisation.solve_velocities(x);
    }
    double grown = 0;
    for (const double c : x) {
        grown += c * c;
    }
    return 1 / std::sqrt(std::sqrt(grown));
}

/// A start, and one exchange of it along an arc.
struct Exchange {
    State<2> state;
    IsostaticStructure<2> structure;
    Factorisation factorisation;
    InverseBoundCache cache;
    InverseBound bound;

    explicit Exchange(State<2> s)
        : state(std::move(s)), structure(IsostaticStructure<2>::prove(state.packing, state.contacts).value()),
          factorisation(structure), bound(bound_inverse(structure, factorisation, cache)) {}

    Result<Arc<2>> open(int contact) {
        CandidateList<2> candidates = find_candidates(state.packing, candidate_fraction);
        const PowerLoad<2> power{&state.load, false, true};
        return follow_arc<2>(state.packing, structure, factorisation, ContactId(contact), +1, power, candidates, {});
    }
    [[nodiscard]] std::vector<double> on_dofs(const std::vector<double>& tangent) const {
        return tangent; // box, nothing fixed: the numbering is the identity
    }
};

} // namespace

BOOST_AUTO_TEST_SUITE(verified)

BOOST_AUTO_TEST_CASE(bounds_after_an_exchange_lie_below_the_smallest_singular_value_and_near_it) {
    Exchange from(read_state<2>(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state);
    int carried = 0;
    int fresh = 0;
    for (int opened = 0; opened < from.structure.size(); opened += 7) {
        const auto arc = from.open(opened);
        if (!arc.ok()) {
            continue;
        }
        const auto next =
            IsostaticStructure<2>::exchange(from.structure, arc.value().end, ContactId(opened), arc.value().closed);
        BOOST_TEST_REQUIRE(next.has_value());
        const ApproximateInverse approximate = from.factorisation.approximate().exchanged(next->slot(), next->matrix());
        const auto by_cholesky = bound_exchanged(*next, approximate, from.cache);
        auto proved = IsostaticStructure<2>::prove(arc.value().end, next->contacts());
        BOOST_TEST_REQUIRE(proved.ok());
        const double sigma = smallest_singular_value(proved.value());
        if (by_cholesky) {
            BOOST_TEST(by_cholesky->bound.sigma_min < sigma * 1.001);
            BOOST_TEST(by_cholesky->bound.sigma_min > 0.1 * sigma);
            ++fresh;
        }
        const auto bound =
            carry_bound(from.structure, from.bound, *next, approximate, from.on_dofs(arc.value().tangent));
        if (!bound) {
            continue;
        }
        BOOST_TEST(bound->bound.sigma_min < sigma * 1.001);
        BOOST_TEST(bound->bound.sigma_min > 0.005 * sigma);
        BOOST_TEST((bound->bound.route == InverseBound::Route::carried));
        BOOST_TEST(bound->proof.sigma_min() == bound->bound.sigma_min);
        ++carried;
    }
    BOOST_TEST(carried > 3);
    BOOST_TEST(fresh > 10);
}

BOOST_AUTO_TEST_CASE(without_motion_a_bound_is_carried_with_little_loss_and_a_wrong_guess_costs_only_the_bound) {
    Exchange from(read_state<2>(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state);
    // A held coordinate in place of a contact, the packing unmoved: the kept rows are the same.
    const std::vector<double> v = from.factorisation.approximate().mechanism(5);
    const auto fastest =
        std::max_element(v.begin(), v.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    const Contact held{ContactKind::held, static_cast<int>(fastest - v.begin()), 0};
    const auto next = IsostaticStructure<2>::exchange(from.structure, from.state.packing, ContactId(5), held);
    BOOST_TEST_REQUIRE(next.has_value());
    const ApproximateInverse approximate = from.factorisation.approximate().exchanged(5, next->matrix());
    const auto bound = carry_bound(from.structure, from.bound, *next, approximate, v);
    BOOST_TEST_REQUIRE(bound.has_value());
    const auto proved = IsostaticStructure<2>::prove(from.state.packing, next->contacts());
    BOOST_TEST_REQUIRE(proved.ok());
    const double sigma = smallest_singular_value(proved.value());
    BOOST_TEST(bound->bound.sigma_min < sigma * 1.001);
    BOOST_TEST(bound->bound.sigma_min > 0.5 * std::min(sigma, from.bound.sigma_min));
    // A guess that is no mechanism at all is refined or refused; what comes out is still a bound.
    oracle::Random random(5);
    std::vector<double> wrong(v.size());
    for (double& c : wrong) {
        c = static_cast<double>(random.integer(2001)) / 1000 - 1;
    }
    const auto still = carry_bound(from.structure, from.bound, *next, approximate, wrong);
    BOOST_TEST((!still || still->bound.sigma_min < sigma * 1.001));
}

BOOST_AUTO_TEST_CASE(a_structure_says_what_its_regularity_was_proved_with) {
    Exchange from(read_state<2>(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state);
    BOOST_TEST((from.structure.evidence() == RegularityEvidence::elimination));
    const auto next =
        IsostaticStructure<2>::exchange(from.structure, from.state.packing, ContactId(5), from.structure.contacts()[5]);
    BOOST_TEST_REQUIRE(next.has_value());
    auto unproved = *next;
    BOOST_TEST((IsostaticStructure<2>::without_proof(std::move(unproved)).evidence() == RegularityEvidence::none));
    const auto proved = bound_exchanged(*next, from.factorisation.approximate(), from.cache);
    BOOST_TEST_REQUIRE(proved.has_value());
    auto contacts = *next;
    // The proof is of the matrix of *next, which the copy shares.
    BOOST_TEST((IsostaticStructure<2>::exchanged(std::move(contacts), proved->proof).evidence() ==
                RegularityEvidence::singular_value));
}

BOOST_AUTO_TEST_CASE(no_proof_is_made_for_a_singular_exchange) {
    Exchange from(read_state<2>(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state);
    // Two of the same contact: singular whatever the coordinates are.
    const Contact twice = from.state.contacts[3];
    const auto next = IsostaticStructure<2>::exchange(from.structure, from.state.packing, ContactId(40), twice);
    if (next) { // the pattern alone may have told
        const ApproximateInverse approximate = from.factorisation.approximate().exchanged(40, next->matrix());
        std::vector<double> v = from.factorisation.approximate().mechanism(40);
        BOOST_TEST(!carry_bound(from.structure, from.bound, *next, approximate, v).has_value());
        BOOST_TEST(!bound_exchanged(*next, from.factorisation.approximate(), from.cache).has_value());
    }
    BOOST_TEST(!IsostaticStructure<2>::prove(from.state.packing, next ? next->contacts() : from.state.contacts).ok() ==
               next.has_value());
}

BOOST_AUTO_TEST_CASE(nothing_is_carried_when_the_grains_moved_farther_than_the_bound_allows) {
    Exchange from(read_state<2>(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state);
    Packing<2> moved = from.state.packing;
    moved.q[20] += 0.5 * moved.min_radius();
    const auto next =
        IsostaticStructure<2>::exchange(from.structure, moved, ContactId(5), Contact{ContactKind::held, 0, 0});
    BOOST_TEST_REQUIRE(next.has_value());
    const ApproximateInverse approximate = from.factorisation.approximate().exchanged(5, next->matrix());
    BOOST_TEST(
        !carry_bound(from.structure, from.bound, *next, approximate, from.factorisation.approximate().mechanism(5))
             .has_value());
}

BOOST_AUTO_TEST_SUITE_END()
