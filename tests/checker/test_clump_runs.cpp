// Runs of clumps re-checked from their records: bars are kept, members of one body are no pair, free motions are held.
#include "checker/run_records.hpp"
#include "support/clumps.hpp"
#include "support/played.hpp"
#include "support/scratch.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>

#include <utility>

using namespace isostat;
using json::Json;

namespace {

const RunOptions every_level{.max_strain = 1e9, .certify = CertifyLevel::arcs};

/// As a scene starts: what can move freely is held, and comes to rest in the run.
State at_the_start(State state) {
    state = with_free_motions_held(std::move(state));
    state.load.refer_to(state.packing);
    (void)snap_to_grid(state.packing);
    return test::with_infinitesimal(std::move(state));
}

/// So many equilibria down, then as many up.
void play_clumps(const State& start, int equilibria, const std::filesystem::path& folder) {
    const SegmentOutcome outcome =
        played::into(folder, start, {towards(-equilibria), towards(equilibria)}, every_level, true);
    BOOST_REQUIRE_MESSAGE(outcome.completed, (outcome.failure ? outcome.failure->message(3) : ""));
}

int total(const isostat::checker::RunRecords& records, const std::string& column) {
    int sum = 0;
    for (const EquilibriumLine& line : records.equilibria) {
        sum += line.integer(column);
    }
    return sum;
}

} // namespace

BOOST_AUTO_TEST_SUITE(checker_of_clump_runs)

BOOST_AUTO_TEST_CASE(runs_of_clumps_are_proved_with_the_way_of_every_arc) {
    int held = 0;
    int turns = 0;
    for (const char* const name :
         {"dimer_20_1", "dimer_20_10", "dimer2_20_2", "dimer2_20_3", "trimer_20_1", "trimer_20_3"}) {
        BOOST_TEST_CONTEXT(name) {
            const scratch::Folder folder;
            play_clumps(at_the_start(test::clumps(name)), 5, folder / "run");
            const RunVerification run = played::proved(folder / "run");
            BOOST_TEST(run.ways_proved == run.arcs);
            BOOST_TEST(run.equilibria_proved == 11);
            turns += run.turns_checked;
            held += total(isostat::checker::read_records(folder / "run"), "held");
        }
    }
    BOOST_TEST(turns > 0);
    BOOST_TEST(held > 0); // equilibria at which a free motion stays where its power turned
}

BOOST_AUTO_TEST_CASE(runs_of_clumps_without_witnesses_are_followed_past_members_that_overlap) {
    for (const char* const name : {"dimer_20_1", "trimer_20_1"}) {
        const scratch::Folder folder;
        const SegmentOutcome outcome = played::into(folder / "run", at_the_start(test::clumps(name)),
                                                    {towards(-5), towards(5)}, {.max_strain = 1e9}, true);
        BOOST_REQUIRE_MESSAGE(outcome.completed, (outcome.failure ? outcome.failure->message() : ""));
        (void)played::proved(folder / "run");
    }
}

BOOST_AUTO_TEST_CASE(closed_forms_of_dimers_run_and_are_proved) {
    for (const State& state : {test::lying_dimer(12, 12), test::lying_dimer_in_space()}) {
        const scratch::Folder folder;
        const SegmentOutcome outcome = played::into(folder / "run", at_the_start(state), {towards(-1)}, every_level);
        BOOST_REQUIRE_MESSAGE(outcome.completed, (outcome.failure ? outcome.failure->message(3) : ""));
        const RunVerification run = played::proved(folder / "run");
        BOOST_TEST(run.ways_proved == run.arcs);
    }
}

/// The last equilibrium supports every load, though by their patterns most forces could change with it.
BOOST_AUTO_TEST_CASE(a_run_of_dimers_is_proved_up_to_the_column_that_supports_every_load) {
    const scratch::Folder folder;
    const SegmentOutcome outcome = played::into(folder / "run", at_the_start(test::clumps("dimer_20_2")), {towards(30)},
                                                {.max_strain = 1e9}, true);
    BOOST_TEST_REQUIRE(outcome.failure.has_value());
    BOOST_TEST((outcome.failure->kind == FailureKind::no_limit), outcome.failure->message());
    const RunVerification run = played::proved(folder / "run");
    BOOST_TEST(run.equilibria_proved > 10);
}

/// Of two contacts that bear one force the infinitesimal loads take one: of a body between them at a power turn (S4),
/// and of the members of a dimer that lies level (S7). The checker finds the same order.
BOOST_AUTO_TEST_CASE(runs_are_proved_where_two_contacts_of_a_body_bear_one_force) {
    for (const auto& [name, equilibria] : {std::pair("dimer2_20_8", 1), std::pair("dimer_20_5", 7)}) {
        BOOST_TEST_CONTEXT(name) {
            const scratch::Folder folder;
            const SegmentOutcome outcome = played::into(folder / "run", at_the_start(test::clumps(name)),
                                                        {towards(equilibria)}, {.max_strain = 1e9}, true);
            BOOST_REQUIRE_MESSAGE(outcome.completed, (outcome.failure ? outcome.failure->message() : ""));
            (void)played::proved(folder / "run");
        }
    }
}

/// What differs in the body makes another run: of a state file the bars are compared with those of the replay.
BOOST_AUTO_TEST_CASE(a_stored_state_with_another_bar_is_refuted) {
    const scratch::Folder folder;
    const SegmentOutcome outcome =
        played::into(folder, at_the_start(test::lying_dimer(12, 12)), {towards(-1)}, {.max_strain = 1e9});
    BOOST_REQUIRE(outcome.completed);
    (void)played::proved(folder);
    for (const char* const file : {"states/eq_000000.json", "states/eq_000001.json"}) {
        BOOST_TEST((forger::altered(folder, file, "1.625", "1.62500001").verdict == Verdict::refuted), file);
    }
}

/// A bar bears forces of either sign: no arc opens one, and none ends a supported interval.
BOOST_AUTO_TEST_CASE(a_bar_that_is_said_to_open_or_to_limit_is_refuted) {
    Certificate certificate;
    certificate.state = with_free_motions_held(test::clumps("dimer_20_2"));
    certificate.claims = certify(certificate.state).claims;
    BOOST_TEST((verify(certificate).verdict == Verdict::proved));
    BOOST_TEST(certificate.claims.load_interval->low.opens.is_unilateral());
    for (const Contact& contact : certificate.state.contacts) {
        if (contact.kind == ContactKind::bar) {
            Certificate forged = certificate;
            forged.claims.load_interval->low.opens = contact;
            BOOST_TEST((verify(forged).verdict == Verdict::refuted));
        }
    }
    // Bars that bear the force of one contact alone vanish with it; the infinitesimal loads order contacts only.
    for (const char* const name : {"dimer_20_3", "trimer_20_1", "trimer_20_2"}) { // k = 0
        const Certification made = certify(test::with_infinitesimal(test::clumps(name)));
        BOOST_TEST_REQUIRE(made.claims.load_interval.has_value());
        BOOST_TEST(made.claims.load_interval->low.opens.is_unilateral());
        BOOST_TEST(made.claims.load_interval->high.opens.is_unilateral());
    }
}

BOOST_AUTO_TEST_SUITE_END()
