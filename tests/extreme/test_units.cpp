// Units: the same packing in every unit of length and stress.
#include "extreme/catalogue.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"

using namespace isostat;
using namespace crafted;

namespace {

constexpr int equilibria = 4;

State start() {
    return ::prepared(30, 3);
}

State scaled(State state, double length, double stress) {
    for (std::vector<double>* list : {&state.packing.radius, &state.packing.q}) {
        for (double& x : *list) {
            x *= length;
        }
    }
    for (std::size_t a = 0; a < 2; ++a) {
        state.load.reference_length[a] *= length;
        state.load.stress[a] *= stress;
    }
    snap_to_grid(state.packing);
    return state;
}

/// One row: a run of some equilibria in other units, compared with the run in the first ones.
void compare(const std::string& unit, const Played& base, const State& state, double length, double stress,
             bool same_bits) {
    extreme::inspect("units", unit + ", start", state);
    BOOST_TEST_INFO_SCOPE(unit);
    extreme::Row row;
    row.family = "units";
    row.parameter = unit + ", run";
    row.disks = state.packing.disk_count();
    row.rung = "none";
    row.checked =
        same_bits ? "every bit of positions, stresses and strains of a run" : "contacts and stresses of a run";
    const extreme::Clock clock;
    const Played run = play(state, +1, equilibria);
    row.seconds = clock.seconds();
    if (!run.outcome.completed) {
        const FailureKind kind = run.outcome.failure->kind;
        row.outcome = kind == FailureKind::undecided || kind == FailureKind::tie ? "undecided" : "refused";
        row.reason = run.why();
        row.checked = "no claim";
    } else {
        row.outcome = "proved";
        Rung rung = Rung::combinatorial;
        double bound = 0;
        BOOST_REQUIRE(run.records.equilibria.size() == base.records.equilibria.size());
        for (std::size_t k = 0; k < run.records.equilibria.size(); ++k) {
            const auto& here = run.records.equilibria[k];
            const auto& there = base.records.equilibria[k];
            rung = std::max(rung, here.decided_by);
            bound = std::max(bound, here.force_bound / here.stress / state.packing.max_radius());
            BOOST_TEST((here.verdict == Verdict::proved));
            BOOST_TEST((run.records.states[k].contacts == base.records.states[k].contacts));
            BOOST_TEST(here.arcs == there.arcs);
            if (same_bits) {
                BOOST_TEST(here.stress == there.stress * stress);
                // Of the true vertex: beyond 1e+-150 the correction of the enclosure is coarser, within its bound.
                for (std::size_t a = 0; a < 2; ++a) {
                    BOOST_TEST(std::abs(here.strain[a] - there.strain[a]) <= 4e-15);
                    BOOST_TEST(std::abs(here.length[a] / length - there.length[a]) <= 4e-15 * there.length[a]);
                }
                for (std::size_t c = 0; c < state.packing.q.size(); ++c) {
                    BOOST_TEST(run.records.states[k].packing.q[c] == base.records.states[k].packing.q[c] * length);
                }
            } else {
                BOOST_TEST(here.stress == there.stress * stress, boost::test_tools::tolerance(1e-9));
            }
        }
        row.rung = to_string(rung);
        row.bound = bound;
    }
    extreme::add(row);
}

} // namespace

BOOST_AUTO_TEST_CASE(units_that_are_powers_of_two_change_no_bit_and_others_no_event) {
    const State one = start();
    const Played base = play(one, +1, equilibria);
    BOOST_REQUIRE_MESSAGE(base.outcome.completed, base.why());
    for (const int exponent : {-498, -300, -100, -10, 10, 100, 300, 498}) {
        const double s = std::ldexp(1.0, exponent);
        const std::string name = fmt::format("2^{} (about 1e{:.0f})", exponent, exponent * std::log10(2.0));
        // At 1e-150 the squares of rounding errors of lengths underflow: last bits may differ, answers may not.
        compare("length " + name, base, scaled(one, s, 1), s, 1, exponent > -490);
        compare("stress " + name, base, scaled(one, 1, s), 1, s, true);
    }
    for (const double s : {1e-150, 1e-100, 1e-50, 1e-9, 1e9, 1e50, 1e100, 1e150}) {
        compare(fmt::format("length {:.0e}", s), base, scaled(one, s, 1), s, 1, false);
        compare(fmt::format("stress {:.0e}", s), base, scaled(one, 1, s), 1, s, false);
    }
}
