#pragma once
// What a ladder of forces was asked, and what its rungs share: private to the room.

#include "verified/refinement.hpp"

#include <isostat/verified/force_ladder.hpp>

#include <gmpxx.h>

#include <optional>
#include <vector>

namespace isostat {

/// One right-hand side with what is known of its solution on every rung reached.
struct RightHandSide {
    std::vector<double> force;
    LoadTerms terms;
    bool zero = false;
    bool rough = false;        ///< `solution` stopped at `first_accuracy`
    std::vector<double> guess; ///< of the solution, or empty
    ForceSolution solution;    ///< on the rung `solution.rung` with `solution.bits`; empty before the first request
    RefinedVector refined;     ///< rung multiprecision
    std::vector<mpq_class> unknown; ///< rung exact
};

/// Of the configuration at which a rung evaluates the normals: distance from the stored one, bound of |H* - H| there,
/// and distance of the stored from the true one. All 0 when the stored configuration is meant.
struct Place {
    double shift = 0;
    double uncertainty = 0;
    double away = 0;
};

/// The arguments of a ladder and its right-hand sides.
template <int Dim> class LadderProblem {
  public:
    LadderProblem(const Packing<Dim>& p, const IsostaticStructure<Dim>& s, const Factorisation& f,
                  const InverseBound& bound, const LadderOptions& limits, const VertexEnclosure* v)
        : packing(p), structure(s), factorisation(f), inverse(bound), options(limits), vertex(v) {}

    const Packing<Dim>& packing;
    const IsostaticStructure<Dim>& structure;
    const Factorisation& factorisation;
    const InverseBound& inverse;
    LadderOptions options;
    const VertexEnclosure* vertex; ///< null: the stored configuration is meant
    std::vector<RightHandSide> parts;

    [[nodiscard]] RightHandSide& part(int number) { return parts[static_cast<std::size_t>(number)]; }
    /// |H(q) - H(q')|_2 per |q - q'|_2 near the true vertex; 0 without one. As it is at the first request.
    [[nodiscard]] double normal_rate();
    /// Of the stored configuration. As it is at the first request.
    [[nodiscard]] const Place& stored_place();
    /// Solves in double, unless a solution of at least this accuracy is there. `accuracy`: as in `solve_forces`.
    void solve_in_double(RightHandSide& part, double accuracy) const;
    /// Goes on from there with residuals in double-double, unless a solution of at least this kind is there.
    void solve_in_double_double(RightHandSide& part, const ExtendedMatrix& matrix) const;
    /// The bound of a solution at the place of a rung becomes one for the true vertex: |H*^-1| <= 1 / (sigma - |H* -
    /// H|), |H* x - F*| <= |H x - F| + |(H* - H) x| + |F* - F|. `stored`: the place is the stored configuration.
    void inflate(RightHandSide& part, const Place& here, bool stored);

  private:
    std::optional<double> normal_rate_;
    std::optional<Place> stored_place_;
};

/// Rounds a vector of MPFR numbers to value + low, the rounding included in the bound.
void round_to_pairs(const std::vector<Real>& x, const Real& error, ForceSolution& solution);

extern template class LadderProblem<2>;

} // namespace isostat
