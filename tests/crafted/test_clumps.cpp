// Clumps in exact numbers: the counts of rigid bodies, forces in bars of any sign, and what is refused.

#include "examples.hpp"
#include "io/bad_input.hpp"
#include "support/test.hpp"

#include <isostat/crafted/exact_packing.hpp>

#include <nlohmann/json.hpp>

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

} // namespace

BOOST_AUTO_TEST_SUITE(crafted_inspection)

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

BOOST_AUTO_TEST_SUITE_END()

} // namespace crafted_clumps
