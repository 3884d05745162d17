// The level `arcs`: every arc of a run with its own proof, and what a path follower that misses contacts would meet.
#include "core/work.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"
#include "support/segments.hpp"
#include "support/threads.hpp"

using namespace isostat;
using namespace ::crafted;

namespace {

const RunOptions with_arcs{.certify = CertifyLevel::arcs};

} // namespace

BOOST_AUTO_TEST_CASE(every_arc_of_a_run_is_certified_with_its_power) {
    for (const std::uint64_t seed : {2U, 5U, 7U}) {
        const Played run = play(prepared(60, seed), +1, 8, {}, with_arcs);
        BOOST_TEST(run.records.arcs.size() > 8U);
        long pieces = 0;
        for (const auto& arc : run.records.arcs) {
            BOOST_TEST_REQUIRE(arc.certificate.has_value());
            const ArcCertificate& c = *arc.certificate;
            BOOST_TEST((c.verdict == Verdict::proved), "seed " << seed << " arc " << arc.step << ": " << c.reason);
            BOOST_TEST((c.power == Verdict::proved),
                       "seed " << seed << " arc " << arc.step << ": " << c.power_reason << c.power_open_start);
            BOOST_TEST(c.tube < 1e-8);
            BOOST_TEST(c.tube_margin > 1);
            BOOST_TEST(c.gap_margin > 1);
            pieces += c.pieces;
        }
        const ArcTally& tally = run.counters.arcs;
        BOOST_TEST(tally.certified == static_cast<long>(run.records.arcs.size()));
        BOOST_TEST(tally.undecided == 0);
        BOOST_TEST(tally.pieces == pieces);
    }
}

BOOST_AUTO_TEST_CASE(centres_of_arcs_are_proved_regular_by_their_bounds_without_another_elimination) {
    const State start = prepared(60, 2);
    const auto done = [&](const RunOptions& options) {
        const auto before = work_done();
        const Played run = play(start, +1, 8, {}, options);
        auto work = work_done();
        for (std::size_t k = 0; k < work_kinds; ++k) {
            work[k] -= before[k];
        }
        return std::pair(run, work[static_cast<std::size_t>(Work::rank_proofs)]);
    };
    const auto [plain, eliminations] = done({});
    const auto [proved, all] = done(with_arcs);
    long whole = 0;
    long parts = 0;
    for (const ArcRecord& arc : proved.records.arcs) {
        (arc.certificate->witness.whole ? whole : parts) += arc.certificate->factorisations + 2; // and the ends
    }
    BOOST_TEST(whole > 20);
    BOOST_TEST(all - eliminations <= parts);
}

BOOST_AUTO_TEST_CASE(the_level_changes_no_bit_of_the_run) {
    const State start = prepared(50, 3);
    const Played plain = play(start, +1, 6);
    const Played proved = play(start, +1, 6, {}, with_arcs);
    BOOST_TEST((plain.state.packing.q == proved.state.packing.q));
    BOOST_TEST_REQUIRE(plain.records.arcs.size() == proved.records.arcs.size());
    for (std::size_t k = 0; k < plain.records.arcs.size(); ++k) {
        BOOST_TEST(!plain.records.arcs[k].certificate.has_value());
        BOOST_TEST((plain.records.arcs[k].closed == proved.records.arcs[k].closed));
        BOOST_TEST(plain.records.arcs[k].displacement == proved.records.arcs[k].displacement);
    }
}

BOOST_AUTO_TEST_CASE(the_number_of_threads_changes_no_bit_of_the_run, *boost::unit_test::label("threads")) {
    const State start = prepared(100, 4);
    const Played one = play(start, +1, 8);
    BOOST_TEST_REQUIRE(one.records.arcs.size() > 20U);
    for (const int count : {2, 3, 2}) { // whoever begins a task first
        const auto before = work_done();
        const Played several = [&] {
            const Threads threads(count);
            return play(start, +1, 8);
        }();
        const auto after = work_done();
        const auto alone = work_done();
        (void)play(start, +1, 8);
        const auto alone_after = work_done();
        for (std::size_t k = 0; k < work_kinds; ++k) {
            BOOST_TEST(after[k] - before[k] == alone_after[k] - alone[k], to_string(static_cast<Work>(k)));
        }
        BOOST_TEST((one.state.packing.q == several.state.packing.q));
        BOOST_TEST_REQUIRE(one.records.arcs.size() == several.records.arcs.size());
        for (std::size_t k = 0; k < one.records.arcs.size(); ++k) {
            const ArcRecord& a = one.records.arcs[k];
            const ArcRecord& b = several.records.arcs[k];
            BOOST_TEST((a.opened == b.opened && a.closed == b.closed));
            BOOST_TEST(a.force == b.force);
            BOOST_TEST(a.strain == b.strain);
            BOOST_TEST(a.displacement == b.displacement);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_run_that_is_stopped_shows_no_arc_that_was_steered_ahead, *boost::unit_test::label("threads")) {
    class Stopper final : public RunObserver {
      public:
        explicit Stopper(long at) : at_(at) {}
        void on_arc(const ArcRecord& arc) override {
            last = arc.step;
            stop = arc.step >= at_;
        }
        void on_equilibrium(const EquilibriumRecord&, const State&, const std::vector<double>&) override {}
        std::atomic<bool> stop = false;
        long last = 0;

      private:
        long at_;
    };
    const State start = prepared(100, 4);
    const Threads threads(2);
    for (const long at : {1L, 4L, 9L, 14L}) {
        Stopper stopper(at);
        RunOptions options{.stop = &stopper.stop};
        State state = start;
        RunCounters counters;
        const SegmentOutcome outcome = run_segment(state, towards(8), 0, options, counters, stopper);
        fails(outcome.failure, FailureKind::interrupted);
        BOOST_TEST(stopper.last == at);
        BOOST_TEST(counters.steps == at);
    }
}

BOOST_AUTO_TEST_CASE(rattlers_are_certified_in_their_own_degrees_of_freedom) {
    int rattlers = 0;
    for (const std::uint64_t seed : {1U, 4U, 6U}) {
        const Played run = play(prepared(60, seed), +1, 12, {}, with_arcs);
        for (const auto& arc : run.records.arcs) {
            if (arc.kind == ArcKind::rattler) {
                ++rattlers;
                BOOST_TEST((arc.certificate->verdict == Verdict::proved), arc.certificate->reason);
                BOOST_TEST((arc.certificate->power == Verdict::proved), arc.certificate->power_reason);
                BOOST_TEST(arc.certificate->moving < 30);
            }
        }
    }
    BOOST_TEST(rattlers > 0);
}

BOOST_AUTO_TEST_CASE(two_disks_are_certified_around_the_hysteresis_loop) {
    const State start = two_disks(1, 1.5, 1, 1);
    for (const int direction : {+1, -1}) {
        const Played run = play(start, direction, 1, {}, with_arcs);
        for (const auto& arc : run.records.arcs) {
            BOOST_TEST((arc.certificate->verdict == Verdict::proved), arc.certificate->reason);
        }
    }
}

BOOST_AUTO_TEST_CASE(true_stresses_leave_the_power_undecided_and_the_contacts_proved) {
    State start = prepared(40, 9);
    start.load.kind = LoadKind::true_stress;
    const Played run = play(start, +1, 3, {}, with_arcs);
    BOOST_TEST(!run.records.arcs.empty());
    for (const auto& arc : run.records.arcs) {
        BOOST_TEST((arc.certificate->verdict == Verdict::proved), arc.certificate->reason);
        BOOST_TEST((arc.certificate->power == Verdict::proved) == (arc.kind == ArcKind::rattler));
    }
}

BOOST_AUTO_TEST_CASE(a_power_that_turns_within_the_first_step_is_found_whatever_the_step,
                     *boost::unit_test::label("slow")) {
    // At equilibrium 59 the power of a limit arc grows from 0 and turns within a tenth of a radius.
    std::vector<std::pair<Contact, Contact>> events;
    for (const double fraction : {0.1, 0.01}) {
        RunOptions options{.step_fraction = fraction};
        Played run = play(prepared(100, 1), +1, 40, {}, options);
        const Segment down = towards(-20);
        options.max_strain = 1e9;
        const auto outcome = run_segment(run.state, down, 1, options, run.counters, run.records);
        BOOST_TEST(outcome.completed, (outcome.failure ? outcome.failure->message() : std::string()));
        std::vector<std::pair<Contact, Contact>> list;
        for (const auto& arc : run.records.arcs) {
            list.emplace_back(arc.opened, arc.closed);
        }
        BOOST_TEST((events.empty() || events == list));
        events = list;
        BOOST_TEST(std::ranges::any_of(run.records.arcs, [](const auto& arc) {
            return arc.power_turn && arc.opened == Contact{ContactKind::disk_disk, 17, 69};
        }));
    }
}
