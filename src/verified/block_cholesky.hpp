#pragma once
// Sparse Cholesky factorisation of H H^T - s I: private to the room. In double in blocks of 2 x 2, one block per pair
// of rows that follow each other in the order of elimination (the two coordinates of a disk, or of the walls; of
// spheres any two); in double-double by Eigen.

#include "sparse/pattern.hpp"
#include "verified/inverse_bound.hpp"

#include <array>
#include <vector>

namespace isostat {

/// Left-looking, in double, round to nearest. Its success alone proves nothing; statement V1 derives a bound from it.
class BlockCholesky {
  public:
    /// The matrix to factorise, which must outlive its use here. `order` is computed when it does not fit or makes the
    /// work too large. Memory of the previous matrix is reused.
    void set(const sparse::Matrix<double>& h, FillOrder& order);

    /// Factorises H H^T - shift I = L L^T; true when every pivot was positive.
    bool factorise(double shift);

    /// E of statement V1 after a successful `factorise(shift)`.
    [[nodiscard]] double error_bound(double shift) const;

    /// About the number of products of blocks in a factorisation, by which orders are compared.
    [[nodiscard]] double work() const;

  private:
    /// Stored by columns: element 2 c + r is (row r, column c) of the block.
    struct alignas(32) Block {         // exact: alignment
        std::array<double, 4> value{}; // exact: size of a block
    };
    /// The entries of a contact in one block.
    struct Part {
        int place = 0;                 ///< position of the block in the order
        std::array<double, 2> value{}; ///< 0 where no entry is stored
    };
    /// Two blocks with entries of one contact.
    struct Pair {
        Part column, row; ///< column.place < row.place
    };

    struct Arrays;
    [[nodiscard]] std::size_t load_column(const Arrays& at, std::size_t j, double shift) const;
    static void subtract_columns(const Arrays& at, std::size_t begin, std::size_t end);
    void arrange(const std::vector<int>& order);
    void analyse();
    double largest_ratio(const std::vector<double>& relative, double shift, std::vector<double>& x) const;

    const sparse::Matrix<double>* h_ = nullptr;
    std::size_t blocks_ = 0;
    std::vector<int> position_;                 ///< position of each row in the order; two rows make a block
    std::vector<Block> diagonal_;               ///< diagonal blocks of H H^T, in the order
    std::vector<Pair> pairs_;                   ///< by contacts
    std::vector<int> column_start_, by_column_; ///< pairs by column
    std::vector<int> row_start_, by_row_;       ///< columns of the pairs by row
    std::vector<int> start_, row_;              ///< L without its diagonal, by columns, rows ascending
    std::vector<int> across_start_;             ///< by row of L:
    std::vector<int> column_, across_;          ///< columns of its entries, and their places in `row_`
    std::vector<Block> value_, work_;
    // exact: index in a block
    std::vector<std::array<double, 3>> pivot_; ///< diagonal blocks of L: (0, 0), (1, 0), (1, 1)
    std::vector<int> place_, next_, next_row_;
};

/// Factorises H H^T - shift I (Eigen's simplicial Cholesky over libqd's double-double).
/// Returns a proved lower bound of lambda_min(H H^T): shift minus the bound of the backward
/// error (statement V1 with the unit of double-double), or 0 when a pivot was not positive.
/// The entries of `h` are taken as exact. Cost: about 30 times that of the double version.
double shifted_cholesky_double_double(const sparse::Matrix<double>& h, double shift);

} // namespace isostat
