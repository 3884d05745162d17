#pragma once
/// \file
/// LU factors of one matrix, reused for nearby matrices: contacts are exchanged one by one while the grains move.

#include "sparse/pattern.hpp"

#include <memory>
#include <span>
#include <vector>

namespace isostat {

class SolveSchedule;

/// An operator M^-1 close to H^-1, made of the LU factors (KLU) of a base matrix and one rank-one correction for each
/// column exchanged since (product form, as in the simplex method; proofs/exchange.md). Columns that were not exchanged
/// keep the values of the base. *Nothing is proved of its results*: they are guesses whose residuals are then bounded
/// with the true matrix. A value; copies share the factors, and several threads may use them, except copies made by
/// `of_block` or for few solves, which share the memory that solves use.
class ApproximateInverse {
  public:
    /// Factorises `matrix` (square). `symbolic` is the analysis of its pattern
    /// (`Ordering::symbolic`), if known. Cost: 3 ms at N = 3900, 9 ms at N = 9800,
    /// a third of it for the layout of solves, and 2 to 6 ms for the analysis.
    explicit ApproximateInverse(const sparse::Matrix<double>& matrix, std::shared_ptr<void> symbolic = {});

    /// New factors, of a matrix with nearly the same columns in the same slots: the order of the columns is reused, and
    /// with it most of the analysis, until the fill has grown by a fifth. Exchanged columns come last, where they fill
    /// least. Cost: half of that of the constructor; for a few solves these take twice as long, and their layout is
    /// left out.
    enum class Use { many_solves, few_solves };
    [[nodiscard]] ApproximateInverse renewed(const sparse::Matrix<double>& matrix, Use use = Use::many_solves) const;

    /// The operator of a block that moves independently: the square submatrix of the given
    /// rows (degrees of freedom) and columns (contacts), where no other column has an entry in
    /// these rows. Velocities are those of right-hand sides that vanish in the other contacts,
    /// and 0 outside the rows; forces are those of the block alone. Cost: that of the block.
    static ApproximateInverse of_block(const sparse::Matrix<double>& matrix, std::vector<int> rows,
                                       std::vector<int> columns);

    /// The operator after the exchange of column `slot` of H, equal to that of `before` up to motion, for that of
    /// `after`. Cost: one pass, or nothing when `mechanism(slot)` was computed before.
    [[nodiscard]] ApproximateInverse exchanged(int slot, const sparse::Matrix<double>& after) const;

    /// M^-T rhs (velocities with approach velocities rhs) and M^-1
    /// rhs (forces that carry the load rhs), in place: one pass each.
    void velocities(std::span<double> rhs) const;
    void forces(std::span<double> rhs) const;
    /// M^-T e_slot: the velocity with unit approach in one contact. Kept for the next call with the same slot.
    [[nodiscard]] const std::vector<double>& mechanism(int slot) const;

    /// Exchanges since the factorisation.
    [[nodiscard]] int exchanges() const { return static_cast<int>(exchanges_.size()); }
    /// Cost of a pass with the exchanges, in units of a pass without exchanges.
    [[nodiscard]] double relative_cost() const;
    /// Cost of new factors (`renewed`) in the same units, from the operations of the present factors: 18 to 27 at n =
    /// 1936, 46 to 80 at 4900. An estimate that depends on no clock.
    [[nodiscard]] double renewal_cost() const;
    /// False when memory did not suffice: every result is NaN.
    [[nodiscard]] bool valid() const;

  private:
    ApproximateInverse() = default;
    struct Base;
    struct Exchange;
    void make_schedule(std::shared_ptr<Base> base);
    std::shared_ptr<const Base> base_;
    std::vector<std::shared_ptr<const Exchange>> exchanges_;
    std::shared_ptr<const SolveSchedule> schedule_; ///< null for a block
    mutable std::shared_ptr<const std::vector<double>> mechanism_;
    mutable int mechanism_slot_ = -1;
};

} // namespace isostat
