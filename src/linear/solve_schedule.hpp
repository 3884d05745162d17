#pragma once
// The solves with KLU's factors, laid out for speed: private to the room.

#include "core/parallel.hpp"
#include "linear/triangle.hpp"

#include <klu.h>

#include <memory>
#include <span>
#include <vector>

namespace isostat {

/// Solves with P A Q = L U + F (block upper triangular, F above the blocks). Blocks of few unknowns, which rattlers
/// make in number, are merged with the block after them: their rows of L^-1 F are rows of its U.
class SolveSchedule {
  public:
    /// Consumes the factors, whose memory it replaces. Cost: half
    /// to two thirds of the factorisation, shared by two threads.
    SolveSchedule(klu_symbolic& symbolic, klu_numeric*& numeric);
    /// A^-1 rhs, and A^-T rhs, in place. Zeros that follow from the pattern stay exact.
    void solve(std::span<double> rhs) const;
    void solve_transposed(std::span<double> rhs) const;

  private:
    /// An entry of F.
    struct OffDiagonal {
        int row, column;
        double value;
    };
    struct Parts;
    explicit SolveSchedule(const std::shared_ptr<const Parts>& parts);
    /// Takes the other triangle from another thread.
    SolveSchedule(const Parts& parts, Future<Triangle> lower);

    std::vector<int> rows_, columns_; ///< P and Q
    Triangle upper_, lower_;
    std::vector<OffDiagonal> off_diagonal_;
    std::vector<std::size_t> off_diagonal_start_; ///< first entry of each block of rows
};

} // namespace isostat
