#include "ensemble/ensemble.hpp"

#include "core/refuse.hpp"
#include "io/equilibria.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "report/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace isostat {

namespace fs = std::filesystem;
using json::Field;
using json::Json;

namespace {

/// Calls `use` for each complete line of a table after its header.
template <class Use> void for_each_row(const std::string& text, const Use& use) {
    for (std::size_t begin = 0, end = text.find('\n'); end != std::string::npos;
         begin = end + 1, end = text.find('\n', begin)) {
        const std::string_view line(text.data() + begin, end - begin);
        if (!line.empty() && line.front() != '#') {
            use(line);
        }
    }
}

/// The header of a run's table with the seed in front and without the last column, the time.
std::string with_seeds(const std::string& header) {
    return "# seed," + header.substr(2, header.rfind(',') - 2) + "\n";
}

void append_equilibria(std::string& table, std::uint64_t seed, const std::string& text) {
    for_each_row(
        text, [&](std::string_view line) { table += fmt::format("{},{}\n", seed, line.substr(0, line.rfind(','))); });
}

void append_increments(std::string& table, std::uint64_t seed, const std::vector<EquilibriumRow>& rows) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (const RearrangementRow& one : rearrangements(rows)) {
        table += fmt::format("{},{},{},{},{},{},{},{}\n", seed, one.segment, one.number, one.direction, one.ratio,
                             one.arcs, one.stress_increment.value_or(none), one.strain_increment.value_or(none));
    }
}

} // namespace

EnsembleDirectory::EnsembleDirectory(fs::path directory, EnsembleHeader header, Mode mode)
    : samples_(std::move(directory), std::move(header)) {
    const EnsembleHeader& asked = samples_.header();
    (void)samples_.scene(0);
    (void)samples_.scene(static_cast<std::size_t>(asked.samples) - 1);
    taken_ = take_folder(samples_.path(), ensemble_folder, mode);
    if (taken_.begun && mode == Mode::resume) {
        check_resumed();
    }
    write_header("running", {});
}

EnsembleDirectory::~EnsembleDirectory() = default;

void EnsembleDirectory::check_resumed() const {
    const fs::path file = samples_.path() / ensemble_folder.mark;
    const Json parsed = Field::parse(read_text(file), file.string());
    const Field old(parsed, file.string());
    const EnsembleHeader& asked = samples_.header();
    if (old.at("scene").string() != asked.scene_text) {
        refuse(file.string(), "the ensemble is of another scene ({}): expected the text of {}",
               old.at("scene_file").string(), asked.scene.string());
    }
    if (old.at("first_seed").string() != std::to_string(asked.first_seed)) {
        refuse(file.string(), "the ensemble starts at seed {}: expected {}", old.at("first_seed").string(),
               asked.first_seed);
    }
    if (old.at("program").string() != asked.program) {
        refuse(file.string(), "the ensemble was made by {}: expected {}, the same bits are not promised otherwise",
               old.at("program").string(), asked.program);
    }
}

void EnsembleDirectory::write_header(const std::string& status, const std::vector<Sample>& samples) const {
    const EnsembleHeader& header = samples_.header();
    Json object;
    object["format"] = "isostat-ensemble";
    object["version"] = 1;
    object["program"] = header.program;
    object["command"] = header.command;
    object["status"] = status;
    object["scene_file"] = header.scene.string();
    object["scene"] = header.scene_text;
    object["first_seed"] = std::to_string(header.first_seed); // text: 64 bits exceed some readers' numbers
    object["samples"] = header.samples;
    if (!samples.empty()) {
        Json counts = Json::object();
        Json reasons = Json::array();
        for (const Sample& sample : samples) {
            const char* word = to_string(sample.status);
            counts[word] = counts.value(word, 0) + 1;
            if (sample.status != SampleStatus::completed) {
                reasons.push_back({{"seed", sample.seed}, {"status", word}, {"reason", sample.reason}});
            }
        }
        object["counts"] = counts;
        object["not_completed"] = reasons;
    }
    write_atomically(samples_.path() / ensemble_folder.mark, json::dumped(object, 2) + "\n");
}

std::vector<Sample> EnsembleDirectory::merge() const {
    std::string equilibria;
    std::string increments = "# seed,segment,number,direction,ratio,arcs,stress_increment,strain_increment\n";
    std::string table = "# seed,status,equilibria,proved,arcs,seconds\n";
    std::vector<Sample> samples;
    for (std::size_t number = 0; number < static_cast<std::size_t>(samples_.header().samples); ++number) {
        const Sample& one = samples.emplace_back(samples_.sample(number));
        table += fmt::format("{},{},{},{},{},{}\n", one.seed, static_cast<int>(one.status), one.equilibria, one.proved,
                             one.arcs, one.seconds);
        if (one.equilibria > 0) {
            const fs::path file = samples_.folder(number) / "equilibria.csv";
            const std::string text = read_text(file);
            if (equilibria.empty()) { // all samples have the same columns
                equilibria = with_seeds(text.substr(0, text.find('\n')));
            }
            append_equilibria(equilibria, one.seed, text);
            append_increments(increments, one.seed, read_equilibria(file));
        }
    }
    const fs::path& path = samples_.path();
    write_atomically(path / "equilibria.csv", equilibria.empty() ? with_seeds(equilibria_header()) : equilibria);
    write_atomically(path / "increments.csv", increments);
    write_atomically(path / "samples.csv", table);
    const bool all = std::ranges::all_of(samples, [](const Sample& s) { return s.finished(); });
    write_header(all ? "completed" : "interrupted", samples);
    return samples;
}

} // namespace isostat
