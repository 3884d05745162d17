// Equilibria made by an independent program, and the sequences that it reached from them in plain double precision.
// What opens and closes, arc by arc, is what it was before the linear algebra was made faster: a change of the last
// bits is allowed, another event is not.
#include "support/crafted.hpp"
#include "support/scratch.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

using namespace isostat;
using namespace ::crafted;

namespace {

/// Lines of a file that are no comments.
std::vector<std::string> recorded(const std::string& name) {
    std::vector<std::string> lines = scratch::lines_of(scratch::data(name));
    std::erase_if(lines, [](const std::string& line) { return line.starts_with("#"); });
    return lines;
}

State sample(const std::string& disks) {
    return read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex" + disks + ".txt").state;
}

/// Of a run that consists of these parts.
void same_events(const std::string& disks, const std::vector<const Played*>& parts) {
    std::vector<std::string> events;
    int before = 0;
    for (const Played* part : parts) {
        for (const ArcRecord& arc : part->records.arcs) {
            events.push_back(
                fmt::format("{} {} > {}", before + arc.equilibrium, to_string(arc.opened), to_string(arc.closed)));
        }
        before += part->counters.equilibria;
    }
    const std::vector<std::string> expected = recorded("events" + disks + ".txt");
    BOOST_REQUIRE(expected.size() > 20);
    BOOST_TEST(events == expected, boost::test_tools::per_element());
}

/// Loading, equilibrium by equilibrium: rows of equilibrium, sigma2/sigma1, eps2, eps1, backbone, rattlers, arcs. Then
/// unloading to equal stresses, which does not retrace the loading.
void compare(const std::string& disks) {
    const std::vector<std::string> rows = recorded("sequence" + disks + ".txt");
    BOOST_REQUIRE(rows.size() > 10);
    const Played up = completed(play(sample(disks), +1, static_cast<int>(rows.size()) - 1));
    BOOST_REQUIRE_EQUAL(up.records.equilibria.size(), rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        BOOST_TEST_INFO_SCOPE("equilibrium " << k);
        const EquilibriumRecord& e = up.records.equilibria[k];
        std::istringstream fields(rows[k]);
        const std::vector<double> row{std::istream_iterator<double>(fields), {}};
        BOOST_REQUIRE_EQUAL(row.size(), 7U);
        const double tolerance = 1e-9;
        BOOST_TEST(std::abs(e.stress - row[1]) <= tolerance);
        BOOST_TEST(std::abs(e.strain[1] - row[2]) <= tolerance);
        BOOST_TEST(std::abs(e.strain[0] - row[3]) <= tolerance);
        BOOST_TEST(e.backbone == static_cast<int>(row[4]));
        BOOST_TEST(e.rattlers == static_cast<int>(row[5]));
        BOOST_TEST(e.arcs == static_cast<int>(row[6]));
        BOOST_TEST((e.verdict == Verdict::proved));
    }
    const Played down = completed(play(up.state, -1, {}, 1.0));
    same_events(disks, {&up, &down});
    const double peak = up.records.equilibria.back().strain[1];
    const EquilibriumRecord& left = down.records.equilibria.back();
    BOOST_TEST(left.stress == 1.0);
    BOOST_TEST(left.strain[1] > 0.1 * peak);
    BOOST_TEST(left.strain[1] < 0.95 * peak);
}

} // namespace

BOOST_AUTO_TEST_CASE(the_sample_of_100_disks_reaches_the_same_14_equilibria_and_goes_back_another_way) {
    compare("100");
}

BOOST_AUTO_TEST_CASE(the_sample_of_400_disks_reaches_the_same_20_equilibria_and_goes_back_another_way) {
    compare("400");
}

BOOST_AUTO_TEST_CASE(the_sample_of_1936_disks_is_an_equilibrium_and_makes_ten_more) {
    const State start = sample("1936");
    const auto inspection = required(inspect_vertex(start));
    BOOST_TEST(inspection.equilibrium, inspection.remark);
    BOOST_TEST(inspection.record.dof_count == 2 * 1936 + 2);
    const Played run = completed(play(start, +1, 10));
    for (const auto& e : run.records.equilibria) {
        BOOST_TEST((e.verdict == Verdict::proved));
        BOOST_TEST(e.backbone == 2 * (1936 - e.rattlers) + 2);
        BOOST_TEST(e.min_force > e.force_bound);
        BOOST_TEST(e.stress_low < e.stress);
        BOOST_TEST(e.stress < e.stress_high);
    }
    same_events("1936", {&run});
}
