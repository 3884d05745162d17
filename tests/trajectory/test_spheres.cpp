// Runs of spheres: closed forms, and the sequences of an independent program.
#include "oracle/truth.hpp"
#include "support/crafted.hpp"
#include "support/spheres.hpp"

using namespace isostat;
using ::crafted::Played;

namespace {

State start_of_spheres(const std::string& name, const PerAxis<double>& stress) {
    State state = test::state_of_spheres(test::read_spheres(name));
    state.load.stress = stress;
    state.load.infinitesimal = generic_infinitesimal(state.packing.radius, 7, 3);
    snap_to_grid(state.packing);
    return state;
}

Contact floor_of(int sphere) {
    return {ContactKind::lower_wall, sphere, 2};
}

/// One equilibrium on, or back where `direction` is -1, with the arc enclosed.
Played one_proved_arc(const State& start, int direction) {
    const Played played = ::crafted::play(start, direction, 1, {}, {.certify = CertifyLevel::arcs});
    for (const ArcRecord& arc : played.records.arcs) {
        BOOST_TEST_REQUIRE(arc.certificate.has_value());
        BOOST_TEST((arc.certificate->verdict == Verdict::proved), arc.certificate->reason);
        BOOST_TEST((arc.certificate->power == Verdict::proved), arc.certificate->power_reason);
    }
    return played;
}

void check_sphere_lengths(const Packing& packing, const PerAxis<double>& lengths) {
    for (int a = 0; a < 3; ++a) {
        BOOST_TEST(packing.length(a) == lengths[static_cast<std::size_t>(a)], boost::test_tools::tolerance(1e-12));
    }
}

/// `["held", coordinate]` besides what contacts of states are.
Contact contact_or_held(const nlohmann::json& c) {
    return c[0] == "held" ? Contact{ContactKind::held, c[1], 0} : test::contact_of(c);
}

} // namespace

BOOST_AUTO_TEST_CASE(two_spheres_go_round_a_loop) {
    const double dx = std::sqrt(7.0); // radii 1 and 2
    const Played down = one_proved_arc(start_of_spheres("closed_two", {1, 1.5, 1}), -1);
    ::crafted::check_arc(down, floor_of(1), ::crafted::left(1), 1 / dx);
    check_sphere_lengths(down.state.packing, {4, 4, 3 + dx});
    const Played up = one_proved_arc(down.state, +1);
    ::crafted::check_arc(up, ::crafted::left(1), floor_of(1), dx);
    check_sphere_lengths(up.state.packing, {3 + dx, 4, 4});
    const EquilibriumRecord& there = down.records.equilibria.back();
    BOOST_TEST(there.strain[2] == 1 - (3 + dx), boost::test_tools::tolerance(1e-12)); // lengths of reference are 1
    BOOST_TEST(there.potential == 4 + 6 + (3 + dx) / dx, boost::test_tools::tolerance(1e-12));
}

/// The small ones in opposite corners of the floor: the large one leaves it for a wall, and comes back.
BOOST_AUTO_TEST_CASE(three_spheres_go_round_a_loop) {
    const nlohmann::json file = test::read_spheres("closed_three");
    const nlohmann::json& expected = file["expected"];
    const State start = start_of_spheres("closed_three", {1, 1.3, 2.5});
    const Played down = one_proved_arc(start, -1);
    ::crafted::check_arc(down, floor_of(2), ::crafted::left(2),
                         std::stod(expected["limit_down"]["F_3"].get<std::string>()));
    check_sphere_lengths(down.state.packing, expected["limit_down"]["then_cell"].get<PerAxis<double>>());
    const Played up = one_proved_arc(down.state, +1);
    ::crafted::check_arc(up, ::crafted::left(2), floor_of(2), expected["way_back"]["F_3"].get<double>());
    check_sphere_lengths(up.state.packing, {start.packing.length(0), start.packing.length(1), start.packing.length(2)});
}

// F_1 = 1 - t, F_2 = 1.5 - t, F_3 = 1 + 2 t: the floor of the small sphere opens at F_3 / F_1 = tau, t < 0.
BOOST_AUTO_TEST_CASE(two_spheres_go_round_a_loop_at_constant_mean_stress) {
    const double tau = 1 / std::sqrt(7.0);
    State start = start_of_spheres("closed_two", {1, 1.5, 1});
    start.load.follow({-1, -1, 2});
    const Played down = ::crafted::play(start, -1, 1);
    ::crafted::check_arc(down, floor_of(1), ::crafted::left(1), (tau - 1) / (tau + 2));
    check_sphere_lengths(down.state.packing, {4, 4, 3 + std::sqrt(7.0)});
    const Played up = ::crafted::play(down.state, +1, 1);
    ::crafted::check_arc(up, ::crafted::left(1), floor_of(1), (1 / tau - 1) / (1 / tau + 2));
    BOOST_TEST(up.records.equilibria.back().mean_stress == 3.5 / 3, boost::test_tools::tolerance(1e-12));
    BOOST_CHECK_THROW((void)::crafted::play(down.state, +1, 1, {}, {.certify = CertifyLevel::arcs}), isostat::Error);
    start.load.follow({0, 0, -1}); // extension: t rises as sigma3 falls
    ::crafted::check_arc(::crafted::play(start, +1, 1), floor_of(1), ::crafted::left(1), 1 - tau);
}

// The forces of every equilibrium by a dense solution that knows nothing of the program: they are affine in t.
BOOST_AUTO_TEST_CASE(intervals_at_constant_mean_stress_are_those_of_a_dense_solution) {
    for (const char* name : {"box_uniform_30_1", "ortho_uniform_30_1"}) {
        State state = test::state_of_spheres(test::read_spheres(name));
        state.load.follow({-1, -1, 2});
        snap_to_grid(state.packing);
        const Played played = ::crafted::completed(::crafted::play(state, +1, 2));
        for (std::size_t k : {std::size_t{0}, played.records.states.size() - 1}) {
            const EquilibriumRecord& record = played.records.equilibria[k];
            const oracle::TruthIn<long double> dense(played.records.states[k], oracle::At::stored);
            BOOST_TEST_REQUIRE(dense.known, dense.why);
            const auto low = static_cast<double>(dense.low.stress), high = static_cast<double>(dense.high.stress);
            BOOST_TEST((!dense.low.unbounded && !dense.high.unbounded));
            BOOST_TEST(record.stress_low == low, boost::test_tools::tolerance(1e-8));
            BOOST_TEST(record.stress_high == high, boost::test_tools::tolerance(1e-8));
        }
        BOOST_TEST(played.records.equilibria.back().stress > 0);
    }
}

BOOST_AUTO_TEST_CASE(a_sphere_of_a_tetrahedron_leaves_with_its_four_contacts) {
    const Played start =
        ::crafted::completed(::crafted::play(start_of_spheres("closed_tetra", {1, 1, 1}), +1, {}, 1.5));
    const EquilibriumRecord& record = start.records.equilibria.front();
    BOOST_TEST(record.stress_high == 2.0, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(record.stress_low == 0.4, boost::test_tools::tolerance(1e-12));
    BOOST_TEST((record.opens_low == floor_of(0)), to_string(record.opens_low));
    const std::vector<Contact> four{
        {ContactKind::upper_wall, 1, 0}, {ContactKind::upper_wall, 1, 1}, floor_of(1), ::crafted::pair(0, 1)};
    BOOST_TEST((std::ranges::find(four, record.opens_high) != four.end()), to_string(record.opens_high));
}

BOOST_AUTO_TEST_CASE(sequences_of_an_independent_program_are_followed) {
    for (const nlohmann::json& sequence : test::read_spheres("sequences")) {
        const std::string name = sequence["start"];
        BOOST_TEST_INFO_SCOPE(name << ", " << sequence["load"]);
        State state = test::state_of_spheres(test::read_spheres(name));
        Load& load = state.load;
        const int count = static_cast<int>(sequence["equilibria"].size());
        double unit = load.stress[2];
        if (sequence["load"] == "true") {
            load.kind = LoadKind::true_stress;
            load.stress = {1, 1, 1};
            load.refer_to(state.packing);
            unit = 1;
        } else if (sequence["load"] == "shear") {
            load.loaded_axis = 3;
            unit = std::stod(sequence["unit_force"].get<std::string>());
        }
        snap_to_grid(state.packing);
        const Played played = ::crafted::completed(::crafted::play(state, sequence["load"] == "down" ? -1 : +1, count));
        std::size_t next = 0;
        for (const nlohmann::json& equilibrium : sequence["equilibria"]) {
            const double ratio = std::stod(equilibrium["ratio"].get<std::string>());
            for (const nlohmann::json& arc : equilibrium["arcs"]) {
                BOOST_TEST_REQUIRE(next < played.records.arcs.size());
                const ArcRecord& found = played.records.arcs[next++];
                BOOST_TEST((found.opened == contact_or_held(arc[0])), arc << ": " << to_string(found.opened));
                BOOST_TEST((found.closed == contact_or_held(arc[1])), arc << ": " << to_string(found.closed));
                BOOST_TEST(found.stress / unit == ratio, boost::test_tools::tolerance(1e-9));
            }
        }
        BOOST_TEST(next == played.records.arcs.size());
        BOOST_TEST(played.records.equilibria.size() == static_cast<std::size_t>(count) + 1);
    }
}

/// A triclinic cell is loaded along an axis, and sheared in each of its three planes.
BOOST_AUTO_TEST_CASE(every_arc_of_spheres_is_certified_with_its_power_and_none_is_changed) {
    struct Loaded {
        const char* name;
        int axis, equilibria;
    };
    for (const auto& [name, axis, equilibria] :
         {Loaded{"box_uniform_30_1", 2, 1}, Loaded{"slab_uniform_30_1", 2, 3}, Loaded{"ortho_uniform_30_1", 0, 1},
          Loaded{"tri_uniform_30_1", 2, 1}, Loaded{"tri_uniform_30_1", 3, 1}, Loaded{"tri_uniform_30_1", 4, 1},
          Loaded{"tri_uniform_30_1", 5, 1}}) {
        BOOST_TEST_INFO_SCOPE(name << " along " << axis);
        State state = test::state_of_spheres(test::read_spheres(name));
        state.load.loaded_axis = axis;
        snap_to_grid(state.packing);
        const RunOptions options{.max_strain = 1e9, .certify = CertifyLevel::arcs};
        const Played plain = ::crafted::play(state, +1, equilibria, {}, {.max_strain = 1e9});
        const Played proved = ::crafted::completed(::crafted::play(state, +1, equilibria, {}, options));
        BOOST_TEST((plain.state.packing.q == proved.state.packing.q));
        BOOST_TEST_REQUIRE(plain.records.arcs.size() == proved.records.arcs.size());
        for (std::size_t k = 0; k < proved.records.arcs.size(); ++k) {
            const ArcRecord& arc = proved.records.arcs[k];
            BOOST_TEST((arc.opened == plain.records.arcs[k].opened && arc.closed == plain.records.arcs[k].closed));
            BOOST_TEST_REQUIRE(arc.certificate.has_value());
            BOOST_TEST((arc.certificate->verdict == Verdict::proved), arc.step << ": " << arc.certificate->reason);
            BOOST_TEST((arc.certificate->power == Verdict::proved), arc.step << ": " << arc.certificate->power_reason);
        }
    }
}
