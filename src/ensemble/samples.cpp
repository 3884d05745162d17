#include "ensemble/ensemble.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "scene/seed.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

namespace isostat {

namespace fs = std::filesystem;
using json::Field;
using json::Json;

namespace {

constexpr auto status_words =
    words_of<SampleStatus>("completed", "failed", "undecided", "interrupted", "crashed", "refused", "missing");

/// Reads "failed: the reason" of a run.json.
void read_status(Sample& sample, const std::string& words) {
    const std::size_t colon = words.find(": ");
    const std::string word = words.substr(0, colon);
    sample.reason = colon == std::string::npos ? "" : words.substr(colon + 2);
    sample.status = value_of(word, status_words).value_or(SampleStatus::crashed);
    if (word == "running") {
        sample.status = SampleStatus::interrupted;
        sample.reason = "the program ended without saying how";
    }
}

} // namespace

const char* to_string(SampleStatus status) {
    return word_of(status, status_words);
}

SampleFolders::SampleFolders(fs::path directory, EnsembleHeader header)
    : directory_(std::move(directory)), header_(std::move(header)) {}

fs::path SampleFolders::folder(std::size_t number) const {
    return directory_ / "samples" / fmt::format("seed_{:06}", seed(number));
}

std::string SampleFolders::scene(std::size_t number) const {
    return with_seed(header_.scene_text, seed(number), header_.scene.string(), header_.scene.parent_path());
}

Sample SampleFolders::sample(std::size_t number) const {
    Sample sample;
    sample.seed = seed(number);
    try {
        read(sample, number);
    } catch (const Error& error) { // a file was damaged, which affects only this sample
        sample.status = SampleStatus::refused;
        sample.reason = error.what();
    }
    return sample;
}

void SampleFolders::read(Sample& sample, std::size_t number) const {
    const fs::path at = folder(number);
    if (fs::exists(at / "run.json")) {
        const Json parsed = Field::parse(read_text(at / "run.json"), (at / "run.json").string());
        const Field run(parsed, (at / "run.json").string());
        if (run.at("scene").string() != scene(number) || run.at("program").string() != header_.program) {
            sample.status = SampleStatus::refused;
            sample.reason = fmt::format("{}: the run is of another scene or program version", at.string());
            return;
        }
        read_status(sample, run.at("status").string());
    }
    if (!sample.finished() && fs::exists(at / "sample.json")) {
        const Json parsed = Field::parse(read_text(at / "sample.json"), (at / "sample.json").string());
        read_status(sample, Field(parsed, (at / "sample.json").string()).at("status").string());
    }
    if (fs::exists(at / "summary.json")) {
        const Json parsed = Field::parse(read_text(at / "summary.json"), (at / "summary.json").string());
        sample.seconds = Field(parsed, (at / "summary.json").string()).at("counters").at("seconds").number();
    }
    if (fs::is_regular_file(at / "equilibria.csv") && fs::file_size(at / "equilibria.csv") > 0) {
        for (const EquilibriumRow& row : read_equilibria(at / "equilibria.csv")) {
            ++sample.equilibria;
            sample.proved += row.proved ? 1 : 0;
            sample.arcs += row.arcs;
        }
    }
}

bool SampleFolders::prepare(std::size_t number) const {
    const fs::path at = folder(number);
    make_directory(at);
    const std::string text = scene(number);
    if (!fs::exists(at / "scene.toml") || read_text(at / "scene.toml") != text) {
        write_atomically(at / "scene.toml", text);
    }
    fs::remove(at / "sample.json");
    return fs::exists(at / "run.json");
}

void SampleFolders::note(std::size_t number, SampleStatus status, const std::string& reason) const {
    Json object;
    object["status"] = fmt::format("{}: {}", to_string(status), reason);
    write_atomically(folder(number) / "sample.json", json::dumped(object) + "\n");
}

} // namespace isostat
