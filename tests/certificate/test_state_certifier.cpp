// Level `states`: a certificate that refutes an equilibrium ends the run.
#include "certificate/state_certifier.hpp"
#include "support/crafted.hpp"
#include "support/scratch.hpp"

#include <boost/test/unit_test.hpp>

using namespace isostat;

namespace {

/// Two disks in a box, and what a run would say of them if it were wrong.
struct Claimed {
    State<2> state = crafted::two_disks(1, 2, 1, 1);
    EquilibriumRecord<2> record;
    RunCounters counters;
    crafted::Recorder next;
    scratch::Folder folder;
    Claimed() {
        record.number = 3;
        record.verdict = Verdict::proved;
    }
    std::optional<Failure> told() {
        StateCertifier certifier(folder.path(), "test", counters, next);
        certifier.on_equilibrium(record, state, std::vector<double>(state.contacts.size(), 1.0));
        return certifier.objection();
    }
};

} // namespace

BOOST_AUTO_TEST_SUITE(certificate)

BOOST_AUTO_TEST_CASE(a_refuted_equilibrium_ends_the_run_and_is_not_recorded_as_proved) {
    Claimed wrong;
    wrong.state.load.stress[1] = 0.01; // below the interval that the two disks support
    const auto objection = wrong.told();
    BOOST_REQUIRE(objection.has_value());
    BOOST_TEST((objection->kind == FailureKind::contradiction));
    BOOST_TEST(objection->message().find("equilibrium 3 is refuted by its certificate") != std::string::npos);
    BOOST_TEST(wrong.counters.states.refuted == 1);
    BOOST_REQUIRE(wrong.next.equilibria.size() == 1U);
    BOOST_TEST((wrong.next.equilibria[0].verdict == Verdict::refuted));
    BOOST_TEST((wrong.next.equilibria[0].certified == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(a_proved_equilibrium_is_passed_on) {
    Claimed right;
    BOOST_TEST(!right.told().has_value());
    BOOST_TEST(right.counters.states.proved == 1);
    BOOST_TEST((right.next.equilibria[0].certified == Verdict::proved));
}

BOOST_AUTO_TEST_SUITE_END()
