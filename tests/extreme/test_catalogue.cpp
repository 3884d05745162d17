// The table and the checks that every row goes through.
#include "contact/candidates.hpp"
#include "core/dot.hpp"
#include "extreme/catalogue.hpp"
#include "oracle/truth.hpp"
#include "support/scratch.hpp"

#include <regex>

namespace extreme {

namespace {

std::vector<Row>& rows() {
    static std::vector<Row> list;
    return list;
}

std::string number(double value, const char* none) {
    return value < 0 || !std::isfinite(value) ? none : fmt::format("{:.1e}", value);
}

/// A cell of a table: no bars, no line breaks, not too long.
std::string cell(std::string text) {
    std::ranges::replace(text, '|', '/');
    std::ranges::replace(text, '\n', ' ');
    constexpr std::size_t longest = 140;
    return text.size() > longest ? text.substr(0, longest - 3) + "..." : text;
}

std::string markdown() {
    std::string text = "| family | case | disks | outcome | rung | error bound | ms | checked by |\n"
                       "|---|---|---|---|---|---|---|---|\n";
    std::map<std::string, int> counts;
    for (const Row& row : rows()) {
        ++counts[row.outcome];
        text += fmt::format("| {} | {} | {} | {}{} | {} | {} | {:.2f} | {} |\n", row.family, row.parameter, row.disks,
                            row.outcome, row.reason.empty() ? "" : ": " + cell(row.reason), row.rung,
                            number(row.bound, "–"), 1000 * row.seconds, row.checked);
    }
    text += fmt::format("\n{} cases:", rows().size());
    for (const auto& [outcome, count] : counts) {
        text += fmt::format(" {} {},", count, outcome);
    }
    text.back() = '.';
    return text + "\n";
}

std::string csv() {
    std::string text = "# family,case,disks,outcome,rung,error_bound,seconds,checked_by,reason\n";
    const auto quoted = [](std::string word) {
        std::ranges::replace(word, '"', '\'');
        return '"' + word + '"';
    };
    for (const Row& row : rows()) {
        text += fmt::format("{},{},{},{},{},{},{:.6f},{},{}\n", quoted(row.family), quoted(row.parameter), row.disks,
                            row.outcome, row.rung, number(row.bound, "nan"), row.seconds, quoted(row.checked),
                            quoted(row.reason));
    }
    return text;
}

/// Writes the table when everything is done: NAME.md and NAME.csv, NAME from the environment.
struct Table {
    ~Table() {
        const char* name = std::getenv("ISOSTAT_EXTREMES"); // NOLINT(concurrency-mt-unsafe): one thread is left
        if (name != nullptr) {
            scratch::write(std::string(name) + ".md", markdown());
            scratch::write(std::string(name) + ".csv", csv());
        }
    }
};
BOOST_TEST_GLOBAL_FIXTURE(Table);

/// Overlaps of any pair beyond the rounding of the stored coordinates.
bool admissible(const State& state) {
    return certify_admissible(state.packing, 8 * grid_step(state.packing)).verdict == Verdict::proved;
}

/// Outcomes of the committed table, by family and case.
const std::map<std::pair<std::string, std::string>, std::string>& committed() {
    static const auto table = [] {
        std::map<std::pair<std::string, std::string>, std::string> outcomes;
        std::ifstream file(ISOSTAT_TEST_DATA "/../extreme/extremes.csv");
        std::string line;
        std::getline(file, line); // the names of the columns
        const std::regex row(R"re(^"([^"]*)","([^"]*)",\d+,([a-z]+),)re");
        while (std::getline(file, line)) {
            std::smatch part;
            BOOST_REQUIRE_MESSAGE(std::regex_search(line, part, row), line);
            outcomes[{part[1], part[2]}] = part[3];
        }
        return outcomes;
    }();
    return table;
}

constexpr int dense = 64; // disks: elimination to 200 digits of larger ones takes seconds

std::string reason_of(const Failure& failure, const std::string& outcome) {
    const std::string kind = to_string(failure.kind);
    return kind == outcome ? failure.message() : kind + ": " + failure.message();
}

/// At the true vertex, or where the coordinates are stored when there is none.
oracle::Truth true_forces(const State& state) {
    oracle::Truth truth(state);
    return truth.known ? truth : oracle::Truth(state, oracle::At::stored);
}

void check_proved(const State& state, const Inspection& inspection, Row& row) {
    BOOST_TEST(inspection.record.hyperstaticity == 0);
    BOOST_TEST(inspection.record.mechanisms == 0);
    BOOST_TEST(admissible(state));
    if (state.packing.disk_count() > dense) {
        row.checked = "exact non-overlap of all pairs";
        return;
    }
    const oracle::Truth truth = true_forces(state);
    BOOST_REQUIRE_MESSAGE(truth.known, "proved, but the matrix is singular");
    for (std::size_t l = 0; l < truth.force.size(); ++l) {
        BOOST_TEST(truth.sign(l) == 1, "contact " << to_string(state.contacts[l]));
        const double error = static_cast<double>(abs(truth.force[l] - oracle::Real(inspection.forces[l])));
        const double rounding = std::abs(inspection.forces[l]) * 0x1p-53; // of the printed double
        BOOST_TEST(error <= inspection.record.force_bound + rounding, "contact " << to_string(state.contacts[l]));
    }
    row.checked = "forces to 200 digits, exact non-overlap of all pairs";
}

void check_refuted(const State& state, Row& row) {
    const oracle::Truth truth = true_forces(state);
    bool right = !truth.known || !admissible(state);
    for (std::size_t l = 0; l < truth.force.size(); ++l) {
        right = right || truth.sign(l) < 0;
    }
    BOOST_TEST(right, "refuted, but every force is positive and nothing overlaps");
    row.checked = "forces to 200 digits";
}

} // namespace

void add(Row row) {
    // What was proved stays proved, and the table tells what is so: after a change on purpose it is made anew.
    const auto known = committed().find({row.family, row.parameter});
    BOOST_TEST((known != committed().end()),
               row.family << ", " << row.parameter << ": not in extremes.csv, which tests/extreme/run makes");
    if (known != committed().end()) {
        BOOST_TEST(row.outcome == known->second, row.family << ", " << row.parameter << ": " << row.outcome << " "
                                                            << row.reason << ", was " << known->second);
    }
    rows().push_back(std::move(row));
}

std::optional<Inspection> inspect(const std::string& family, const std::string& parameter, const State& state) {
    BOOST_TEST_CONTEXT(family << ", " << parameter) {
        Row row;
        row.family = family;
        row.parameter = parameter;
        row.disks = state.packing.disk_count();
        const Clock clock;
        auto result = inspect_vertex(state);
        row.seconds = clock.seconds();
        if (!result.ok()) {
            const FailureKind kind = result.failure().kind;
            row.outcome = kind == FailureKind::undecided || kind == FailureKind::tie ? "undecided" : "refused";
            row.reason = reason_of(result.failure(), row.outcome);
            row.rung = "none";
            row.checked = "no claim";
            if (kind == FailureKind::not_isostatic && state.packing.disk_count() <= dense) {
                BOOST_TEST(!true_forces(state).known, "not isostatic, but the matrix is square and regular");
                row.checked = "rank to 200 digits";
            }
            add(row);
            return std::nullopt;
        }
        Inspection& inspection = result.value();
        const EquilibriumRecord& record = inspection.record;
        row.outcome = to_string(record.verdict);
        row.reason = record.verdict == Verdict::proved ? "" : inspection.remark;
        if (row.reason.empty() && record.mechanisms > 0) {
            row.reason = fmt::format("not isostatic: {} mechanisms", record.mechanisms);
        }
        row.rung = to_string(record.decided_by);
        row.checked = "no claim";
        if (record.verdict == Verdict::proved) {
            row.bound = record.force_bound / largest(inspection.forces);
            check_proved(state, inspection, row);
        } else if (record.verdict == Verdict::refuted && state.packing.disk_count() <= dense) {
            check_refuted(state, row);
        }
        add(row);
        return inspection;
    }
    return std::nullopt;
}

std::optional<State> prepared(const std::string& family, const std::string& parameter,
                              const PreparationOptions& options) {
    Row row;
    row.family = family;
    row.parameter = parameter;
    row.disks = options.radii.empty() ? options.disks : static_cast<int>(options.radii.size());
    const Clock clock;
    PreparationReport report;
    const auto result = prepare(options, report);
    if (result.ok()) {
        const double seconds = clock.seconds();
        const auto inspection = inspect(family, parameter, result.value());
        BOOST_TEST_CONTEXT(family << ", " << parameter) {
            // A preparation proves its forces for the stored coordinates; where those of the true vertex nearby are not
            // known well enough, the inspection says so.
            BOOST_TEST(!(inspection && inspection->record.verdict == Verdict::refuted));
        }
        rows().back().seconds = seconds;
        return result.value();
    }
    row.seconds = clock.seconds();
    const Failure& failure = result.failure();
    row.outcome = failure.kind == FailureKind::undecided || failure.kind == FailureKind::tie ? "undecided" : "refused";
    row.reason = reason_of(failure, row.outcome);
    row.rung = "none";
    row.checked = "no claim";
    BOOST_TEST(report.last.has_value()); // nothing is lost
    add(row);
    return std::nullopt;
}

} // namespace extreme
