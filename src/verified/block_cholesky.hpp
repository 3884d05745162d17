#pragma once
// Sparse Cholesky factorisation of H H^T - s I in blocks of 2 x 2, one block per pair of successive rows (the two
// coordinates of a disk, or of the walls): private to the room.

#include <isostat/sparse/pattern.hpp>

#include <array>
#include <vector>

namespace isostat {

/// Left-looking, in double, round to nearest. It proves nothing by itself: statement V1 turns its success into a bound.
class BlockCholesky {
  public:
    /// `permutation` is an order of the blocks of little fill; made (AMD) when it does not fit the matrix. \pre the
    /// matrix outlives the object.
    BlockCholesky(const sparse::Matrix<double>& h, std::vector<int>& permutation);

    /// Factorises H H^T - shift I = L L^T; true when every pivot was positive.
    bool factorise(double shift);

    /// E of statement V1 after a successful `factorise(shift)`.
    [[nodiscard]] double error_bound(double shift) const;

  private:
    /// Row-major pairs: element 2 c + r is (row r, column c) of the block.
    using Block = std::array<double, 4>;
    struct Product {
        int row, column; ///< permuted blocks, row > column
        Block value;
    };

    void form_products(const std::vector<int>& position);
    void analyse();

    const sparse::Matrix<double>& h_;
    std::size_t blocks_;
    std::vector<Block> diagonal_;    ///< of H H^T, permuted
    std::vector<Product> products_;  ///< off the diagonal, sorted by column
    std::vector<int> product_start_; ///< by column
    std::vector<int> start_, row_;   ///< L without its diagonal, by columns, rows ascending
    std::vector<Block> value_, pivot_;
    std::vector<int> across_start_, across_; ///< by row: places in `row_` of its entries, columns ascending
    std::vector<int> column_of_;             ///< by place in `row_`
    std::vector<int> position_;              ///< of each block in the permuted order
};

} // namespace isostat
