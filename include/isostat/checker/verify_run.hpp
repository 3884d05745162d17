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
    int choices_checked = 0;   ///< of these: choices of the rule, of what is not refuted to be tied
    int turns_checked = 0;     ///< power turns whose held coordinate was found to be right
    int equilibria = 0;        ///< rows of equilibria.csv
    int equilibria_proved = 0; ///< all forces, gaps, ends of the load interval and the rank proved to be as recorded
};

/// How far a verification is.
struct VerificationProgress {
    int equilibrium = 0;        ///< the number of the row that is being replayed, or was
    bool closed = false;        ///< its row was checked; false: an arc towards it was
    int arcs_here = 0;          ///< towards it, so far
    int arcs = 0, all_arcs = 0; ///< gone through, and of the run
    int equilibria = 0, all_equilibria = 0;
    int undecided = 0; ///< remarks so far
};

/// First whether the run is finished and its records undamaged (checkpoint.json, states/last.json, summary.json). Then
/// replays events.jsonl and equilibria.csv from states/eq_000000.json. An arc that cannot be followed (a
/// Newton iteration that goes elsewhere, a record of an older version that does not say where a coordinate is held) is
/// undecided, and the replay goes on at the next stored state
/// (`states_every = 1` stores all). `progress` is called after each arc and each row, by the calling thread. Uses the
/// threads of `set_threads`: the next arcs are followed while the ends of others are proved; the result is the same for
/// any number of them. Throws `Error(bad_input)` when a file is missing, cannot be read, or has unknown or missing
/// columns. Cost: per arc two sparse factorisations, the exact residual of one of them, and some dozens of back
/// substitutions; where a vertex is badly conditioned, a certificate check.
RunVerification verify_run(const std::filesystem::path& directory,
                           const std::function<void(const VerificationProgress&)>& progress = {});

/// The answer in words: "refuted", "undecided", "not finished"; "proved" when the way of every arc is proved too, else
/// "ends proved, way looked at".
std::string words(const RunVerification& run);

} // namespace isostat
