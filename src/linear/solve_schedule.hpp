#pragma once
// The solves with KLU's factors, laid out for speed: private to the room.

#include "core/parallel.hpp"
#include "linear/triangle.hpp"

#include <klu.h>

#include <memory>
#include <span>
#include <vector>

namespace isostat {

/// Solves with P A Q = L U + F (block upper triangular, F above the blocks). Blocks of few unknowns, of which rattlers
/// make many, are one with the block that comes after them: their rows of L^-1 F are rows of its U.
class SolveSchedule {
  public:
    /// Takes the place of the factors, which are as large: none are left. Cost: half to two thirds of the
    /// factorisation; two threads share it.
    SolveSchedule(klu_symbolic& symbolic, klu_numeric*& numeric);
    /// A^-1 rhs, and A^-T rhs, in place. Zeros that follow from the pattern stay exact.
    void solve(std::span<double> rhs) const;
    void solve_transposed(std::span<double> rhs) const;

  private:
    /// An entry of F.
    struct Beside {
        int row, column;
        double value;
    };
    struct Parts;
    explicit SolveSchedule(const std::shared_ptr<const Parts>& parts);
    /// The other triangle meanwhile.
    SolveSchedule(const Parts& parts, Future<Triangle> lower);

    std::vector<int> rows_, columns_; ///< P and Q
    Triangle upper_, lower_;
    std::vector<Beside> beside_;
    std::vector<std::size_t> beside_start_; ///< by block of the row
};

} // namespace isostat
