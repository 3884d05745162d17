// A whole programme: its segments one after the other, from the last equilibrium or an earlier one.
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/trajectory/trajectory.hpp>

using namespace isostat;

namespace {

/// With which segments began where.
struct ProgrammeCourse : ::crafted::Recorder {
    std::vector<std::pair<int, int>> begun; ///< segment, equilibrium it starts from
    int direction = 0;                      ///< of the last segment
    void on_segment(int number, const Segment& goal, int made, const State& from) override {
        BOOST_TEST(made == 0);
        begun.emplace_back(number, from.equilibrium);
        direction = goal.direction;
    }
    void on_equilibrium(const EquilibriumRecord& record, const State& state,
                        const std::vector<double>& forces) override {
        BOOST_TEST(record.number == static_cast<int>(states.size()));
        ::crafted::Recorder::on_equilibrium(record, state, forces);
    }
};

ProgrammeStep up(int equilibria) {
    ProgrammeStep step;
    step.equilibria = equilibria;
    step.name = "up";
    return step;
}

/// Of the 100 disks of tests/data.
ProgrammeOutcome played(ProgrammeCourse& course, const std::vector<ProgrammeStep>& steps) {
    State state = read_state(ISOSTAT_TEST_DATA "/vertex100.txt").state;
    Programme programme;
    programme.steps = steps;
    programme.source = "here";
    programme.stored = [&](int equilibrium) { return course.states.at(static_cast<std::size_t>(equilibrium)); };
    RunCounters counters;
    return play(programme, state, {}, counters, course);
}

} // namespace

BOOST_AUTO_TEST_CASE(a_programme_goes_on_from_the_last_equilibrium_or_from_an_earlier_one) {
    ProgrammeStep again = up(2);
    again.from = 2;
    ProgrammeStep back;
    back.action = Action::down;
    back.to = 1.0;
    ProgrammeCourse course;
    const ProgrammeOutcome outcome = played(course, {up(2), up(2), again, back});
    BOOST_TEST(!outcome.failure);
    BOOST_TEST(outcome.impossible.empty());
    BOOST_TEST((course.begun == std::vector<std::pair<int, int>>{{0, 0}, {1, 2}, {2, 2}, {3, 6}}));
    BOOST_TEST(course.direction == -1);
    // The third segment does again what the second one did, bit by bit.
    BOOST_TEST_REQUIRE(course.equilibria.size() > 7U);
    BOOST_TEST(course.equilibria[5].stress == course.equilibria[3].stress);
    BOOST_TEST(course.equilibria[6].stress == course.equilibria[4].stress);
    BOOST_TEST((course.states[6].packing.q == course.states[4].packing.q));
    BOOST_TEST(course.states.back().load.stress[1] == course.states.back().load.stress[0]);
}

BOOST_AUTO_TEST_CASE(a_segment_that_cannot_begin_says_why_in_words) {
    ProgrammeStep from = up(1);
    from.from = 3;
    ProgrammeCourse course;
    ProgrammeOutcome outcome = played(course, {up(1), from});
    BOOST_TEST(outcome.impossible == "segment \"up\" starts from equilibrium 3, but the run has only reached 1");
    ProgrammeStep behind;
    behind.to = 0.5;
    behind.name = "behind";
    behind.line = 7;
    ProgrammeCourse other;
    outcome = played(other, {up(1), behind});
    BOOST_TEST(outcome.segment == "behind");
    BOOST_TEST(outcome.impossible.starts_with("here:7: segment \"behind\": sigma2/sigma1 is 1.0"), outcome.impossible);
    BOOST_TEST(other.states.size() == 2U);
}
