#pragma once
/// \file
/// Solves with a contact matrix that was proved regular.

#include "linear/approximate_inverse.hpp"
#include "rigidity/isostatic.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>

namespace isostat {

/// Solutions with H and G = H^T, as good as sparse LU in double makes them. They are approximate: their error is
/// bounded by whoever uses them, from residuals (room verified). A solver's own success flag is never a statement about
/// rank; the structure is.
///
/// Fresh factors solve in one pass. Factors taken over from an earlier structure (`ApproximateInverse`) are applied
/// again and again to the residual with the matrix of *this* structure until the change is below rounding; when that
/// does not converge, this matrix is factorised after all.
class Factorisation {
  public:
    explicit Factorisation(const IsostaticStructure& structure);
    /// With an operator close to the inverse of the structure's matrix.
    Factorisation(const IsostaticStructure& structure, ApproximateInverse inverse);
    /// Of the grains that move when contact `slot` opens, when these are few (rattlers): for such motions one pass is a
    /// solve; forces are those of the block. Nothing when more than a quarter of the degrees of freedom move.
    static std::optional<Factorisation> of_moving_block(const IsostaticStructure& structure, int slot);
    ~Factorisation();
    Factorisation(Factorisation&&) noexcept;
    Factorisation& operator=(Factorisation&&) noexcept;

    /// Solves H f = F in place for `count` right-hand sides stored one after the other (size N_f each).
    void solve_forces(std::span<double> rhs, int count = 1) const;
    /// The same for one right-hand side, from a guess of the solution, and to a relative accuracy that is estimated
    /// from the rate of convergence: fewer passes with factors taken over.
    void solve_forces_from(std::span<double> rhs, std::span<const double> guess, double accuracy) const;
    /// The same, ending as soon as `enough` says so of the forces so far and their largest error, as estimated
    /// (infinity where it is not, as after the first pass). Asked after each pass with factors taken over. Returns the
    /// estimate; 0 when the forces are as accurate as they get.
    double solve_forces_until(std::span<double> rhs, std::span<const double> guess,
                              const std::function<bool(std::span<const double>, double)>& enough) const;
    /// Solves G v = dV in place: velocities with given approach velocities.
    void solve_velocities(std::span<double> rhs, int count = 1) const;

    /// The operator inside: one pass, for iterations that compute their own residuals.
    [[nodiscard]] const ApproximateInverse& approximate() const;
    /// Whether it is the LU of this very matrix, so that one pass is a solve.
    [[nodiscard]] bool is_fresh() const;
    /// Passes of `approximate()` made by the solves so far.
    [[nodiscard]] int passes() const;

  private:
    Factorisation() = default;
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace isostat
