// Periodic packings from random disks: proved vertices, and what may not change them.

#include "preparation/soft.hpp"
#include "support/prepared.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/error.hpp>
#include <isostat/io/state_file.hpp>

namespace {

using namespace isostat;

PreparationOptions periodic(int disks, std::uint64_t seed) {
    return {.disks = disks, .seed = seed, .cell = PreparedCell::rectangular};
}

} // namespace

BOOST_AUTO_TEST_CASE(periodic_packings_are_proved_equilibria) {
    for (const auto& [disks, seeds] : {std::pair{30, 5}, {100, 2}}) {
        for (int seed = 1; seed <= seeds; ++seed) {
            BOOST_TEST_INFO_SCOPE("n = " << disks << ", seed " << seed);
            const State state = prepared(periodic(disks, static_cast<std::uint64_t>(seed)));
            const Packing& packing = state.packing;
            BOOST_TEST(packing.cell.all());
            BOOST_TEST(packing.lattice(0, 1) == 0);
            BOOST_TEST(state.contacts.size() == 2 * packing.radius.size());
            BOOST_TEST(state.load.reference_length[0] == packing.length(0));
            BOOST_TEST(state.load.reference_length[1] == packing.length(1));
            for (std::size_t a = 0; a < 2; ++a) {
                double sum = 0;
                for (std::size_t k = a; k < state.load.infinitesimal.size(); k += 2) {
                    sum += state.load.infinitesimal[k];
                }
                BOOST_TEST(sum == 0);
            }
            const Certification proof = certify(state);
            BOOST_TEST((proof.verdict == Verdict::proved));
            BOOST_TEST(packing.solid_fraction() > 0.75);
            BOOST_TEST(packing.solid_fraction() < 0.9);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_tilt_that_moves_bears_no_shear_and_has_its_contact) {
    PreparationOptions options = periodic(60, 1);
    options.cell = PreparedCell::tilted;
    const State state = prepared(options);
    BOOST_TEST(state.contacts.size() == 2 * state.packing.radius.size() + 1);
    BOOST_TEST(state.packing.lattice(0, 1) != 0);
    BOOST_TEST(std::abs(state.packing.lattice(0, 1)) < 0.1 * state.packing.length(0));
    BOOST_TEST((state.load.shear == isostat::PerTilt<double>{}));
    const Certification proof = certify(state);
    BOOST_TEST((proof.verdict == Verdict::proved));
    BOOST_TEST((inspect_cell(state, proof).strict.verdict == Verdict::proved));
    // Downhill under a larger stress along y: at an isotropic pressure a force would be negative.
    options.ratio = 1.3;
    const State pressed = vertex_near(state.packing, options);
    BOOST_TEST(pressed.packing.length(1) < state.packing.length(1));
    BOOST_TEST((inspect_cell(pressed, certify(pressed)).strict.verdict == Verdict::refuted));
}

// The vertex of the cell that is stored, found again with overlaps everywhere: all pairs across the sides count.
BOOST_AUTO_TEST_CASE(a_vertex_is_found_again_in_its_cell) {
    const State state = prepared(periodic(30, 3));
    Packing soft = state.packing;
    for (double& x : soft.q) {
        x *= 1 - 1e-6;
    }
    PreparationOptions options = periodic(30, 3);
    PreparationReport report;
    const State again = vertex_near(soft, options);
    BOOST_TEST(std::abs(again.packing.length(0) - state.packing.length(0)) < 1e-11);
    BOOST_TEST(std::abs(again.packing.length(1) - state.packing.length(1)) < 1e-11);
    soft.cell.period_moves = {true, false};
    BOOST_CHECK_THROW((void)find_vertex(soft, options, report), Error);
}

BOOST_AUTO_TEST_CASE(a_vertex_is_found_in_a_channel) {
    Packing soft = read_any_state(std::string(ISOSTAT_TEST_DATA) + "/cells/channel_16.json").state.packing;
    for (double& x : soft.q) {
        x *= 1 - 1e-6;
    }
    PreparationOptions options = periodic(16, 1);
    PreparationReport report;
    const State state = vertex_near(soft, options);
    BOOST_TEST(state.contacts.size() == 2 * state.packing.radius.size() + 1);
    BOOST_TEST((certify(state).verdict == Verdict::proved));
    const auto some = [&](auto holds) { return std::any_of(state.contacts.begin(), state.contacts.end(), holds); };
    BOOST_TEST(some([](const Contact& c) { return !c.image.is_here(); }));
    BOOST_TEST(some([](const Contact& c) { return c.kind == ContactKind::upper_wall; }));
    BOOST_TEST(some([](const Contact& c) { return c.kind == ContactKind::lower_wall; }));
    soft.cell.period_moves = {false, false};
    BOOST_CHECK_THROW((void)find_vertex(soft, options, report), Error);
}

BOOST_AUTO_TEST_CASE(the_same_seed_gives_the_same_cell_and_units_do_not_matter) {
    const State one = prepared(periodic(30, 2));
    const State other = prepared(periodic(30, 2));
    BOOST_TEST(one.packing.q == other.packing.q, boost::test_tools::per_element());
    PreparationOptions large = periodic(30, 2);
    large.radii = one.packing.radius;
    for (double& r : large.radii) {
        r *= 1024;
    }
    const State scaled = prepared(large);
    BOOST_TEST((scaled.contacts == one.contacts));
    for (std::size_t k = 0; k < one.packing.q.size(); ++k) {
        BOOST_TEST(scaled.packing.q[k] == 1024 * one.packing.q[k]);
    }
}

// Where the disks are drawn must not matter for the forces: all pairs across the sides are there. A cell shifted by
// half a period has other images, and relaxes to the same pressure and number of contacts.
BOOST_AUTO_TEST_CASE(soft_disks_feel_their_images) {
    Packing packing;
    packing.walls = Walls::none();
    packing.cell.periodic = packing.cell.period_moves = {true, true};
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 6; ++x) {
            packing.radius.push_back(1);
            packing.q.insert(packing.q.end(), {1.99 * x + 0.3, 1.99 * y - 0.7});
        }
    }
    packing.q.insert(packing.q.end(), {6 * 1.99, 6 * 1.99, 0});
    // A square lattice under the pressure of its overlaps, 0.01 / 1.99: every disk balanced, every contact there.
    isostat::preparation::SoftDynamics dynamics(packing, false, nullptr, [](double) {});
    const auto measures = dynamics.relax(0.01 / 1.99, 1e-6, 0);
    BOOST_TEST(measures.contacts == 72);
    BOOST_TEST(measures.residual < 1e-9);
    BOOST_TEST(measures.pressure_error < 1e-9);
    BOOST_TEST(std::abs(measures.overlap - 0.005) < 1e-12);
}

BOOST_AUTO_TEST_CASE(too_few_or_too_many_disks_are_refused) {
    PreparationReport report;
    BOOST_CHECK_THROW((void)prepare(periodic(9000, 1), report), Error);
    PreparationOptions options = periodic(30, 1);
    options.load = LoadKind::true_stress;
    BOOST_TEST((certify(prepared(options)).verdict == Verdict::proved));
    options.cell = PreparedCell::tilted; // no potential
    BOOST_CHECK_THROW((void)prepare(options, report), Error);
    PreparationOptions few = periodic(3, 1); // the cell becomes narrower than four diameters
    BOOST_CHECK_THROW((void)prepare(few, report), Error);
}

BOOST_AUTO_TEST_CASE(a_way_down_that_flattens_the_cell_ends_with_words) {
    // Found by the search for contradictions: a large stress along y shears and flattens a cell of four disks.
    Packing start;
    start.walls = Walls::none();
    start.radius = {2.7876204452241971, 0.65472544046501935, 1.0015561869148328, 3.2929607891851669};
    start.q = {5.8328524909703203, 3.6381445016534553, 3.5319556976286353,   6.2488283970903336,
               8.9283998854660425, 1.3884984014368156, -0.24170659535067671, 4.5402521862358807,
               12.149213315945422, 6.0596347498486081, -2.7414239873924848};
    start.cell = {{true, true}, {true, true}, {true}, 2};
    PreparationOptions options{.stress = 0.50053308055745815, .ratio = 3.7831519571624725};
    PreparationReport report;
    const Result<State> found = find_vertex(start, options, report);
    BOOST_REQUIRE(!found.ok());
    BOOST_TEST((found.failure().kind == FailureKind::not_converged));
    BOOST_TEST((found.failure().message().find("too flat, or too tilted") != std::string::npos),
               found.failure().message());
    options.ratio = 1;
    BOOST_TEST(find_vertex(start, options, report).ok());
}
