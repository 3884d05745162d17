// Clumps in exact numbers: the counts of rigid bodies, forces in bars of any sign, and what is refused.

#include "crafted/genericity.hpp"
#include "examples.hpp"
#include "packing/bodies.hpp"
#include "support/bad_input.hpp"
#include "support/clumps.hpp"

#include <isostat/crafted/plateau.hpp>

namespace crafted_clumps { // names of its own, beside test_inspection.cpp

namespace {

using namespace isostat;
using namespace isostat::crafted;
using namespace examples;

PackingFile dimer(const std::string& name, const std::string& wall) {
    const std::string path = std::string(ISOSTAT_EXAMPLES) + "/packings/clump_dimer_" + name + ".toml";
    PackingFile file = read_packing(path);
    const std::string text = "format = \"isostat-packing 1\"\ndisks = [[0, 0, 1]]\n[box]\nlength = [2, 2]\n";
    file.packing.load = parse_packing(text + "[load]\nwall = " + wall + "\n", "load").packing.load;
    file.packing.load->disk.clear();
    return file;
}

void refused(const std::string& rest, const std::vector<std::string>& words) {
    expect_bad_input([&] { (void)parse_packing("format = \"isostat-packing 1\"\n" + rest, "FILE"); }, words);
}

/// With every pair up to a gap of 1e-9.
PlateauStep closed(const Packing& packing) {
    return plateau(packing, {1e-9}).steps.front();
}

/// Degrees of freedom of the rigid bodies.
int body_dofs(const Packing& packing) {
    return DofMap(packing).dof_count() - static_cast<int>(packing.bars.size());
}

} // namespace

BOOST_AUTO_TEST_CASE(clumps_in_exact_numbers_count_as_their_doubles_do) {
    const std::vector<std::string> paths = packing_files(false, true);
    BOOST_TEST(paths.size() >= 6u);
    for (const std::string& path : paths) {
        BOOST_TEST_INFO_SCOPE(path);
        const PackingFile file = read_packing(path);
        const crafted::Inspection found = inspected(file.packing);
        const Counting doubles = count_contacts(approximate(file.packing), found.contacts);
        BOOST_TEST(found.dof_count == doubles.dof_count);
        BOOST_TEST(found.contact_count() == doubles.contact_count);
        BOOST_TEST(found.rank == doubles.rank);
        BOOST_TEST(found.hyperstaticity == doubles.hyperstaticity);
        BOOST_TEST(found.mechanisms == doubles.mechanisms);
        const auto json = nlohmann::json::parse(to_json(found, file.packing));
        BOOST_TEST(json.at("N") == json.at("contacts").size());
        BOOST_TEST(json.at("bodies").at(0).size() >= 2u);
    }
}

BOOST_AUTO_TEST_CASE(one_choice_of_forces_on_clumps_is_in_balance) {
    const PackingFile file = dimer("flat", "[1, 2]");
    const crafted::Inspection found = inspected(file.packing);
    const DofMap dofs(approximate(file.packing));
    const exact::NumberMatrix matrix = exact_contact_matrix(file.packing, dofs, found.contacts);
    std::vector<Number> force = external_force(file.packing, dofs);
    BOOST_REQUIRE(found.forces.size() == matrix.column.size());
    for (std::size_t l = 0; l < matrix.column.size(); ++l) {
        BOOST_TEST((l >= 6 || found.forces[l].sign() > 0));
        for (const auto& [dof, value] : matrix.column[l]) {
            force[static_cast<std::size_t>(dof)] -= value * found.forces[l];
        }
    }
    for (const Number& rest : force) {
        BOOST_TEST(rest.is_zero());
    }
    BOOST_TEST((found.forces.back() == Number(2) / Number(3))); // 1 over the length 3/2
}

BOOST_AUTO_TEST_CASE(clumps_that_bear_no_load_are_refuted_where_nothing_is_hyperstatic) {
    const crafted::Inspection lies = inspected(dimer("lies", "[12, 4]").packing);
    BOOST_TEST((lies.support == Support::none));
    BOOST_TEST((lies.stable == Verdict::refuted));
    const crafted::Inspection flat = inspected(dimer("flat", "[-1, 1]").packing);
    BOOST_TEST((flat.support == Support::none));
    BOOST_TEST((flat.stable == Verdict::undecided));
    // A pull in the bar is no contact under tension.
    const PackingFile pulled = parse_packing("format = \"isostat-packing 1\"\ndisks = [[1, 1, 1], [4, 5, 1]]\nbodies = "
                                             "[[0, 1]]\n[load]\ndisk = [[0, -3, -4], [1, 3, 4]]\n",
                                             "FILE");
    const crafted::Inspection free = inspected(pulled.packing);
    BOOST_TEST((free.forces == std::vector<Number>{Number(-1)}));
    BOOST_TEST(free.dof_count == 3);
    BOOST_TEST(free.mechanisms == 3);
}

BOOST_AUTO_TEST_CASE(bodies_that_are_none_are_refused) {
    const std::string disks = "disks = [[0, 0, 1], [3, 0, 1], [6, 0, 1], [3, 0, 1]]\n";
    refused(disks + "bodies = [[0, 1], [1, 2]]\n", {"FILE:3", "bodies is 1", "once"});
    refused(disks + "bodies = [[0, 4]]\n", {"FILE:3", "0 to 3"});
    refused(disks + "bodies = [[0]]\n", {"FILE:3", "two members"});
    refused(disks + "bodies = [[1, 3]]\n", {"FILE:3", "one place"});
    refused(disks + "bodies = [[0, 1, 2]]\n", {"FILE:3", "one line"});
    const std::string third = "disks = [[0, 0, 1], [0.1, 0.3, 1], [0.3, 0.9, 1], [5, 5, 1]]\n";
    refused(third + "bodies = [[0, 1, 2]]\n", {"FILE:3", "one line"}); // not so in doubles
    refused("bodies = [[0, 1]]\ndisks = [[3, 0, 1]]\n[[disk]]\nx = 0\ny = 0\nr = 1\nfixed = true\n",
            {"FILE:2", "bodies is 1", "not fixed"});
}

/// Its counts, without its list of contacts; with one pair more than it lists the packing has a self-stress.
BOOST_AUTO_TEST_CASE(plateaus_of_clumps_have_the_counts_of_an_independent_program) {
    for (const char* const kind : {"dimer_20_", "dimer2_20_", "trimer_20_"}) {
        for (const char number : {'1', '2', '3'}) {
            const State state = test::clumps(kind + std::string(1, number));
            const auto expected = nlohmann::json::parse(state.provenance)["expected"];
            BOOST_TEST_INFO_SCOPE(kind << number);
            const Plateau found = plateau(state.packing, {1e-9, 0.05});
            const PlateauStep& step = found.steps.front();
            BOOST_TEST(step.rattlers == static_cast<int>(expected["rattlers"].size()));
            BOOST_TEST(step.backbone.dof_count == expected["N_f_of_loaded_bodies"].get<int>());
            BOOST_TEST(step.backbone.contact_count == expected["N"].get<int>());
            BOOST_TEST(step.backbone.hyperstaticity == 0);
            BOOST_TEST(step.backbone.mechanisms == expected["k"].get<int>());
            BOOST_TEST(step.backbone.turns == static_cast<int>(expected["rotational_rattlers"].size()));
            BOOST_TEST((step.backbone.isostatic == Verdict::proved));
            BOOST_TEST(step.all.dof_count == 62);
            const auto inside = [](const PlateauRange& range) { return range.first < 1e-9 && range.last > 1e-9; };
            BOOST_TEST(std::ranges::count_if(found.ranges, inside) == 1);
            BOOST_TEST((backbone_at(state.packing, 1e-9).size() == expected["N"].get<std::size_t>()));
            for (const Contact& contact : backbone_at(state.packing, 0.05)) {
                BOOST_TEST((!contact.of_disks() ||
                            Bodies(state.packing).of(contact.i) != Bodies(state.packing).of(contact.j)));
            }
        }
    }
}

/// Pressed by two opposite forces a body carries them where they are in one line.
BOOST_AUTO_TEST_CASE(forces_that_would_turn_a_body_are_not_in_the_backbone_of_a_plateau) {
    const auto pressed = [](double lid) { // the members stand on the bottom and under a part of the lid
        return closed(test::clumps_of(R"({"format": "isostat-state", "version": 2, "length": [10, )" +
                                      std::to_string(lid) + R"(], "load": {"stress": [1, 1],
            "reference_length": [1, 1]}, "disks": [[3, 1, 1], [4, 3, 1]], "bars": [[0, 1, "0x1.1e3779b97f4a8p+1"]],
            "contacts": []})")
                          .packing);
    };
    BOOST_TEST(pressed(4).all.contact_count == 2);
    BOOST_TEST(pressed(4).all.turns == 0);
    BOOST_TEST(pressed(4).rattlers == 1);
    const PlateauStep turns = closed(test::disk_with_a_dangling_member().packing);
    BOOST_TEST(turns.rattlers == 0);
    BOOST_TEST(turns.backbone.turns == 1);
    BOOST_TEST(turns.backbone.mechanisms == 1);
    BOOST_TEST((turns.backbone.isostatic == Verdict::proved));
    BOOST_TEST(pressed(4.5).all.contact_count == 1);
    BOOST_TEST(pressed(4.5).all.turns == 1);
}

BOOST_AUTO_TEST_CASE(plateaus_of_clumps_in_space_and_in_cells) {
    const PlateauStep lies = closed(test::lying_dimer_in_space().packing);
    BOOST_TEST(lies.backbone.dof_count == 8);
    BOOST_TEST((lies.backbone.isostatic == Verdict::proved));
    const PlateauStep corner = closed(test::sphere_in_a_corner().packing); // two turns, as of any dimer
    BOOST_TEST(corner.all.contact_count == 3);
    BOOST_TEST(corner.all.turns == 2);
    const PlateauStep row = closed(test::row_of_dimers().packing);
    BOOST_TEST(row.backbone.contact_count == 4);
    BOOST_TEST((row.backbone.isostatic == Verdict::proved));
    expect_bad_input([] { (void)closed(test::pendulums(-3, -4).packing); }, {"bar 0-1", "not fixed"});
    expect_bad_input([] { (void)closed(test::oval_in_a_box(1, 1).packing); }, {"arcs"});
}

/// Two parallel contacts at either side; with other radii and places one of the four opens.
BOOST_AUTO_TEST_CASE(equal_members_become_isostatic_with_other_radii_and_places) {
    const PackingFile flat = dimer("flat", "[1, 1]");
    const Packing packing = approximate(flat.packing);
    const std::vector<Contact> contacts = inspected(flat.packing).contacts;
    GenericityOptions options{.samples = 20, .size = 1e-4};
    const Genericity found = genericity(packing, contacts, options);
    BOOST_TEST(found.proved == 20);
    BOOST_TEST(found.lists.size() == 4U); // each of them
    for (const GenericitySample& sample : found.samples) {
        BOOST_TEST(sample.carrying.size() == 5U);
        BOOST_TEST(sample.within_original);
        BOOST_TEST(sample.turns + sample.rattlers + sample.mechanisms == 0);
    }
    options.keep_equal = true; // equal members at other sizes lie flat again
    const Genericity equal = genericity(packing, contacts, options);
    BOOST_TEST(equal.proved == 0);
    BOOST_TEST(equal.ties == 20);
    const Packing lies = approximate(dimer("lies", "[1, 1]").packing); // other radii: what is left are the places
    options.samples = 1;
    const double fixed = genericity(lies, {}, options).samples.front().min_force;
    options.keep_equal = false;
    const double moved = genericity(lies, {}, options).samples.front().min_force;
    BOOST_TEST((fixed > 0 && std::abs(moved - fixed) > 1e-6 && std::abs(moved - fixed) < 1e-2));
    const auto all = [&](const char* name) { return genericity(approximate(example(name)), {}, {.samples = 10}); };
    BOOST_TEST(all("clump_cell_square.toml").proved == 10); // h = 1 before
    BOOST_TEST(all("clump_trimer_and_disk.toml").proved == 10);
    BOOST_TEST(all("clump_spheres_dimer.toml").proved == 10);
}

/// N = N_f - turns - 3 rattlers, whatever moves.
BOOST_AUTO_TEST_CASE(perturbed_packings_of_clumps_are_isostatic_but_for_rotational_rattlers) {
    int turning = 0;
    for (const char* const name : {"dimer_20_1", "dimer2_20_2", "dimer2_20_1", "trimer_20_1"}) {
        const Packing packing = test::clumps(name).packing;
        const Genericity found = genericity(packing, {}, {.samples = 10, .size = 1e-2});
        BOOST_TEST(found.proved >= 9, name);
        for (const GenericitySample& sample : found.samples) {
            if (!sample.failure) {
                BOOST_TEST(static_cast<int>(sample.carrying.size()) ==
                           body_dofs(packing) - sample.turns - 3 * sample.rattlers);
                turning += sample.turns;
            }
        }
    }
    BOOST_TEST(turning > 30);
}

} // namespace crafted_clumps
