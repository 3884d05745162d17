#pragma once
/// \file
/// The last pivots of the sequence of linear programmes, in which signs have no tolerances.

#include "preparation/polish.hpp"

#include <atomic>

namespace isostat::preparation {

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
/// the state is in `candidate`: another proof may succeed. Failures beside those: `unbounded`, `not_converged`
/// (limits), `interrupted`. Cost: a rank proof, a factorisation and a bound of the inverse per pivot.
Result<Polished> pivot_to_vertex(const Packing& packing, const std::vector<Contact>& contacts, const Load& load,
                                 const PivotLimits& limits, long& iterations, std::optional<State>& candidate);

} // namespace isostat::preparation
