#pragma once
/// \file
/// Symmetric matrices that are sums of small blocks, one per contact: Cholesky factors and solves.

#include <cstddef>
#include <memory>
#include <vector>

namespace isostat::preparation {

/// Sum over l of blocks on the columns column[start[l]] ... column[start[l + 1] - 1], plus a diagonal. Pattern and
/// order of little fill are computed once (AMD or nested dissection), numbers and factor on every call. Uses CHOLMOD's
/// simplicial factors: the supernodal ones are faster but call a BLAS, whose bits depend on the processor. One thread.
/// Cost of a factor: O(n^1.5) for planar contact graphs, O(n log n) memory.
class CliqueMatrix {
  public:
    CliqueMatrix(std::size_t columns, const std::vector<int>& start, const std::vector<int>& column);
    ~CliqueMatrix();
    CliqueMatrix(const CliqueMatrix&) = delete;
    CliqueMatrix& operator=(const CliqueMatrix&) = delete;

    /// Entry of block l between positions p and r of `column`: block(l, p, r), for r <= p. False when the matrix is not
    /// positive definite in rounded arithmetic.
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
            value_[static_cast<std::size_t>(first_[k])] += diagonal[k];
        }
        return factorise();
    }

    /// Solves in place. \pre the last `factorise` was true.
    void solve(std::vector<double>& b);

  private:
    struct Factors;
    bool factorise();

    std::vector<int> block_start_;
    std::vector<int> first_, row_;   ///< lower triangle by columns, the diagonal first
    std::vector<std::size_t> place_; ///< of each block entry in `value_`
    std::vector<double> value_;
    std::unique_ptr<Factors> factors_;
};

} // namespace isostat::preparation
