// Runs re-checked from their records; altered records must be found, the first of them named.
#include "checker/strut.hpp"
#include "support/bad_input.hpp"
#include "support/cells.hpp"
#include "support/crafted.hpp"
#include "support/played.hpp"
#include "support/same_sequence.hpp"
#include "support/strut.hpp"

#include <isostat/core/machine.hpp>

using namespace isostat;

namespace {

/// Plays segments, each given by its equilibria, from a state into a folder.
void play_and_store(const State& start, const std::vector<int>& segments, const std::filesystem::path& folder,
                    OpeningRule rule = OpeningRule::most_negative, TiePolicy ties = TiePolicy::stop) {
    RunOptions options{.rule = rule, .max_strain = 1e9, .ties = ties};
    std::vector<Segment> all;
    std::ranges::transform(segments, std::back_inserter(all), towards);
    played::completely(folder, start, all, options);
}

std::string line_of(const std::string& text, int number) {
    return scratch::split(text, '\n').at(static_cast<std::size_t>(number - 1));
}

/// A number of the records, changed in one line of a file.
struct Alteration {
    std::string file;
    int line;
    std::string from, to;
    std::string said; ///< must be in the message
};

/// "name":value of a JSON line, multiplied.
Alteration scaled(const std::string& events, int line, const std::string& name, double factor,
                  const std::string& said) {
    const std::string old = forger::value_of(line_of(events, line), name), key = "\"" + name + "\":";
    return {"events.jsonl", line, key + old, key + forger::times(old, factor), said};
}

/// The answer of one thread, and of more.
void same_with_threads(const std::filesystem::path& folder, const RunVerification& one) {
    set_threads(3);
    const RunVerification three = verify_run(folder);
    set_threads(1);
    BOOST_TEST((three.verdict == one.verdict));
    BOOST_TEST(three.wrong == one.wrong);
    BOOST_TEST(three.undecided == one.undecided, boost::test_tools::per_element());
    BOOST_TEST(three.arcs_proved == one.arcs_proved);
    BOOST_TEST(three.equilibria_proved == one.equilibria_proved);
    BOOST_TEST(three.turns_checked == one.turns_checked);
    BOOST_TEST(three.ties_checked == one.ties_checked);
}

void finds(const std::filesystem::path& folder, const Alteration& alteration) {
    BOOST_TEST_INFO_SCOPE(alteration.file << ":" << alteration.line << " " << alteration.from << " -> "
                                          << alteration.to);
    const std::string line = line_of(scratch::read(folder / alteration.file), alteration.line);
    const forger::Alteration there(folder, alteration.file, line,
                                   scratch::replaced(line, alteration.from, alteration.to));
    const RunVerification run = verify_run(folder);
    same_with_threads(folder, run);
    BOOST_TEST((run.verdict == Verdict::refuted));
    BOOST_TEST((run.wrong.find(alteration.said) != std::string::npos), run.wrong);
    if (alteration.file == "events.jsonl") {
        const std::string where = "events.jsonl:" + std::to_string(alteration.line) + ":";
        BOOST_TEST((run.wrong.find(where) != std::string::npos), run.wrong);
    }
}

/// The fields of a row of equilibria.csv, with one replaced.
Alteration in_row(const std::string& csv, int line, const std::string& column, const std::string& value,
                  const std::string& said = "") {
    return {"equilibria.csv", line, line_of(csv, line),
            forger::row_with(csv, static_cast<std::size_t>(line - 1), column, value), said};
}

/// checkpoint.json and summary.json of a run whose last row is that of equilibrium `last`, in its first segment.
void count_until(const std::filesystem::path& folder, int last, int arcs) {
    using json::Json;
    const auto row = scratch::row_of(folder / "equilibria.csv", static_cast<std::size_t>(last));
    const auto value = [&row](const std::string& column) { return Json::parse(row.at(column)); };
    Json point = Json::parse(scratch::read(folder / "checkpoint.json"));
    Json summary = Json::parse(scratch::read(folder / "summary.json"));
    point["counters"]["arcs"] = arcs;
    point["counters"]["equilibria"] = last;
    point["strain"] = {value("eps1"), value("eps2")};
    point["made"] = last;
    point["segment"] = summary["segment"] = value("segment");
    summary["counters"] = point["counters"];
    summary["last_equilibrium"] = last;
    for (const char* name : {"ratio", "eps1", "eps2", "solid_fraction"}) {
        summary[name] = value(name);
    }
    scratch::write(folder / "checkpoint.json", point.dump());
    scratch::write(folder / "summary.json", summary.dump());
}

/// A row one arc too early, where the contact that `line` of the events opens still pulls.
void refutes_a_row_before(const std::filesystem::path& folder, int line) {
    const std::string events = scratch::read(folder / "events.jsonl");
    const std::string csv = scratch::read(folder / "equilibria.csv");
    const std::string summary = scratch::read(folder / "summary.json");
    const auto head_of = [](const std::string& text, int lines) {
        std::string head;
        for (int k = 1; k <= lines; ++k) {
            head += line_of(text, k) + "\n";
        }
        return head;
    };
    const auto towards = [&events](int k) {
        return json::Json::parse(line_of(events, k)).at("equilibrium").get<int>();
    };
    const int reached = towards(line);
    int arcs = 0;
    for (int k = 1; k < line; ++k) {
        arcs += towards(k) == reached ? 1 : 0;
    }
    BOOST_REQUIRE(arcs > 0);
    const Alteration row = in_row(csv, reached + 2, "arcs", std::to_string(arcs));
    scratch::write(folder / "events.jsonl", head_of(events, line - 1));
    scratch::write(folder / "equilibria.csv", scratch::replaced(head_of(csv, reached + 2), row.from, row.to));
    const std::string checkpoint = scratch::read(folder / "checkpoint.json");
    count_until(folder, reached, line - 1);
    forger::seal(folder);
    played::refuted(verify_run(folder), "no equilibrium");
    scratch::write(folder / "events.jsonl", events);
    scratch::write(folder / "equilibria.csv", csv);
    scratch::write(folder / "summary.json", summary);
    scratch::write(folder / "checkpoint.json", checkpoint);
    forger::seal(folder);
}

} // namespace

BOOST_FIXTURE_TEST_CASE(progress_counts_every_arc_and_every_equilibrium_once, scratch::InFolder) {
    play_and_store(read_state(scratch::data("vertex100.txt")).state, {2}, folder / "run");
    int arcs = 0, equilibria = 0;
    VerificationProgress last;
    const RunVerification run = verify_run(folder / "run", [&](const VerificationProgress& at) {
        (at.closed ? equilibria : arcs) += 1;
        BOOST_TEST(at.arcs == arcs);
        BOOST_TEST(at.equilibria == equilibria);
        last = at;
    });
    BOOST_TEST(equilibria == run.equilibria);
    BOOST_TEST(arcs == run.arcs);
    BOOST_TEST(last.all_arcs == run.arcs);
    BOOST_TEST(last.all_equilibria == run.equilibria);
}

// Case 2: bottom of disk 1 opens at F2/F1 = t, disk 1 rolls over disk 0.
BOOST_FIXTURE_TEST_CASE(the_rolling_disk_is_replayed, scratch::InFolder) {
    play_and_store(crafted::two_disks(1, 2, 1, 1), {-1, 1}, folder / "run");
    const RunVerification run = played::proved(folder / "run");
    BOOST_TEST(run.equilibria_proved == 3);
}

BOOST_AUTO_TEST_CASE(what_a_grain_without_force_puts_on_a_strut_orders_its_ends) {
    for (const double angle : {0.5235987755982988, 1.3089969389957472}) {
        for (const crafted::StrutLoad& load : crafted::strut_loads()) {
            checker::Place place;
            const auto objection = checker::make_place(crafted::strut_with_a_grain(angle, load), place, {}, 7);
            BOOST_REQUIRE_MESSAGE(!objection, (objection ? objection->text : ""));
            BOOST_TEST(checker::same_at_turn(place, 0, 1));
            BOOST_TEST(checker::strut_order(place, 0, 1).value_or(0) == (load.to_the_right ? -1 : 1));
            BOOST_TEST(checker::strut_order(place, 1, 0).value_or(0) == (load.to_the_right ? 1 : -1));
        }
    }
}

// Arc 23 follows a power turn that holds a grain without force; that grain hangs on a straight strut, whose end opens.
BOOST_FIXTURE_TEST_CASE(the_end_of_a_strut_that_a_grain_without_force_hangs_on_is_replayed_and_no_other,
                        scratch::InFolder) {
    play_and_store(prepared(40, 15), {5}, folder / "run");
    const RunVerification run = played::proved(folder / "run");
    const std::string opened = R"("opened":"28-34")";
    const std::string other = R"("opened":"28-30")";
    const std::string line = line_of(scratch::read(folder / "run" / "events.jsonl"), 23);
    BOOST_REQUIRE(line.find(opened) != std::string::npos);
    finds(folder / "run", {"events.jsonl", 23, opened, other, "opens with"});
}

// Many power turns, and at many of them grains whose forces are but the rounding of the turn: the weakest traction is
// never one of theirs.
BOOST_FIXTURE_TEST_CASE(contacts_that_carry_nothing_at_a_power_turn_do_not_compete, scratch::InFolder,
                        *boost::unit_test::label("threads")) {
    play_and_store(prepared(36, 3), {4}, folder / "run", OpeningRule::least_negative);
    const RunVerification run = played::proved(folder / "run");
    BOOST_TEST(run.turns_checked > 20);
    same_with_threads(folder / "run", run); // coordinates let go in either direction too
}

BOOST_FIXTURE_TEST_CASE(a_run_by_contact_numbers_is_verified_and_no_other_rule_fits_it, scratch::InFolder) {
    play_and_store(prepared(36, 3), {3}, folder / "run", OpeningRule::least_index);
    const RunVerification run = played::proved(folder / "run");
    played::refuted(forger::altered(folder / "run", "run.json", "least_index", "most_negative"),
                    "but the rule 'most_negative' takes");
    play_and_store(prepared(36, 3), {3}, folder / "most");
    played::refuted(forger::altered(folder / "most", "run.json", "most_negative", "least_index"),
                    "but the rule 'least_index' takes");
}

// Under true stresses the load changes along an arc: the derivatives of the power count that.
BOOST_FIXTURE_TEST_CASE(power_turns_under_true_stresses_are_found_and_replayed, scratch::InFolder) {
    State start = prepared(36, 3);
    start.load.kind = LoadKind::true_stress;
    play_and_store(start, {4}, folder / "run", OpeningRule::least_index);
    const RunVerification run = verify_run(folder / "run");
    BOOST_TEST(run.wrong == "");
    BOOST_TEST(run.turns_checked == 3);
}

BOOST_FIXTURE_TEST_CASE(a_run_of_a_hundred_disks_is_replayed_and_altered_records_are_named, scratch::InFolder,
                        *boost::unit_test::label("slow")) {
    play_and_store(read_state(scratch::data("vertex100.txt")).state, {3, -1}, folder / "run");
    const RunVerification run = played::proved(folder / "run");
    BOOST_TEST(run.equilibria_proved == 5);
    BOOST_TEST_MESSAGE(run.arcs << " arcs");

    const std::string events = scratch::read(folder / "run/events.jsonl");
    const std::string csv = scratch::read(folder / "run/equilibria.csv");
    int tension = 0;
    for (int line = 1; line <= run.arcs && tension == 0; ++line) {
        tension = line_of(events, line).find("\"tension\"") != std::string::npos ? line : 0;
    }
    BOOST_REQUIRE(tension > 0);
    for (const auto& [name, said] : std::vector<std::pair<std::string, std::string>>{
             {"eps2", "eps2"}, {"work", "work"}, {"force", "force"}, {"sigma2", "stress"}}) {
        finds(folder / "run", scaled(events, tension, name, 1 + 1e-6, said));
    }
    finds(folder / "run", scaled(events, tension, "power", -1, "power"));
    finds(folder / "run", {"events.jsonl", tension, "\"tension\"", "\"rattler\"", "kind"});
    finds(folder / "run", {"events.jsonl", tension, "\"step\":", "\"step\":1", "step"});
    finds(folder / "run", {"events.jsonl", tension, "\"arc\":", "\"arc\":1", "arc"});
    // Another contact opens, or closes.
    const auto names = [&](const std::string& key, const std::string& by, int line, const std::string& said) {
        const std::string name = "\"" + key + "\":";
        finds(folder / "run",
              {"events.jsonl", line, name + forger::value_of(line_of(events, line), key), name + '"' + by + '"', said});
    };
    const State first = read_state(folder / "run/states/eq_000000.json").state;
    const std::string kept = to_string(first.contacts[5]);
    BOOST_REQUIRE(line_of(events, tension).find("\"opened\":\"" + kept + '"') == std::string::npos);
    names("opened", kept, tension, "");
    names("closed", kept, tension, "closed already");
    names("opened", kept, 1, "");

    // Several forces are negative somewhere: the other rule takes another one of them.
    played::refuted(forger::altered(folder / "run", "run.json", "most_negative", "least_negative"),
                    "but the rule 'least_negative' takes");
    // A record left out.
    played::refuted(forger::altered(folder / "run", "events.jsonl", line_of(events, tension) + "\n", ""), "");
    refutes_a_row_before(folder / "run", tension);
    // Another stored state, by a coordinate and by a contact.
    const std::filesystem::path stored = folder / "run/states/eq_000001.json";
    const State state = read_state(stored).state;
    for (const bool coordinate : {true, false}) {
        State altered = state;
        if (coordinate) {
            altered.packing.q[7] += 1e-7;
        } else {
            altered.contacts[5] = {ContactKind::disk_disk, 0, 99};
        }
        write_state(stored, altered);
        forger::seal(folder / "run");
        played::refuted(verify_run(folder / "run"), "eq_000001");
    }
    write_state(stored, state);
    forger::seal(folder / "run");
    for (const std::string& name :
         scratch::split("number previous sigma2 ratio eps1 eps2 L1 L2 solid_fraction arcs rattlers backbone dofs "
                        "contacts rank h k held sigma2_low sigma2_high opens_low_i opens_high_j potential min_force "
                        "min_force_i min_gap min_gap_j proved")) {
        // The first row is checked before any arc; it has no equilibrium before it. Contacts keep their spelling.
        const char* other = name.ends_with("_i") ? "0" : name.ends_with("_j") ? "-1" : "9";
        finds(folder / "run", in_row(csv, name == "previous" ? 4 : 2, name, other));
    }
}

/// Where a rattler is pinned its own pattern shows no structural zero: another disk counts as pinned (C9, cells.md).
BOOST_AUTO_TEST_CASE(runs_in_periodic_cells_are_replayed_whichever_disk_is_pinned, *boost::unit_test::label("slow")) {
    for (const char* name : {"tilt_16", "rect_16", "channel_16"}) {
        for (const int pin : {0, 8, 9}) { // 8 and 9 become rattlers, or are
            for (const TiePolicy ties : {TiePolicy::stop, TiePolicy::choose}) {
                BOOST_TEST_INFO_SCOPE(name << ", disk " << pin << " pinned, ties " << word_of(ties, tie_policy_words));
                const scratch::Folder folder;
                play_and_store(cells::of_file(name, pin), {3}, folder / "run", OpeningRule::most_negative, ties);
                const RunVerification run = verify_run(folder / "run");
                played::without_objection(run);
                BOOST_TEST(words(run) == "ends proved, way looked at");
                BOOST_TEST(run.arcs_proved == run.arcs);
                BOOST_TEST(run.equilibria_proved == 4);
                same_with_threads(folder / "run", run);
                for (const char* forged : {"32", "33"}) { // all of the contacts, in two of the cells
                    if (pin == 9) {
                        finds(folder / "run",
                              in_row(scratch::read(folder / "run/equilibria.csv"), 3, "backbone", forged, "backbone"));
                    }
                }
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(true_stresses_and_forces_on_disks_in_cells_are_replayed) {
    const auto is_replayed = [&](const State& state) {
        const scratch::Folder folder;
        play_and_store(state, {3}, folder / "run");
        const RunVerification run = verify_run(folder / "run");
        played::without_objection(run);
        BOOST_TEST(run.arcs_proved == run.arcs);
    };
    for (const char* name : {"rect_16", "channel_16"}) {
        State state = cells::of_file(name, 0);
        state.load.kind = LoadKind::true_stress;
        is_replayed(state);
    }
    State state = cells::of_file("rect_16", 0);
    state.load.disk_force.assign(32, 0.0);
    state.load.disk_force[4] = 0.125;
    state.load.disk_force[10] = -0.125;
    is_replayed(state);
}

BOOST_AUTO_TEST_CASE(altered_records_of_a_run_in_a_cell_are_named, *boost::unit_test::label("slow")) {
    const scratch::Folder run;
    play_and_store(cells::of_file("tilt_16", 0), {2}, run);
    const std::string events = scratch::read(run / "events.jsonl");
    const std::string csv = scratch::read(run / "equilibria.csv");
    for (const char* name : {"eps2", "work", "power"}) {
        finds(run, scaled(events, 5, name, 1 + 1e-6, name));
    }
    finds(run, {"events.jsonl", 2, "3-8(1,0)", "3-8", "no contact of the structure"});
    forger::unreadable(run, "events.jsonl", "3-8(1,0)", "3-8(1,0,0)", "opened is");
    finds(run, {"events.jsonl", 2, "3-8(1,0)", "3-5(1,0)", ""}); // a contact, but another one
    finds(run, {"events.jsonl", 4, "8-10(-1,0)", "3-5(1,0)", "closed already"});
    for (const auto& [column, value] :
         std::vector<std::pair<std::string, std::string>>{{"L1", "10.2"},
                                                          {"potential", "9"},
                                                          {"opens_high_j", "4"}, // no contact
                                                          {"opens_high_j", "6"}, // one whose force stays above 0
                                                          {"min_gap_i", "2"},
                                                          {"L3", "-0.9"},
                                                          {"eps3", "0.1"},
                                                          {"backbone", "28"}}) {
        finds(run, in_row(csv, 3, column, value));
    }
    // Another stored state: the tilt, an image, the pinned disk.
    const std::filesystem::path stored = run / "states/eq_000001.json";
    const State state = read_any_state(stored).state;
    for (const int what : {0, 1, 2}) {
        State altered = state;
        if (what == 0) {
            altered.packing.q[altered.packing.tilt_at(0, 1)] += 1e-7;
        } else if (what == 1) {
            altered.contacts[0].image.m[1] = 1;
        } else {
            altered.packing.cell.pin = 1;
        }
        write_state(stored, altered);
        forger::seal(run);
        played::refuted(verify_run(run), "eq_000001");
    }
}

BOOST_FIXTURE_TEST_CASE(folders_without_the_records_are_bad_input, scratch::InFolder) {
    BOOST_CHECK_THROW((void)verify_run(folder.path()), Error);
    scratch::write(
        folder / "run.json",
        R"({"format":"isostat-run","version":1,"status":"completed","program":"","programme":[],"settings":{"run":{"rule":"most_negative"}}})");
    scratch::write(folder / "events.jsonl", "");
    scratch::write(folder / "equilibria.csv", "# number,previous\n0,-1\n");
    expect_bad_input([&] { (void)verify_run(folder.path()); }, {"the names of the columns"});
}
