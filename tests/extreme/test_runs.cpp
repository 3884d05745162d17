// Runs, not only states: what steers them decided at the edge too.
#include "extreme/catalogue.hpp"
#include "support/crafted.hpp"
#include "support/segments.hpp"

using namespace isostat;

namespace {

std::optional<State> prepared_or_none(const PreparationOptions& options) {
    PreparationReport report;
    auto made = prepare(options, report);
    return made.ok() ? std::optional(made.value()) : std::nullopt;
}

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
