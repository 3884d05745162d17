#pragma once
/// \file
/// Symmetric matrices that are sums of small blocks, one per contact: Cholesky factors and solves.

#include <cstddef>
#include <vector>

namespace isostat::preparation {

/// Sum over l of blocks on the columns column[start[l]] ... column[start[l + 1] - 1], plus a diagonal. Pattern, order
/// of little fill and groups of columns with the same rows once (CHOLMOD: AMD or nested dissection), numbers and factor
/// as often as asked. The numbers are our own (multifrontal): CHOLMOD's fast ones are those of a BLAS, whose bits
/// depend on the processor; these do not, nor on the number of threads. Cost of a factor: O(n^1.5) for planar contact
/// graphs, O(n log n) memory.
class CliqueMatrix {
  public:
    CliqueMatrix(std::size_t columns, const std::vector<int>& start, const std::vector<int>& column);

    /// Entry of block l between the places p and r of `column` : block(l, p, r), for r <= p. False when the matrix is
    /// not positive definite as far as rounded numbers say.
    template <class Block> bool factorise(const Block& block, const std::vector<double>& diagonal) {
        value_.assign(value_.size(), 0.0);
        std::size_t next = 0;
        for (std::size_t l = 0; l + 1 < block_start_.size(); ++l) {
            const auto begin = static_cast<std::size_t>(block_start_[l]);
            const auto end = static_cast<std::size_t>(block_start_[l + 1]);
            for (std::size_t p = begin; p < end; ++p) {
                for (std::size_t r = begin; r <= p; ++r) {
                    value_[place_[next++]] += block(l, p, r);
                }
            }
        }
        for (std::size_t k = 0; k < diagonal.size(); ++k) {
            value_[diagonal_place_[k]] += diagonal[k];
        }
        return factorise();
    }

    /// Solves in place. \pre the last `factorise` was true.
    void solve(std::vector<double>& b);

  private:
    /// Columns that are eliminated together.
    struct Front {
        std::size_t first = 0, columns = 0; ///< in the order
        std::size_t row = 0, rows = 0;      ///< of `row_`: its own columns, then the rows below
        std::size_t value = 0;              ///< of `value_`: rows x columns
        int parent = -1;
        std::vector<int> children; ///< ascending
    };
    /// Fronts [first, last) that need no others.
    struct Subtree {
        std::size_t first, last;
    };
    void analyse(std::size_t columns, const std::vector<int>& column);
    void share_out();
    bool factorise();
    bool eliminate(std::size_t front);
    [[nodiscard]] std::size_t place_of(std::size_t row, std::size_t column) const;

    std::vector<int> block_start_;
    std::vector<std::size_t> place_, diagonal_place_; ///< of each block entry, of each diagonal entry, in `value_`
    std::vector<int> order_, position_;               ///< column in each place, place of each column
    std::vector<Front> fronts_;                       ///< children first
    std::vector<int> front_of_;                       ///< of each place
    std::vector<int> row_;
    std::vector<std::size_t> in_parent_; ///< of each row below a front: its place among the rows of the parent
    std::vector<Subtree> subtrees_;
    std::vector<unsigned char> above_;        ///< fronts that are in no subtree
    std::vector<double> value_;               ///< L
    std::vector<std::vector<double>> update_; ///< what each front leaves to its parent, until it is taken
    std::vector<double> x_, left_;            ///< of a solve: in the order; of each front, laid out as `row_`
};

} // namespace isostat::preparation
