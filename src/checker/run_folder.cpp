#include "checker/run_folder.hpp"

#include "io/files.hpp"
#include "io/folders.hpp"
#include "io/json.hpp"
#include "io/record_digests.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::checker {

namespace {

namespace fs = std::filesystem;
using json::Field;

Objections wrong(std::string text) {
    return Objection{true, std::move(text)};
}

/// The records are those of the last checkpoint, except for arcs without an equilibrium when the run ended early.
Objections check_digests(const fs::path& directory, const CheckedRecords& checked, const RunRecords& records) {
    if (!checked.damage.empty()) {
        return wrong(checked.damage);
    }
    for (const char* name : {"events.jsonl", "equilibria.csv", witness_records}) {
        const bool may_be_longer = records.status != "completed" && std::string_view(name) != "equilibria.csv";
        const auto found = checked.lines.find(name);
        if (name == witness_records && found == checked.lines.end() && !fs::exists(directory / name)) {
            continue; // then no motion is proved
        }
        if (found == checked.lines.end()) {
            return wrong(fmt::format("checkpoint.json: no digest of {}", name));
        }
        const auto size = static_cast<long>(fs::file_size(directory / name));
        if (size != found->second.bytes && !may_be_longer) {
            return wrong(fmt::format("{}: {} bytes: expected {}, the length at the last checkpoint", name, size,
                                     found->second.bytes));
        }
    }
    return {};
}

/// Numbers that a file repeats from the records.
class Repeated {
  public:
    explicit Repeated(std::string file) : file_(std::move(file)) {}
    template <class Number> void same(const std::string& name, const Number& said, const Number& found) {
        if (!(said == found) && !wrong_) {
            wrong_ = wrong(fmt::format("{}: {} is {}, but the records have {}", file_, name, said, found));
        }
    }
    void same(const std::string& name, const Field& said, double found) {
        const json::Json number = said.value().is_null() ? json::Json(nullptr) : json::Json(said.number());
        same(name, number.dump(), json::or_null(found).dump());
    }
    [[nodiscard]] const Objections& answer() const { return wrong_; }

  private:
    std::string file_;
    Objections wrong_;
};

/// Number of rows of the segment of the last row.
long made_in_segment(const RunRecords& records) {
    const int segment = records.equilibria.back().integer("segment");
    return std::count_if(records.equilibria.begin() + 1, records.equilibria.end(),
                         [segment](const EquilibriumLine& line) { return line.integer("segment") == segment; });
}

/// \pre there is a row
Objections check_checkpoint(const CheckedRecords& checked, const RunRecords& records, const State& last) {
    const Field file(checked.checkpoint, (records.directory / "checkpoint.json").string());
    const EquilibriumLine& row = records.equilibria.back();
    const auto rows = static_cast<long>(records.equilibria.size());
    Repeated here("checkpoint.json");
    if (checked.state != read_text(records.directory / "states" / "last.json")) {
        const std::string difference =
            state_difference(last, parse_any_state(checked.state, "checkpoint.json", Dimensions::any_clumps).state);
        return wrong(fmt::format("states/last.json: {} is not that of checkpoint.json",
                                 difference.empty() ? "a recorded result" : difference));
    }
    here.same("segment", file.at("segment").integer(), long{row.integer("segment")});
    here.same("made", file.at("made").integer(), made_in_segment(records));
    const auto arcs = std::count_if(records.events.begin(), records.events.end(),
                                    [rows](const EventRecord& event) { return event.equilibrium < rows; });
    here.same("counters.arcs", file.at("counters").at("arcs").integer(), long{arcs});
    here.same("counters.equilibria", file.at("counters").at("equilibria").integer(), rows - 1);
    const Field strain = file.at("strain");
    const RecordColumns names = record_columns(last.load, last.packing.cell.shears());
    here.same("the number of strains", strain.size(), names.measures.size());
    for (const auto& [column, length, axis] : names.measures) {
        here.same(fmt::format("strain[{}]", axis), strain.at(axis), row.at(column));
    }
    return here.answer();
}

/// Counters without the times, as text.
std::string without_seconds(const Field& counters) {
    json::Json object = counters.value();
    for (auto& [name, part] : object.items()) {
        if (part.is_object()) {
            part.erase("seconds");
        }
    }
    if (object.is_object()) {
        object.erase("seconds");
    }
    return object.dump();
}

Objections check_summary(const std::optional<CheckedRecords>& checked, const RunRecords& records,
                         const std::optional<State>& last) {
    const fs::path path = records.directory / "summary.json";
    const json::Json parsed = Field::parse(read_text(path), path.string());
    const Field summary(parsed, path.string());
    if (summary.at("format").string() != "isostat-summary") {
        summary.at("format").fail("\"isostat-summary\"");
    }
    (void)summary.at("version").integer(1, 1);
    Repeated here("summary.json");
    here.same("status", summary.at("status").string(), records.status);
    here.same("reason", summary.at("reason").string(), records.reason);
    here.same("program", summary.at("program").string(), records.program);
    here.same("segments", summary.at("segments").integer(), long{records.segments});
    here.same("last_equilibrium", summary.at("last_equilibrium").integer(),
              std::max(0L, static_cast<long>(records.equilibria.size()) - 1));
    if (records.status == "completed") {
        here.same("counters.arcs", summary.at("counters").at("arcs").integer(),
                  static_cast<long>(records.events.size()));
    }
    if (last) {
        std::vector<std::string> names{"ratio", "solid_fraction"};
        for (const RecordColumns::Measure& measure : record_columns(last->load, false).measures) {
            names.push_back(measure.strain);
        }
        for (const std::string& name : names) {
            here.same(name, summary.at(name.c_str()), records.equilibria.back().at(name));
        }
        here.same("disks", summary.at("disks").integer(), long{last->packing.disk_count()});
    }
    if (checked && records.status == "completed") { // nothing came after the checkpoint
        const Field checkpoint(checked->checkpoint, (records.directory / "checkpoint.json").string());
        here.same("segment", summary.at("segment").integer(), checkpoint.at("segment").integer());
        here.same("counters, but for the times,", without_seconds(summary.at("counters")),
                  without_seconds(checkpoint.at("counters")));
    }
    return here.answer();
}

/// Rows name segments of the programme, in its order.
Objections check_segments(const RunRecords& records) {
    int before = 0;
    for (const EquilibriumLine& line : records.equilibria) {
        const int segment = line.integer("segment");
        if (segment < before || (records.segments > 0 && segment >= records.segments)) {
            return wrong(
                fmt::format("{}: segment is {}, after {}, of {}", line.where, segment, before, records.segments));
        }
        before = segment;
    }
    return {};
}

} // namespace

bool is_running(const fs::path& directory) {
    const fs::path path = directory / "run.json";
    const json::Json parsed = Field::parse(read_text(path), path.string());
    return Field(parsed, path.string()).at("status").string() == "running";
}

Objections check_folder(const fs::path& directory, const RunRecords& records) {
    const std::optional<CheckedRecords> checked = compare_records(directory);
    if (!checked && records.equilibria.size() > 1) {
        return wrong("checkpoint.json is missing, with the digests of the records");
    }
    if (Objections damage = checked ? check_digests(directory, *checked, records) : Objections()) {
        return damage;
    }
    std::optional<State> last;
    if (!records.equilibria.empty()) {
        const fs::path path = directory / "states" / "last.json";
        if (!fs::exists(path)) {
            return wrong("states/last.json is missing");
        }
        last = read_any_state(path, Dimensions::any_clumps).state;
    }
    if (Objections other = checked && last ? check_checkpoint(*checked, records, *last) : Objections()) {
        return other;
    }
    Objections other = check_segments(records);
    return other ? other : check_summary(checked, records, last);
}

std::vector<std::string> files_apart(const RunRecords& records) {
    const FolderContent content = content_of(records.directory, run_folder);
    std::vector<std::string> notes = notes_on(content, run_folder);
    const int rows = static_cast<int>(records.equilibria.size());
    for (const std::string& name : content.files) {
        const std::size_t number = name.find("/eq_") + std::string_view("/eq_").size();
        const std::string digits = name.substr(std::min(number, name.size()), name.rfind('.') - number);
        constexpr std::size_t most_digits_of_int = 9; // exact: decimal digits that always fit an int
        if ((name.starts_with("states/eq_") || name.starts_with("certificates/eq_")) &&
            (digits.size() > most_digits_of_int || std::stoi(digits) >= rows)) {
            notes.push_back(fmt::format("{} is of no equilibrium of this run: it was left alone", name));
        }
    }
    return notes;
}

Objections check_certificate(const RunRecords& records, const Place& place, const EquilibriumLine& line) {
    const std::string name = fmt::format("certificates/eq_{:06}.json", line.integer("number"));
    const bool claims_all = line.integer("certified") == 1;
    if (!claims_all && line.integer("certified") != 0) {
        return wrong(fmt::format("certified is {}: expected 0 or 1 at this level", line.integer("certified")));
    }
    if (!fs::exists(records.directory / name)) {
        return wrong(name + " is missing");
    }
    const Certificate certificate = read_certificate(records.directory / name);
    if (Objections other = check_stored(place, certificate.state, records.start)) {
        return Objection{other->wrong, fmt::format("{}: {}", name, other->text)};
    }
    const Verification found = verify(certificate);
    for (const ClaimCheck& check : found.checks) {
        if (check.verdict == Verdict::refuted || (claims_all && !check.claimed)) {
            return wrong(fmt::format("{}: {}: {}", name, check.claim, check.detail));
        }
        if (claims_all && check.verdict != Verdict::proved) {
            return Objection{false, fmt::format("{}: {}: {}", name, check.claim, check.detail)};
        }
    }
    if (!claims_all && found.verdict == Verdict::proved) {
        return wrong(fmt::format("certified is 0, but {} proves everything", name));
    }
    return {};
}

} // namespace isostat::checker
