#include "checker/run_folder.hpp"

#include "io/files.hpp"
#include "io/json.hpp"
#include "io/record_digests.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/core/error.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

namespace isostat::checker {

namespace {

namespace fs = std::filesystem;
using json::Field;

Objections wrong(std::string text) {
    return Objection{true, std::move(text)};
}

/// The records are those of the last checkpoint, but for arcs that led to no equilibrium when the run ended early.
Objections check_digests(const fs::path& directory, const RunRecords& records) {
    const std::optional<CheckedRecords> checked = check_records(directory);
    if (!checked) {
        return records.equilibria.size() > 1 ? wrong("checkpoint.json is missing, with the digests of the records")
                                             : Objections();
    }
    for (const char* name : {"events.jsonl", "equilibria.csv", witness_records}) {
        const bool may_be_longer = records.status != "completed" && std::string_view(name) != "equilibria.csv";
        const auto found = checked->lines.find(name);
        if (name == witness_records && found == checked->lines.end() && !fs::exists(directory / name)) {
            continue; // then no way is proved
        }
        if (found == checked->lines.end()) {
            return wrong(fmt::format("checkpoint.json: no digest of {}", name));
        }
        const auto size = static_cast<long>(fs::file_size(directory / name));
        if (size != found->second.bytes && !may_be_longer) {
            return wrong(fmt::format("{}: {} bytes: expected {}, the length at the last checkpoint", name, size,
                                     found->second.bytes));
        }
    }
    const State<2> last = read_any_state<2>(directory / "states" / "last.json").state;
    const std::string difference = state_difference(last, parse_any_state<2>(checked->state, "checkpoint.json").state);
    return difference.empty() ? Objections()
                              : wrong(fmt::format("states/last.json: {} is not that of checkpoint.json", difference));
}

Objections check_summary(const fs::path& directory, const RunRecords& records) {
    const fs::path path = directory / "summary.json";
    const json::Json parsed = Field::parse(read_text(path), path.string());
    const Field summary(parsed, path.string());
    if (summary.at("status").string() != records.status) {
        return wrong(fmt::format("summary.json: the status is {}, and {} in run.json", summary.at("status").string(),
                                 records.status));
    }
    const auto count = [&](const char* name, long said, long found) {
        return said == found ? Objections()
                             : wrong(fmt::format("summary.json: {} {}, but the records have {}", said, name, found));
    };
    const Field counters = summary.at("counters");
    if (Objections other = count("arcs", counters.at("arcs").integer(), static_cast<long>(records.events.size()));
        other && records.status == "completed") {
        return other;
    }
    return count("is the last equilibrium", summary.at("last_equilibrium").integer(),
                 std::max(0L, static_cast<long>(records.equilibria.size()) - 1));
}

} // namespace

bool is_running(const fs::path& directory) {
    const fs::path path = directory / "run.json";
    const json::Json parsed = Field::parse(read_text(path), path.string());
    return Field(parsed, path.string()).at("status").string() == "running";
}

Objections check_folder(const fs::path& directory, const RunRecords& records) {
    try {
        if (Objections damage = check_digests(directory, records)) {
            return damage;
        }
        return check_summary(directory, records);
    } catch (const Error& error) {
        return wrong(error.what());
    }
}

Objections check_certificate(const RunRecords& records, const Place& place, const EquilibriumLine& line) {
    const std::string name = fmt::format("certificates/eq_{:06}.json", line.integer("number"));
    const bool claims_all = line.integer("certified") == 1;
    try {
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
            return wrong(fmt::format("certified is {}, but {} proves everything", line.at("certified"), name));
        }
    } catch (const Error& error) {
        return wrong(error.what());
    }
    return {};
}

} // namespace isostat::checker
