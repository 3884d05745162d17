// Runs, not only states: what steers them decided at the edge too.
// Preparations that nobody planned for: from the loose start to the proof, or to an honest end.
// Units: the same packing in every unit of length and stress.
#include "extreme/catalogue.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"
#include "support/segments.hpp"
#include "support/units.hpp"

using namespace isostat;
using namespace crafted;

namespace {

PreparationOptions disks_of(int count, double smallest = 1, double largest = 2) {
    return {.disks = count, .diameters = {smallest, largest}};
}

/// One row for a run; the state where it ends is a row of its own, checked to 200 digits. W never grows.
void follow(const std::string& family, const std::string& parameter, State state, const Segment& segment) {
    BOOST_TEST_INFO_SCOPE(family << ", " << parameter);
    RunOptions options{.max_arcs = 2000};
    options.max_strain = 1e3; // towards extreme ratios the box becomes a column
    RunCounters counters;
    crafted::Recorder records;
    extreme::Row row;
    row.family = family;
    row.disks = state.packing.disk_count();
    const extreme::Clock clock;
    const SegmentOutcome outcome = run_segment(state, segment, 0, options, counters, records);
    row.seconds = clock.seconds();
    const auto found = static_cast<long>(records.equilibria.size());
    row.parameter = fmt::format("{} ({} arcs, {} equilibria)", parameter, records.arcs.size(), found);
    Rung rung = Rung::combinatorial;
    for (const auto& e : records.equilibria) {
        BOOST_TEST((e.verdict == Verdict::proved));
        rung = std::max(rung, e.decided_by);
    }
    for (const auto& arc : records.arcs) {
        rung = std::max(rung, arc.decided_by);
        BOOST_TEST(arc.work > -1e-9 * state.load.stress[1] * state.packing.length(0) * state.packing.length(1));
    }
    row.rung = to_string(rung);
    row.outcome = "proved";
    row.checked = "W along every arc; the last state to 200 digits (next row)";
    if (!outcome.completed) {
        const FailureKind kind = outcome.failure->kind;
        row.outcome = kind == FailureKind::undecided || kind == FailureKind::tie ? "undecided" : "refused";
        row.reason = fmt::format("{}: {}", to_string(kind), outcome.failure->message());
    }
    extreme::add(row);
    if (found > 0) {
        const auto last = extreme::inspect(family, parameter + ", last equilibrium", records.states.back());
        BOOST_TEST((last && last->record.verdict == Verdict::proved));
    }
}

PreparationOptions disks(int count, double smallest = 1, double largest = 2) {
    return {.disks = count, .diameters = {smallest, largest}};
}

constexpr int equilibria = 4;

State start() {
    return ::prepared(30, 3);
}

State scaled(State state, double length, double stress) {
    units::stretch(state.packing, length);
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

BOOST_AUTO_TEST_CASE(runs_from_extreme_packings) {
    struct Case {
        std::string name;
        PreparationOptions options;
    };
    std::vector<Case> cases;
    for (const double ratio : {1.5, 100.0, 1e4}) {
        cases.push_back({fmt::format("diameters in [1, {:g}]", ratio), disks_of(40, 1, ratio)});
    }
    for (const double width : {1e-2, 1e-4, 1e-6, 1e-9}) {
        cases.push_back({fmt::format("diameters in [1, 1 + {:.0e}]", width), disks_of(40, 1, 1 + width)});
    }
    for (const double aspect : {1e-3, 1e3}) {
        Case c{fmt::format("loose box 1 : {:g}", aspect), disks_of(40)};
        c.options.aspect = aspect;
        cases.push_back(c);
    }
    Case huge{"radius 100 among 40 of 0.5 to 1", {}};
    huge.options.radii = {100};
    for (int i = 0; i < 40; ++i) {
        huge.options.radii.push_back(0.5 + 0.5 * std::fmod(i * 0.618033988749895, 1.0));
    }
    cases.push_back(huge);
    int made = 0;
    for (const Case& c : cases) {
        if (const auto start = prepared_or_none(c.options)) {
            ++made;
            follow("run", c.name, *start, towards(4));
        }
    }
    BOOST_TEST(made >= 8); // those that end in the preparation have their rows there
}

BOOST_AUTO_TEST_CASE(runs_towards_every_stress_ratio) {
    for (const int count : {2, 4, 10}) {
        const auto start = prepared_or_none(disks_of(count));
        BOOST_REQUIRE(start);
        for (const int power : {-12, -4, 4, 12}) {
            follow("stress ratio", fmt::format("{} disks, run to σ₂/σ₁ = 1e{:+03d}", count, power), *start,
                   until(power < 0 ? -1 : +1, std::pow(10.0, power)));
        }
    }
}

BOOST_AUTO_TEST_CASE(size_ratios_up_to_ten_thousand) {
    for (const double ratio : {1.5, 10.0, 100.0, 1e3, 1e4}) {
        extreme::prepared("size ratio", fmt::format("diameters in [1, {:g}]", ratio), disks(60, 1, ratio));
        // Sizes of every decade: log-uniform, largest first as far as the order matters.
        PreparationOptions options;
        for (int i = 0; i < 40; ++i) {
            options.radii.push_back(std::pow(ratio, i / 39.0));
        }
        extreme::prepared("size ratio", fmt::format("log-spaced radii, ratio {:g}", ratio), options);
    }
}

BOOST_AUTO_TEST_CASE(nearly_crystalline_radii) {
    for (const double width :
         {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15}) {
        extreme::prepared("nearly equal radii", fmt::format("diameters in [1, 1 + {:.0e}]", width),
                          disks(40, 1, 1 + width));
    }
    extreme::prepared("equal radii", "40 random equal disks", disks(40, 1, 1));
    extreme::prepared("equal radii", "7 random equal disks", disks(7, 1, 1));
}

BOOST_AUTO_TEST_CASE(boxes_that_are_a_thousand_times_longer_than_wide) {
    for (const double aspect : {1e-3, 1e-2, 1e-1, 10.0, 100.0, 1000.0}) {
        PreparationOptions options = disks(60);
        options.aspect = aspect;
        const auto state = extreme::prepared("long box", fmt::format("loose box 1 : {:g}", aspect), options);
        if (state && aspect >= 100) {
            BOOST_TEST(state->packing.length(1) > 10 * state->packing.length(0));
        }
    }
}

BOOST_AUTO_TEST_CASE(one_huge_disk_among_small_ones) {
    for (const double huge : {10.0, 100.0, 1e3, 1e4}) {
        PreparationOptions options{.radii = {huge}};
        for (int i = 0; i < 40; ++i) {
            options.radii.push_back(0.5 + 0.5 * std::fmod(i * 0.618033988749895, 1.0));
        }
        const std::string name = fmt::format("radius {:g} among 40 of 0.5 to 1", huge);
        extreme::prepared("one huge disk", name, options);
    }
}

BOOST_AUTO_TEST_CASE(stiffness_of_the_dynamics_up_to_1e8) {
    for (const double softness : {1e-3, 1e-5, 1e-7, 1e-8}) {
        PreparationOptions options = disks(60);
        options.softness = softness;
        extreme::prepared("stiff dynamics", fmt::format("stiffness / pressure = {:.0e}", 1 / softness), options);
    }
}

BOOST_AUTO_TEST_CASE(numbers_of_disks) {
    for (const int count : {1, 2, 3, 4, 10, 100, 1000}) {
        extreme::prepared("number of disks", fmt::format("{}", count), disks(count));
    }
}

BOOST_AUTO_TEST_CASE(five_thousand_disks, *boost::unit_test::label("slow")) {
    extreme::prepared("number of disks", "5000", disks(5000));
}

// Too long for every run of the tests: `tests/extreme/run --long`.
BOOST_AUTO_TEST_CASE(twenty_thousand_disks, *boost::unit_test::disabled()) {
    extreme::prepared("number of disks", "20000", disks(20000));
}

BOOST_AUTO_TEST_CASE(units_that_are_powers_of_two_change_no_bit_and_others_no_event) {
    const State one = start();
    const Played base = completed(play(one, +1, equilibria));
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
