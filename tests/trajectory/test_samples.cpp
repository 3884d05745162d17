// Equilibria made by an independent program, and the sequences that it reached from them in plain double precision.
#include "support/crafted.hpp"

#include <isostat/certificate/inspect.hpp>
#include <isostat/io/state_file.hpp>

using namespace isostat;
using namespace ::crafted;

namespace {

State sample(const std::string& name) {
    return read_state(std::string(ISOSTAT_TEST_DATA) + "/" + name).state;
}

/// Rows of a sequence file: equilibrium, sigma2/sigma1, eps2, eps1, backbone, rattlers, arcs.
std::vector<std::array<double, 7>> sequence(const std::string& name) {
    std::ifstream file(std::string(ISOSTAT_TEST_DATA) + "/" + name);
    std::vector<std::array<double, 7>> rows;
    for (std::string line; std::getline(file, line);) {
        if (!line.empty() && line[0] != '#') {
            std::istringstream fields(line);
            rows.emplace_back();
            for (double& value : rows.back()) {
                fields >> value;
            }
            BOOST_REQUIRE(fields);
        }
    }
    BOOST_REQUIRE(rows.size() > 2);
    return rows;
}

void compare(const std::string& vertex, const std::string& expected, double tolerance) {
    const auto rows = sequence(expected);
    const Played run = play(sample(vertex), +1, static_cast<int>(rows.size()) - 1);
    BOOST_REQUIRE_MESSAGE(run.outcome.completed, run.why());
    BOOST_REQUIRE_EQUAL(run.records.equilibria.size(), rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const EquilibriumRecord& e = run.records.equilibria[k];
        BOOST_TEST_INFO_SCOPE("equilibrium " << k);
        BOOST_TEST(std::abs(e.stress - rows[k][1]) <= tolerance);
        BOOST_TEST(std::abs(e.strain[1] - rows[k][2]) <= tolerance);
        BOOST_TEST(std::abs(e.strain[0] - rows[k][3]) <= tolerance);
        BOOST_TEST(e.backbone == static_cast<int>(rows[k][4]));
        BOOST_TEST(e.rattlers == static_cast<int>(rows[k][5]));
        BOOST_TEST(e.arcs == static_cast<int>(rows[k][6]));
        BOOST_TEST((e.verdict == Verdict::proved));
    }
}

} // namespace

BOOST_AUTO_TEST_SUITE(trajectory)

BOOST_AUTO_TEST_CASE(the_sample_of_100_disks_reaches_the_same_14_equilibria) {
    compare("vertex100.txt", "sequence100.txt", 1e-9);
}

BOOST_AUTO_TEST_CASE(the_sample_of_400_disks_reaches_the_same_20_equilibria) {
    compare("vertex400.txt", "sequence400.txt", 1e-9);
}

BOOST_AUTO_TEST_CASE(the_sample_of_1936_disks_is_an_equilibrium_and_makes_ten_more) {
    const State start = sample("vertex1936.txt");
    const auto inspection = inspect_vertex(start);
    BOOST_REQUIRE(inspection.ok());
    BOOST_TEST(inspection.value().equilibrium, inspection.value().remark);
    BOOST_TEST(inspection.value().record.dof_count == 2 * 1936 + 2);
    const Played run = play(start, +1, 10);
    BOOST_REQUIRE_MESSAGE(run.outcome.completed, run.why());
    for (const auto& e : run.records.equilibria) {
        BOOST_TEST((e.verdict == Verdict::proved));
        BOOST_TEST(e.backbone == 2 * (1936 - e.rattlers) + 2);
        BOOST_TEST(e.min_force > e.force_bound);
        BOOST_TEST(e.stress_low < e.stress);
        BOOST_TEST(e.stress < e.stress_high);
    }
}

BOOST_AUTO_TEST_CASE(unloading_does_not_retrace_the_loading) {
    const Played up = play(sample("vertex100.txt"), +1, 8);
    BOOST_REQUIRE(up.outcome.completed);
    const Played down = play(up.state, -1, {}, 1.0);
    BOOST_REQUIRE_MESSAGE(down.outcome.completed, down.why());
    const double peak = up.records.equilibria.back().strain[1];
    const double left = down.records.equilibria.back().strain[1];
    BOOST_TEST(down.records.equilibria.back().stress == 1.0);
    BOOST_TEST(left > 0.1 * peak);
    BOOST_TEST(left < 0.95 * peak);
}

BOOST_AUTO_TEST_SUITE_END()
