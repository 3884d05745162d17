#pragma once
/// \file
/// Counts of the work that the program did: the evidence that a scene pays only for what it needs.

#include <isostat/core/result.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace isostat {

/// Kinds of work, in the order of the rooms. Each piece of work is counted when it begins.
enum class Work : std::uint8_t {
    dynamics_steps,     ///< steps of the damped dynamics
    linear_programmes,  ///< linear programmes solved by Clp
    candidate_searches, ///< searches for complete candidates, by triangulation or sweep
    overlap_proofs,     ///< certificates of non-overlap
    rank_proofs,        ///< ranks computed in the prime field
    factorisations,     ///< KLU
    inverse_bounds,     ///< proofs of a bound of the inverse
    double_double,      ///< climbs to double-double
    multiprecision,     ///< climbs to MPFR or to more bits
    exact_solutions,    ///< climbs to exact numbers
    states_written,     ///< state files, checkpoints not counted
    checkpoints,        ///< checkpoint.json replaced
    pictures,           ///< force pictures drawn
    charts,             ///< gnuplot started
    vtk_files           ///< ParaView files
};

/// The words used in records.
inline constexpr auto work_words =
    words_of<Work>("dynamics_steps", "linear_programmes", "candidate_searches", "overlap_proofs", "rank_proofs",
                   "factorisations", "inverse_bounds", "double_double", "multiprecision", "exact_solutions",
                   "states_written", "checkpoints", "pictures", "charts", "vtk_files");
constexpr const char* to_string(Work kind) {
    return word_of(kind, work_words);
}
inline constexpr std::size_t work_kinds = work_words.size();

/// Adds to the counter of this process. Cost: one relaxed atomic addition; no computation reads the counters, so
/// results cannot depend on them.
void count_work(Work kind, long amount = 1);

/// From now on this thread counts in `counts` (null: in the process). Returns the previous place. Used by tasks: work
/// without a waiting caller is not counted, so that counters do not depend on threads.
std::array<long, work_kinds>* count_work_in(std::array<long, work_kinds>* counts);

/// Counts since the start of the process, in the order of `Work`.
std::array<long, work_kinds> work_done();

} // namespace isostat
