#pragma once
// The triangular solves of KLU's factors, laid out for speed: private to the room.

#include <klu.h>

#include <span>
#include <vector>

namespace isostat {

/// Substitutions x_t <- (x_t - sum_e value_e x_index_e) scale, one after the other, that make a solve with P A Q = L U
/// + F (block triangular). Inside each triangle they are ordered by level of dependence and then by length, so that
/// neighbours do not wait for each other and a branch predictor knows the lengths: half the time of column by column.
class SolveSchedule {
  public:
    /// Cost: about a quarter of the factorisation.
    SolveSchedule(klu_symbolic& symbolic, klu_numeric& numeric);
    /// x <- A^-1 x, and x <- A^-T x.
    void solve(std::span<double> x) const { matrix_.run(x, rows_, columns_); }
    void solve_transposed(std::span<double> x) const { transposed_.run(x, columns_, rows_); }

    /// A sparse matrix by columns or rows.
    struct Lines {
        std::vector<int> start, index;
        std::vector<double> value;
        Lines(int lines, int entries);
        [[nodiscard]] Lines transposed() const;
    };

  private:
    struct Step {
        int target, end;
        double scale;
    };
    struct Program {
        std::vector<Step> steps;
        std::vector<int> index;
        std::vector<double> value;
        void run(std::span<double> rhs, const std::vector<int>& in, const std::vector<int>& out) const;
    };
    /// Block by block the first triangle, which also takes the entries of the blocks before, and the second.
    static Program make(const Lines& first, const Lines& second, const Lines& beside, const std::vector<int>& blocks,
                        bool upwards);
    std::vector<int> rows_, columns_; ///< P and Q
    Program matrix_, transposed_;
};

} // namespace isostat
