// What opens and closes, arc by arc, is what it was before the linear algebra was made faster: a change of the last
// bits is allowed, another event is not.
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>

using namespace isostat;
using namespace ::crafted;

namespace {

std::vector<std::string> recorded(const std::string& name) {
    std::ifstream file(std::string(ISOSTAT_TEST_DATA) + "/" + name);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("#")) {
            lines.push_back(line);
        }
    }
    return lines;
}

void compare(const std::string& disks, int up, bool down) {
    const std::vector<std::string> expected = recorded("events" + disks + ".txt");
    BOOST_REQUIRE(expected.size() > 20);
    State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex" + disks + ".txt").state;
    Recorder records;
    RunCounters counters;
    const RunOptions options;
    Segment segment;
    segment.equilibria = up;
    SegmentOutcome outcome = run_segment(state, segment, 0, options, counters, records);
    BOOST_REQUIRE_MESSAGE(outcome.completed, (outcome.failure ? outcome.failure->message() : ""));
    if (down) {
        segment = {};
        segment.direction = -1;
        segment.to_stress = 1.0;
        outcome = run_segment(state, segment, 1, options, counters, records);
        BOOST_REQUIRE_MESSAGE(outcome.completed, (outcome.failure ? outcome.failure->message() : ""));
    }
    std::vector<std::string> events;
    for (const ArcRecord& arc : records.arcs) {
        events.push_back(std::to_string(arc.equilibrium) + " " + to_string(arc.opened) + " > " + to_string(arc.closed));
    }
    BOOST_TEST(events == expected, boost::test_tools::per_element());
}

} // namespace

BOOST_AUTO_TEST_SUITE(trajectory)

BOOST_AUTO_TEST_CASE(a_loading_cycle_of_100_disks_opens_and_closes_what_it_did_before) {
    compare("100", 14, true);
}

BOOST_AUTO_TEST_CASE(a_loading_cycle_of_400_disks_opens_and_closes_what_it_did_before) {
    compare("400", 20, true);
}

BOOST_AUTO_TEST_CASE(ten_equilibria_of_1936_disks_open_and_close_what_they_did_before,
                     *boost::unit_test::label("slow")) {
    compare("1936", 10, false);
}

BOOST_AUTO_TEST_SUITE_END()
