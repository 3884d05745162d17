// Struts that a power turn leaves straight: which end lets go is no matter of digits (statement S4).
#include "support/crafted.hpp"
#include "support/same_sequence.hpp"

#include <boost/test/unit_test.hpp>

using namespace isostat;
using namespace crafted;

namespace {

/// Samples whose loading meets a straight strut (found by search), and over how many equilibria.
constexpr std::array<std::pair<int, std::uint64_t>, 6> samples{
    {{6, 24}, {8, 13}, {10, 4}, {10, 6}, {10, 15}, {14, 17}}};
constexpr int equilibria = 7;

/// The step after a power turn that holds `disk`, when it opens a contact of that disk: its index, or 0.
std::size_t strut_opening(const std::vector<ArcRecord<2>>& arcs) {
    for (std::size_t k = 1; k < arcs.size(); ++k) {
        const int disk = arcs[k - 1].closed.i / 2;
        const Contact& opened = arcs[k].opened;
        const bool touches = opened.i == disk || (opened.kind == ContactKind::disk_disk && opened.j == disk);
        if (arcs[k - 1].power_turn && arcs[k].kind == "tension" && touches) {
            return k;
        }
    }
    return 0;
}

} // namespace

BOOST_AUTO_TEST_SUITE(trajectory)

BOOST_AUTO_TEST_CASE(the_straight_strut_lets_go_where_its_own_load_does_not_press) {
    int compared = 0;
    for (const auto& [disks, seed] : samples) {
        const State<2> start = prepared(disks, seed);
        const Played run = play(start, +1, equilibria);
        const std::size_t k = strut_opening(run.records.arcs);
        BOOST_TEST_REQUIRE(k > 0U, disks << " disks, seed " << seed);
        BOOST_TEST((run.records.arcs[k].decided_by <= Rung::double_bound),
                   "no climbing after digits that mean nothing");
        State<2> reversed = start;
        const auto disk = static_cast<std::size_t>(run.records.arcs[k - 1].closed.i / 2);
        reversed.load.infinitesimal[2 * disk] *= -1;
        reversed.load.infinitesimal[2 * disk + 1] *= -1;
        const Played other = play(reversed, +1, equilibria);
        bool same_so_far = other.records.arcs.size() > k;
        for (std::size_t j = 0; j < k && same_so_far; ++j) {
            same_so_far = other.records.arcs[j].opened == run.records.arcs[j].opened &&
                          other.records.arcs[j].closed == run.records.arcs[j].closed;
        }
        if (same_so_far) { // otherwise the load of this disk mattered before
            BOOST_TEST((other.records.arcs[k].opened != run.records.arcs[k].opened), disks << " disks, seed " << seed);
            ++compared;
        }
    }
    BOOST_TEST(compared >= 3);
}

BOOST_AUTO_TEST_CASE(runs_with_straight_struts_do_not_depend_on_labels_sides_and_axes) {
    for (const auto& [disks, seed] : samples) {
        const State<2> start = prepared(disks, seed);
        const Played run = play(start, +1, equilibria);
        BOOST_TEST_CONTEXT(disks << " disks, seed " << seed) {
            check_same_sequence(run, relabelled(start, 5), equilibria);
            check_same_sequence(run, relabelled(start, 6), equilibria);
            check_same_sequence(run, mirrored(start), equilibria);
            check_same_sequence(run, exchanged(start), equilibria);
            check_same_sequence(run, quarter_turned(start), equilibria);
        }
    }
}

BOOST_AUTO_TEST_SUITE_END()
