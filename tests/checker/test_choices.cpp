// Runs under ties = "choose", re-checked from their records; a forged choice must be found.
#include "support/course.hpp"
#include "support/mirror.hpp"
#include "support/played.hpp"

using namespace isostat;
using forger::altered;
namespace fs = std::filesystem;

namespace {

/// Plays one segment under `choose` into a folder; how it ends does not matter.
void play(const State& state, int equilibria, const fs::path& folder, std::uint64_t seed = 1, bool with_start = false) {
    RunOptions options{.ties = TiePolicy::choose, .ties_seed = seed};
    (void)played::into(folder, state, {towards(equilibria)}, options, with_start);
}

/// A lattice with the list that other changed radii keep of its contacts, under a load at which some force is negative.
State with_a_foreign_list(const State& lattice, double stress) {
    State state = lattice;
    state.contacts = crafted::follow_load(lattice, +1, 1, crafted::Ties::choose, 10).states.at(0).contacts;
    state.load.stress[1] = stress;
    return state;
}

/// The first arc opens a contact at the start, and nothing of the run is left undecided.
RunVerification proved_from_start(const fs::path& folder) {
    const std::string events = scratch::read(folder / "events.jsonl");
    BOOST_TEST(events.substr(0, events.find('\n')).find("\"equilibrium\":0,") != std::string::npos);
    return played::proved(folder);
}

/// The entry of a record that names an exchange of the list, with the braces; empty: none does.
std::string exchange_in(const std::string& events, const std::string& decision) {
    const std::size_t at = events.find("\"decision\":\"" + decision + '"');
    if (at == std::string::npos) {
        return {};
    }
    const std::size_t begin = events.rfind('{', at);
    return events.substr(begin, events.find('}', at) + 1 - begin);
}

/// The record of an exchange of the list: `by` in the place of `from` in it.
struct ForgedExchange {
    const fs::path& folder;
    std::string entry;

    [[nodiscard]] RunVerification with(const std::string& from, const std::string& by) const {
        return altered(folder, "events.jsonl", entry, scratch::replaced(entry, from, by));
    }
    void refuted(const std::string& from, const std::string& by, const std::string& said) const {
        BOOST_TEST_INFO_SCOPE(from << " -> " << by);
        played::refuted(with(from, by), said);
    }
    void not_proved(const std::string& from, const std::string& by) const {
        const RunVerification forged = with(from, by);
        BOOST_TEST((forged.verdict != Verdict::proved), from << " -> " << by);
        BOOST_TEST_MESSAGE(by << ": " << forged.wrong << (forged.undecided.empty() ? "" : forged.undecided[0]));
    }
};

} // namespace

BOOST_FIXTURE_TEST_CASE(a_forged_choice_is_refused, scratch::InFolder) {
    play(crafted::alike(crafted::mirror_forces()), -1, folder);
    const RunVerification run = played::proved(folder);
    BOOST_TEST(run.choices_checked > 0);
    const std::string events = scratch::read(folder / "events.jsonl");
    const bool one = events.find("\"opened\":\"1-bottom\"") != std::string::npos;
    const auto refuted = [&](const std::string& from, const std::string& to, const std::string& said) {
        BOOST_TEST_INFO_SCOPE(from << " -> " << to);
        played::refuted(altered(folder, "events.jsonl", from, to), said);
    };
    const std::string loads = "\"choice\":\"infinitesimal loads\"";
    refuted(loads, "\"choice\":\"names\"", one ? "tell which comes first" : "comes first");
    forger::unreadable(folder, "events.jsonl", loads, "\"choice\":\"dice\"", "choice is");
    // Terms that tell the two apart are no tie.
    const std::size_t term = events.find("\"against_first_order\":[") + 23;
    const std::string value = events.substr(term, events.find(',', term) - term);
    refuted("\"against_first_order\":[" + value, "\"against_first_order\":[1e3", "");
    // The other one of the two, in all of the record.
    std::string swapped = events;
    for (std::size_t at = 0; (at = swapped.find("-bottom\"", at)) != std::string::npos; at += 8) {
        char& number = swapped[at - 1];
        number = number == '1' ? '2' : number == '2' ? '1' : number;
    }
    scratch::write(folder / "events.jsonl", swapped);
    forger::seal(folder);
    played::refuted(verify_run(folder), "infinitesimal loads take");
}

/// The run with the radii of another, whose first-order terms take another one of two forces that vanish together; with
/// bounds so wide that nothing is told apart, the record calls it a choice.
void call_it_a_choice(const fs::path& folder, const std::vector<double>& rho, double bound) {
    for (const char* name : {"eq_000000.json", "eq_000001.json", "last.json"}) {
        StateFile file = read_state(folder / "states" / name);
        file.state.perturbation->rho = rho;
        for (auto* list : {&file.state.perturbation->open, &file.state.perturbation->zero}) {
            for (auto& [contact, term] : *list) {
                term = {0, bound};
            }
        }
        write_state(folder / "states" / name, file.state, file.forces);
    }
    json::Json event = json::Json::parse(scratch::read(folder / "events.jsonl"));
    for (json::Json& tie : event["perturbed"]) {
        tie["first_order"] = {0.0, bound};
        tie["choice"] = tie["decision"] == "limit" ? "infinitesimal loads" : "zero";
        if (tie.contains("against")) {
            tie["against_first_order"] = {0.0, bound};
        }
    }
    scratch::write(folder / "events.jsonl", event.dump() + "\n");
    forger::seal(folder);
}

BOOST_AUTO_TEST_CASE(bounds_so_wide_that_they_say_nothing_are_no_evidence_of_a_tie) {
    const State start = read_state(fs::path(ISOSTAT_EXAMPLES) / "ties/two-forces.json").state;
    const scratch::Folder scratch_folder;
    std::map<bool, std::pair<fs::path, std::vector<double>>> runs; // by what opens
    for (std::uint64_t seed = 1; runs.size() < 2 && seed < 10; ++seed) {
        const fs::path folder = scratch_folder / std::to_string(seed);
        play(start, -1, folder, seed);
        BOOST_REQUIRE((verify_run(folder).verdict == Verdict::proved));
        const bool one = scratch::read(folder / "events.jsonl").find("\"opened\":\"1-bottom\"") != std::string::npos;
        runs[one] = {folder, read_state(folder / "states/eq_000000.json").state.perturbation->rho};
    }
    int told_apart = 0;
    for (const bool one : {false, true}) {
        for (const double bound : {1e6, 1.0}) {
            const fs::path folder = scratch_folder / "forged";
            fs::remove_all(folder);
            fs::copy(runs.at(one).first, folder, fs::copy_options::recursive);
            call_it_a_choice(folder, runs.at(!one).second, bound);
            const RunVerification forged = verify_run(folder);
            BOOST_TEST((forged.verdict != Verdict::proved));
            told_apart +=
                forged.wrong.empty() && forged.undecided[0].find("first-order terms tell apart") != std::string::npos;
        }
    }
    BOOST_TEST(told_apart == 2); // the infinitesimal loads refute the others
}

/// No record says how an end of the interval was chosen, and each of them ends it (C1 b).
BOOST_FIXTURE_TEST_CASE(a_row_may_name_any_of_the_forces_that_vanish_at_an_end, scratch::InFolder) {
    play(crafted::mirror_forces(), -1, folder);
    BOOST_TEST((verify_run(folder).verdict == Verdict::proved));
    const std::string rows = scratch::read(folder / "equilibria.csv");
    const bool one = rows.find(",1,-2,") < rows.find(",2,-2,");
    const RunVerification other =
        altered(folder, "equilibria.csv", one ? ",1,-2," : ",2,-2,", one ? ",2,-2," : ",1,-2,");
    BOOST_TEST((other.verdict == Verdict::proved), (other.undecided.empty() ? other.wrong : other.undecided[0]));
}

BOOST_FIXTURE_TEST_CASE(the_way_of_a_square_of_disks_is_replayed, scratch::InFolder) {
    play(crafted::square(), 3, folder);
    const RunVerification run = verify_run(folder);
    BOOST_TEST(run.wrong == "");
    BOOST_TEST(run.equilibria > 0);
    for (const std::string& open : run.undecided) {
        BOOST_TEST_MESSAGE(open);
    }
}

/// Bounds of its records end next to the number: the checker needs more digits than its usual ones.
BOOST_FIXTURE_TEST_CASE(rows_that_change_their_lists_where_they_are_and_spread_are_replayed_and_proved,
                        scratch::InFolder) {
    State state = crafted::pile(5, 4);
    state.load.reference_length = {16, 4}; // the same forces; strains stay below the cap
    state.load.stress = {0.25, 0.25};
    play(state, 3, folder);
    const RunVerification run = verify_run(folder);
    BOOST_TEST(run.wrong == "");
    BOOST_TEST(run.equilibria == 4);
    BOOST_TEST((run.verdict == Verdict::proved), (run.undecided.empty() ? "" : run.undecided[0]));
    played::refuted(
        altered(folder, "events.jsonl", "\"decision\":\"gap\"", "\"choice\":\"watched\",\"decision\":\"gap\""),
        "is left as 'watched'");
    // Pairs that touch besides the contacts: the last column but one.
    const std::string rows = scratch::read(folder / "equilibria.csv");
    const std::size_t time = rows.rfind(',');
    const std::size_t column = rows.rfind(',', time - 1) + 1;
    const int touching = std::stoi(rows.substr(column));
    BOOST_TEST(touching > 0);
    const std::string last = rows.substr(rows.rfind('\n', time));
    for (const int said : {touching - 1, touching + 1}) {
        const std::string by = rows.substr(rows.rfind('\n', time), column - rows.rfind('\n', time));
        const RunVerification wrong =
            altered(folder, "equilibria.csv", last, by + std::to_string(said) + rows.substr(time));
        BOOST_TEST((wrong.verdict == (said > touching ? Verdict::refuted : Verdict::undecided)), wrong.wrong);
    }
}

BOOST_FIXTURE_TEST_CASE(a_choice_in_a_run_that_chooses_nothing_is_refused, scratch::InFolder) {
    play(crafted::alike(crafted::mirror_gaps()), 1, folder);
    const RunVerification run = played::proved(folder);
    BOOST_TEST(run.choices_checked > 0);
    const RunVerification stopped = altered(folder, "run.json", "choose", "stop");
    BOOST_TEST((stopped.verdict == Verdict::refuted));
    const std::string capped = "choose\",\"max_choices\":";
    played::refuted(altered(folder, "run.json", "choose\"", capped + std::to_string(run.choices_checked - 1)),
                    "which may choose");
    const RunVerification as_many =
        altered(folder, "run.json", "choose\"", capped + std::to_string(run.choices_checked));
    BOOST_TEST((as_many.verdict == Verdict::proved));
}

BOOST_FIXTURE_TEST_CASE(a_forged_exchange_at_second_order_is_refused, scratch::InFolder) {
    play(crafted::two_crests(true), -1, folder);
    const RunVerification run = played::proved(folder);
    BOOST_TEST(run.equilibria_proved == 2);
    const ForgedExchange forged{folder, exchange_in(scratch::read(folder / "events.jsonl"), "second order")};
    BOOST_TEST_MESSAGE(forged.entry);
    forged.refuted("\"0-right\"", "\"1-3\"", "share in");            // its share is -1
    forged.refuted("\"0-right\"", "\"0-bottom\"", "that cannot be"); // it is what opens
    forged.refuted("\"1-right\"", "\"0-4\"", "no such exchange");    // does not touch
    forged.refuted("\"1-right\"", "\"1-top\"", "that cannot be");    // a contact already
    forged.refuted("\"first_order\":[-", "\"first_order\":[", "second derivative");
    forged.refuted("\"against_first_order\":[", "\"against_first_order\":[-", "share");
    forged.refuted("\"second order\"", "\"end\"", "second derivative"); // it does not rest
    forged.not_proved("\"0-right\"", "\"1-top\""); // its share is 0, which an interval does not tell
    forged.not_proved("\"0-right\"", "\"0-2\"");   // may give way as well, but leads to another list
    forged.not_proved(forged.entry, "");           // 1-right overlaps
}

/// The rows of a lattice sink until they lie in line: the contacts that the run would keep are dependent there.
BOOST_FIXTURE_TEST_CASE(a_list_that_is_exchanged_for_the_end_of_an_arc_is_proved_and_a_forged_one_refused,
                        scratch::InFolder) {
    play(crafted::triangular(3, 4), 20, folder);
    const RunVerification run = played::proved(folder);
    const ForgedExchange forged{folder, exchange_in(scratch::read(folder / "events.jsonl"), "end")};
    BOOST_TEST_REQUIRE(forged.entry.find("\"contact\":\"3-8\"") != std::string::npos, forged.entry);
    forged.refuted("\"3-8\"", "\"4-5\"", "no such exchange"); // does not touch
    forged.refuted("\"5-8\"", "\"3-5\"", "that cannot be");   // it is what opens
    forged.refuted("\"first_order\":[0.0,", "\"first_order\":[1.0,", "rate is 1 +-");
    forged.refuted("\"against_first_order\":[", "\"against_first_order\":[-", "share is -1");
    forged.not_proved("\"end\"", "\"second order\"");    // it does not overlap
    forged.refuted("\"5-8\"", "\"0-left\"", "share in"); // its share is negative
    // Then the contacts are dependent at the end.
    BOOST_TEST((altered(folder, "events.jsonl", forged.entry + ",", "").verdict != Verdict::proved));
}

BOOST_AUTO_TEST_CASE(an_exchange_for_a_pair_that_parts_at_second_order_is_refused) {
    const scratch::Folder scratch_folder;
    const fs::path needed = scratch_folder / "needed";
    const fs::path folder = scratch_folder / "run";
    play(crafted::two_crests(true), -1, needed);
    play(crafted::two_crests(false), -1, folder);
    const RunVerification run = played::proved(folder);
    const std::string events = scratch::read(folder / "events.jsonl");
    BOOST_TEST(exchange_in(events, "second order").empty());
    std::string entry = exchange_in(scratch::read(needed / "events.jsonl"), "second order");
    for (const auto& [from, to] :
         {std::pair{"1-right", "0-RIGHT"}, std::pair{"0-right", "1-right"}, std::pair{"0-RIGHT", "0-right"}}) {
        entry = scratch::replaced(entry, from, to);
    }
    const std::string key = "\"perturbed\":[";
    const bool others = events.find(key) < events.find('\n');
    played::refuted(others ? altered(folder, "events.jsonl", key,
                                     key + entry + (events[events.find(key) + key.size()] == ']' ? "" : ","))
                           : altered(folder, "events.jsonl", "}\n", ",\"perturbed\":[" + entry + "]}\n"),
                    "second derivative");
}

/// A list that is given stays: pairs that overlap at first order are watched (C1 g).
BOOST_AUTO_TEST_CASE(a_start_at_which_touching_pairs_overlap_at_first_order_is_replayed_and_a_forged_one_refused) {
    const scratch::Folder scratch_folder;
    for (const int columns : {3, 4}) {
        const State lattice = crafted::triangular(columns, columns - 1);
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const fs::path folder = scratch_folder / fmt::format("{}-{}", columns, seed);
            play(with_a_foreign_list(lattice, 3), 2, folder, seed, true);
            proved_from_start(folder);
            // The rule asks for the sign of every force: those that vanish at the start may bear load after the arc.
            const fs::path other = scratch_folder / fmt::format("{}-{}-least", columns, seed);
            RunOptions options{.rule = OpeningRule::least_negative, .ties = TiePolicy::choose, .ties_seed = seed};
            (void)played::into(other, with_a_foreign_list(lattice, 3), {towards(2)}, options, true);
            proved_from_start(other);
        }
    }
    const fs::path folder = scratch_folder / "3-2";
    // From the whole lattice the run has to choose a list with which no pair overlaps.
    write_state(folder / "start.json", crafted::triangular(3, 2));
    forger::seal(folder);
    played::refuted(verify_run(folder), "touch at the start");
}

BOOST_AUTO_TEST_CASE(what_is_chosen_to_open_at_a_start_is_replayed_and_a_forged_choice_refused) {
    const scratch::Folder folder;
    State state = crafted::alike(crafted::mirror_forces());
    state.load.stress[1] = 0.25; // both have left the bottom at 0.5
    play(state, 1, folder, 1, true);
    BOOST_TEST(proved_from_start(folder).choices_checked == 1);
    const std::string loads = "\"choice\":\"infinitesimal loads\"";
    played::refuted(altered(folder, "events.jsonl", loads, "\"choice\":\"names\""), "comes first");
    played::refuted(altered(folder, "events.jsonl", "\"against_first_order\":[-0.0", "\"against_first_order\":[1.0"),
                    "first-order term");
    // At the end of the arc what opened is no contact.
    played::refuted(altered(folder, "events.jsonl", "\"decision\":\"start\"", "\"decision\":\"opening\""),
                    "of which there is none");
}
