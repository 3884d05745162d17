#pragma once
/// \file
/// Interior-point method for one linear programme of the preparation: some thirty sparse factorisations (22 at n = 10
/// 000), whereas the number of pivots of the simplex method grows with the packing.

#include <atomic>
#include <memory>
#include <vector>

namespace isostat::preparation {

class CliqueMatrix;

/// minimise cost.x subject to A x >= lower, |x_k| <= bound_k.
struct BoxedProgramme {
    std::vector<int> start;    ///< rows of A: entries start[l] ... start[l + 1] - 1
    std::vector<int> column;   ///< at most 4 per row, all different
    std::vector<double> value; ///< of each entry
    std::vector<double> lower; ///< one per row
    std::vector<double> cost;  ///< one per column
    std::vector<double> bound; ///< > 0, one per column
};

/// Which constraints hold with equality at the optimum, as the iteration found them.
struct ActiveSet {
    bool converged = false;          ///< otherwise the other fields have no meaning
    int iterations = 0;              ///< factorisations
    std::vector<unsigned char> row;  ///< 1: A x = lower
    std::vector<signed char> column; ///< -1: x = -bound, 1: x = bound, 0: between
    std::vector<double> x;           ///< the point reached
};

/// Predictor-corrector steps (S. Mehrotra, SIAM J. Optim. 2, 575 (1992)) on the normal equations (CliqueMatrix), each
/// direction centred again where that makes longer steps. Ends when the complementarity products are below `tolerance`
/// (cost unit x length unit) and the constraints hold up to it. A generic programme has one solution, strictly
/// complementary: the active set is then the basis of the simplex method. The result is a proposal, not proved. Cost:
/// O(n^1.5) per iteration for planar contact graphs, O(n log n) memory.
ActiveSet interior_point(const BoxedProgramme& programme, double tolerance, const std::atomic<bool>* stop);

/// Slacks and multipliers of the rows, > 0, kept from step to step while the programme changes.
struct InteriorPoint {
    std::vector<double> slack;
    std::vector<double> force;
};

/// What one step of a descent did.
struct InteriorStep {
    bool done = false;    ///< otherwise nothing was changed and the other fields have no meaning
    double product = 0;   ///< mean slack x force of the rows before the step
    double violation = 0; ///< largest |A x - lower - slack| before the step
    ActiveSet active;     ///< as after the step; x is the displacement
};

/// Steps of the same method for a programme that changes at every
/// step but keeps its pattern. A direction that is blocked (some
/// product is far below the mean, usual after the programme has
/// changed) is replaced by one towards products above the mean.
class InteriorDescent {
  public:
    explicit InteriorDescent(const BoxedProgramme& pattern);
    ~InteriorDescent();
    InteriorDescent(const InteriorDescent&) = delete;
    InteriorDescent& operator=(const InteriorDescent&) = delete;

    /// Takes a step from x = 0 and updates `point`. Cost: a factorisation, some solves.
    InteriorStep step(const BoxedProgramme& programme, InteriorPoint& point);

  private:
    std::unique_ptr<CliqueMatrix> matrix_;
};

} // namespace isostat::preparation
