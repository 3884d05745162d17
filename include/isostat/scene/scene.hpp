#pragma once
/// \file
/// Scene files (TOML): what to prepare, how to load it, what to write.

#include <isostat/preparation/preparation.hpp>
#include <isostat/trajectory/programme.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// One setting as it is used: for `plan` and for the records of a run.
struct Setting {
    std::string section, key;
    std::string value; ///< as TOML
    int line = 0;      ///< in the scene file; 0: the default
};

/// A scene: checked, complete, every default filled in.
struct Scene {
    std::string file; ///< name of the scene file
    std::string text; ///< its content

    std::filesystem::path start; ///< [packing] file: a state or vertex text to start from; empty: prepare
    PreparationOptions
        preparation; ///< [packing], [preparation] and sigma1, kind of [load]; unused when `start` is given
    std::optional<LoadKind> load_kind; ///< [load] kind, when given: overrides that of a start file
    std::optional<std::uint64_t>
        infinitesimal_seed; ///< [load] infinitesimal_seed: new infinitesimal loads for a start file

    std::vector<ProgrammeStep> programme;
    RunOptions run;

    int states_every = 0;          ///< [output] states_every: store every k-th equilibrium, 0 = only those needed
    double checkpoint_seconds = 1; ///< [output] checkpoint_seconds: shortest time between two checkpoints
    bool pictures = true;          ///< [output] pictures: figures at the end of the run
    bool vtk = false;              ///< [output] vtk: also ParaView files

    std::vector<Setting> settings; ///< every key that this scene uses, in the order of the sections
};

/// Reads a scene. Throws `Error(bad_input)`: "FILE:LINE: KEY is VALUE: expected WHAT" for a value, unknown keys with
/// those known, settings that exclude each other, programmes that contradict themselves (`check_programme`). Relative
/// file names in a scene are relative to its folder.
Scene read_scene(const std::filesystem::path& path);
/// The same from text; `source` starts the messages, `folder` is that of relative names.
Scene parse_scene(const std::string& text, const std::string& source, const std::filesystem::path& folder);

/// Refuses, with `Error(bad_input)`, a programme that cannot be carried out whatever the packing does: a segment with
/// no end, a ratio on the wrong side of every ratio possible there, `from` an equilibrium that will not exist by then.
/// `ratio`: sigma_2 / sigma_1 of the start, when known. What depends on the packing (how many equilibria lie below a
/// ratio) is found during the run.
void check_programme(const Scene& scene, std::optional<double> ratio);

/// "up: 95 equilibria", "down from 10: to sigma2/sigma1 = 1".
std::string describe(const ProgrammeStep& step);

/// Equilibria that a programme starts segments from: their states must be kept.
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

/// Which stages, solvers and outputs a scene uses and which it leaves out, each with the reason. Nothing is computed.
std::vector<PlanEntry> make_plan(const Scene& scene);

} // namespace isostat
