// Matrices as large and as full as those of many spheres: nested dissection orders them.
#include "exact/rank.hpp"
#include "oracle/matrices.hpp"
#include "sparse/fill_order.hpp"
#include "support/test.hpp"

#include <future>

using namespace isostat;
using namespace isostat::oracle;

namespace {

/// Column k has the rows k and k +- 1, side, side^2 (those that exist), any values; every `copied`-th is its
/// predecessor again.
sparse::Matrix<std::uint64_t> cube(int side, int copied) {
    Random random(5);
    const int n = side * side * side;
    sparse::Matrix<std::uint64_t> matrix{n, n, {0}, {}, {}};
    for (int k = 0; k < n; ++k) {
        const bool copy = copied > 0 && k % copied == copied - 1;
        const auto before = static_cast<std::size_t>(k == 0 ? 0 : matrix.start[static_cast<std::size_t>(k) - 1]);
        const std::size_t end = matrix.row.size();
        for (std::size_t e = before; copy && e < end; ++e) {
            matrix.row.push_back(matrix.row[e]);
            matrix.value.push_back(matrix.value[e]);
        }
        for (const int step : {-side * side, -side, -1, 0, 1, side, side * side}) {
            if (!copy && k + step >= 0 && k + step < n) {
                matrix.row.push_back(k + step);
                matrix.value.push_back(1 + random.bits() % (exact::mersenne61 - 1));
            }
        }
        matrix.start.push_back(static_cast<int>(matrix.row.size()));
    }
    return matrix;
}

/// Entries of the Cholesky factor of that symmetric pattern, its rows in this order: of column k those of the matrix
/// and of the columns whose first row below the diagonal is k.
std::size_t fill(const sparse::Matrix<std::uint64_t>& matrix, const std::vector<int>& order) {
    std::vector<int> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
    }
    std::vector<std::set<int>> below(order.size());
    std::size_t entries = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const auto column = static_cast<std::size_t>(order[k]);
        for (int e = matrix.start[column]; e < matrix.start[column + 1]; ++e) {
            const int row = place[static_cast<std::size_t>(matrix.row[static_cast<std::size_t>(e)])];
            if (row > static_cast<int>(k)) {
                below[k].insert(row);
            }
        }
        if (!below[k].empty()) {
            const auto parent = static_cast<std::size_t>(*below[k].begin());
            below[parent].insert(std::next(below[k].begin()), below[k].end());
        }
        entries += below[k].size();
    }
    return entries;
}

} // namespace

BOOST_AUTO_TEST_CASE(nested_dissection_fills_less_than_half_of_the_order_by_planes) {
    const sparse::Matrix<std::uint64_t> matrix = cube(12, 0);
    std::vector<int> by_planes(static_cast<std::size_t>(matrix.rows));
    std::iota(by_planes.begin(), by_planes.end(), 0);
    const sparse::Ordering ordering(matrix);
    const std::size_t less = fill(matrix, ordering.column_order());
    BOOST_TEST(2 * less < fill(matrix, by_planes), less << " entries");
}

BOOST_AUTO_TEST_CASE(orders_are_the_same_on_every_thread) {
    const sparse::Matrix<std::uint64_t> matrix = cube(12, 0);
    BOOST_TEST_REQUIRE(sparse::worth_dissection(matrix.rows, matrix.entries()));
    const sparse::Ordering alone(matrix);
    const auto order = [&] { return sparse::Ordering(matrix).column_order(); };
    auto other = std::async(std::launch::async, order);
    BOOST_TEST((order() == alone.column_order()));
    BOOST_TEST((other.get() == alone.column_order()));
}

BOOST_AUTO_TEST_CASE(large_matrices_with_copied_columns_have_their_rank) {
    for (const int side : {11, 14}) { // columns are dissected from 2500 rows on
        const sparse::Matrix<std::uint64_t> matrix = cube(side, 50);
        BOOST_TEST_REQUIRE(sparse::worth_dissection(matrix.rows, matrix.entries()));
        BOOST_TEST(exact::rank(matrix) == matrix.rows - matrix.rows / 50);
        BOOST_TEST(exact::rank(cube(side, 0)) == matrix.rows);
    }
}
