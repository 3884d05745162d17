// Struts that a power turn leaves straight: which end lets go is no matter of digits (statement S4).
#include "support/crafted.hpp"
#include "support/same_sequence.hpp"

using namespace isostat;
using namespace ::crafted;

namespace {

/// Samples whose loading meets a straight strut (found by search), and over how many played_equilibria.
constexpr std::array<std::pair<int, std::uint64_t>, 6> samples{
    {{6, 24}, {8, 13}, {10, 4}, {10, 6}, {10, 15}, {14, 17}}};
constexpr int played_equilibria = 7;

/// The step after a power turn that holds `disk`, when it opens a contact of that disk: its index, or 0.
std::size_t strut_opening(const std::vector<ArcRecord>& arcs) {
    for (std::size_t k = 1; k < arcs.size(); ++k) {
        const int disk = arcs[k - 1].closed.i / 2;
        const Contact& opened = arcs[k].opened;
        const bool touches = opened.i == disk || (opened.kind == ContactKind::disk_disk && opened.j == disk);
        if (arcs[k - 1].power_turn && arcs[k].kind == ArcKind::tension && touches) {
            return k;
        }
    }
    return 0;
}

} // namespace

BOOST_AUTO_TEST_CASE(a_straight_strut_lets_go_at_the_same_end_for_all_labels_sides_and_axes) {
    for (const auto& [disks, seed] : samples) {
        const State start = prepared(disks, seed);
        const Played run = play(start, +1, played_equilibria);
        BOOST_TEST_INFO_SCOPE(disks << " disks, seed " << seed);
        check_same_sequence(run, relabelled(start, 5), played_equilibria);
        check_same_sequence(run, relabelled(start, 6), played_equilibria);
        check_same_sequence(run, exchanged(start), played_equilibria);
        // A held coordinate is counted from the walls that do not move: seen from the other side it is another
        // one once the movable walls move. What is the same is what came before, the choice at the turn included.
        const std::size_t k = strut_opening(run.records.arcs);
        BOOST_TEST_REQUIRE(k > 0U);
        BOOST_TEST((run.records.arcs[k].decided_by <= Rung::double_bound), "no climb after digits without meaning");
        BOOST_TEST(run.counters.tally.structural_ties > 0);
        for (const Disguised& other : {mirrored(start), quarter_turned(start)}) {
            const auto seen = events(play(other.state, +1, played_equilibria).records, other.back);
            BOOST_TEST_REQUIRE(seen.size() > k);
            for (std::size_t j = 0; j <= k; ++j) {
                BOOST_TEST((seen[j].first == run.records.arcs[j].opened), "arc " << j + 1);
                BOOST_TEST((j == k || seen[j].second == run.records.arcs[j].closed), "arc " << j + 1);
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(grains_that_hang_on_a_strut_without_force_do_not_hide_it) {
    // Grain 37 is held at the turn and carries nothing; the strut is 28, some contacts away.
    const State start = prepared(40, 15);
    const Played run = play(start, +1, 5);
    const auto& arcs = run.records.arcs;
    BOOST_TEST_REQUIRE(arcs.size() > 22U);
    BOOST_TEST(arcs[21].power_turn);
    BOOST_TEST((arcs[22].opened == pair(28, 34)));
    BOOST_TEST((arcs[22].decided_by <= Rung::double_bound), "no climb after digits without meaning");
    for (const Disguised& other : {relabelled(start, 5), exchanged(start)}) {
        check_same_sequence(run, other, 5);
    }
    for (const Disguised& other : {mirrored(start), quarter_turned(start)}) {
        const auto seen = events(play(other.state, +1, 5).records, other.back);
        BOOST_TEST_REQUIRE(seen.size() > 22U);
        BOOST_TEST((seen[22].first == arcs[22].opened));
    }
}

BOOST_AUTO_TEST_CASE(the_weakest_traction_is_never_that_of_a_grain_that_carries_nothing_at_the_turn) {
    int after_turns = 0;
    for (const std::uint64_t seed : {1U, 3U, 5U, 10U}) {
        const Played run = play(prepared(36, seed), +1, 4, {}, {.rule = OpeningRule::least_negative});
        const auto& arcs = run.records.arcs;
        for (std::size_t k = 1; k < arcs.size(); ++k) {
            if (arcs[k - 1].power_turn && arcs[k].kind == ArcKind::tension) {
                BOOST_TEST(arcs[k].force < -1e-9, "seed " << seed << ", arc " << k + 1);
                ++after_turns;
            }
        }
    }
    BOOST_TEST(after_turns > 30);
    BOOST_TEST_MESSAGE(after_turns << " choices after power turns");
}
