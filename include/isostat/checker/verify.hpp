#pragma once
/// \file
/// An independent checker of certificates and of runs, from their files alone. It shares with the program that made
/// them only the data (states, contacts, claims) and the readers of the files: no matrix, bound, solver or list of
/// neighbours. Mathematics, what is proved and what is only compared: proofs/checker.md (K1 to K30; "Runs").

#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// The answer about one claim.
/// - `proved`: the checker's own rigorous enclosure implies the claim;
/// - `refuted`: this enclosure contradicts the claim;
/// - `undecided`: neither; `detail` says what is missing. Nothing is known of the claim then.
struct ClaimCheck {
    std::string claim{};  ///< name of the field of `CertificateClaims`
    bool claimed = false; ///< false: the certificate does not make this claim (`undecided`)
    Verdict verdict = Verdict::undecided;
    std::string detail{};                                  ///< one line: what was proved, or why not
    std::vector<std::pair<std::string, double>> numbers{}; ///< numbers behind `detail`: proved bounds, rounded outwards
};

/// The answers about all claims, in the order of `CertificateClaims`, `stable` last.
struct Verification {
    std::vector<ClaimCheck> checks;
    /// Refuted when a claim is; else undecided when a claim is undecided or absent; else proved: the state has a true
    /// vertex nearby that is an isostatic equilibrium without overlap and a strict local minimum. With a claimed
    /// `minimum` absent claims do not count: an equilibrium as in `MinimumClaim`, not isostatic.
    Verdict verdict = Verdict::undecided;
};

/// How the inverse is bounded. Every arithmetic proves; they differ in reach and cost.
enum class CheckerArithmetic {
    automatic,      ///< the first of the following that is accurate enough for the claim about the vertex
    singular_value, ///< a sparse Cholesky factor, its residual in 64-bit integers: condition numbers up to about 1e7
    rows,           ///< row by row of an approximate inverse: the first of the following that succeeds
    fixed64, ///< rows of 64-bit integers, products in 128 bits: coordinates on a common grid of at most 2^60 steps
    gmp,     ///< rows of GMP integers, refined: any coordinates, condition numbers up to about 1e14
    rational ///< exact inverse: at most `largest_exact_matrix` contacts, any regular matrix
};

/// Largest number of rows and columns for which the checker eliminates exactly.
inline constexpr int largest_exact_matrix = 100; // cost: larger matrices are not eliminated exactly (checker.md K3)

/// Checks every claim from the state and the claims alone. Does not throw on false claims. Coordinates, radii and loads
/// are the stored doubles, taken as exact rationals. All that `State` can hold is supported, except held coordinates:
/// then every claim is undecided. Cost: some sparse factorisations (nothing of them is trusted) and as many integer
/// products as one takes; where these do not suffice N solves and 4 N^2 integer products. Memory: the factors.
Verification verify(const Certificate& certificate, CheckerArithmetic arithmetic = CheckerArithmetic::automatic);

/// The first difference between two states, bit for bit, in words; empty: the states are the same problem. Numbers of
/// equilibria, provenance and recorded results (first-order terms) are not compared.
std::string state_difference(const State& a, const State& b);

/// The result of checking the records of a run.
struct RunVerification {
    /// refuted: `wrong` is the first record that does not follow from the records before. undecided: no record was
    /// found wrong, and `undecided` lists what could not be checked. proved: every equilibrium and both ends of every
    /// arc were proved to be as recorded; at level `arcs` the motion between them too; at other levels the motion is
    /// only followed in double: see `words`.
    Verdict verdict = Verdict::undecided;
    bool finished = true; ///< false: the run goes on, or was killed; then nothing else is checked
    std::string wrong;    ///< file, record, and its defect
    std::vector<std::string> undecided;
    std::vector<std::string> notes; ///< files in the folder that belong to no record and were not checked
    int arcs = 0;                   ///< records of arcs
    int arcs_proved = 0;       ///< opening proved by the rule, end proved to be an admissible vertex, W proved to fall
    int ways_proved = 0;       ///< arcs whose witness proves a motion from end to end without another contact
    int ties_checked = 0;      ///< recomputed first-order terms of decisions, on the replayed arcs
    int choices_checked = 0;   ///< of these: choices by the rule between quantities that are not refuted to be tied
    int turns_checked = 0;     ///< power turns whose recorded held coordinate was confirmed
    int equilibria = 0;        ///< rows of equilibria.csv
    int equilibria_proved = 0; ///< all forces, gaps, ends of the load interval and the rank proved to be as recorded
};

/// How far a verification has come.
struct VerificationProgress {
    int equilibrium = 0;        ///< number of the row that is being replayed, or of the last one
    bool closed = false;        ///< its row was checked; false: an arc that leads to it was
    int arcs_here = 0;          ///< arcs checked so far that lead to it
    int arcs = 0, all_arcs = 0; ///< arcs checked so far, and all arcs of the run
    int equilibria = 0, all_equilibria = 0;
    int undecided = 0; ///< remarks so far
};

/// First checks that the run is finished and its records undamaged (checkpoint.json, states/last.json, summary.json).
/// Then replays events.jsonl and equilibria.csv from states/eq_000000.json. An arc that cannot be followed (a Newton
/// iteration that goes elsewhere, a record of an older version that does not say where a coordinate is held) is
/// undecided, and the replay goes on at the next stored state (`states_every = 1` stores all). `progress` is called
/// after each arc and each row, by the calling thread. Uses the threads of `set_threads`: the next arcs are followed
/// while the ends of others are proved; the result is the same for any number of threads. Throws `Error(bad_input)`
/// when a file is missing, cannot be read, or has unknown or missing columns or words. Cost: per arc two sparse
/// factorisations, the exact residual of one of them, and some dozens of back substitutions; where a vertex is badly
/// conditioned, a certificate check.
RunVerification verify_run(const std::filesystem::path& directory,
                           const std::function<void(const VerificationProgress&)>& progress = {});

/// The answer in words: "refuted", "undecided", "not finished"; "proved" when the way of every arc is proved too, else
/// "ends proved, way looked at".
std::string words(const RunVerification& run);

} // namespace isostat
