#pragma once
/// \file
/// A scene carried out into the folder of a run: what `isostat run` and the Python module have in common.

#include <isostat/io/run_directory.hpp>
#include <isostat/scene/scene.hpp>

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// The start of a scene that reads one: overrides of [load], checks in the words of a user (`check_start`,
/// `check_programme`), and then the grid (`snap_to_grid`; the provenance says in `moved_to_grid` by how much it moved a
/// coordinate, when it did). `source` starts messages. Throws `Error(bad_input)`.
State<2> start_of_scene(State<2> state, const Scene& scene, const std::string& source);
/// The same of the file that the scene names. \pre !scene.start.empty()
State<2> start_from_file(const Scene& scene);

/// Provenance of a state that was prepared for a scene, as JSON text.
std::string provenance_of(const Scene& scene, const std::string& program, const std::string& command,
                          const PreparationReport<2>& report);

/// What identifies a run of the scene.
RunHeader header_of(const Scene& scene, const std::string& program, const std::string& command);

/// What may help after a failure: equal radii tie, and a jitter of a prepared scene makes them different. Empty:
/// nothing.
std::string advice(const Scene& scene, const Failure& failure, std::vector<double> radius);

/// How a run ended; `failure` where there is one (a programme that cannot begin a step has none).
struct SceneEnding {
    RunStatus status = RunStatus::completed;
    std::string reason;
    std::optional<Failure> failure;
};
/// The ending that a failure makes; `where` begins the reason.
SceneEnding ending_of(const Failure& failure, const std::string& where);

/// Plays the programme of the scene from `state`, or from the checkpoint of the folder when it has one, with the
/// certificates that the level asks for. `watcher` is told after the folder. Ends after the arc in which `stop` becomes
/// true. `program` is named in the certificates. The caller calls `RunDirectory::finish`.
SceneEnding play_scene(const Scene& scene, State<2> state, RunDirectory& directory, const std::string& program,
                       RunCounters& counters, const std::atomic<bool>& stop, RunObserver<2>& watcher);

} // namespace isostat
