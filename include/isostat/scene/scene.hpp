#pragma once
/// \file
/// Scene files (TOML): what to prepare, how to load it, what to write; and carrying out a scene into the folder of a
/// run, which `isostat run` and the Python module share.

#include <isostat/io/run_directory.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// One setting with the value that is used, for `plan` and for the records of a run.
struct Setting {
    std::string section, key;
    std::string value; ///< as TOML
    int line = 0;      ///< in the scene file; 0: the default
};

/// A scene that was checked, with every default filled in.
struct Scene {
    std::string file; ///< name of the scene file
    std::string text; ///< its content

    std::filesystem::path start; ///< [packing] file: a state or vertex text to start from; empty: prepare a packing
    PreparationOptions
        preparation;          ///< [packing], [preparation] and sigma1, kind of [load]; unused when `start` is given
    std::string loaded;       ///< [load] loaded, when given: overrides what a start file says
    std::vector<double> path; ///< [load] direction, or the one that `loaded` stands for: rates of the stresses
    std::optional<LoadKind> load_kind; ///< [load] kind, when given: overrides what a start file says
    std::optional<std::uint64_t>
        infinitesimal_seed; ///< [load] infinitesimal_seed: new infinitesimal loads for a start file

    std::vector<ProgrammeStep> programme;
    RunOptions run;

    int states_every = 0;          ///< [output] states_every: store every k-th equilibrium, 0 = only the needed ones
    double checkpoint_seconds = 1; ///< [output] checkpoint_seconds: shortest time between two checkpoints
    bool pictures = true;          ///< [output] pictures: figures at the end of the run
    bool vtk = false;              ///< [output] vtk: also ParaView files

    std::vector<Setting> settings; ///< every key that applies to this scene, in the order of the sections
};

/// Reads a scene. Throws `Error(bad_input)`: "FILE:LINE: KEY is VALUE: expected WHAT" for a value, unknown keys with
/// the known ones, settings that exclude each other, programmes that contradict themselves (`check_programme`).
/// Relative file names in a scene are relative to the folder of the scene.
Scene read_scene(const std::filesystem::path& path);
/// Reads a scene from text; `source` starts the messages, relative names are relative to `folder`.
Scene parse_scene(const std::string& text, const std::string& source, const std::filesystem::path& folder);

/// Refuses, with `Error(bad_input)`, a programme that no packing can carry out: a segment with
/// no end, a ratio on the wrong side of every possible ratio, `from` an equilibrium that will
/// not exist by then. `ratio`: sigma_2 / sigma_1 of the start, when known. Conditions that
/// depend on the packing (how many equilibria lie below a ratio) are checked during the run.
void check_programme(const Scene& scene, std::optional<double> ratio);

/// "up: 95 equilibria", "down from 10: to sigma2/sigma1 = 1".
std::string describe(const ProgrammeStep& step);

/// Equilibria that a programme starts segments from, so that their states must be stored.
std::vector<int> needed_equilibria(const Scene& scene);

/// The settings as JSON (sections, keys, values): for the records of a run.
std::string settings_json(const Scene& scene);

/// One part of the program and whether a scene uses it.
struct PlanEntry {
    std::string kind; ///< "stage", "solver", "output"
    std::string name;
    bool used = false;
    std::string reason;
};

/// Which stages, solvers and outputs a scene uses and which it leaves out, each with the reason. Computes no mechanics.
std::vector<PlanEntry> make_plan(const Scene& scene);

/// Conditions on a state before a trajectory starts from it, in the words of a user: throws `Error(bad_input)` when
/// contacts and degrees of freedom do not match or the rank is deficient (h or k > 0, with the numbers), when two
/// grains overlap (which, by how much), or when a listed contact is visibly open. The thresholds on lengths (1e-6 of
/// the smallest radius) only choose between a clear message here and a proof later: `run_segment` decides the signs of
/// all gaps with bounds. With h > 0 and k = 0 the message names the contacts of a basis of the self-stresses (double
/// precision; parts below 1e-9 left out). With `hyperstatic_allowed` (ties = "choose") h > 0 is accepted.
void check_start(const State& state, const std::string& source, bool hyperstatic_allowed = false);

/// Makes what [load] loaded or direction names the loaded stress; without these keys the state decides. Throws
/// `Error(bad_input)` where the packing has no such axis or the named period, wall or tilt does not move.
void choose_loaded(State& state, const Scene& scene, const std::string& source);

/// The start of a scene that reads one: overrides of [load], checks in the words of a user (`check_start`,
/// `check_programme`), and then the grid (`snap_to_grid`; `moved_to_grid` in the provenance is the largest change of a
/// coordinate, if there is one). `source` starts messages. Throws `Error(bad_input)`.
State start_of_scene(State state, const Scene& scene, const std::string& source);
/// `start_of_scene` of the file that the scene names. \pre !scene.start.empty()
State start_from_file(const Scene& scene);

/// Provenance of a state that was prepared for a scene, as JSON text.
std::string provenance_of(const Scene& scene, const std::string& program, const std::string& command,
                          const PreparationReport& report);

/// The header of a run of the scene.
RunHeader header_of(const Scene& scene, const std::string& program, const std::string& command);

/// What the user may try after a failure: equal radii tie, and a
/// jitter of a prepared scene makes them different. Empty: no advice.
std::string advice(const Scene& scene, const Failure& failure, const Packing& packing);

/// How a run ended, with its `failure` if any (a programme that cannot begin a step has none).
struct SceneEnding {
    RunStatus status = RunStatus::completed;
    std::string reason;
    std::optional<Failure> failure;
};
/// The ending that a failure makes; `where` begins the reason.
SceneEnding ending_of(const Failure& failure, const std::string& where, int dimension);

/// Plays the programme of the scene from `state`, or from the checkpoint of the folder if there is one, with the
/// certificates of the level. `further` receives every record after the folder. Ends after the arc in which `stop`
/// becomes true. `program` is named in the certificates. The caller has to call `RunDirectory::finish`.
SceneEnding play_scene(const Scene& scene, State state, RunDirectory& directory, const std::string& program,
                       RunCounters& counters, const std::atomic<bool>& stop, RunObserver& further);

} // namespace isostat
