// Trajectories in periodic cells: three sequences of an independent program, and what is a matter of description.
#include "support/bad_input.hpp"
#include "support/disguised_cells.hpp"
#include "support/scratch.hpp"
#include "support/segments.hpp"

#include <nlohmann/json.hpp>

using namespace isostat;
using crafted::Disguised;
using crafted::play;
using crafted::Played;

namespace {

using Json = nlohmann::json;

const std::vector<std::string> names{"tilt_16", "rect_16", "channel_16"};

State start_of(const std::string& name) {
    State state = cells::of_file(name);
    snap_to_grid(state.packing);
    return state;
}

const Json& sequences() {
    static const Json document = [] {
        std::ifstream file(scratch::data("cells/sequences.json"));
        return Json::parse(file);
    }();
    return document;
}

/// ["p", i, j, [m, m]] or ["w", i, axis, 0 or 1].
Contact contact_of(const Json& line) {
    const int i = line.at(1).get<int>();
    const int j = line.at(2).get<int>();
    if (line.at(0) == "w") {
        return {line.at(3) == 0 ? ContactKind::lower_wall : ContactKind::upper_wall, i, j};
    }
    return cells::across(i, j, line.at(3).at(0).get<int>(), line.at(3).at(1).get<int>());
}

/// Every event, ratio, count and length of a run is that of the sequence.
void check_sequence(const Played& played, const Json& sequence) {
    BOOST_TEST_REQUIRE(played.outcome.completed, played.why());
    std::size_t step = 0;
    for (std::size_t e = 0; e < sequence.size(); ++e) {
        const EquilibriumRecord& record = played.records.equilibria.at(e + 1); // after the start
        const Json& expected = sequence[e];
        BOOST_TEST(record.stress == expected.at("ratio").get<double>(), boost::test_tools::tolerance(1e-9));
        BOOST_TEST(record.rattlers == static_cast<int>(expected.at("rattlers").size()));
        BOOST_TEST(record.backbone == expected.at("backbone").get<int>());
        BOOST_TEST(record.hyperstaticity == 0);
        BOOST_TEST(record.mechanisms == 0);
        for (std::size_t a = 0; a < 2; ++a) {
            BOOST_TEST(record.length[a] == expected.at("cell").at(a).get<double>(), boost::test_tools::tolerance(1e-9));
        }
        for (const Json& arc : expected.at("arcs")) {
            BOOST_TEST_REQUIRE(step < played.records.arcs.size());
            const ArcRecord& found = played.records.arcs[step++];
            BOOST_TEST((found.opened == contact_of(arc.at(0))), to_string(found.opened) << " opened, not " << arc);
            BOOST_TEST((found.closed == contact_of(arc.at(1))), to_string(found.closed) << " closed, not " << arc);
        }
    }
    BOOST_TEST(step == played.records.arcs.size());
}

/// All disks moved along the periodic axes.
Disguised elsewhere(const State& start) {
    State state = start;
    for (std::size_t k = 0; k < state.packing.length_at(0); ++k) {
        state.packing.q[k] += start.packing.cell.periodic[k % 2] ? (k % 2 == 0 ? 1.25 : -0.375) : 0;
    }
    return crafted::disguised(std::move(state), crafted::same, crafted::same);
}

/// Two disks are pulled apart; a force across a channel is borne by its walls.
State with_forces(State state) {
    state.load.disk_force.assign(2 * state.packing.radius.size(), 0.0);
    state.load.disk_force[4] = 0.125;
    state.load.disk_force[10] = -0.125;
    state.load.disk_force[5] = 0.0625;
    state.load.disk_force[11] = state.packing.cell.periodic[1] ? -0.0625 : 0;
    return state;
}

} // namespace

BOOST_AUTO_TEST_CASE(sequences_of_an_independent_program_whichever_disk_is_pinned) {
    for (const std::string& name : names) {
        for (const int pin : {start_of(name).packing.cell.pin, 3, 8, 9, 15}) { // 8 and 9 become rattlers, or are
            BOOST_TEST_INFO_SCOPE(name << ", disk " << pin << " pinned");
            State state = start_of(name);
            state.packing.cell.pin = pin;
            const Json& sequence = sequences().at(name);
            const Played played = play(state, +1, static_cast<int>(sequence.size()));
            check_sequence(played, sequence);
            BOOST_TEST(played.counters.tally.undecided == 0);
        }
    }
}

BOOST_AUTO_TEST_CASE(every_arc_is_certified_with_its_power) {
    RunOptions options{.certify = CertifyLevel::arcs};
    int parts = 0; // arcs of rattlers
    for (const std::string& name : names) {
        for (const int pin : {0, 8, 9}) {
            BOOST_TEST_INFO_SCOPE(name << ", disk " << pin << " pinned");
            State state = start_of(name);
            state.packing.cell.pin = pin;
            const Json& sequence = sequences().at(name);
            const Played played = play(state, +1, static_cast<int>(sequence.size()), {}, options);
            check_sequence(played, sequence);
            for (const ArcRecord& arc : played.records.arcs) {
                BOOST_TEST_REQUIRE(arc.certificate.has_value());
                const ArcCertificate& c = *arc.certificate;
                BOOST_TEST((c.verdict == Verdict::proved), "arc " << arc.step << ": " << c.reason);
                BOOST_TEST((c.power == Verdict::proved), "arc " << arc.step << ": " << c.power_reason);
                parts += c.witness.whole ? 0 : 1;
            }
        }
    }
    BOOST_TEST(parts > 0);
}

BOOST_AUTO_TEST_CASE(whichever_image_of_a_disk_is_stored) {
    for (const std::string& name : names) {
        BOOST_TEST_INFO_SCOPE(name);
        const State start = start_of(name);
        std::vector<Image> k(16);
        const int along_y = start.packing.cell.periodic[1] ? 1 : 0;
        k[3] = cells::image(1, 0);
        k[8] = cells::image(0, along_y);
        k[9] = cells::image(0, -along_y);
        const Disguised other = cells::shifted(start, k);
        const Played a = play(start, +1, 6);
        const Played b = completed(play(other.state, +1, 6));
        crafted::check_same_sequence(a, b, crafted::events(b.records, other.back), 1e-11);
    }
}

BOOST_AUTO_TEST_CASE(a_disk_that_rolled_many_periods_away_ends_the_run_with_words) {
    const State start = start_of("rect_16");
    const State near = cells::shifted(start, std::vector<Image>(16, cells::image(23, 0))).state;
    BOOST_TEST(play(near, +1, 1).outcome.completed);
    const State far = cells::shifted(start, std::vector<Image>(16, cells::image(28, 0))).state;
    const Played played = play(far, +1, 1);
    BOOST_TEST(!played.outcome.completed);
    BOOST_TEST((played.why().find("periods from the origin") != std::string::npos), played.why());
    BOOST_TEST(played.records.equilibria.size() == 1U); // the start
}

BOOST_AUTO_TEST_CASE(in_whichever_order_place_and_basis) {
    for (const std::string& name : names) {
        BOOST_TEST_INFO_SCOPE(name);
        const State start = start_of(name);
        const Played played = play(start, +1, 6);
        crafted::check_same_sequence(played, cells::reversed(start), 6);
        crafted::check_same_sequence(played, elsewhere(start), 6);
        if (name == "tilt_16") {
            crafted::check_same_sequence(played, cells::in_other_basis(start, 1), 6);
            crafted::check_same_sequence(played, cells::in_other_basis(start, -1), 6);
        } else {
            crafted::check_same_sequence(played, cells::transposed(start), 6);
        }
    }
}

BOOST_AUTO_TEST_CASE(down_and_up_again) {
    for (const std::string& name : names) {
        BOOST_TEST_INFO_SCOPE(name);
        const Played down = completed(play(start_of(name), -1, 3));
        const Played up = play(down.state, +1, {}, down.state.load.stress[1] * 1.0001);
        BOOST_TEST(up.outcome.completed, up.why());
    }
}

BOOST_AUTO_TEST_CASE(true_stresses_open_the_same_contacts_at_the_same_ratio_of_forces) {
    // F_2 / F_1 is sigma_2 L_1 / (sigma_1 L_2): with the reference lengths, or with those of the moment.
    for (const char* name : {"rect_16", "channel_16"}) {
        BOOST_TEST_INFO_SCOPE(name);
        State state = start_of(name);
        const Played nominal = play(state, +1, 3);
        state.load.kind = LoadKind::true_stress;
        const Played present = completed(play(state, +1, 3, {}, {.certify = CertifyLevel::arcs}));
        BOOST_TEST_REQUIRE(present.records.arcs.size() == nominal.records.arcs.size());
        for (std::size_t k = 0; k < present.records.arcs.size(); ++k) {
            const ArcRecord& arc = present.records.arcs[k];
            BOOST_TEST((arc.opened == nominal.records.arcs[k].opened));
            BOOST_TEST((arc.closed == nominal.records.arcs[k].closed));
            BOOST_TEST((arc.certificate->verdict == Verdict::proved), arc.certificate->reason);
        }
        const auto& reference = state.load.reference_length;
        for (std::size_t e = 0; e + 1 < present.records.equilibria.size(); ++e) {
            const auto& length = present.records.equilibria[e].length;
            const double dead = nominal.records.equilibria[e + 1].stress * reference[0] / reference[1];
            const double now = present.records.equilibria[e + 1].stress * length[0] / length[1];
            BOOST_TEST(now == dead, boost::test_tools::tolerance(1e-9));
        }
        BOOST_TEST(present.records.equilibria[3].stress != nominal.records.equilibria[3].stress);
    }
}

BOOST_AUTO_TEST_CASE(forces_on_disks_do_not_depend_on_the_pin) {
    for (const std::string& name : names) {
        BOOST_TEST_INFO_SCOPE(name);
        const State start = with_forces(start_of(name));
        const Played played = completed(play(start, +1, 3));
        const Played bare = play(start_of(name), +1, 3);
        BOOST_TEST(played.records.equilibria[1].stress != bare.records.equilibria[1].stress);
        for (const int pin : {3, 12}) { // none that becomes a rattler: its zeros are not seen then (C9)
            State other = start;
            other.packing.cell.pin = pin;
            const Played again = completed(play(other, +1, 3));
            crafted::check_same_sequence(played, again, crafted::events(again.records, crafted::same), 1e-11);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_shear_that_grows_opens_one_diagonal_and_a_shear_that_falls_the_other) {
    // f(1,-1) = F2 / sqrt 3 - T and f(0,1) = F2 / sqrt 3 + T (A2), F1 large enough.
    State state = cells::one_tilted_disk(2, 1, 0.25);
    state.load.loaded_axis = 2;
    snap_to_grid(state.packing);
    const Played here = completed(play(state, +1, {}, 0.375));
    const EquilibriumRecord& record = here.records.equilibria.back();
    BOOST_TEST(record.stress == 0.375);
    BOOST_TEST(record.sigma1 == 1); // F2: what the shear is measured in
    BOOST_TEST(record.stress_high == 1 / std::sqrt(3.0), boost::test_tools::tolerance(1e-12));
    BOOST_TEST(record.stress_low == -1 / std::sqrt(3.0), boost::test_tools::tolerance(1e-12));
    BOOST_TEST((record.opens_high == cells::across(0, 0, 1, -1)));
    BOOST_TEST((record.opens_low == cells::across(0, 0, 0, 1)));
    BOOST_TEST_REQUIRE(record.strain.size() == 3U);
    BOOST_TEST(record.strain[2] == -1, boost::test_tools::tolerance(1e-12)); // tilt 1 over the reference height 1
    BOOST_TEST(record.length[2] == 1, boost::test_tools::tolerance(1e-12));
    for (const int direction : {-1, +1}) {
        const Played beyond = play(here.state, direction, 1);
        BOOST_TEST(!beyond.outcome.completed); // no other structure carries more
        BOOST_TEST_REQUIRE(!beyond.records.arcs.empty());
        BOOST_TEST(beyond.records.arcs.front().stress == direction / std::sqrt(3.0),
                   boost::test_tools::tolerance(1e-12));
    }
}

/// x -> -x: the tilt and the shear change sign, and contacts are named by other images.
Disguised sheared_the_other_way(const State& start) {
    State state = start;
    for (std::size_t i = 0; i < start.packing.radius.size(); ++i) {
        state.packing.q[2 * i] *= -1;
        state.load.infinitesimal[2 * i] *= -1;
    }
    state.packing.q[state.packing.tilt_at(0, 1)] *= -1;
    state.load.shear[0] *= -1;
    const auto mirror = [](const Contact& c) {
        return c.kind == ContactKind::disk_disk ? cells::across(c.i, c.j, -c.image.m[0], c.image.m[1]) : c;
    };
    return crafted::disguised(std::move(state), mirror, mirror);
}

BOOST_AUTO_TEST_CASE(simple_shear_to_one_side_is_that_to_the_other_of_the_mirror_image) {
    State start = start_of("tilt_16");
    start.load.loaded_axis = 2;
    const Played up = completed(play(start, +1, 4));
    const Disguised other = sheared_the_other_way(start);
    const Played down = completed(play(other.state, -1, 4));
    BOOST_TEST((crafted::events(up.records, crafted::same) == crafted::events(down.records, other.back)));
    for (std::size_t e = 0; e < up.records.equilibria.size(); ++e) {
        const EquilibriumRecord& a = up.records.equilibria[e];
        const EquilibriumRecord& b = down.records.equilibria[e];
        BOOST_TEST(std::abs(a.stress + b.stress) < 1e-9);
        BOOST_TEST(std::abs(a.strain[2] + b.strain[2]) < 1e-9);
        BOOST_TEST(a.potential == b.potential, boost::test_tools::tolerance(1e-9));
        BOOST_TEST((e == 0 || a.stress > up.records.equilibria[e - 1].stress));
        BOOST_TEST((e == 0 || a.strain[2] > up.records.equilibria[e - 1].strain[2])); // the shear does work
    }
    const Played back = completed(play(up.state, -1, {}, 0));
    BOOST_TEST(back.state.load.shear[0] == 0);
    BOOST_TEST((back.state.load.stress == start.load.stress));
}

BOOST_AUTO_TEST_CASE(a_dead_shear_that_flows_ends_the_run) {
    // One disk: f(1,-1) = F2 / sqrt 3 - T vanishes at F2 = sqrt 3 T, and the disk rolls over its own image.
    State state = cells::one_tilted_disk(1, 1, 0.5);
    state.load.reference_length = {2, std::sqrt(3.0)};
    snap_to_grid(state.packing);
    RunCounters counters;
    crafted::Recorder records;
    const SegmentOutcome outcome = run_segment(state, towards(-3), 0, {}, counters, records);
    fails(outcome.failure, FailureKind::flows);
    BOOST_TEST(records.arcs.size() == 1U);
    BOOST_TEST((records.arcs[0].opened == cells::across(0, 0, 1, -1)));
    BOOST_TEST((records.arcs[0].closed == cells::across(0, 0, 1, 1)), to_string(records.arcs[0].closed));
    BOOST_TEST(records.arcs[0].stress == 0.5 * std::sqrt(3.0), boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(what_is_not_followed_is_refused) {
    const State start = start_of("rect_16");
    const auto refuses = [&](const State& state, const std::string& words) {
        expect_bad_input([&] { require_followed(state, "state"); }, {words});
    };
    BOOST_CHECK_NO_THROW(require_followed(start, "state"));
    State state = start_of("tilt_16");
    state.load.kind = LoadKind::true_stress;
    refuses(state, "no potential where the tilt moves");
    state = with_forces(start);
    BOOST_CHECK_NO_THROW(require_followed(state, "state"));
    state.load.disk_force[4] += 0x1p-40;
    refuses(state, "forces on disks along axis 0");
    state = start;
    state.load.infinitesimal[0] += 1;
    refuses(state, "expected 0 exactly");
}
