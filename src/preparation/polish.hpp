#pragma once
/// \file
/// From the contacts of a linear programme to a proved vertex, by the last pivots if need be, in which signs have no
/// tolerances; or the reason why the contacts give none.

#include "verified/proved_structure.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace isostat::preparation {

/// Reach of candidates that are no contacts, in smallest radii; T6 allows up to 0.82.
inline constexpr double pivot_reach = 0.5;

/// The vertex and the figures of its proof.
struct Polished {
    State state;
    double max_gap = 0;   ///< largest |gap| of a contact, as computed
    double min_gap = 0;   ///< smallest gap of the other candidates at the true vertex
    double min_force = 0; ///< smallest backbone force
    double sigma_min_bound = 0;
    int rattlers = 0;
};

/// `to_vertex` from `packing`, then coordinates to the grid and the checks promised by `find_vertex`. `state.load` must
/// hold kind, stress and infinitesimal loads; its reference lengths are set to the lengths found.
/// Failures: `not_isostatic`; `not_converged` (Newton stopped early, or a named
/// force is not compressive); `overlap` (of another pair); `tie` (another gap cannot
/// be told from 0); `undecided` (a bound that would prove the rest was not found).
Result<Polished> polish(Packing packing, std::vector<Contact> contacts, Load load, long& iterations);

/// The bounds at the vertex of the contacts nearest to `packing`, which moves there (`to_vertex`) and to the grid.
Result<std::unique_ptr<ProvedStructure>> centre_at_vertex(Packing& packing, const std::vector<Contact>& contacts,
                                                          long& iterations);

struct PivotLimits {
    double step = 0; ///< longest displacement of one exchange, beyond which linear gaps are too inaccurate
    const std::atomic<bool>* stop = nullptr;
};

/// Pivots from a basis that is wrong only below the tolerances of a linear solver (forces and gaps near 1e-9, wrong
/// infinitesimal loads) to the vertex. At the true vertex of the present contacts (Newton, then a correction in
/// double-double, so that gaps and forces far below the rounding of a length have signs): a negative gap is closed
/// (dual simplex: the contact whose force reaches 0 first, lexicographically in (f0, f1), is left); else the most
/// negative force is opened (primal simplex: the gap that closes first is taken). The choices are made in rounded
/// arithmetic and prove nothing; `polish` proves the end, and its failure is the result when it cannot. When this
/// fails, or returns to the same contacts, a second attempt counts quantities that bounds cannot tell from 0 as 0, and
/// replaces nearly dependent contacts by other touching pairs: packings of equal disks need this.
/// When the last basis has computed gaps and forces of the right sign but `polish` cannot prove these in double-double,
/// the state is in `candidate`: another proof may succeed. Failures besides these: `unbounded`, `not_converged`
/// (limits), `interrupted`. Cost: a rank proof, a factorisation and a bound of the inverse per pivot.
Result<Polished> pivot_to_vertex(const Packing& packing, const std::vector<Contact>& contacts, const Load& load,
                                 const PivotLimits& limits, long& iterations, std::optional<State>& candidate);

/// Another list of contacts at a vertex where more pairs touch: as many of the touching pairs as there are degrees of
/// freedom, with rows as independent as an orthogonal factorisation with column pivoting finds them, because a linear
/// solver may keep contacts whose rows are independent only by rounded coordinates: those of equal disks in line.
/// Nothing: too few pairs touch, their rows are dependent up to rounding, or the packing is too large for full
/// matrices. A guess, which later proofs judge. Cost: N_f^3.
std::optional<std::vector<Contact>> best_conditioned(const Packing& packing);

} // namespace isostat::preparation
