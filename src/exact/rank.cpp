#include "exact/rank.hpp"

#include "exact/elimination.hpp"
#include "sparse/pattern.hpp"

#include <colamd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <new>
#include <vector>

namespace isostat::exact {

namespace {

/// Rank of one diagonal block. `position` numbers the rows of the whole matrix in the order of the blocks.
template <class Field>
int block_rank(const sparse::Matrix<typename Field::Value>& matrix, const sparse::Ordering& ordering,
               const std::vector<int>& position, int first, int last, Elimination<Field>& elimination) {
    std::vector<int> rows;
    std::vector<typename Field::Value> values;
    elimination.start(static_cast<std::size_t>(last - first));
    for (int k = first; k < last; ++k) {
        rows.clear();
        values.clear();
        const auto column = static_cast<std::size_t>(ordering.column_order()[static_cast<std::size_t>(k)]);
        for (auto e = static_cast<std::size_t>(matrix.start[column]);
             e < static_cast<std::size_t>(matrix.start[column + 1]); ++e) {
            const int i = position[static_cast<std::size_t>(matrix.row[e])];
            assert(i < last); // an entry below the blocks: the ordering is of another pattern, and proves no rank
            if (i >= first) {
                rows.push_back(i - first);
                values.push_back(matrix.value[e]);
            }
        }
        elimination.append(rows, values, k - first);
    }
    return elimination.rank();
}

/// A column order with little fill for any choice of pivot rows.
std::vector<int> colamd_order(const sparse::Matrix<std::uint64_t>& matrix) {
    std::vector<int> order(matrix.start.begin(), matrix.start.end());
    const std::size_t length = colamd_recommended(matrix.entries(), matrix.rows, matrix.cols);
    if (length == 0 || length > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw std::bad_alloc();
    }
    std::vector<int> work(length);
    std::ranges::copy(matrix.row, work.begin());
    std::array<int, COLAMD_STATS> stats{};
    [[maybe_unused]] const int done =
        colamd(matrix.rows, matrix.cols, static_cast<int>(length), work.data(), order.data(), nullptr, stats.data());
    assert(done != 0);
    order.resize(static_cast<std::size_t>(matrix.cols));
    return order;
}

template <class Field>
int rank_in_blocks(const sparse::Matrix<typename Field::Value>& matrix, const sparse::Ordering& ordering) {
    assert(ordering.structurally_regular() && ordering.row_order().size() == static_cast<std::size_t>(matrix.rows));
    const std::vector<int>& block_start = ordering.block_start();
    std::vector<int> position(static_cast<std::size_t>(matrix.rows));
    for (std::size_t k = 0; k < position.size(); ++k) {
        position[static_cast<std::size_t>(ordering.row_order()[k])] = static_cast<int>(k);
    }
    // It is kept between calls because a run proves the rank of ten thousands of matrices of the same size.
    thread_local Elimination<Field> elimination;
    int total = 0;
    for (std::size_t b = 0; b + 1 < block_start.size(); ++b) {
        total += block_rank(matrix, ordering, position, block_start[b], block_start[b + 1], elimination);
    }
    return total;
}

} // namespace

int rank(const sparse::Matrix<std::uint64_t>& matrix, const sparse::Ordering& ordering) {
    return rank_in_blocks<Field<61>>(matrix, ordering);
}

int rank(const sparse::Matrix<std::uint32_t>& matrix, const sparse::Ordering& ordering) {
    return rank_in_blocks<Field<31>>(matrix, ordering);
}

int rank(const sparse::Matrix<std::uint64_t>& matrix) {
    return ranks_of_first_rows(matrix, std::array{matrix.rows}).back();
}

std::vector<int> ranks_of_first_rows(const sparse::Matrix<std::uint64_t>& matrix, std::span<const int> ends) {
    std::vector<int> ranks(ends.size(), 0);
    if (matrix.entries() == 0) {
        return ranks;
    }
    std::vector<int> weight(static_cast<std::size_t>(matrix.rows), 0);
    for (const int row : matrix.row) {
        ++weight[static_cast<std::size_t>(row)];
    }
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        std::for_each(weight.begin() + ends[k], weight.end(), [&](int& w) { w += matrix.cols + 1; });
    }
    Elimination<Field<61>> elimination;
    elimination.start(weight.size());
    constexpr int many = 2500; // A^T A has some 22 entries per column: at 1500 METIS takes the time that it saves
    const bool dissect = matrix.rows >= many && sparse::worth_dissection(matrix.rows, matrix.entries());
    for (const int column :
         dissect ? sparse::dissection_of_columns(matrix.rows, matrix.start, matrix.row) : colamd_order(matrix)) {
        const auto begin = static_cast<std::size_t>(matrix.start[static_cast<std::size_t>(column)]);
        const auto count = static_cast<std::size_t>(matrix.start[static_cast<std::size_t>(column) + 1]) - begin;
        if (elimination.append({matrix.row.data() + begin, count}, {matrix.value.data() + begin, count}, -1, weight)) {
            const auto first = std::ranges::upper_bound(ends, elimination.pivot_row());
            std::for_each(ranks.begin() + (first - ends.begin()), ranks.end(), [](int& r) { ++r; });
        }
        if (elimination.rank() == matrix.rows) {
            break;
        }
    }
    return ranks;
}

} // namespace isostat::exact
