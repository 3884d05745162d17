// Numbers of records against the true vertex to 200 digits: what is shown holds to within the bound beside it, and the
// bounds are those of the last digit.
#include "oracle/truth.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"

#include <isostat/contact/state.hpp>

using namespace isostat;
using namespace ::crafted;
using oracle::Real;

namespace {

/// Loaded stress at which the force in a contact vanishes.
Real vanishing_stress(const State& state, const oracle::Truth& truth, const Contact& opens) {
    const auto l = static_cast<std::size_t>(std::ranges::find(state.contacts, opens) - state.contacts.begin());
    BOOST_TEST_REQUIRE(l < state.contacts.size());
    return Real(state.load.loaded_stress()) - truth.force[l] / truth.rate[l];
}

void within(const char* name, double shown, double bound, const Real& truth) {
    BOOST_TEST(static_cast<double>(abs(truth - shown)) <= bound,
               name << " is " << shown << ", off by " << static_cast<double>(truth - shown) << ", bound " << bound);
}

/// `terms`: size of what the number is made of, when it may be smaller than its last digit says.
void compare(const char* name, double shown, double bound, const Real& truth, double terms) {
    within(name, shown, bound, truth);
    BOOST_TEST(bound <= 0x1p-52 * std::max(std::abs(shown), 0x1p-36 * terms), name << " has bound " << bound);
}

} // namespace

BOOST_AUTO_TEST_CASE(recorded_numbers_hold_in_every_digit_at_the_true_vertex) {
    const Played run = play(prepared(20, 3), +1, 4);
    BOOST_TEST_REQUIRE(run.records.equilibria.size() == 5U, run.why());
    double most = 0; // what the stored coordinates would give
    for (std::size_t k = 0; k < run.records.equilibria.size(); ++k) {
        const EquilibriumRecord& e = run.records.equilibria[k];
        const State& state = run.records.states[k];
        const oracle::Truth truth(state);
        BOOST_TEST_REQUIRE(truth.known, truth.why);
        BOOST_TEST_INFO_SCOPE("equilibrium " << k);
        Real potential = 0;
        for (std::size_t a = 0; a < 2; ++a) {
            const Real length = truth.q[2 * state.packing.radius.size() + a];
            const Real reference = state.load.reference_length[a];
            const Real strain = (reference - length) / reference;
            compare("L", e.length[a], e.length_bound[a], length, 1);
            compare("eps", e.strain[a], e.strain_bound[a], strain, 1);
            most =
                std::max(most, std::abs((state.load.reference_length[a] - state.packing.length(static_cast<int>(a))) /
                                            state.load.reference_length[a] -
                                        e.strain[a]));
            potential += Real(state.load.stress[a]) * Real(state.load.reference_length[1 - a]) * length;
        }
        compare("W", e.potential, e.potential_bound, potential, 1);
        within("low", e.stress_low, e.stress_low_bound, vanishing_stress(state, truth, e.opens_low));
        within("high", e.stress_high, e.stress_high_bound, vanishing_stress(state, truth, e.opens_high));
        BOOST_TEST(std::max(e.stress_low_bound, e.stress_high_bound) < 1e-9);
        compare("min_gap", e.min_gap, e.min_gap_bound, truth.gap(e.min_gap_contact), 0x1p40);
    }
    BOOST_TEST(most > 0); // the stored coordinates say something else
    for (const ArcRecord& arc : run.records.arcs) {
        const EquilibriumRecord& e = run.records.equilibria[static_cast<std::size_t>(arc.equilibrium)];
        BOOST_TEST(!std::isnan(arc.strain_bound));
        if (arc.arc == e.arcs) {
            BOOST_TEST(std::abs(arc.strain - e.strain[1]) <= arc.strain_bound + e.strain_bound[1]);
            BOOST_TEST(arc.strain_bound < 1e-14);
        }
    }
}
