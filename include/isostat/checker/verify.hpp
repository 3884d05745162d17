#pragma once
/// \file
/// An independent checker of certificates and of runs, from their files alone. It shares with the program that made
/// them only the data (states, contacts, claims) and the readers of the files: no matrix, bound, solver or list of
/// neighbours. Mathematics, what is proved and what is only compared: proofs/checker.md (K1 to K26; "Runs").

#include <isostat/core/verdict.hpp>
#include <isostat/io/state_file.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// The answer to one claim.
/// - `proved`: the checker's own rigorous enclosure implies the claim;
/// - `refuted`: it contradicts the claim;
/// - `undecided`: neither; `detail` says what is missing. Nothing is known of the claim then.
struct ClaimCheck {
    std::string claim{};  ///< name of the field of `CertificateClaims`
    bool claimed = false; ///< false: the certificate does not claim it (`undecided`)
    Verdict verdict = Verdict::undecided;
    std::string detail{};                                  ///< one line: what was proved, or why not
    std::vector<std::pair<std::string, double>> numbers{}; ///< the numbers behind it: proved bounds, rounded outwards
};

/// The answers to all claims, in the order of `CertificateClaims`, `stable` last.
struct Verification {
    std::vector<ClaimCheck> checks;
    /// Refuted when a claim is; else undecided when a claim is undecided or absent; else proved: then the state has a
    /// true vertex nearby that is an isostatic equilibrium without overlap and a strict local minimum. Where `minimum`
    /// is claimed absent claims do not count: an equilibrium as `MinimumClaim` says, which is not isostatic.
    Verdict verdict = Verdict::undecided;
};

/// How the inverse is bounded. All of them prove; they differ in reach and cost.
enum class CheckerArithmetic {
    automatic,      ///< the first of the others that is good enough for the claim about the vertex
    singular_value, ///< a sparse Cholesky factor, its residual in 64-bit integers: condition numbers up to about 1e7
    rows,           ///< row by row of an approximate inverse: the first of the following that succeeds
    fixed64, ///< rows of 64-bit integers, products in 128 bits: coordinates on a common grid of at most 2^60 steps
    gmp,     ///< rows of GMP integers, refined: any coordinates, condition numbers up to about 1e14
    rational ///< exact inverse: at most `largest_exact_matrix` contacts, any regular matrix
};

/// Largest number of rows and columns for which the checker eliminates exactly.
inline constexpr int largest_exact_matrix = 100;

/// Checks every claim from the state and the claims alone. Does not throw on false claims. Coordinates, radii and loads
/// are the stored doubles, taken as exact rationals. Supported: all that `State` can hold, except held coordinates:
/// then every claim is undecided. Cost: some sparse factorisations, of which nothing is trusted, and as many integer
/// products as one of them takes; where that does not suffice N solves and 4 N^2 integer products. Memory: the factors.
Verification verify(const Certificate& certificate, CheckerArithmetic arithmetic = CheckerArithmetic::automatic);

/// The first thing in which two states differ, bit for bit, in words; empty: they are the same problem. Numbers of
/// equilibria, provenance and recorded results (first-order terms) do not count.
std::string state_difference(const State& a, const State& b);

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
    std::vector<std::string> notes; ///< files in the folder that belong to no record: they were not looked at
    int arcs = 0;                   ///< records of arcs
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
/// columns or words. Cost: per arc two sparse factorisations, the exact residual of one of them, and some dozens of
/// back substitutions; where a vertex is badly conditioned, a certificate check.
RunVerification verify_run(const std::filesystem::path& directory,
                           const std::function<void(const VerificationProgress&)>& progress = {});

/// The answer in words: "refuted", "undecided", "not finished"; "proved" when the way of every arc is proved too, else
/// "ends proved, way looked at".
std::string words(const RunVerification& run);

} // namespace isostat
