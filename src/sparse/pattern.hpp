#pragma once
/// \file
/// Compressed-column matrices and what follows from their pattern alone: matching, block triangular form, reachability,
/// orders of little fill.

#include <memory>
#include <span>
#include <vector>

struct klu_common_struct; // declared in klu.h

namespace isostat::sparse {

/// Compressed columns, row indices sorted in each column. `Value` is double or a residue.
template <class Value> struct Matrix {
    int rows = 0;
    int cols = 0;
    std::vector<int> start;   ///< size cols + 1
    std::vector<int> row;     ///< one per entry
    std::vector<Value> value; ///< one per entry
    [[nodiscard]] int entries() const { return start.empty() ? 0 : start.back(); }
};

/// Symbolic analysis of a square pattern: block upper triangular form with
/// a zero-free diagonal, fill-reducing order inside the blocks (KLU: BTF +
/// `choose_order`). Uses no values, so it may precede the rank check.
class Ordering {
  public:
    /// \pre square, rows sorted and not repeated in each column. `structurally_regular()`
    /// says whether a perfect matching exists; if not, orders and blocks are empty.
    /// Throws std::bad_alloc. Cost: 2 ms for 4000 contacts, 6 ms for 10 000.
    template <class Value>
    explicit Ordering(const Matrix<Value>& matrix) : Ordering(matrix.rows, matrix.start, matrix.row) {}
    Ordering(int n, std::span<const int> start, std::span<const int> row);

    [[nodiscard]] bool structurally_regular() const { return structural_rank_ == n_; }
    [[nodiscard]] int structural_rank() const { return structural_rank_; }
    /// Position k of the permuted matrix holds row `row_order()[k]`, column
    /// `column_order()[k]`; these two are matched.
    [[nodiscard]] const std::vector<int>& row_order() const { return row_order_; }
    [[nodiscard]] const std::vector<int>& column_order() const { return column_order_; }
    /// Block b is the range [block_start()[b], block_start()[b+1]) of positions.
    [[nodiscard]] const std::vector<int>& block_start() const { return block_start_; }
    /// The analysis itself (a klu_symbolic), so that the factorisation of the same pattern need not repeat it.
    [[nodiscard]] const std::shared_ptr<void>& symbolic() const { return symbolic_; }

  private:
    int n_ = 0;
    int structural_rank_ = 0;
    std::vector<int> row_order_, column_order_, block_start_;
    std::shared_ptr<void> symbolic_;
};

/// Which unknowns of A x = b can be non-zero for *some* values with this pattern: search from the rows where b may be
/// non-zero, through the matching. Unknown c is 0 => x_c = 0 exactly, for the stored values (when A is regular) and for
/// every other values with which A is regular; 1 => x_c != 0 for generic values, which implies nothing for the stored
/// values. The result does not depend on the matching. \pre structurally regular. Statement T11
/// (proofs/structural_zeros.md). Cost O(entries).
std::vector<unsigned char> structural_nonzeros(std::span<const int> start, std::span<const int> row,
                                               const Ordering& ordering, std::span<const int> loaded_rows);

/// Uses the matching alone (`matched[r]` = column matched to row r): a fifth of the cost of an `Ordering`. `reached`:
/// the result for some of the rows, if known; then only what the other rows reach in addition is searched.
std::vector<unsigned char> structural_nonzeros(std::span<const int> start, std::span<const int> row,
                                               std::span<const int> matched, std::span<const int> loaded_rows,
                                               std::vector<unsigned char> reached = {});

/// A perfect matching of rows to columns of a square pattern (BTF): column of each row. Empty when there is none
/// (the matrix is then singular for all values), and when n = 0.
std::vector<int> perfect_matching(int n, std::span<const int> start, std::span<const int> row);

/// A perfect matching after one column changed: `matched` is one of the previous pattern, `start` and `row` are the new
/// pattern. Empty when there is none. Cost: one augmenting path, mostly a few columns long.
std::vector<int> repaired_matching(std::vector<int> matched, std::span<const int> start, std::span<const int> row,
                                   int column);

/// Whether nested dissection is worth its cost: for contact matrices of spheres with this many rows and more, where
/// METIS costs less than it saves. (Without it 1.4 times the operations at 750 rows, 2.3 times at 3000.) Matrices of
/// disks have at most four entries in nearly all columns, and so little fill that AMD's order is as good.
[[nodiscard]] constexpr bool worth_dissection(int rows, int entries) {
    return rows >= 1000 && entries / 5 > rows;
}

/// Makes KLU analyse with nested dissection of A + A^T where this is worth its cost; else with AMD on the same pattern,
/// which fills least for some thousands of contacts, above 20 000 rows with COLAMD (AMD against COLAMD: at 40 000
/// rows 1.7 against 1.2 million entries of L + U, and twice the time; at 10 000 rows 205 000 against 235 000), and from
/// 200 000 rows on with `dissection_of_columns` (against COLAMD 0.75 and 0.69 of the operations at 205 000 and 819
/// 000).
void choose_order(klu_common_struct& common, int rows, int entries);

/// Nested dissection of A A^T, A by columns without repeated rows: `order[k]` is row k of the permuted matrix. Throws
/// std::bad_alloc. The same on every run: METIS draws from the random numbers of the C library, one call at a time.
[[nodiscard]] std::vector<int> dissection_of_products(int rows, std::span<const int> start, std::span<const int> row);

/// The same of the columns that share a row, A^T A; rows of very many entries, as those of a cell, are left out.
[[nodiscard]] std::vector<int> dissection_of_columns(int rows, std::span<const int> start, std::span<const int> row);

} // namespace isostat::sparse
