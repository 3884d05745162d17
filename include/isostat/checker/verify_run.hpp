#pragma once
/// \file
/// Re-checks a finished run from its records alone. Shares with the program that made the run only data and readers of
/// JSON, states and files. What is proved and what is only compared: proofs/checker.md, "Runs".

#include <isostat/core/verdict.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace isostat {

/// What became of the records of a run.
struct RunVerification {
    /// refuted: `wrong` is the first record that does not follow from those before it. undecided: none is wrong as far
    /// as was seen, and `undecided` lists what could not be checked. proved: every equilibrium and both ends of every
    /// arc were proved to be as recorded; in a run of level `arcs` the ways between them too, in others they are only
    /// looked at: see `words`.
    Verdict verdict = Verdict::undecided;
    bool finished = true; ///< false: the run goes on, or was killed; then nothing else is looked at
    std::string wrong;    ///< file, record, what is wrong with it
    std::vector<std::string> undecided;
    int arcs = 0;              ///< records of arcs
    int arcs_proved = 0;       ///< opening proved by the rule, end proved to be an admissible vertex, W proved to fall
    int ways_proved = 0;       ///< arcs whose witness proves that they lead from end to end, past nothing else
    int ties_checked = 0;      ///< first-order terms of decisions found again, of the arcs that were replayed
    int turns_checked = 0;     ///< power turns whose held coordinate was found to be right
    int equilibria = 0;        ///< rows of equilibria.csv
    int equilibria_proved = 0; ///< all forces, gaps, ends of the load interval and the rank proved to be as recorded
};

/// First whether the run is finished and its records undamaged (checkpoint.json, states/last.json, summary.json). Then
/// replays events.jsonl and equilibria.csv from states/eq_000000.json. An arc that cannot be followed (a
/// Newton iteration that goes elsewhere, a record of an older version that does not say where a coordinate is held) is
/// undecided, and the replay goes on at the next stored state
/// (`states_every = 1` stores all). `progress` is called after each record with the number of the equilibrium. Throws
/// `Error(bad_input)` when a file is missing, cannot be read, or has unknown or missing columns. Cost: one certificate
/// check per arc.
RunVerification verify_run(const std::filesystem::path& directory, const std::function<void(int)>& progress = {});

/// The answer in words: "refuted", "undecided", "not finished"; "proved" when the way of every arc is proved too, else
/// "ends proved, way looked at".
std::string words(const RunVerification& run);

} // namespace isostat
