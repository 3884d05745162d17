#pragma once
/// \file
/// Solves with a contact matrix that was proved regular; a structure with its factors.

#include "linear/approximate_inverse.hpp"
#include "rigidity/isostatic.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace isostat {

/// Solutions with H and G = H^T, with the accuracy of sparse LU in double. They
/// are approximate: the caller bounds their error from residuals (room verified).
/// The success flag of a solver never proves a rank; the structure does.
///
/// Fresh factors solve in one pass. Factors reused from an earlier structure (`ApproximateInverse`) are applied
/// repeatedly to the residual with the matrix of *this* structure until the change is below rounding; when this does
/// not converge, this matrix is factorised.
class Factorisation {
  public:
    explicit Factorisation(const IsostaticStructure& structure);
    /// Uses an operator close to the inverse of the structure's matrix.
    Factorisation(const IsostaticStructure& structure, ApproximateInverse inverse);
    /// One flag per degree of freedom: 0 where the motion that opens contact `slot` is a structural zero.
    static std::vector<unsigned char> moving(const IsostaticStructure& structure, int slot);
    /// For the grains that move when contact `slot` opens, when they are few (rattlers): for such motions one pass is a
    /// solve; forces are those of the block. Nothing when more than a quarter of the degrees of freedom move.
    static std::optional<Factorisation> of_moving_block(const IsostaticStructure& structure, int slot);
    /// From factors of exactly this matrix, as `renewed` makes them: one pass is a solve.
    static Factorisation of(const IsostaticStructure& structure, ApproximateInverse factors);
    /// The same factors for another owner, whose passes count there.
    [[nodiscard]] Factorisation shared() const;
    ~Factorisation();
    Factorisation(Factorisation&&) noexcept;
    Factorisation& operator=(Factorisation&&) noexcept;

    /// Solves H f = F in place for `count` right-hand sides stored one after the other (size N_f each).
    void solve_forces(std::span<double> rhs, int count = 1) const;
    /// Solves for one right-hand side from a guess of the solution, to a relative accuracy that is estimated from the
    /// rate of convergence: takes fewer passes with reused factors.
    void solve_forces_from(std::span<double> rhs, std::span<const double> guess, double accuracy) const;
    /// As `solve_forces_from`, ending as soon as `enough` returns true for the present forces and their largest error,
    /// as estimated (infinity without an estimate, as after the first pass). Called after each pass with reused
    /// factors. Returns the estimate; 0 when the forces are converged to rounding.
    double solve_forces_until(std::span<double> rhs, std::span<const double> guess,
                              const std::function<bool(std::span<const double>, double)>& enough) const;
    /// Solves G v = dV in place: velocities with given approach velocities.
    void solve_velocities(std::span<double> rhs, int count = 1) const;

    /// The operator itself: one pass per call, for iterations that compute their own residuals.
    [[nodiscard]] const ApproximateInverse& approximate() const;
    /// Whether it is the LU of exactly this matrix, so that one pass is a solve.
    [[nodiscard]] bool is_fresh() const;
    /// Passes of `approximate()` made by the solves so far.
    [[nodiscard]] int passes() const;

  private:
    Factorisation() = default;
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Neither copied nor moved: whoever makes one keeps it.
struct FactorisedStructure {
    explicit FactorisedStructure(IsostaticStructure s) : structure(std::move(s)), factorisation(structure) {}
    FactorisedStructure(IsostaticStructure s, ApproximateInverse factors)
        : structure(std::move(s)), factorisation(Factorisation::of(structure, std::move(factors))) {}
    FactorisedStructure(const FactorisedStructure&) = delete;
    FactorisedStructure& operator=(const FactorisedStructure&) = delete;
    IsostaticStructure structure;
    Factorisation factorisation;
};

} // namespace isostat
