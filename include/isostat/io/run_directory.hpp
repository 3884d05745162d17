#pragma once
/// \file
/// The folder of a run: at every instant it holds all records up to the last one, complete.

#include <isostat/core/result.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace isostat {

/// What identifies a run: written at its start, compared on resume.
struct RunHeader {
    std::string program;                ///< name and version
    std::string command;                ///< command line
    std::string scene_name;             ///< file name of the scene
    std::string scene_text;             ///< its whole text: a resumed run must have the same
    std::string settings = "{}";        ///< JSON object: every setting with its value, including defaults
    std::vector<std::string> programme; ///< one line of text per segment
    std::vector<int> keep;              ///< equilibria that later segments start from: their states are stored
    double checkpoint_seconds = 1;      ///< shortest time between two checkpoints; 0: one after every equilibrium
    bool witnesses = false;             ///< level `arcs`: certificates/arcs.jsonl is written
    bool touching = false;              ///< rows have the column `touching`: see `MoreColumns`
    int states_every = 0;               ///< also store every k-th equilibrium; 0: only the needed states
};

/// Where an interrupted run goes on.
struct Checkpoint {
    State state;               ///< the last equilibrium
    int segment = 0;           ///< number of the segment it belongs to
    int made = 0;              ///< equilibria made in that segment
    bool segment_done = false; ///< that equilibrium completed the segment
    RunCounters counters;
};

/// How a run ended.
enum class RunStatus { completed, failed, undecided, interrupted };

/// The word used in files and messages.
const char* to_string(RunStatus status);

/// Columns that only some runs have, and their names.
struct MoreColumns {
    bool tilt = false;     ///< a cell whose tilts move: `eps3` to `L3_bound`; in space `eps_xy`, `xy` for each tilt
    bool touching = false; ///< ties are settled at first order: number of pairs that touch without being contacts
    int dimension = 2;
    int loaded_axis = 1; ///< in space the loaded axis names columns: `sigma3`, `shear_xy`
    bool path = false;   ///< a path in the space of stresses: `t`, `p` and `q`
};

/// How a folder is taken for output.
enum class FolderMode {
    fresh, ///< the folder does not exist or is empty, else `Error(usage)`
    force, ///< also one of the same kind: files with the fixed names of such a folder are removed first
    resume ///< goes on; `Error(bad_input)` when the folder holds nothing of this kind
};
inline constexpr auto folder_mode_words = words_of<FolderMode>("fresh", "force", "resume");

/// Receives the records of a run and writes them immediately. Files (all of them JSON except equilibria.csv):
/// - run.json: what was asked, by which program, and the status ("running" until `finish`);
/// - events.jsonl: one object per arc, handed to the system line by line;
/// - certificates/arcs.jsonl: at level `arcs`, for each certified arc what a checker needs (`witness_line`);
/// - equilibria.csv: one row per equilibrium, a header line that starts with '#': numpy.loadtxt(delimiter=",") and
///   numpy.genfromtxt(delimiter=",", names=True) read it (columns: `equilibria_columns`);
/// - states/eq_000012.json: the first equilibrium, those that later segments
///   start from, every k-th; states/last.json: the last equilibrium;
/// - checkpoint.json: replaced (atomically, after the records have reached
///   the disk) at an equilibrium when the last checkpoint is
///   `checkpoint_seconds` old, at the end of every segment and by `finish`;
/// - summary.json: written by `finish` only.
/// After a kill at any instant, `resume` cuts events and equilibria back to the checkpoint, and the run goes on from
/// there. The checkpoint holds digests (SHA-256) of itself, of the records before it and of the stored states: a resume
/// that finds one changed byte, or a missing record, throws `Error(bad_input)` naming the file and changes nothing.
/// Every failure to write throws `Error(cannot_write)`, also out of the observer's calls.
class RunDirectory final : public RunObserver {
  public:
    using Mode = FolderMode; ///< resume: also `Error(bad_input)` for the run of another scene or program version
    /// Makes the folder if needed and locks it: `Error(cannot_write)` when another
    /// program holds the lock. `counters` must outlive this object: it reads them
    /// after every equilibrium (on resume the caller sets them from the checkpoint).
    RunDirectory(std::filesystem::path directory, RunHeader header, Mode mode, const RunCounters& counters);
    ~RunDirectory() override;
    RunDirectory(const RunDirectory&) = delete;
    RunDirectory& operator=(const RunDirectory&) = delete;

    /// Where to go on: empty in a fresh run, or when the interrupted one had not reached its first equilibrium.
    [[nodiscard]] const std::optional<Checkpoint>& checkpoint() const { return checkpoint_; }
    /// Status of the interrupted run: "completed", "failed: ..."; "running" when it was killed; empty in a fresh run.
    [[nodiscard]] const std::string& previous_status() const { return previous_status_; }
    /// The state that the interrupted run started from (start.json); empty in a fresh run.
    [[nodiscard]] std::optional<State> start() const;
    void store_start(const State& state);
    /// What a resumed run found in its folder and no run writes, in words.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
    /// The stored state of an equilibrium. Throws `Error(bad_input)` when it was not stored.
    [[nodiscard]] State stored(int equilibrium) const;

    /// Before each `run_segment`: number and goal of the segment, equilibria already made in it (after a resume) and
    /// the equilibrium that it starts from.
    void begin_segment(int number, const Segment& goal, int made, int from);
    void on_segment(int number, const Segment& goal, int made, const State& from) override {
        begin_segment(number, goal, made, from.equilibrium);
    }
    void on_arc(const ArcRecord& arc) override;
    void on_equilibrium(const EquilibriumRecord& record, const State& state,
                        const std::vector<double>& forces) override;
    /// Ends the run: status with its reason, states/last.json, summary.json. No record may follow.
    void finish(RunStatus status, const std::string& reason);

    /// The text of summary.json. \pre `finish` was called.
    [[nodiscard]] const std::string& summary() const { return summary_; }
    [[nodiscard]] const std::filesystem::path& path() const { return directory_; }

  private:
    struct Files;
    void write_header(const std::string& status) const;
    /// Writes the first line of equilibria.csv, once: later rows have the same columns, in a resumed run too.
    void name_columns(MoreColumns more);
    /// Writes a checkpoint of the last equilibrium, unless that was done.
    void write_checkpoint();
    void sync();
    void keep_digest(const std::string& name);
    /// Whether the last equilibrium completed its segment.
    [[nodiscard]] bool segment_done() const;
    void open_for_resume();
    void read_checkpoint();
    std::filesystem::path directory_;
    RunHeader header_;
    const RunCounters& counters_;
    bool resumed_ = false;
    std::unique_ptr<Files> files_;
    std::optional<Checkpoint> checkpoint_;
    std::string previous_status_, provenance_, summary_;
    std::vector<std::string> notes_;
    /// What a checkpoint of the last equilibrium holds besides the state.
    struct Point {
        int segment = 0;
        int made = 0;
        bool segment_done = false;
        RunCounters counters;
        std::vector<std::tuple<const char*, long, std::string>> records; ///< name, bytes, digest: see `chained`
    };
    std::optional<Point> pending_; ///< empty: checkpoint.json is up to date
    std::optional<std::chrono::steady_clock::time_point> last_checkpoint_;
    MoreColumns columns_; ///< the columns of equilibria.csv
    /// The columns of a run that starts from that state.
    [[nodiscard]] MoreColumns columns_of(const State& state) const;
    Segment goal_;
    int segment_ = 0;
    int made_ = 0;
    int previous_ = 0;                           ///< the equilibrium before the next one on the path
    std::map<std::string, std::string> digests_; ///< SHA-256 of the other files that a resume reads
    State last_;
    std::vector<double> last_forces_;
    EquilibriumRecord last_record_;
    std::vector<double> last_strain_; ///< kept after a resume too, which may end without a new equilibrium
};

/// Names of the columns of equilibria.csv, in order. Contacts are two columns, i and j: disks from 0; j = -1 left, -2
/// bottom, -3 right, -4 top, -5 back, -6 front wall; -9 no contact. `decided_by`: 0 combinatorial, 1 double, 2
/// double-double, 3 mpfr, 4 exact. `proved`: 1 or 0; `certified`: 1 the certificate proves every claim, 0 it does not,
/// -1 no certificate was asked for. An unbounded interval ends at inf or -inf. `x_bound`: bound of the error of `x` at
/// the true vertex, rounding included. `previous` is the equilibrium before this one on its path (-1: the start). In
/// the plane `sigma2`, `eps2`, `L2` belong to the loaded axis or tilt and `eps1`, `L1` to the other axis; in space
/// names go by axis: `record_columns`.
std::vector<std::string> equilibria_columns(MoreColumns more = {});

/// One row of equilibria.csv.
struct EquilibriumRow {
    int number = 0, previous = -1, segment = 0;
    double stress = 0, ratio = 0, solid_fraction = 0;
    double strain1 = 0, strain2 = 0; ///< of the other axis, and of what is loaded
    std::vector<double> length;      ///< in space, by axis
    int arcs = 0, rattlers = 0, backbone = 0, hyperstaticity = 0;
    double stress_low = 0, stress_high = 0, min_force = 0, min_gap = 0, margin = 0;
    bool proved = false;
};

/// Reads equilibria.csv of a run. Throws `Error(bad_input)` with file and line.
std::vector<EquilibriumRow> read_equilibria(const std::filesystem::path& path);

} // namespace isostat
