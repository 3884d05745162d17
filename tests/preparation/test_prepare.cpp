// From random disks to a proved vertex: the contract, its invariances, its failures.

#include "check.hpp"
#include "support/bad_input.hpp"
#include "support/prepared.hpp"

#include <isostat/core/machine.hpp>

#include <atomic>

namespace {

using namespace isostat;

struct Outcome {
    Result<State> result;
    PreparationReport report;
};

Outcome run(const PreparationOptions& options) {
    PreparationReport report;
    Result<State> result = prepare(options, report);
    return {std::move(result), std::move(report)};
}

Outcome run(int disks, std::uint64_t seed) {
    return run({.disks = disks, .seed = seed});
}

void must_be_vertex(const Outcome& outcome, double stress = 1) {
    BOOST_REQUIRE_MESSAGE(outcome.result.ok(), (outcome.result.ok() ? "" : outcome.result.failure().message()));
    check::is_proved_vertex(outcome.result.value(), stress);
    BOOST_TEST(!outcome.report.last.has_value());
}

} // namespace

BOOST_AUTO_TEST_CASE(every_size_and_seed_ends_at_a_proved_vertex) {
    for (const auto& [disks, seeds] : {std::pair{1, 5}, {2, 30}, {3, 30}, {20, 20}, {100, 5}}) {
        for (int seed = 1; seed <= seeds; ++seed) {
            BOOST_TEST_INFO_SCOPE("n = " << disks << ", seed " << seed);
            const Outcome outcome = run(disks, static_cast<std::uint64_t>(seed));
            must_be_vertex(outcome);
            BOOST_TEST(
                outcome.result.value().load.infinitesimal ==
                    generic_infinitesimal(outcome.result.value().packing.radius, outcome.report.infinitesimal_seed),
                boost::test_tools::per_element());
        }
    }
}

BOOST_AUTO_TEST_CASE(one_disk_is_held_by_the_four_walls) {
    const Outcome outcome = run(1, 3);
    must_be_vertex(outcome);
    const Packing& packing = outcome.result.value().packing;
    for (int a = 0; a < 2; ++a) {
        BOOST_TEST(std::abs(packing.length(a) - 2 * packing.radius[0]) <= grid_step(packing));
    }
}

// Figures of an independent program: solid fraction 0.823 at n = 400, 5-7 % rattlers; one sample scatters by 0.005 and
// by 2 %.
BOOST_AUTO_TEST_CASE(solid_fraction_and_rattlers_are_those_of_random_packings) {
    double fraction = 0, rattlers = 0;
    constexpr int samples = 4;
    for (int seed = 1; seed <= samples; ++seed) {
        const Outcome outcome = run(400, static_cast<std::uint64_t>(seed));
        must_be_vertex(outcome);
        fraction += outcome.report.solid_fraction / samples;
        rattlers += outcome.report.rattlers / (400.0 * samples);
        const auto inspection = inspect_vertex(outcome.result.value());
        BOOST_TEST(inspection.value().record.rattlers == outcome.report.rattlers);
        BOOST_TEST(inspection.value().record.backbone == 2 * (400 - outcome.report.rattlers) + 2);
    }
    BOOST_TEST(fraction > 0.815);
    BOOST_TEST(fraction < 0.831);
    BOOST_TEST(rattlers > 0.03);
    BOOST_TEST(rattlers < 0.09);
}

// The way of large packings (pressed harder first, patches, interior points) on small ones: four to nine patches.
BOOST_AUTO_TEST_CASE(the_way_of_large_packings_ends_at_proved_vertices_of_the_same_kind) {
    double fraction = 0, rattlers = 0;
    constexpr int samples = 3;
    for (int seed = 1; seed <= samples; ++seed) {
        const Outcome outcome = run({.disks = 1000, .seed = static_cast<std::uint64_t>(seed), .large_above = 100});
        must_be_vertex(outcome);
        BOOST_TEST(outcome.report.stages[2].name == "relaxation at 1e-02");
        // The proofs at the end hold whatever the stages before were worth: these say themselves that they did their
        // part.
        long steps = 0;
        for (const PreparationStage& stage : outcome.report.stages) {
            BOOST_TEST(stage.completed, "seed " << seed << ", " << stage.name);
            steps += stage.name.starts_with("relaxation") ? stage.iterations : 0;
        }
        BOOST_TEST(outcome.report.stages[5].name == "relaxation at 1e-05");
        BOOST_TEST(outcome.report.stages[5].residual < 3e-4);
        BOOST_TEST(steps < 100000); // 15 000 to 56 000
        const auto descent = std::ranges::find_if(outcome.report.stages,
                                                  [](const auto& stage) { return stage.name == "interior descent"; });
        BOOST_REQUIRE((descent != outcome.report.stages.end()));
        BOOST_TEST(descent->iterations > 10);
        BOOST_TEST(outcome.report.programmes <= 3); // what the descent leaves to the programmes
        BOOST_TEST(outcome.report.pivots < 100);
        fraction += outcome.report.solid_fraction / samples;
        rattlers += outcome.report.rattlers / (1000.0 * samples);
    }
    BOOST_TEST(fraction > 0.82);
    BOOST_TEST(fraction < 0.845);
    BOOST_TEST(rattlers > 0.03);
    BOOST_TEST(rattlers < 0.09);
}

// That of very large ones: Newton steps, and no simplex method.
BOOST_AUTO_TEST_CASE(the_way_of_very_large_packings_ends_at_proved_vertices_too) {
    for (int seed = 1; seed <= 3; ++seed) {
        PreparationOptions options{.disks = 300, .seed = static_cast<std::uint64_t>(seed), .large_above = 100};
        options.newton_above = 200;
        const Outcome outcome = run(options);
        must_be_vertex(outcome);
        for (const std::size_t k : {6U, 7U, 8U, 9U}) {
            const PreparationStage& stage = outcome.report.stages[k];
            BOOST_TEST(stage.name.starts_with("newton steps at"), stage.name);
            BOOST_TEST(stage.completed, "seed " << seed << ", " << stage.name);
            BOOST_TEST(stage.residual < 3e-3);
        }
        BOOST_TEST(outcome.report.stages[9].overlap < outcome.report.stages[6].overlap / 50);
        BOOST_TEST(outcome.report.pivots == 0);
    }
}

BOOST_AUTO_TEST_CASE(the_same_seed_gives_the_same_bits_and_another_seed_another_packing) {
    const Outcome first = run(60, 7);
    run(33, 5); // leaves nothing behind
    const Outcome again = run(60, 7);
    const Outcome other = run(60, 8);
    must_be_vertex(first);
    must_be_vertex(other);
    BOOST_TEST((first.result.value().packing.q == again.result.value().packing.q));
    BOOST_TEST((first.result.value().contacts == again.result.value().contacts));
    BOOST_TEST((first.result.value().load.infinitesimal == again.result.value().load.infinitesimal));
    BOOST_TEST((first.result.value().packing.radius != other.result.value().packing.radius));
    BOOST_TEST((first.result.value().packing.q != other.result.value().packing.q));
}

// Sums are taken in blocks of 8192 disks: three of them here, a few steps of the dynamics, disks renumbered.
BOOST_AUTO_TEST_CASE(the_number_of_threads_does_not_change_the_bits, *boost::unit_test::label("threads")) {
    PreparationOptions options{.disks = 17000, .max_steps = 60, .max_programmes = 0};
    std::vector<std::vector<double>> positions;
    for (const int count : {1, 2, 3}) {
        set_threads(count);
        const Outcome outcome = run(options);
        BOOST_REQUIRE(outcome.report.last.has_value());
        positions.push_back(outcome.report.last->q);
    }
    set_threads(1);
    BOOST_TEST((positions[0] == positions[1]));
    BOOST_TEST((positions[0] == positions[2]));
}

BOOST_AUTO_TEST_CASE(watching_does_not_change_the_bits) {
    PreparationOptions options{.disks = 40, .seed = 4};
    const Outcome alone = run(options);
    std::set<std::string> stages;
    std::atomic<bool> stop{false};
    options.stop = &stop;
    options.progress = [&](const PreparationProgress& p) {
        stages.insert(p.stage);
        BOOST_TEST(p.fraction >= 0);
        BOOST_TEST(p.fraction <= 1);
    };
    const Outcome watched = run(options);
    must_be_vertex(watched);
    BOOST_TEST((alone.result.value().packing.q == watched.result.value().packing.q));
    BOOST_TEST(stages.size() == 6U);
    BOOST_TEST(watched.report.stages.size() == 7U);
}

BOOST_AUTO_TEST_CASE(lengths_scaled_by_a_power_of_two_scale_every_bit) {
    for (const double scale : {0x1p-40, 0x1p30}) {
        PreparationOptions options{.disks = 30};
        const Outcome one = run(options);
        options.diameters = {scale, 2 * scale};
        const Outcome scaled = run(options);
        must_be_vertex(scaled);
        BOOST_TEST((one.result.value().contacts == scaled.result.value().contacts));
        for (std::size_t k = 0; k < one.result.value().packing.q.size(); ++k) {
            BOOST_REQUIRE_EQUAL(one.result.value().packing.q[k] * scale, scaled.result.value().packing.q[k]);
        }
    }
}

BOOST_AUTO_TEST_CASE(any_unit_of_length_or_stress_will_do) {
    for (const double length : {1e-6, 1e6}) {
        for (const double stress : {1e-5, 2e7}) {
            must_be_vertex(run({.disks = 25, .diameters = {length, 2 * length}, .stress = stress}), stress);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_given_list_of_radii_is_kept_as_it_is) {
    PreparationOptions options{.radii = {0.5, 0.83, 0.61, 0.97, 0.55, 0.72, 0.66, 0.9, 0.58, 0.79}};
    options.load = LoadKind::true_stress;
    const Outcome outcome = run(options);
    must_be_vertex(outcome);
    BOOST_TEST((outcome.result.value().packing.radius == options.radii));
    BOOST_TEST((outcome.result.value().load.kind == LoadKind::true_stress));
}

BOOST_AUTO_TEST_CASE(size_ratio_twenty) {
    for (int seed = 1; seed <= 5; ++seed) {
        BOOST_TEST_INFO_SCOPE("seed " << seed);
        PreparationOptions options{.disks = 80, .seed = static_cast<std::uint64_t>(seed)};
        options.diameters = {0.1, 2};
        must_be_vertex(run(options));
    }
}

BOOST_AUTO_TEST_CASE(a_long_box_stays_long) {
    const Outcome outcome = run({.disks = 100, .aspect = 4});
    must_be_vertex(outcome);
    const Packing& packing = outcome.result.value().packing;
    BOOST_TEST(packing.length(1) > 2.5 * packing.length(0));
}

// Equal disks make more contacts than degrees of freedom, with gaps that are exactly zero: an honest failure, or a
// vertex that holds.
BOOST_AUTO_TEST_CASE(equal_disks_are_never_a_wrong_vertex) {
    int failures = 0;
    for (int seed = 1; seed <= 12; ++seed) {
        PreparationOptions options{.disks = 20, .seed = static_cast<std::uint64_t>(seed)};
        options.diameters = {1, 1};
        const Outcome outcome = run(options);
        if (outcome.result.ok()) {
            must_be_vertex(outcome);
        } else {
            ++failures;
            BOOST_TEST(outcome.report.last.has_value());
            BOOST_TEST(!outcome.result.failure().message().empty());
        }
    }
    BOOST_TEST(failures > 0); // crystals do occur: else this case tests nothing
}

BOOST_AUTO_TEST_CASE(a_stop_in_any_stage_keeps_the_last_configuration) {
    const auto stages = {"separation",          "compression",         "relaxation at 1e-03",
                         "relaxation at 1e-04", "relaxation at 1e-05", "linear programmes"};
    for (const std::string name : stages) {
        BOOST_TEST_INFO_SCOPE(name);
        std::atomic<bool> stop{false};
        PreparationOptions options{.disks = 50, .stop = &stop};
        options.progress = [&](const PreparationProgress& p) { stop = stop || p.stage == name; };
        const Outcome outcome = run(options);
        fails(outcome.result, FailureKind::interrupted, {name == "linear programmes" ? "programme 1" : name});
        BOOST_REQUIRE(outcome.report.last.has_value());
        BOOST_TEST(outcome.report.last->radius.size() == 50U);
        BOOST_TEST(outcome.report.last->q.size() == 102U);
        BOOST_TEST(outcome.report.last->solid_fraction() > 0.5);
    }
}

BOOST_AUTO_TEST_CASE(options_without_sense_are_named) {
    const auto refused = [](const auto& change, const std::string& word) {
        PreparationOptions options{.disks = 5};
        change(options);
        expect_bad_input([&] { (void)run(options); }, {word});
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused([](auto& o) { o.disks = 0; }, "number of disks is 0");
    refused([](auto& o) { o.diameters.smallest = -1; }, "smallest diameter is -1");
    refused([](auto& o) { o.diameters.largest = 0.5; }, "largest diameter is 0.5");
    refused([&](auto& o) { o.diameters.largest = nan; }, "largest diameter is nan");
    refused([](auto& o) { o.radii = {1, 0, 1}; }, "radius of disk 1 is 0");
    refused([&](auto& o) { o.radii = {1, nan}; }, "radius of disk 1 is nan");
    refused([](auto& o) { o.stress = 0; }, "stress is 0");
    refused([](auto& o) { o.aspect = -2; }, "aspect is -2");
    refused([](auto& o) { o.jitter = -1e-9; }, "jitter is -1e-09");
    refused([](auto& o) { o.loose_fraction = 0.95; }, "loose fraction 0.95");
    refused([](auto& o) { o.softness = 0.1; }, "softness 0.1");
}
