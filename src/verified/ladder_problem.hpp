#pragma once
// The input of a ladder of forces, and data that its rungs share: private to the room.

#include "verified/contact_system.hpp"
#include "verified/force_ladder.hpp"

#include <gmpxx.h>

#include <optional>
#include <vector>

namespace isostat {

/// One right-hand side with its solution on every rung reached.
struct RightHandSide {
    std::vector<double> force;
    LoadTerms terms;
    bool zero = false;
    bool rough = false;          ///< `solution` stopped at `first_accuracy`
    std::vector<double> guess;   ///< of the solution, or empty
    ForceSolution solution;      ///< on the rung `solution.rung` with `solution.bits`; empty before the first request
    BoundedVector<Real> refined; ///< rung multiprecision
    std::vector<mpq_class> unknown; ///< rung exact
};

/// The arguments of a ladder and its right-hand sides.
class LadderProblem {
  public:
    LadderProblem(const Packing& p, const IsostaticStructure& s, const Factorisation& f, const InverseBound& bound,
                  const LadderOptions& limits, const VertexEnclosure* v)
        : packing(p), structure(s), factorisation(f), inverse(bound), options(limits), vertex(v) {}

    const Packing& packing;
    const IsostaticStructure& structure;
    const Factorisation& factorisation;
    const InverseBound& inverse;
    LadderOptions options;
    const VertexEnclosure* vertex; ///< null: forces are those of the stored configuration
    std::vector<RightHandSide> parts;

    [[nodiscard]] RightHandSide& part(int number) { return parts[static_cast<std::size_t>(number)]; }
    /// |H(q) - H(q')|_2 per |q - q'|_2 near the true vertex; 0 without one. Fixed at the first call.
    [[nodiscard]] double normal_rate();
    /// Bounds of |q* - q| and of |H* - H| at the stored configuration q;
    /// 0 when forces of q itself are asked for. Fixed at the first call.
    struct Distance {
        double away = 0;
        double uncertainty = 0;
    };
    [[nodiscard]] const Distance& stored_distance();
    /// Solves in double, unless a solution of this accuracy is known. `accuracy`: as in `solve_forces`.
    void solve_in_double(RightHandSide& part, double accuracy) const;
    /// Turns the bound of a solution at the stored configuration into one for the true vertex: |H*^-1| <= 1 / (sigma -
    /// |H* - H|), |H* x - F*| <= |H x - F| + |(H* - H) x| + |F* - F|.
    void inflate(RightHandSide& part);

  private:
    std::optional<double> normal_rate_;
    std::optional<Distance> stored_distance_;
};

/// Rounds a vector of MPFR numbers to value + low, the rounding included in the bound.
void round_to_pairs(const std::vector<Real>& x, const Real& error, ForceSolution& solution);

} // namespace isostat
