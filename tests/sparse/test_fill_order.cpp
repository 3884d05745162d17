// Matrices as large and as full as those of many spheres: nested dissection orders them.
#include "exact/rank.hpp"
#include "oracle/matrices.hpp"
#include "sparse/pattern.hpp"
#include "support/scale.hpp"

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

sparse::Matrix<std::uint64_t> random_values(const Dense<char>& pattern, Random& random) {
    const int n = static_cast<int>(pattern.size());
    Dense<std::uint64_t> dense(pattern.size(), std::vector<std::uint64_t>(pattern.size()));
    for (auto& row : dense) {
        std::ranges::generate(row, [&] { return 1 + random.bits() % (exact::mersenne61 - 1); });
    }
    return compress(dense, n, [&](std::size_t i, std::size_t j) { return pattern[i][j] != 0; });
}

bool is_permutation_of_all(const std::vector<int>& order, int n) {
    return std::set<int>(order.begin(), order.end()).size() == order.size() && static_cast<int>(order.size()) == n &&
           (n == 0 || (*std::ranges::min_element(order) == 0 && *std::ranges::max_element(order) == n - 1));
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

BOOST_AUTO_TEST_CASE(orderings_match_every_column_and_are_block_upper_triangular) {
    Random random(21);
    int many_blocks = 0;
    for (int repeat = 0; repeat < testing::scaled(600); ++repeat) {
        const int n = 1 + random.integer(40);
        const auto matrix = random_values(random_pattern(n, n, random.integer(2 * n), true, random), random);
        const sparse::Ordering ordering(matrix);
        BOOST_REQUIRE(ordering.structurally_regular());
        BOOST_TEST(is_permutation_of_all(ordering.row_order(), n));
        BOOST_TEST(is_permutation_of_all(ordering.column_order(), n));
        const std::vector<int>& start = ordering.block_start();
        BOOST_TEST(start.front() == 0);
        BOOST_TEST(start.back() == n);
        std::vector<int> block_of_row(static_cast<std::size_t>(n));
        std::vector<int> block_of_column(static_cast<std::size_t>(n));
        for (std::size_t b = 0; b + 1 < start.size(); ++b) {
            BOOST_TEST(start[b] < start[b + 1]);
            for (auto k = static_cast<std::size_t>(start[b]); k < static_cast<std::size_t>(start[b + 1]); ++k) {
                block_of_row[static_cast<std::size_t>(ordering.row_order()[k])] = static_cast<int>(b);
                block_of_column[static_cast<std::size_t>(ordering.column_order()[k])] = static_cast<int>(b);
            }
        }
        many_blocks += start.size() > 3 ? 1 : 0;
        const auto dense = expand(matrix);
        for (std::size_t i = 0; i < dense.size(); ++i) {
            for (std::size_t j = 0; j < dense.size(); ++j) {
                BOOST_TEST((dense[i][j] == 0 || block_of_row[i] <= block_of_column[j]));
            }
        }
        for (std::size_t k = 0; k < dense.size(); ++k) {
            BOOST_TEST(dense[static_cast<std::size_t>(ordering.row_order()[k])]
                            [static_cast<std::size_t>(ordering.column_order()[k])] != 0U);
        }
    }
    BOOST_TEST(many_blocks > 100);
}

BOOST_AUTO_TEST_CASE(structural_rank_is_the_size_of_a_maximum_matching) {
    Random random(22);
    int deficient = 0;
    for (int repeat = 0; repeat < testing::scaled(1500); ++repeat) {
        const int n = 1 + random.integer(15);
        const auto matrix = random_values(random_pattern(n, n, random.integer(4 * n), false, random), random);
        const sparse::Ordering ordering(matrix);
        const int expected = matching_size(matrix);
        BOOST_TEST(ordering.structural_rank() == expected);
        BOOST_TEST(ordering.structurally_regular() == (expected == n));
        BOOST_TEST(ordering.row_order().empty() == (expected < n));
        const std::vector<int> matched = sparse::perfect_matching(n, matrix.start, matrix.row);
        BOOST_TEST(matched.empty() == (expected < n));
        if (expected == n) {
            BOOST_TEST(is_permutation_of_all(matched, n));
            const auto dense = expand(matrix);
            for (std::size_t r = 0; r < matched.size(); ++r) {
                BOOST_TEST(dense[r][static_cast<std::size_t>(matched[r])] != 0U);
            }
        }
        deficient += expected < n ? 1 : 0;
    }
    BOOST_TEST(deficient > 300);
}

BOOST_AUTO_TEST_CASE(structural_nonzeros_are_those_of_random_values) {
    Random random(23);
    int zeros = 0;
    for (int repeat = 0; repeat < testing::scaled(1500); ++repeat) {
        const int n = 1 + random.integer(14);
        const auto matrix = random_values(random_pattern(n, n, random.integer(2 * n), true, random), random);
        const sparse::Ordering ordering(matrix);
        std::vector<int> loaded;
        std::vector<std::uint64_t> load(static_cast<std::size_t>(n), 0);
        for (int i = 0; i < n; ++i) {
            if (random.integer(4) == 0) {
                loaded.push_back(i);
                load[static_cast<std::size_t>(i)] = 1 + random.bits() % (exact::mersenne61 - 1);
            }
        }
        const auto nonzero = sparse::structural_nonzeros(matrix.start, matrix.row, ordering, loaded);
        // The matching alone gives the same answer, whichever it is, and whatever of it is known.
        const std::vector<int> matched = sparse::perfect_matching(n, matrix.start, matrix.row);
        const std::span<const int> some = std::span(loaded).first(loaded.size() / 2);
        BOOST_TEST((nonzero == sparse::structural_nonzeros(matrix.start, matrix.row, matched, loaded)));
        BOOST_TEST((nonzero ==
                    sparse::structural_nonzeros(matrix.start, matrix.row, matched, loaded,
                                                sparse::structural_nonzeros(matrix.start, matrix.row, matched, some))));
        const auto x = Modular(expand(matrix), n, exact::mersenne61).solution(load);
        if (!x) {
            continue; // structurally regular, yet singular: has probability n / p
        }
        for (std::size_t c = 0; c < x->size(); ++c) {
            BOOST_TEST((nonzero[c] != 0) == ((*x)[c] != 0));
            zeros += (*x)[c] == 0 ? 1 : 0;
        }
    }
    BOOST_TEST(zeros > 1000);
}

BOOST_AUTO_TEST_CASE(a_structural_zero_holds_for_special_values_and_a_nonzero_need_not) {
    // Chain: b enters row 0; unknown 1 feels it, unknown 2 never does.
    const Dense<std::uint64_t> dense = {{1, 0, 1}, {1, 1, 1}, {0, 0, 1}};
    const auto matrix = compress(dense, 3, [&](std::size_t i, std::size_t j) { return dense[i][j] != 0; });
    const std::vector<int> loaded = {0, 1};
    const auto nonzero = sparse::structural_nonzeros(matrix.start, matrix.row, sparse::Ordering(matrix), loaded);
    BOOST_TEST(nonzero[0] == 1);
    BOOST_TEST(nonzero[1] == 1); // generic; for these values and b = (1, 1, 0) it vanishes
    BOOST_TEST(nonzero[2] == 0);
    const auto x = Modular(dense, 3, exact::mersenne61).solution({1, 1, 0}).value();
    BOOST_TEST(x[1] == 0U);
    BOOST_TEST(x[2] == 0U);
}

BOOST_AUTO_TEST_CASE(no_load_means_no_structural_nonzero) {
    Random random(24);
    const auto matrix = random_values(random_pattern(10, 10, 30, true, random), random);
    const auto nonzero =
        sparse::structural_nonzeros(matrix.start, matrix.row, sparse::Ordering(matrix), std::vector<int>{});
    BOOST_TEST(std::ranges::count(nonzero, 0) == 10);
}

BOOST_AUTO_TEST_CASE(a_repaired_matching_is_perfect_exactly_when_there_is_one) {
    Random random(22);
    int repaired = 0, none = 0;
    for (int repeat = 0; repeat < testing::scaled(800); ++repeat) {
        const int n = 1 + random.integer(30);
        Dense<char> pattern = random_pattern(n, n, random.integer(n), true, random);
        const auto before = random_values(pattern, random);
        const std::vector<int> matching = sparse::perfect_matching(n, before.start, before.row);
        BOOST_TEST_REQUIRE(static_cast<int>(matching.size()) == n);
        const int column = random.integer(n);
        for (int i = 0; i < n; ++i) {
            pattern[static_cast<std::size_t>(i)][static_cast<std::size_t>(column)] = random.integer(n) < 2 ? 1 : 0;
        }
        const auto after = random_values(pattern, random);
        const std::vector<int> again = sparse::repaired_matching(matching, after.start, after.row, column);
        const bool possible = !sparse::perfect_matching(n, after.start, after.row).empty();
        BOOST_TEST(again.empty() != possible);
        if (possible) {
            BOOST_TEST(is_permutation_of_all(again, n));
            for (std::size_t r = 0; r < again.size(); ++r) {
                BOOST_TEST(pattern[r][static_cast<std::size_t>(again[r])] != 0);
            }
            ++repaired;
        } else {
            ++none;
        }
    }
    BOOST_TEST(repaired > 50);
    BOOST_TEST(none > 50);
}
