// A catalogue of forged runs. Whoever forges a record computes the digests too, so they do not help: each forgery must
// be refuted or left undecided, but for numbers that proofs/checker.md lists as not checked.
#include "checker/run_records.hpp"
#include "support/crafted.hpp"
#include "support/forger.hpp"
#include "support/same_sequence.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>
#include <isostat/core/error.hpp>
#include <isostat/io/certificate_file.hpp>
#include <isostat/io/run_directory.hpp>
#include <isostat/io/state_file.hpp>

#include <boost/test/unit_test.hpp>

#include <functional>
#include <sstream>

using namespace isostat;
namespace fs = std::filesystem;
using json::Json;

namespace {

/// Certificates of the equilibria, as a run of level `arcs` has them.
class Certifying final : public RunObserver<2> {
  public:
    explicit Certifying(RunDirectory& next) : next_(next) {}
    void on_arc(const ArcRecord<2>& arc) override { next_.on_arc(arc); }
    void on_equilibrium(const EquilibriumRecord<2>& record, const State<2>& state,
                        const std::vector<double>& forces) override {
        write(next_.path(), record.number, state);
        EquilibriumRecord<2> certified = record;
        certified.certified = Verdict::proved;
        next_.on_equilibrium(certified, state, forces);
    }
    static void write(const fs::path& run, int number, const State<2>& state) {
        Certificate certificate;
        certificate.input = "equilibrium";
        certificate.program = "test";
        certificate.state = state;
        certificate.state.provenance.clear();
        certificate.input_hash = sha256(state_text<2>(certificate.state));
        certificate.claims = certify(certificate.state).claims;
        write_certificate(run / "certificates" / ("eq_00000" + std::to_string(number) + ".json"), certificate);
    }

  private:
    RunDirectory& next_;
};

Segment one(int direction, int equilibria = 1) {
    Segment segment;
    segment.direction = direction;
    segment.equilibria = equilibria;
    return segment;
}

void play(const State<2>& start, const std::vector<Segment>& segments, const fs::path& folder) {
    RunHeader header;
    header.program = "test";
    header.settings = R"({"run":{"rule":"most_negative","certify":"arcs"}})";
    header.states_every = 1;
    header.witnesses = true;
    RunCounters counters;
    RunDirectory directory(folder, header, RunDirectory::Mode::fresh, counters);
    fs::create_directories(folder / "certificates");
    Certifying observer(directory);
    State<2> state = start;
    RunOptions options;
    options.max_strain = 1e9;
    options.certify = CertifyLevel::arcs;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        directory.begin_segment(static_cast<int>(k), segments[k], 0, counters.equilibria);
        const SegmentOutcome outcome =
            run_segment<2>(state, segments[k], static_cast<int>(k), options, counters, observer);
        BOOST_REQUIRE_MESSAGE(outcome.completed, (outcome.failure ? outcome.failure->message() : ""));
    }
    directory.finish(RunStatus::completed, "");
}

/// Disk 0 swings around the fixed disk 2 between fixed disks; `last` is where the fifth disk stands: in the way, or
/// just beside it.
State<2> swing(double x, double y) {
    return parse_state<2>(R"({"format": "isostat-state", "version": 1, "walls": {"lower": ["absent", "absent"], "upper":
["absent", "movable"]}, "load": {"kind": "nominal", "stress": [1, 1], "loaded_axis": 1, "reference_length": [1, 13]},
"disk_force": [[0.3, 0], [0, 0], [0, 0], [0, 0], [0, 0]], "disks": [[1, 8.585786437626904, 11.414213562373096],
[0.3, 7.415786437626905, 10.847556699712808], [1, 10.0, 10.0], [0.3, 12.907160852994403, 9.9367358990906], [0.3, )" +
                              Json(x).dump() + ", " + Json(y).dump() +
                              R"(]], "length": [20, 12.414213562373096], "fixed": [1, 2, 3, 4],
"infinitesimal": [[0.1, -1], [0, 0], [0, 0], [0, 0], [0, 0]], "contacts": [[0, "top"], [0, 1], [0, 2]]})",
                          "swing")
        .state;
}

std::vector<std::string> lines_of(const fs::path& file) {
    std::vector<std::string> lines;
    std::istringstream in(scratch::read(file));
    for (std::string line; std::getline(in, line);) {
        lines.push_back(line);
    }
    return lines;
}

void write_lines(const fs::path& file, const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) {
        text += line + "\n";
    }
    scratch::write(file, text);
}

Json read_json(const fs::path& file) {
    return Json::parse(scratch::read(file));
}

/// What must become of a forgery.
enum class Expected : unsigned char {
    found,   ///< refuted or undecided
    listed,  ///< a number that is listed as not checked: it may be anything, and the list must name it
    harmless ///< advice to the checker, not a claim: never refuted
};

struct Forgery {
    std::string name;
    std::function<void(const fs::path&)> alter;
    Expected expected = Expected::found;
};

/// One line of a file of JSON lines, changed.
Forgery in_line(const std::string& file, std::size_t line, const std::string& name,
                const std::function<void(Json&)>& change, Expected expected = Expected::found) {
    return {file + ":" + std::to_string(line + 1) + " " + name,
            [=](const fs::path& run) {
                std::vector<std::string> lines = lines_of(run / file);
                Json object = Json::parse(lines.at(line));
                change(object);
                lines[line] = object.dump();
                write_lines(run / file, lines);
            },
            expected};
}

Forgery in_state(const std::string& file, const std::string& name, const std::function<void(StateFile<2>&)>& change) {
    return {file + " " + name, [=](const fs::path& run) {
                StateFile<2> state = read_state<2>(run / file);
                change(state);
                write_state<2>(run / file, state.state, state.forces);
            }};
}

void events(const fs::path& run, std::vector<Forgery>& list) {
    const std::vector<std::string> lines = lines_of(run / "events.jsonl");
    const std::string file = "events.jsonl";
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const Json event = Json::parse(lines[k]);
        for (const char* name : {"sigma2", "eps2", "force", "power", "work", "held_at"}) {
            for (const double factor : {1 + 1e-4, -1.0, 3.0}) {
                const double value = event.contains(name) ? event[name].get<double>() : 0;
                // The power of a turn, like a force at a limit, is 0.
                if (value == 0 || (std::string(name) == "power" && event["power_turn"].get<bool>())) {
                    continue;
                }
                list.push_back(in_line(file, k, std::string(name) + " x " + std::to_string(factor),
                                       [=](Json& e) { e[name] = value * factor; }));
            }
        }
        for (const char* name : {"eps2_bound", "force_bound", "power_bound", "work_bound"}) {
            list.push_back(in_line(file, k, name, [=](Json& e) { e[name] = e[name].is_null() ? Json(1) : Json(); }));
            if (event[name].is_number() && event[name] != 0) {
                list.push_back(in_line(file, k, std::string(name) + " = 0", [=](Json& e) { e[name] = 0; }));
                list.push_back(in_line(file, k, std::string(name) + " = 1e300", [=](Json& e) { e[name] = 1e300; }));
            }
        }
        for (const char* name : {"margin", "displacement", "steps", "decided_by", "certificate"}) {
            list.push_back(in_line(
                file, k, name, [=](Json& e) { e[name] = e[name].is_number() ? Json(1) : e[name]; }, Expected::listed));
        }
        for (const char* name : {"step", "arc", "equilibrium"}) {
            list.push_back(in_line(file, k, name, [=](Json& e) { e[name] = e[name].get<int>() + 1; }));
        }
        list.push_back(
            in_line(file, k, "kind", [](Json& e) { e["kind"] = e["kind"] == "limit" ? "tension" : "limit"; }));
        list.push_back(in_line(file, k, "power_turn", [](Json& e) { e["power_turn"] = !e["power_turn"].get<bool>(); }));
        list.push_back(
            in_line(file, k, "opened and closed swapped", [](Json& e) { std::swap(e["opened"], e["closed"]); }));
        for (const char* name : {"opened", "closed"}) {
            for (const char* other : {"0-bottom", "0-top", "1-right", "0-1", "0-2", "1-2"}) {
                if (event[name] != other && (std::string(name) == "opened" || event["opened"] != other)) {
                    list.push_back(
                        in_line(file, k, std::string(name) + " = " + other, [=](Json& e) { e[name] = other; }));
                }
            }
        }
        for (const char* which : {"events.jsonl", "certificates/arcs.jsonl"}) {
            list.push_back({std::string(which) + " without line " + std::to_string(k + 1), [=](const fs::path& folder) {
                                std::vector<std::string> left = lines_of(folder / which);
                                left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
                                write_lines(folder / which, left);
                            }});
            list.push_back(
                {std::string(which) + " with line twice " + std::to_string(k + 1), [=](const fs::path& folder) {
                     std::vector<std::string> more = lines_of(folder / which);
                     more.insert(more.begin() + static_cast<std::ptrdiff_t>(k), more[k]);
                     write_lines(folder / which, more);
                 }});
        }
        if (k + 1 < lines.size()) {
            list.push_back({"events exchanged " + std::to_string(k + 1), [=](const fs::path& folder) {
                                std::vector<std::string> other = lines_of(folder / file);
                                std::swap(other[k], other[k + 1]);
                                write_lines(folder / file, other);
                            }});
        }
        const std::string witness = "certificates/arcs.jsonl";
        list.push_back(in_line( // the true vertex is found from there all the same
            witness, k, "end", [](Json& w) { w["end"][0] = w["end"][0].get<double>() + 1e-3; }, Expected::harmless));
        list.push_back(
            in_line(witness, k, "another end", [](Json& w) { w["end"][0] = w["end"][0].get<double>() + 1; }));
        list.push_back(in_line(witness, k, "end too long", [](Json& w) { w["end"].push_back(1.0); }));
        list.push_back(in_line(witness, k, "no grain", [](Json& w) { w["grains"] = Json::array(); }));
        list.push_back(in_line(witness, k, "a grain that there is not", [](Json& w) { w["grains"] = {1000}; }));
        list.push_back(in_line(
            witness, k, "no centres", [](Json& w) { w["centres"] = Json::array(); }, Expected::harmless));
        list.push_back(in_line(
            witness, k, "another centre",
            [](Json& w) {
                for (Json& centre : w["centres"]) {
                    centre["q"][0] = centre["q"][0].get<double>() + 1e-2;
                }
            },
            Expected::harmless));
    }
}

const std::vector<std::string>& unchecked_columns() {
    static const std::vector<std::string> columns{"segment",      "balance", "virtual_power", "sigma_min_bound",
                                                  "gap_residual", "margin",  "decided_by",    "seconds"};
    return columns;
}

std::vector<std::string> fields_of(const fs::path& run, std::size_t row) {
    std::vector<std::string> fields;
    std::istringstream in(lines_of(run / "equilibria.csv")[row]);
    for (std::string field; std::getline(in, field, ',');) {
        fields.push_back(field);
    }
    return fields;
}

/// Writes into one field of equilibria.csv, `otherwise` when it says so already.
void set_field(const fs::path& run, std::size_t row, std::size_t column, const std::string& value,
               const std::string& otherwise) {
    std::vector<std::string> text = lines_of(run / "equilibria.csv");
    std::vector<std::string> fields = fields_of(run, row);
    fields[column] = fields[column] == value ? otherwise : value;
    text[row].clear();
    for (const std::string& field : fields) {
        text[row] += (text[row].empty() ? "" : ",") + field;
    }
    write_lines(run / "equilibria.csv", text);
}

void rows(const fs::path& run, std::vector<Forgery>& list) {
    const std::vector<std::string> lines = lines_of(run / "equilibria.csv");
    const std::vector<std::string> names = equilibria_columns();
    for (std::size_t row = 1; row < lines.size(); ++row) {
        for (std::size_t c = 0; c < names.size(); ++c) {
            const bool listed = std::find(unchecked_columns().begin(), unchecked_columns().end(), names[c]) !=
                                unchecked_columns().end();
            if (names[c] == "previous" && row == 1) {
                continue; // the start has none before it
            }
            list.push_back({"equilibria.csv:" + std::to_string(row + 1) + " " + names[c],
                            [=](const fs::path& folder) { set_field(folder, row, c, "7", "8"); },
                            listed ? Expected::listed : Expected::found});
        }
        list.push_back({"equilibria.csv without line " + std::to_string(row + 1), [=](const fs::path& folder) {
                            std::vector<std::string> left = lines_of(folder / "equilibria.csv");
                            left.erase(left.begin() + static_cast<std::ptrdiff_t>(row));
                            write_lines(folder / "equilibria.csv", left);
                        }});
    }
}

void files(const fs::path& run, std::vector<Forgery>& list) {
    std::vector<std::string> states{"states/last.json"};
    const auto rows = static_cast<int>(lines_of(run / "equilibria.csv").size()) - 1;
    for (int k = 0; k < rows; ++k) {
        const std::string name = "eq_00000" + std::to_string(k) + ".json";
        states.push_back("states/" + name);
        const std::string certificate = "certificates/" + name;
        list.push_back(
            {certificate + " emptied", [=](const fs::path& folder) { scratch::write(folder / certificate, ""); }});
        list.push_back({certificate + " without claims", [=](const fs::path& folder) {
                            Certificate altered = read_certificate(folder / certificate);
                            altered.claims = {};
                            write_certificate(folder / certificate, altered);
                        }});
        list.push_back({certificate + " with another force", [=](const fs::path& folder) {
                            Certificate altered = read_certificate(folder / certificate);
                            altered.claims.forces->finite[0] = {1e3, 2e3};
                            write_certificate(folder / certificate, altered);
                        }});
        list.push_back({certificate + " of another state", [=](const fs::path& folder) {
                            State<2> other = read_state<2>(folder / ("states/" + name)).state;
                            other.load.stress[1] *= 1 + 1e-6;
                            Certifying::write(folder, k, other);
                        }});
        list.push_back({certificate + " left out", [=](const fs::path& folder) { fs::remove(folder / certificate); }});
    }
    for (const std::string& file : states) {
        for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
            list.push_back(in_state(file, "coordinate " + std::to_string(k),
                                    [=](StateFile<2>& s) { s.state.packing.q[k] += 1e-7; }));
        }
        list.push_back(in_state(file, "a radius", [](StateFile<2>& s) { s.state.packing.radius[0] *= 1 + 1e-7; }));
        list.push_back(in_state(file, "a stress", [](StateFile<2>& s) { s.state.load.stress[0] *= 1 + 1e-9; }));
        list.push_back(in_state(file, "a length of reference",
                                [](StateFile<2>& s) { s.state.load.reference_length[0] *= 1 + 1e-9; }));
        list.push_back(
            in_state(file, "an infinitesimal load", [](StateFile<2>& s) { s.state.load.infinitesimal[0] *= -2; }));
        list.push_back(in_state(file, "a contact less", [](StateFile<2>& s) {
            s.state.contacts.pop_back();
            s.forces.pop_back();
        }));
        list.push_back(in_state(file, "a force", [](StateFile<2>& s) { s.forces[0] += 1e-3; }));
    }
    list.push_back({"summary.json: arcs", [](const fs::path& folder) {
                        Json summary = read_json(folder / "summary.json");
                        summary["counters"]["arcs"] = 99;
                        scratch::write(folder / "summary.json", summary.dump());
                    }});
    list.push_back({"summary.json: equilibria", [](const fs::path& folder) {
                        Json summary = read_json(folder / "summary.json");
                        summary["last_equilibrium"] = 99;
                        scratch::write(folder / "summary.json", summary.dump());
                    }});
    list.push_back({"run.json: still running", [](const fs::path& folder) {
                        Json header = read_json(folder / "run.json");
                        header["status"] = "running";
                        scratch::write(folder / "run.json", header.dump());
                    }});
    list.push_back(
        {"no witnesses", [](const fs::path& folder) { scratch::write(folder / "certificates/arcs.jsonl", ""); }});
    list.push_back({"no checkpoint", [](const fs::path& folder) { fs::remove(folder / "checkpoint.json"); }});
    list.push_back({"run.json: a lower level", [](const fs::path& folder) {
                        Json header = read_json(folder / "run.json");
                        header["settings"]["run"]["certify"] = "decisions";
                        scratch::write(folder / "run.json", header.dump());
                    }});
}

/// The names in the paragraph "Not checked" of the page.
bool is_listed(const std::string& forgery) {
    const std::string page = scratch::read(fs::path(ISOSTAT_EXAMPLES) / "../proofs/checker.md");
    const std::size_t begin = page.find("*Not checked.*");
    const std::string list = page.substr(begin, page.find("\n\n", begin) - begin);
    return list.find("`" + forgery.substr(forgery.rfind(' ') + 1) + "`") != std::string::npos;
}

/// What the checker says of a forged copy; bad input is a refusal too.
std::string said_of(const fs::path& original, const Forgery& forgery, bool& refuted) {
    const scratch::Folder folder;
    const fs::path run = folder / "run";
    fs::copy(original, run, fs::copy_options::recursive);
    forgery.alter(run);
    try {
        forger::seal(run);
        const RunVerification result = verify_run(run);
        refuted = result.verdict == Verdict::refuted;
        return words(result);
    } catch (const Error& error) {
        refuted = true;
        return error.what();
    }
}

int try_all(const fs::path& run, const std::vector<Forgery>& list) {
    for (const Forgery& forgery : list) {
        BOOST_TEST_CONTEXT(forgery.name) {
            bool refuted = false;
            const std::string said = said_of(run, forgery, refuted);
            if (forgery.expected == Expected::harmless) {
                BOOST_TEST(!refuted, said);
            } else if (forgery.expected == Expected::listed) {
                BOOST_TEST(is_listed(forgery.name));
                BOOST_TEST(said == "proved");
            } else {
                BOOST_TEST(said != "proved");
            }
        }
    }
    return static_cast<int>(list.size());
}

std::vector<Forgery> catalogue(const fs::path& run) {
    std::vector<Forgery> list;
    events(run, list);
    rows(run, list);
    files(run, list);
    return list;
}

} // namespace

BOOST_AUTO_TEST_SUITE(checker)

BOOST_AUTO_TEST_CASE(forged_records_are_refused_or_undecided_and_whatever_is_not_checked_is_listed) {
    const scratch::Folder folder;
    play(swing(12.991722005007981, 11.395062882006048), {one(-1)}, folder / "swing");
    play(prepared(8, 3), {one(1, 2), one(-1)}, folder / "eight");
    int forgeries = 0;
    for (const char* run : {"swing", "eight"}) {
        BOOST_TEST_CONTEXT(run) {
            BOOST_REQUIRE(words(verify_run(folder / run)) == "proved");
            forgeries += try_all(folder / run, catalogue(folder / run));
        }
    }
    BOOST_TEST_MESSAGE(forgeries << " forgeries");
    BOOST_TEST(forgeries >= 200);
}

// A bound that is too small is wrong; one so large that nothing follows from it leaves the row undecided.
BOOST_AUTO_TEST_CASE(what_a_row_says_of_its_own_errors_is_checked) {
    const scratch::Folder folder;
    play(prepared(8, 3), {one(1, 2)}, folder / "eight");
    const std::vector<std::string> names = equilibria_columns();
    const auto column = [&names](const std::string& name) {
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    const std::vector<std::string> fields = fields_of(folder / "eight", 2);
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
        const auto said = [&, of = column(value), by = column(bound)](const std::string& number,
                                                                      const std::string& error) {
            bool refuted = false;
            const auto alter = [&](const fs::path& run) {
                set_field(run, 2, of, number, number);
                set_field(run, 2, by, error, error);
            };
            return said_of(folder / "eight", {value, alter}, refuted);
        };
        const std::string number = fields[column(value)];
        const std::string error = fields[column(bound)];
        const double beside =
            std::max(std::stod(number) + 2 * std::stod(error), std::nextafter(std::stod(number), 1e9));
        BOOST_TEST_CONTEXT(value << " is " << number << " +- " << error) {
            BOOST_TEST(said(number, error) == "proved");
            BOOST_TEST(said(Json(beside).dump(), error) == "refuted");
            BOOST_TEST(said(number, "0") == "refuted");
            BOOST_TEST(said(number, "1e300") == "undecided");
            BOOST_TEST(said(number, "inf") == "undecided");
        }
    }
}

// The fifth disk is moved into the way of disk 0, in every file: the ends of the arc, the forces and the certificates
// are those of the run in which it is not there, and overlap is nowhere but on the way.
BOOST_AUTO_TEST_CASE(a_disk_that_passes_through_another_one_is_not_proved) {
    const scratch::Folder folder;
    const State<2> near = swing(12.990813884605371, 11.394639418507785);
    play(swing(12.991722005007981, 11.395062882006048), {one(-1)}, folder / "far");
    play(near, {one(-1)}, folder / "near");
    BOOST_REQUIRE(words(verify_run(folder / "far")) == "proved");
    BOOST_REQUIRE(words(verify_run(folder / "near")) == "proved");
    const fs::path run = folder / "far";
    for (const char* name : {"eq_000000.json", "eq_000001.json", "last.json"}) {
        StateFile<2> file = read_state<2>(run / "states" / name);
        file.state.packing.q[8] = near.packing.q[8];
        file.state.packing.q[9] = near.packing.q[9];
        write_state<2>(run / "states" / name, file.state, file.forces);
        if (name[0] == 'e') {
            Certifying::write(run, name[8] - '0', file.state);
        }
    }
    const std::vector<std::string> names = equilibria_columns();
    const auto column = [&names](const char* name) {
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    for (const std::size_t row : {1, 2}) {
        const State<2> state = read_state<2>(run / ("states/eq_00000" + std::to_string(row - 1) + ".json")).state;
        const std::vector<std::string> fields = fields_of(run, row);
        const auto nearest = isostat::checker::contact_of_columns(
            std::stod(fields[column("min_gap_i")]), std::stod(fields[column("min_gap_j")]), state.packing);
        BOOST_REQUIRE(nearest.has_value());
        set_field(run, row, column("min_gap"), Json(gap(state.packing, *nearest)).dump(), "");
        set_field(run, row, column("min_gap_bound"), "1e-12", "");
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

BOOST_AUTO_TEST_SUITE_END()
