// Runs with power turns, held coordinates and ties settled at first order, re-checked from their records; one number or
// name changed in each kind of record must be found.
#include "support/course.hpp"
#include "support/mirror.hpp"
#include "support/mirror_cells.hpp"
#include "support/played.hpp"

using namespace isostat;
using crafted::Ties;
using forger::times;
using forger::value_of;
namespace fs = std::filesystem;

namespace {

/// Plays one segment into a folder, every state stored; how it ends does not matter.
void play(const State& state, const Segment& segment, Ties ties, std::uint64_t seed, const fs::path& folder) {
    RunOptions options;
    crafted::settle(options, ties);
    options.ties_seed = seed;
    (void)played::into(folder, state, {segment}, options);
}

void is_proved(const fs::path& folder) {
    const RunVerification run = played::proved(folder);
    BOOST_TEST(run.equilibria_proved == run.equilibria);
}

/// One change in a file; the replay must not accept it, and refute the run with these words.
bool finds(const fs::path& folder, const std::string& file, const std::string& from, const std::string& to,
           const std::string& said) {
    BOOST_TEST_INFO_SCOPE(file << " " << from << " -> " << to);
    const RunVerification run = forger::altered(folder, file, from, to);
    // What the way seems to be refutes nothing: then the record is left undecided, and named.
    const bool seen = run.verdict == Verdict::undecided && run.undecided[0].find("as far as") != std::string::npos;
    BOOST_TEST((seen || run.verdict == Verdict::refuted), (run.undecided.empty() ? "" : run.undecided[0]));
    BOOST_TEST((seen || run.wrong.find(said) != std::string::npos), run.wrong);
    return run.verdict == Verdict::refuted;
}

/// The number at the head of the first list of this name in the events, multiplied.
void finds_head(const fs::path& folder, const std::string& name, double factor) {
    const std::string head = value_of(scratch::read(folder / "events.jsonl"), name).substr(1);
    const std::string key = "\"" + name + "\":[";
    finds(folder, "events.jsonl", key + head, key + times(head, factor), "first-order");
}

/// The first term of a list of equilibrium 1, multiplied; `name` ends with this in its contact.
void finds_term(const fs::path& folder, const std::string& list, const std::string& name, double factor,
                const std::string& said) {
    const std::string stored = scratch::read(folder / "states/eq_000001.json");
    const std::size_t at = stored.find("\"" + list + "\":[[");
    BOOST_REQUIRE(at != std::string::npos);
    const std::size_t begin = stored.find(name, at) + name.size();
    const std::string term = stored.substr(begin, stored.find(',', begin) - begin);
    finds(folder, "states/eq_000001.json", name + term, name + times(term, factor), said);
}

} // namespace

BOOST_FIXTURE_TEST_CASE(power_turn_held_coordinate_and_release_are_replayed_and_altered_ones_are_found,
                        scratch::InFolder) {
    play(read_state(fs::path(ISOSTAT_EXAMPLES) / "turns/three-disks.json").state, towards(-1), Ties::stop, 1, folder);
    is_proved(folder);
    BOOST_TEST(verify_run(folder).turns_checked == 1);
    const std::string events = scratch::read(folder / "events.jsonl");
    const std::string held = value_of(events, "held_at");
    finds(folder, "events.jsonl", "\"held_at\":" + held, "\"held_at\":" + times(held, 1 + 1e-3), "");
    forger::unreadable(folder, "events.jsonl", "\"power_turn\":true", "\"power_turn\":false", "held_at is");
    finds(folder, "events.jsonl", "\"power_turn\":true,\"held_at\":" + held, "\"power_turn\":false", "power_turn");
    finds(folder, "events.jsonl", "\"closed\":\"held x of grain 1\"", "\"closed\":\"held x of grain 0\"", "");
    finds(folder, "events.jsonl", "\"opened\":\"held x of grain 1\"", "\"opened\":\"held y of grain 1\"",
          "is no contact");
    finds(folder, "events.jsonl", "\"kind\":\"release\"", "\"kind\":\"tension\"", "kind");
    // The multiplier of the release.
    const std::string release = events.substr(events.find("\"kind\":\"release\""));
    const std::string force = value_of(release, "force");
    finds(folder, "events.jsonl", "\"force\":" + force, "\"force\":" + times(force, 1 + 1e-5), "force");
}

BOOST_FIXTURE_TEST_CASE(a_turning_arc_is_replayed, scratch::InFolder) {
    play(read_state(fs::path(ISOSTAT_EXAMPLES) / "turns/four-disks.json").state, towards(1), Ties::stop, 1, folder);
    is_proved(folder);
    BOOST_TEST(verify_run(folder).arcs > 0);
}

BOOST_FIXTURE_TEST_CASE(a_tie_of_two_forces_is_replayed_and_altered_first_order_terms_are_found, scratch::InFolder) {
    play(crafted::mirror_forces(), towards(-1), Ties::first_order, 1, folder);
    is_proved(folder);
    BOOST_TEST(verify_run(folder).ties_checked == 2);
    finds_head(folder, "first_order", -1);
    finds_head(folder, "first_order", 1 + 1e-6);
    // The other one of the two is said to open.
    const std::string events = scratch::read(folder / "events.jsonl");
    const bool one = events.find("\"opened\":\"1-bottom\"") != std::string::npos;
    finds(folder, "events.jsonl", one ? "\"opened\":\"1-bottom\"" : "\"opened\":\"2-bottom\"",
          one ? "\"opened\":\"2-bottom\"" : "\"opened\":\"1-bottom\"", "at first order");
    // The direction of the radii, and the first-order force of the contact that stays at 0.
    const std::string rho = value_of(scratch::read(folder / "states/eq_000001.json"), "rho").substr(1);
    finds(folder, "states/eq_000001.json", "\"rho\":[" + rho, "\"rho\":[" + times(rho, 2), "direction of the radii");
    finds_term(folder, "zero", "],", 1.001, "first-order force");
}

BOOST_FIXTURE_TEST_CASE(a_tie_of_two_gaps_is_replayed_and_an_altered_choice_is_found, scratch::InFolder) {
    play(crafted::mirror_gaps(), towards(1), Ties::first_order, 1, folder);
    is_proved(folder);
    const std::string events = scratch::read(folder / "events.jsonl");
    const bool one = events.find("\"closed\":\"1-bottom\"") != std::string::npos;
    finds(folder, "events.jsonl", one ? "\"closed\":\"1-bottom\"" : "\"closed\":\"2-bottom\"",
          one ? "\"closed\":\"2-bottom\"" : "\"closed\":\"1-bottom\"", "first-order gap");
    finds_head(folder, "against_first_order", 1 + 1e-6);
    finds_term(folder, "open", "],", -1, "first-order gap");
}

BOOST_AUTO_TEST_CASE(ties_in_cells_are_replayed_and_altered_first_order_terms_are_found) {
    const scratch::Folder scratch_folder;
    int ties = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const fs::path folder = scratch_folder / ("mirror" + std::to_string(seed));
        play(cells::mirror_pairs(), towards(1), Ties::first_order, seed, folder);
        is_proved(folder);
        ties += verify_run(folder).ties_checked;
        finds_head(folder, "against_first_order", 1 + 1e-6);
        finds_term(folder, "open", "]],", 1.001, "first-order gap"); // the pair touches across a side of the cell
    }
    BOOST_TEST(ties > 5);
    // A hyperstatic start.
    const fs::path folder = scratch_folder / "hyperstatic";
    play(cells::unfolded(crafted::three_disks(1, 1.1, 1.5, 1, 1), 0), towards(2), Ties::first_order, 1, folder);
    is_proved(folder);
}

BOOST_AUTO_TEST_CASE(a_hyperstatic_start_and_lattices_are_replayed) {
    const scratch::Folder scratch_folder;
    const Segment to = until(-1, 0.5);
    play(crafted::equal_pair(), to, Ties::first_order, 1, scratch_folder / "pair");
    is_proved(scratch_folder / "pair");
    int arcs = 0, ties = 0, altered = 0;
    std::set<std::string> kinds;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const fs::path folder = scratch_folder / ("lattice" + std::to_string(seed));
        play(crafted::triangular(3, 2), towards(3), Ties::first_order, seed, folder);
        if (fs::file_size(folder / "equilibria.csv") < 600) {
            continue; // not even an equilibrium 0: nothing to check
        }
        const RunVerification run = verify_run(folder);
        BOOST_TEST(run.wrong == "");
        arcs += run.arcs_proved;
        ties += run.ties_checked;
        // One first-order term of each kind of decision, changed.
        const std::string events = scratch::read(folder / "events.jsonl");
        for (const std::string kind : {"force", "opening", "limit", "zero all along", "gap", "step"}) {
            const std::size_t entry = events.find("{\"decision\":\"" + kind + "\"");
            if (entry == std::string::npos || !run.undecided.empty()) {
                continue;
            }
            const std::string name = kind == "gap" ? "\"against_first_order\":[" : "\"first_order\":[";
            const std::size_t begin = events.find(name, entry) + name.size();
            const std::string term = events.substr(begin, events.find(',', begin) - begin);
            altered += finds(folder, "events.jsonl", events.substr(entry, begin - entry) + term,
                             events.substr(entry, begin - entry) + times(term, 1.001), "first-order")
                           ? 1
                           : 0;
            kinds.insert(kind);
        }
        for (const std::string& open : run.undecided) {
            BOOST_TEST_MESSAGE(open);
        }
    }
    BOOST_TEST(arcs > 0);
    BOOST_TEST(altered > 0);
    BOOST_TEST(kinds.contains("force"));
    BOOST_TEST(kinds.contains("step"));
    BOOST_TEST_MESSAGE(arcs << " arcs, " << ties << " first-order decisions, " << altered << " altered, of "
                            << kinds.size() << " kinds");
}
