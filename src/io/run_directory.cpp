#include "core/refuse.hpp"
#include "core/work.hpp"
#include "io/descriptor.hpp"
#include "io/equilibria.hpp"
#include "io/files.hpp"
#include "io/folders.hpp"
#include "io/json.hpp"
#include "io/record_digests.hpp"
#include "io/record_text.hpp"

#include <isostat/core/result.hpp>
#include <isostat/io/run_directory.hpp>
#include <isostat/io/state_file.hpp>

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace isostat {

namespace {

using json::Field;
using json::Json;
namespace fs = std::filesystem;

std::string header_text(const RunHeader& header, const std::string& status) {
    Json object;
    object["format"] = "isostat-run";
    object["version"] = 1;
    object["program"] = header.program;
    object["command"] = header.command;
    object["status"] = status;
    object["scene_file"] = header.scene_name;
    object["scene"] = header.scene_text;
    object["programme"] = header.programme;
    object["settings"] = Json::parse(header.settings);
    return json::dumped(object, 2) + "\n";
}

/// What is known of the way between the equilibria.
std::string steering(const RunCounters& counters) {
    const ArcTally& arcs = counters.arcs;
    if (arcs.certified + arcs.undecided == 0) {
        return "ends of arcs proved, way between them looked at";
    }
    return arcs.undecided == 0
               ? "ends of arcs proved, way between them proved"
               : fmt::format("ends of arcs proved, way between them proved but for {} arcs", arcs.undecided);
}

} // namespace

const char* to_string(RunStatus status) {
    static constexpr auto words = words_of<RunStatus>("completed", "failed", "undecided", "interrupted");
    return word_of(status, words);
}

struct RunDirectory::Files {
    /// A file that grows, and the digest of all in it.
    struct Records {
        const char* name;
        Descriptor file;
        std::string digest;
        void write(const std::string& line) {
            file.write(line);
            digest = chained(digest, line);
        }
    };
    TakenFolder folder;
    Records events{"events.jsonl", {}, {}}, equilibria{"equilibria.csv", {}, {}}, witnesses{witness_records, {}, {}};
    std::vector<Records*> used{&events, &equilibria}; ///< and the witnesses at level `arcs`
};

RunDirectory::RunDirectory(fs::path directory, RunHeader header, Mode mode, const RunCounters& counters)
    : directory_(std::move(directory)), header_(std::move(header)), counters_(counters), resumed_(mode == Mode::resume),
      files_(std::make_unique<Files>()) {
    files_->folder = take_folder(directory_, run_folder, mode);
    if (mode == Mode::resume) {
        open_for_resume();
        const FolderContent& before = files_->folder.before;
        remove_files(directory_, before.leftovers);
        fs::remove(directory_ / "preparation_failed.json");
        notes_ = notes_on(before, run_folder);
    }
    make_directory(directory_ / "states");
    fs::remove(directory_ / "summary.json"); // of the interrupted run: it must not look like that of this one
    write_header("running");
    const int flags = O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | (checkpoint_ ? 0 : O_TRUNC);
    if (header_.witnesses) {
        make_directory(directory_ / "certificates");
        files_->used.push_back(&files_->witnesses);
    }
    for (Files::Records* records : files_->used) {
        records->file = Descriptor::open(directory_ / records->name, flags);
    }
    Json provenance;
    provenance["program"] = header_.program;
    provenance["command"] = header_.command;
    provenance["scene_file"] = header_.scene_name;
    provenance["settings"] = Json::parse(header_.settings);
    provenance_ = json::dumped(provenance);
}

RunDirectory::~RunDirectory() = default;

void RunDirectory::open_for_resume() {
    if (!files_->folder.begun) { // killed before it wrote anything
        previous_status_ = "killed before it began";
        resumed_ = false;
        return;
    }
    const fs::path run = directory_ / run_folder.mark;
    const Json parsed = Field::parse(read_text(run), run.string());
    const Field old(parsed, run.string());
    previous_status_ = old.at("status").string();
    if (old.at("scene").string() != header_.scene_text) {
        refuse(run.string(), "the run is of another scene ({}): expected the text of {}", old.at("scene_file").string(),
               header_.scene_name);
    }
    if (old.at("program").string() != header_.program) {
        refuse(run.string(), "the run was made by {}: expected {}, the same bits are not promised otherwise",
               old.at("program").string(), header_.program);
    }
    header_.command = old.at("command").string(); // states tell how the run was started
    read_checkpoint();
}

/// Everything is checked before anything is cut.
void RunDirectory::read_checkpoint() {
    const std::optional<CheckedRecords> checked = check_records(directory_);
    if (!checked) {
        return;
    }
    const std::string path = (directory_ / "checkpoint.json").string();
    const Field file(checked->checkpoint, path);
    Checkpoint& point = checkpoint_.emplace();
    const auto segments = static_cast<int>(header_.programme.size());
    point.segment = file.at("segment").integer(0, std::max(0, segments - 1));
    point.made = file.at("made").integer(0, std::numeric_limits<int>::max());
    point.segment_done = file.at("segment_done").boolean();
    point.counters = counters_from(file.at("counters"));
    StateFile state = parse_any_state(file.at("state").value().dump(), path, Dimensions::any_clumps);
    point.state = state.state;
    const bool tilts = point.state.packing.cell.shears();
    last_strain_ =
        file.at("strain").numbers(record_columns(point.state.load, tilts).measures.size(), "a strain for each axis");
    segment_ = point.segment;
    last_ = std::move(state.state);
    last_forces_ = std::move(state.forces);
    digests_ = checked->files;
    const fs::path equilibria = directory_ / "equilibria.csv";
    columns_ = named_columns(read_text(equilibria), equilibria.string());
    std::vector<std::pair<Descriptor, long>> cut;
    for (const auto& [name, lines] : checked->lines) {
        cut.emplace_back(Descriptor::open(directory_ / name, O_WRONLY | O_NOFOLLOW), lines.bytes);
        for (Files::Records* records : {&files_->events, &files_->equilibria, &files_->witnesses}) {
            records->digest = name == records->name ? lines.digest : records->digest;
        }
    }
    for (auto& [records, bytes] : cut) {
        records.truncate(bytes);
    }
}

std::optional<State> RunDirectory::start() const {
    const fs::path path = directory_ / "start.json";
    if (!resumed_ || !fs::exists(path)) {
        return std::nullopt;
    }
    return read_any_state(path, Dimensions::any_clumps).state;
}

void RunDirectory::keep_digest(const std::string& name) {
    digests_[name] = sha256(read_text(directory_ / name));
}

void RunDirectory::store_start(const State& state) {
    write_state(directory_ / "start.json", state);
    keep_digest("start.json");
    name_columns(columns_of(state));
}

MoreColumns RunDirectory::columns_of(const State& state) const {
    return {state.packing.cell.shears(), header_.touching, state.packing.dimension, state.load.loaded_axis,
            state.load.path.has_value()};
}

State RunDirectory::stored(int equilibrium) const {
    return read_any_state(directory_ / state_name(equilibrium), Dimensions::any_clumps).state;
}

void RunDirectory::begin_segment(int number, const Segment& goal, int made, int from) {
    segment_ = number;
    goal_ = goal;
    made_ = made;
    previous_ = from;
}

void RunDirectory::on_arc(const ArcRecord& arc) {
    files_->events.write(event_line(arc, record_columns(columns_)));
    if (header_.witnesses) {
        files_->witnesses.write(witness_line(arc));
    }
}

void RunDirectory::name_columns(MoreColumns more) {
    if (files_->equilibria.digest.empty()) {
        columns_ = more;
        files_->equilibria.write(equilibria_header(more));
    }
}

void RunDirectory::on_equilibrium(const EquilibriumRecord& record, const State& state,
                                  const std::vector<double>& forces) {
    const bool first = record.number == 0;
    MoreColumns columns = columns_of(state);
    columns.touching = record.touching.has_value();
    name_columns(columns);
    files_->equilibria.write(equilibrium_row(record, state, first ? -1 : previous_, columns_));
    previous_ = record.number;
    made_ += first ? 0 : 1;
    last_ = state;
    last_.provenance = provenance_;
    last_forces_ = forces;
    last_record_ = record;
    last_strain_ = record.strain;
    const bool every = header_.states_every > 0 && record.number % header_.states_every == 0;
    const bool kept = std::ranges::find(header_.keep, record.number) != header_.keep.end();
    if (first || every || kept || segment_done()) {
        const std::string name = state_name(record.number);
        write_state(directory_ / name, last_, last_forces_);
        keep_digest(name);
    }
    if (first) {
        return; // the start is made again from start.json: run_segment reports number 0 itself
    }
    pending_ = Point{segment_, made_, segment_done(), counters_, {}};
    for (const Files::Records* records : files_->used) {
        pending_->records.emplace_back(records->name, records->file.size(), records->digest);
    }
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> interval(header_.checkpoint_seconds);
    if (pending_->segment_done || !last_checkpoint_ || now - *last_checkpoint_ >= interval) {
        write_checkpoint();
        last_checkpoint_ = now;
    }
}

bool RunDirectory::segment_done() const {
    const bool reached = goal_.to_stress && last_record_.stress == *goal_.to_stress;
    return reached || (goal_.equilibria && made_ >= *goal_.equilibria);
}

void RunDirectory::write_checkpoint() {
    if (!pending_) {
        return;
    }
    count_work(Work::checkpoints);
    sync();
    Json object;
    object["format"] = "isostat-checkpoint";
    object["version"] = 1;
    object["segment"] = pending_->segment;
    object["made"] = pending_->made;
    object["strain"] = last_strain_;
    object["segment_done"] = pending_->segment_done;
    object["counters"] = counters_json(pending_->counters);
    for (const char* what : {"bytes", "digests"}) {
        for (const auto& [name, bytes, digest] : pending_->records) {
            object[what][name] = what == std::string_view("bytes") ? Json(bytes) : Json(digest);
        }
    }
    object["files"] = digests_;
    std::string text = json::dumped(object);
    text.pop_back();
    text += before_state + state_text(last_, last_forces_);
    write_atomically(directory_ / "checkpoint.json", text + before_digest + '"' + sha256(text) + "\"}\n");
    pending_.reset();
}

void RunDirectory::sync() {
    for (Files::Records* records : files_->used) {
        records->file.sync();
    }
}

void RunDirectory::finish(RunStatus status, const std::string& reason) {
    const std::string words = reason.empty() ? to_string(status) : fmt::format("{}: {}", to_string(status), reason);
    name_columns({}); // of a run without a start
    write_checkpoint();
    if (!last_.packing.radius.empty()) {
        write_state(directory_ / last_state, last_, last_forces_);
    }
    Json object;
    object["format"] = "isostat-summary";
    object["version"] = 1;
    object["program"] = header_.program;
    object["status"] = to_string(status);
    object["reason"] = reason;
    object["directory"] = directory_.string();
    object["segments"] = header_.programme.size();
    object["segment"] = segment_;
    object["last_equilibrium"] = last_.equilibrium;
    object["steering"] = steering(counters_);
    object["counters"] = counters_json(counters_);
    if (!last_.packing.radius.empty()) {
        object["disks"] = last_.packing.disk_count();
        object["ratio"] = json::or_null(last_.load.ratio());
        for (const auto& [strain, length, axis] : record_columns(last_.load, false).measures) {
            object[strain] = json::or_null(last_strain_[axis]);
        }
        object["solid_fraction"] = json::or_null(last_.packing.solid_fraction());
    }
    summary_ = json::dumped(object, 2) + "\n";
    sync();
    write_atomically(directory_ / "summary.json", summary_);
    write_header(words);
}

void RunDirectory::write_header(const std::string& status) const {
    write_atomically(directory_ / "run.json", header_text(header_, status));
}

} // namespace isostat
