// Forged runs. Whoever forges a record computes the digests too, so they do not help: each alteration of a field must
// be refused or left undecided, but for those that proofs/checker.md lists as not checked.
#include "checker/altered_run.hpp"
#include "support/bad_input.hpp"
#include "support/cells.hpp"
#include "support/clumps.hpp"
#include "support/crafted.hpp"
#include "support/mirror.hpp"
#include "support/played.hpp"
#include "support/same_sequence.hpp"
#include "support/segments.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/run_directory.hpp>

using namespace isostat;
namespace fs = std::filesystem;
using json::Json;

namespace {

/// Puts another state into a certificate, with what is true of it.
void certify_again(const fs::path& file, const State& state) {
    Certificate certificate = read_certificate(file);
    certificate.state = state;
    certificate.state.provenance.clear();
    certificate.input_hash = sha256(state_text(certificate.state));
    certificate.claims = certify(certificate.state).claims;
    write_certificate(file, certificate);
}

void play(const State& start, const std::vector<Segment>& segments, const fs::path& folder,
          CertifyLevel level = CertifyLevel::arcs, TiePolicy ties = TiePolicy::stop) {
    const RunOptions options{.max_strain = 1e9, .certify = level, .ties = ties};
    const SegmentOutcome outcome = played::into(folder, start, segments, options, true);
    const bool played = outcome.completed || ties == TiePolicy::choose; // a lattice may end at its walls
    BOOST_REQUIRE_MESSAGE(played, (outcome.failure ? outcome.failure->message() : ""));
}

/// Two forces that vanish together, which nothing but the infinitesimal loads orders.
State equal_forces() {
    return crafted::alike(crafted::mirror_forces());
}

/// Disk 0 swings around the fixed disk 2 between fixed disks; `last` is where the fifth disk stands: in the way, or
/// just beside it.
State swing(double x, double y) {
    return parse_state(R"({"format": "isostat-state", "version": 1, "walls": {"lower": ["absent", "absent"], "upper":
["absent", "movable"]}, "load": {"kind": "nominal", "stress": [1, 1], "loaded_axis": 1, "reference_length": [1, 13]},
"disk_force": [[0.3, 0], [0, 0], [0, 0], [0, 0], [0, 0]], "disks": [[1, 8.585786437626904, 11.414213562373096],
[0.3, 7.415786437626905, 10.847556699712808], [1, 10.0, 10.0], [0.3, 12.907160852994403, 9.9367358990906], [0.3, )" +
                           Json(x).dump() + ", " + Json(y).dump() +
                           R"(]], "length": [20, 12.414213562373096], "fixed": [1, 2, 3, 4],
"infinitesimal": [[0.1, -1], [0, 0], [0, 0], [0, 0], [0, 0]], "contacts": [[0, "top"], [0, 1], [0, 2]]})",
                       "swing")
        .state;
}

/// Writes into a field of equilibria.csv; row 0 is that of equilibrium 0.
void set_field(const fs::path& run, std::size_t row, const std::string& column, const std::string& value) {
    const std::string csv = scratch::read(run / "equilibria.csv");
    std::vector<std::string> lines = scratch::split(csv, '\n');
    lines[row + 1] = forger::row_with(csv, row + 1, column, value);
    scratch::write(run / "equilibria.csv", scratch::joined(lines, '\n') + "\n");
}

/// A run, the verdict of which is words, every alteration of it tried.
struct Sample {
    std::string name;
    std::function<void(const fs::path&)> play;
    std::string words;
};

std::vector<Sample> samples() {
    using L = CertifyLevel;
    const std::string arcs = "proved";
    const std::string looked_at = "ends proved, way looked at";
    return {
        {"a box, level arcs, a power turn",
         [](const fs::path& f) { play(swing(12.991722005007981, 11.395062882006048), {towards(-1)}, f); }, arcs},
        {"a box, level arcs",
         [](const fs::path& f) {
             play(prepared(8, 3), {towards(2), towards(-1)}, f);
         },
         arcs},
        {"clumps, level arcs",
         [](const fs::path& f) {
             play(test::with_infinitesimal(test::lying_dimer(12, 12)), {towards(-1), towards(1)}, f);
         },
         arcs},
        {"a box, a turn",
         [](const fs::path& f) {
             play(read_state(fs::path(ISOSTAT_EXAMPLES) / "turns/three-disks.json").state, {towards(-1)}, f,
                  L::decisions);
         },
         looked_at},
        {"a tilted cell", [](const fs::path& f) { play(cells::of_file("tilt_16", 0), {towards(1)}, f, L::decisions); },
         looked_at},
        {"a rattler is pinned",
         [](const fs::path& f) {
             play(cells::of_file("rect_16", 9), {towards(1)}, f, L::decisions, TiePolicy::choose);
         },
         looked_at},
        {"a choice", [](const fs::path& f) { play(equal_forces(), {towards(-1)}, f, L::decisions, TiePolicy::choose); },
         looked_at},
        {"ties",
         [](const fs::path& f) { play(crafted::mirror_forces(), {towards(-1)}, f, L::decisions, TiePolicy::choose); },
         looked_at},
        {"an exchange at second order",
         [](const fs::path& f) { play(crafted::two_crests(true), {towards(-1)}, f, L::decisions, TiePolicy::choose); },
         looked_at},
        {"an exchange for an end",
         [](const fs::path& f) { play(crafted::triangular(3, 4), {towards(20)}, f, L::decisions, TiePolicy::choose); },
         looked_at},
    };
}

/// A column of the table "Not checked" on the page: "file field".
std::set<std::string> listed(std::size_t column) {
    const std::string page = scratch::read(fs::path(ISOSTAT_EXAMPLES) / "../proofs/checker.md");
    std::set<std::string> all;
    for (const std::string& line : scratch::split(page.substr(page.find("| file | not checked |")), '\n')) {
        if (!line.starts_with("|")) {
            break;
        }
        std::vector<std::string> cells = altered_run::split(line, '|');
        const auto quoted = [](const std::string& cell) {
            std::vector<std::string> names = altered_run::split(cell, '`');
            std::vector<std::string> inside;
            for (std::size_t k = 1; k < names.size(); k += 2) {
                inside.push_back(names[k]);
            }
            return inside;
        };
        if (const std::vector<std::string> file = quoted(cells[1]); !file.empty() && cells.size() > column + 1) {
            for (const std::string& field : quoted(cells[column + 1])) {
                all.insert(file[0] + " " + field);
            }
        }
    }
    return all;
}

/// The entry for a field: its name, or the beginning of it with a star.
std::string entry_for(const std::set<std::string>& list, const std::string& field) {
    const auto found = std::ranges::find_if(list, [&](const std::string& entry) {
        return field == entry || (entry.ends_with('*') && field.starts_with(entry.substr(0, entry.size() - 1)));
    });
    return found == list.end() ? "" : *found;
}

/// The lists of the page are those that were found, both ways where all was tried.
void compare_with_page(const altered_run::Counts& counts, bool both_ways) {
    const std::set<std::string> not_checked = listed(1);
    const std::set<std::string> one_sided = listed(2);
    std::set<std::string> unused = not_checked;
    unused.insert(one_sided.begin(), one_sided.end());
    for (const auto& [what, count] : counts) {
        const std::string field = what.first + " " + what.second;
        if (count.proved == 0) {
            continue;
        }
        const std::string entry = entry_for(not_checked, field);
        const std::string weaker = count.not_proved > 0 ? entry_for(one_sided, field) : "";
        BOOST_TEST((!entry.empty() || !weaker.empty()), field << " can be altered (" << count.example << "): proved "
                                                              << count.proved << ", not " << count.not_proved);
        unused.erase(entry);
        unused.erase(weaker);
    }
    for (const std::string& entry : unused) {
        BOOST_TEST(!both_ways, entry << " is listed, but no alteration of it was proved");
    }
}

/// What the checker says of a forged copy.
std::string said_of(const fs::path& original, const std::function<void(const fs::path&)>& alter) {
    const scratch::Folder folder;
    const fs::path run = folder / "run";
    fs::copy(original, run, fs::copy_options::recursive);
    alter(run);
    forger::seal(run);
    return words(verify_run(run));
}

} // namespace

BOOST_FIXTURE_TEST_CASE(some_altered_fields_of_signed_runs_are_refused_or_undecided_or_listed_on_the_page,
                        scratch::InFolder, *boost::unit_test::label("slow")) {
    altered_run::Counts counts;
    for (const Sample& sample : samples()) {
        BOOST_TEST_INFO_SCOPE(sample.name);
        sample.play(folder / sample.name);
        const RunVerification run = verify_run(folder / sample.name);
        BOOST_TEST(words(run) == sample.words, run.wrong << (run.undecided.empty() ? "" : run.undecided[0]));
    }
    const int here = altered_run::try_all(folder / "a choice", 1, counts) +
                     altered_run::try_all(folder / "clumps, level arcs", 1, counts) +
                     altered_run::try_all(folder / "a box, level arcs", 1, counts);
    BOOST_TEST(here >= 2000);
    compare_with_page(counts, false);
}

// Ten runs and 15 000 alterations, a minute: run by hand.
BOOST_AUTO_TEST_CASE(every_altered_field_of_signed_runs_is_refused_or_undecided_or_listed_on_the_page,
                     *boost::unit_test::disabled()) {
    altered_run::Counts counts;
    int alterations = 0;
    for (const Sample& sample : samples()) {
        const scratch::Folder folder;
        BOOST_TEST_INFO_SCOPE(sample.name);
        sample.play(folder / "run");
        const int here = altered_run::try_all(folder / "run", 1, counts);
        BOOST_TEST_MESSAGE(sample.name << ": " << here);
        alterations += here;
    }
    BOOST_TEST_MESSAGE(alterations << " alterations");
    BOOST_TEST(alterations >= 10000);
    compare_with_page(counts, true);
}

// A contact has one spelling, a column one name, a word one list: nothing else is read, and nothing crashes on it.
BOOST_FIXTURE_TEST_CASE(what_is_no_record_of_a_run_is_bad_input, scratch::InFolder) {
    play(equal_forces(), {towards(-1)}, folder / "run", CertifyLevel::decisions, TiePolicy::choose);
    const fs::path run = folder / "run";
    const auto refuses = [&](const char* file, const std::string& from, const std::string& to) {
        BOOST_TEST_INFO_SCOPE(file << ": " << from << " -> " << to);
        const std::string original = scratch::read(run / file);
        const std::string changed = scratch::replaced(original, from, to);
        BOOST_REQUIRE(changed != original);
        altered_run::write_signed(run, file, changed);
        expect_bad_input([&] { (void)verify_run(run); }, {file});
        altered_run::write_signed(run, file, original);
    };
    const std::string event = scratch::lines_of(run / "events.jsonl")[0];
    const std::string opened =
        event.substr(event.find("\"opened\":"), event.find(",\"closed\"") - event.find("\"opened\":"));
    for (const char* other :
         {"0-0", "2-1", "01-2", "1-2(1,0", "1--2", "1-2 ", "1-2(-1,0)x", "1-2(0,0)", "1-Left", "1", "held z of grain 1",
          "held x of grain -1", "held x of grain 1073741824", "+1-2", "", "1-2(300,0)", "3-3(-1,0)", "11-10(0,-1)"}) {
        refuses("events.jsonl", opened, std::string("\"opened\":\"") + other + "\"");
    }
    refuses("events.jsonl", "\"kind\":\"limit\"", "\"kind\":\"Limit\"");
    refuses("events.jsonl", "\"decision\":\"", "\"decision\":\"no ");
    refuses("events.jsonl", "\"choice\":\"", "\"choice\":\"no ");
    refuses("events.jsonl", "\"power_turn\":false", "\"power_turn\":false,\"held_at\":1.0");
    refuses("events.jsonl", "\"step\":1", "\"step\":1,\"unknown\":1");
    refuses("events.jsonl", "\"step\":1", "\"step\":1,\"step\":1");
    refuses("equilibria.csv", "sigma2,", "sigma2,sigma2,");
    refuses("equilibria.csv", "# number", "# sigma2,number");
    refuses("equilibria.csv", ",L2_bound", ",L3_bound");
    refuses("equilibria.csv", "\n0,-1,", "\n0,-1.0,");
    refuses("equilibria.csv", "\n0,-1,", "\n0.0,-1,");
    refuses("run.json", "most_negative", "most negative");
    refuses("run.json", "\"choose\"", "\"choose \"");
    refuses("run.json", "\"decisions\"", "\"states \"");
    refuses("run.json", "\"status\": \"completed", "\"status\": \"complete");
    refuses("run.json", "\"version\": 1", "\"version\": 2");
    refuses("run.json", "isostat-run", "isostat-walk");
    refuses("summary.json", "isostat-summary", "isostat");
    refuses("checkpoint.json", "isostat-checkpoint", "isostat");
    refuses("checkpoint.json", "\"version\":1", "\"version\":2");
    scratch::write(run / "checkpoint.json", "no JSON");
    BOOST_CHECK_THROW((void)verify_run(run), Error);
}

BOOST_FIXTURE_TEST_CASE(the_summary_of_a_completed_run_has_the_counters_of_the_checkpoint, scratch::InFolder) {
    play(equal_forces(), {towards(-1)}, folder / "run", CertifyLevel::decisions, TiePolicy::choose);
    const std::string summary = scratch::read(folder / "run/summary.json");
    for (const char* name : {"combinatorial", "double", "undecided", "equilibria", "arcs"}) {
        const auto more = [&](const fs::path& run) {
            json::Json altered = json::Json::parse(summary);
            json::Json& counters = altered["counters"];
            json::Json& count = counters.contains(name) ? counters[name] : counters["decisions"][name];
            count = count.get<long>() + 1;
            scratch::write(run / "summary.json", altered.dump());
        };
        const std::string said = said_of(folder / "run", more);
        BOOST_TEST(said.starts_with("refuted"), name << ": " << said);
    }
}

BOOST_FIXTURE_TEST_CASE(files_that_no_record_names_are_noted_and_left_alone, scratch::InFolder) {
    play(equal_forces(), {towards(-1)}, folder / "run", CertifyLevel::decisions, TiePolicy::choose);
    BOOST_TEST(verify_run(folder / "run").notes.size() == 0U);
    scratch::write(folder / "run/states/notes.json", "{}");
    fs::copy(folder / "run/states/eq_000001.json", folder / "run/states/eq_000099.json");
    const RunVerification run = verify_run(folder / "run");
    BOOST_TEST((run.verdict == Verdict::proved));
    BOOST_TEST_REQUIRE(run.notes.size() == 2U);
    BOOST_TEST(run.notes[0].starts_with("states/notes.json"), run.notes[0]);
    BOOST_TEST(run.notes[1].starts_with("states/eq_000099.json"), run.notes[1]);
}

// A bound that is too small is wrong; beside one so large that nothing follows from it the number itself must be right.
BOOST_FIXTURE_TEST_CASE(what_a_row_says_of_its_own_errors_is_checked, scratch::InFolder,
                        *boost::unit_test::label("slow")) {
    play(prepared(8, 3), {towards(2)}, folder / "eight");
    const auto fields = scratch::row_of(folder / "eight/equilibria.csv", 1);
    const std::vector<std::pair<std::string, std::string>> pairs{{"eps1", "eps1_bound"},
                                                                 {"eps2", "eps2_bound"},
                                                                 {"L1", "L1_bound"},
                                                                 {"L2", "L2_bound"},
                                                                 {"sigma2_low", "sigma2_low_bound"},
                                                                 {"sigma2_high", "sigma2_high_bound"},
                                                                 {"potential", "potential_bound"},
                                                                 {"min_gap", "min_gap_bound"},
                                                                 {"min_force", "force_bound"}};
    for (const auto& [value, bound] : pairs) {
        const auto said = [&, &of = value, &by = bound](const std::string& number, const std::string& error) {
            const auto alter = [&](const fs::path& run) {
                set_field(run, 1, of, number);
                set_field(run, 1, by, error);
            };
            return said_of(folder / "eight", alter);
        };
        const std::string number = fields.at(value);
        const std::string error = fields.at(bound);
        const double beside =
            std::max(std::stod(number) + 2 * std::stod(error), std::nextafter(std::stod(number), 1e9));
        BOOST_TEST_INFO_SCOPE(value << " is " << number << " +- " << error);
        BOOST_TEST(said(number, error) == "proved");
        BOOST_TEST(said(Json(beside).dump(), error) == "refuted");
        BOOST_TEST(said(number, "0") == "refuted");
        const std::string wrong = Json(2 * std::stod(number)).dump();
        for (const char* nothing : {"1e300", "inf"}) { // then the number itself is compared
            BOOST_TEST(said(number, nothing) == "proved");
            BOOST_TEST(said(wrong, nothing) != "proved");
        }
    }
}

// The fifth disk is moved into the way of disk 0, in every file: the ends of the arc, the forces and the certificates
// are those of the run in which it is not there, and overlap is nowhere but on the way.
BOOST_FIXTURE_TEST_CASE(a_disk_that_passes_through_another_one_is_not_proved, scratch::InFolder) {
    const State near = swing(12.990813884605371, 11.394639418507785);
    play(swing(12.991722005007981, 11.395062882006048), {towards(-1)}, folder / "far");
    play(near, {towards(-1)}, folder / "near");
    BOOST_REQUIRE(words(verify_run(folder / "far")) == "proved");
    BOOST_REQUIRE(words(verify_run(folder / "near")) == "proved");
    const fs::path run = folder / "far";
    for (const char* name : {"eq_000000.json", "eq_000001.json", "last.json"}) {
        StateFile file = read_state(run / "states" / name);
        file.state.packing.q[8] = near.packing.q[8];
        file.state.packing.q[9] = near.packing.q[9];
        write_state(run / "states" / name, file.state, file.forces);
        if (name[0] == 'e') {
            certify_again(run / "certificates" / name, file.state);
        }
    }
    for (const std::size_t row : {0, 1}) {
        const State state = read_state(run / ("states/eq_00000" + std::to_string(row) + ".json")).state;
        const auto fields = scratch::row_of(run / "equilibria.csv", row);
        const auto nearest = required(checker::contact_of_columns(std::stoi(fields.at("min_gap_i")),
                                                                  std::stoi(fields.at("min_gap_j")), state.packing));
        set_field(run, row, "min_gap", Json(gap(state.packing, nearest)).dump());
        set_field(run, row, "min_gap_bound", "1e-12");
    }
    forger::seal(run);
    const RunVerification forged = verify_run(run);
    BOOST_TEST(words(forged) != "proved");
    BOOST_TEST(forged.ways_proved == 0);
    BOOST_TEST(forged.wrong == "");
    BOOST_REQUIRE(!forged.undecided.empty());
    BOOST_TEST((forged.undecided[0].find("the gap of 0-4 is not proved positive") != std::string::npos),
               forged.undecided[0]);
}
