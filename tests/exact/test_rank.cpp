#include "exact/rank.hpp"
#include "oracle/matrices.hpp"
#include "oracle/random.hpp"
#include "support/scale.hpp"

#include <gmpxx.h>

using namespace isostat;
using namespace isostat::oracle;
using exact::mersenne61;

namespace {

/// Small integers: exact combinations stay exact.
double small_integer(Random& random) {
    return random.integer(19) - 9;
}

/// Numbers of every magnitude that a double has.
double any_double(Random& random) {
    switch (random.integer(6)) {
    case 0: return random.real(-1, 1);
    case 1: return random.real(-1, 1) * 1e-300;
    case 2: return random.real(-1, 1) * 1e150;
    case 3: return std::ldexp(static_cast<double>(random.integer(1000) + 1), -1074);
    case 4: return small_integer(random);
    default: return std::ldexp(1.0, random.integer(200) - 100);
    }
}

template <class Number> sparse::Matrix<double> fill(const Dense<char>& pattern, int cols, Number number) {
    Dense<double> dense(pattern.size(), std::vector<double>(static_cast<std::size_t>(cols), 0.0));
    for (auto& row : dense) {
        std::ranges::generate(row, [&] { return number(); });
    }
    return compress(dense, cols, [&](std::size_t i, std::size_t j) { return pattern[i][j] != 0; });
}

sparse::Matrix<std::uint32_t> reduce31(const sparse::Matrix<double>& matrix) {
    sparse::Matrix<std::uint32_t> reduced{matrix.rows, matrix.cols, matrix.start, matrix.row, {}};
    std::ranges::transform(matrix.value, std::back_inserter(reduced.value), exact::residue31);
    return reduced;
}

/// What the header promises of both variants, against the rank over Q.
void check_square(const sparse::Matrix<double>& matrix) {
    const int n = matrix.rows;
    const int true_rank = rational_rank(matrix);
    const auto reduced = reduce(matrix);
    BOOST_TEST(exact::rank(reduced) == true_rank);
    const sparse::Ordering ordering(reduced);
    if (!ordering.structurally_regular()) {
        BOOST_TEST(true_rank <= ordering.structural_rank());
        return;
    }
    const int found = exact::rank(reduced, ordering);
    BOOST_TEST(found <= true_rank); // never above
    BOOST_TEST((found == n) == (true_rank == n));
    const int found31 = exact::rank(reduce31(matrix), ordering);
    BOOST_TEST(found31 <= true_rank);
    BOOST_TEST((found31 == n) == (true_rank == n)); // by chance wrong once in 2^31 / n
    if (ordering.block_start().size() == 2) {       // irreducible: nothing is left out
        BOOST_TEST(found == true_rank);
        BOOST_TEST(found31 == true_rank);
    }
}

/// Sparse residues on a pattern, for comparison with dense elimination mod p.
sparse::Matrix<std::uint64_t> residues(const Dense<char>& pattern, int cols, Random& random, int percent_of_zeros) {
    Dense<std::uint64_t> dense(pattern.size(), std::vector<std::uint64_t>(static_cast<std::size_t>(cols), 0));
    for (auto& row : dense) {
        for (std::uint64_t& x : row) {
            x = random.integer(100) < percent_of_zeros ? 0 : random.bits() % mersenne61;
        }
    }
    return compress(dense, cols, [&](std::size_t i, std::size_t j) { return pattern[i][j] != 0; });
}

sparse::Matrix<std::uint64_t> first_rows(const sparse::Matrix<std::uint64_t>& matrix, int count) {
    sparse::Matrix<std::uint64_t> out{count, matrix.cols, {0}, {}, {}};
    for (std::size_t j = 0; j < static_cast<std::size_t>(matrix.cols); ++j) {
        for (auto e = static_cast<std::size_t>(matrix.start[j]); e < static_cast<std::size_t>(matrix.start[j + 1]);
             ++e) {
            if (matrix.row[e] < count) {
                out.row.push_back(matrix.row[e]);
                out.value.push_back(matrix.value[e]);
            }
        }
        out.start.push_back(static_cast<int>(out.row.size()));
    }
    return out;
}

void check_mod_p(const sparse::Matrix<std::uint64_t>& matrix) {
    const int expected = dense_rank(matrix);
    BOOST_TEST(exact::rank(matrix) == expected);
    const std::array ends{matrix.rows / 2, matrix.rows - matrix.rows / 4, matrix.rows};
    const std::vector<int> ranks = exact::ranks_of_first_rows(matrix, ends);
    for (std::size_t k = 0; k < ends.size(); ++k) {
        BOOST_TEST(ranks[k] == dense_rank(first_rows(matrix, ends[k])));
    }
    BOOST_TEST(exact::independent_columns(matrix).size() == static_cast<std::size_t>(expected));
    const sparse::Ordering ordering(matrix);
    if (matrix.rows == matrix.cols && ordering.structurally_regular()) {
        const int found = exact::rank(matrix, ordering);
        BOOST_TEST(found <= expected);
        BOOST_TEST((found == matrix.rows) == (expected == matrix.rows));
        if (ordering.block_start().size() == 2) {
            BOOST_TEST(found == expected);
        }
        // The same pattern over the small field, with the same zeros: full or deficient together but for an accident.
        sparse::Matrix<std::uint32_t> small{matrix.rows, matrix.cols, matrix.start, matrix.row, {}};
        for (const std::uint64_t x : matrix.value) {
            small.value.push_back(static_cast<std::uint32_t>(x % exact::mersenne31));
        }
        sparse::Matrix<std::uint64_t> wide{matrix.rows, matrix.cols, matrix.start, matrix.row, {}};
        wide.value.assign(small.value.begin(), small.value.end());
        const int found31 = exact::rank(small, ordering);
        const int expected31 = dense_rank(wide, exact::mersenne31);
        BOOST_TEST(found31 <= expected31);
        BOOST_TEST((found31 == matrix.rows) == (expected31 == matrix.rows));
        if (ordering.block_start().size() == 2) {
            BOOST_TEST(found31 == expected31);
        }
    }
}

const mpz_class prime = (mpz_class(1) << 61) - 1;

std::uint64_t to_word(const mpz_class& x) {
    return std::stoull(x.get_str());
}

/// The residue of a rational with a power of two as denominator, by GMP.
std::uint64_t reduce_modulo(const mpq_class& x, const mpz_class& p = prime) {
    mpz_class inverse;
    mpz_invert(inverse.get_mpz_t(), x.get_den().get_mpz_t(), p.get_mpz_t());
    mpz_class r = x.get_num() * inverse % p;
    return to_word(r < 0 ? mpz_class(r + p) : r);
}

mpz_class big(std::uint64_t x) {
    return mpz_class(std::to_string(x));
}

} // namespace

BOOST_AUTO_TEST_CASE(random_square_matrices_have_their_rational_rank) {
    Random random(11);
    for (int repeat = 0; repeat < testing::scaled(2500); ++repeat) {
        const int n = 1 + random.integer(11);
        const Dense<char> pattern = random_pattern(n, n, random.integer(3 * n), repeat % 5 != 0, random);
        check_square(fill(pattern, n, [&] { return repeat % 2 == 0 ? small_integer(random) : any_double(random); }));
    }
}

BOOST_AUTO_TEST_CASE(exact_combinations_of_columns_are_never_certified_full) {
    Random random(12);
    for (int repeat = 0; repeat < testing::scaled(1500); ++repeat) {
        const int n = 3 + random.integer(9);
        const Dense<char> pattern = random_pattern(n, n, 4 * n, true, random);
        Dense<double> dense = expand(fill(pattern, n, [&] { return small_integer(random); }));
        // A power of two keeps the combination exact at any magnitude.
        const double scale = std::ldexp(1.0, random.integer(2) * (random.integer(1800) - 900));
        const int target = random.integer(n);
        const int a = random.integer(n);
        const int b = random.integer(n);
        for (auto& row : dense) {
            const auto t = static_cast<std::size_t>(target);
            row[t] = 0;
            row[t] = (3 * row[static_cast<std::size_t>(a)] - 2 * row[static_cast<std::size_t>(b)]) * scale;
        }
        const auto matrix =
            compress(dense, n, [&](std::size_t i, std::size_t j) { return dense[i][j] != 0 || pattern[i][j] != 0; });
        BOOST_TEST(rational_rank(matrix) < n);
        check_square(matrix);
    }
}

BOOST_AUTO_TEST_CASE(rectangular_matrices_have_their_rational_rank) {
    Random random(13);
    for (int repeat = 0; repeat < testing::scaled(1000); ++repeat) {
        const int rows = 1 + random.integer(12);
        const int cols = 1 + random.integer(12);
        const Dense<char> pattern = random_pattern(rows, cols, random.integer(3 * rows), repeat % 2 == 0, random);
        const auto matrix =
            fill(pattern, cols, [&] { return repeat % 3 == 0 ? any_double(random) : small_integer(random); });
        BOOST_TEST(exact::rank(reduce(matrix)) == rational_rank(matrix));
    }
}

BOOST_AUTO_TEST_CASE(zeros_among_the_stored_values_move_the_pivots) {
    Random random(14);
    for (int repeat = 0; repeat < testing::scaled(1500); ++repeat) {
        const int n = 2 + random.integer(30);
        check_mod_p(residues(random_pattern(n, n, 4 * n, true, random), n, random, 10 * (repeat % 6)));
    }
}

BOOST_AUTO_TEST_CASE(large_blocks_with_fill_agree_with_dense_elimination) {
    Random random(15);
    for (const int n : {40, 80, 150, 300}) {
        for (const int extra : {2, 3, 5}) {
            for (const int zeros : {0, 5, 30}) {
                check_mod_p(residues(random_pattern(n, n, extra * n, true, random), n, random, zeros));
            }
        }
    }
    // Full, banded and arrow patterns: long runs of columns with the same rows.
    for (const int n : {5, 64, 130}) {
        for (const int zeros : {0, 20, 60, 95}) {
            Dense<char> pattern(static_cast<std::size_t>(n), std::vector<char>(static_cast<std::size_t>(n), 1));
            check_mod_p(residues(pattern, n, random, zeros));
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    pattern[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = std::abs(i - j) <= 6 ? 1 : 0;
                }
            }
            check_mod_p(residues(pattern, n, random, zeros));
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    pattern[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
                        i == j || i == 0 || j == 0 || i > n - 4 ? 1 : 0;
                }
            }
            check_mod_p(residues(pattern, n, random, zeros));
        }
    }
}

BOOST_AUTO_TEST_CASE(dependent_columns_inside_a_large_block_are_counted) {
    Random random(16);
    for (int repeat = 0; repeat < testing::scaled(30); ++repeat) {
        const int n = 60;
        auto dense = expand(residues(random_pattern(n, n, 5 * n, true, random), n, random, 0));
        const int dependent = 1 + random.integer(5);
        for (int k = 0; k < dependent; ++k) {
            const auto t = static_cast<std::size_t>(random.integer(n));
            const auto a = static_cast<std::size_t>(random.integer(n));
            const auto b = static_cast<std::size_t>(random.integer(n));
            const std::uint64_t factor = random.bits() % mersenne61;
            for (auto& row : dense) {
                row[t] = exact::subtract(row[a], exact::multiply(factor, row[b]));
            }
        }
        check_mod_p(compress(dense, n, [&](std::size_t i, std::size_t j) { return dense[i][j] != 0; }));
    }
}

BOOST_AUTO_TEST_CASE(block_triangular_matrices_need_only_their_blocks) {
    // Upper triangular in hidden order: n blocks of size 1.
    Random random(17);
    Dense<std::uint64_t> dense(40, std::vector<std::uint64_t>(40, 0));
    for (std::size_t i = 0; i < 40; ++i) {
        for (std::size_t j = i; j < 40; ++j) {
            dense[(7 * i) % 40][(11 * j + 3) % 40] = 1 + random.bits() % (mersenne61 - 1);
        }
    }
    const auto matrix = compress(dense, 40, [&](std::size_t i, std::size_t j) { return dense[i][j] != 0; });
    const sparse::Ordering ordering(matrix);
    BOOST_TEST(ordering.block_start().size() == 41U);
    BOOST_TEST(exact::rank(matrix, ordering) == 40);
    // One zero on the diagonal of the hidden triangle: the count drops by one, and the rank is indeed deficient.
    for (std::size_t i = 0; i < 40; ++i) {
        auto holed = dense;
        holed[(7 * i) % 40][(11 * i + 3) % 40] = 0;
        const auto singular = compress(holed, 40, [&](std::size_t r, std::size_t c) { return dense[r][c] != 0; });
        BOOST_TEST(exact::rank(singular, sparse::Ordering(singular)) == 39);
        BOOST_TEST(dense_rank(singular) == 39);
    }
}

BOOST_AUTO_TEST_CASE(rank_mod_p_is_only_a_lower_bound) {
    // Regular over Q, singular mod p: 2^61 = 1.
    const Dense<double> dense = {{1, 0x1p61}, {1, 1}};
    const auto matrix = compress(dense, 2, [](std::size_t, std::size_t) { return true; });
    BOOST_TEST(rational_rank(matrix) == 2);
    BOOST_TEST(exact::rank(reduce(matrix)) == 1);
    BOOST_TEST(exact::rank(reduce(matrix), sparse::Ordering(reduce(matrix))) == 1);
    const Dense<double> small = {{1, 0x1p31}, {1, 1}};
    const auto matrix31 = compress(small, 2, [](std::size_t, std::size_t) { return true; });
    BOOST_TEST(exact::rank(reduce31(matrix31), sparse::Ordering(matrix31)) == 1);
    BOOST_TEST(exact::rank(reduce(matrix31), sparse::Ordering(matrix31)) == 2);
    // A reducible matrix with a singular block: the count by blocks (0) is below the rank mod p (1).
    const Dense<std::uint64_t> reducible = {{0, 5}, {0, 0}};
    const auto upper = compress(reducible, 2, [](std::size_t i, std::size_t j) { return i <= j; });
    BOOST_TEST(exact::rank(upper, sparse::Ordering(upper)) == 0);
    BOOST_TEST(exact::rank(upper) == 1);
}

BOOST_AUTO_TEST_CASE(nearly_singular_matrices_are_regular) {
    // Determinant 2^-1000 against entries of order 1; and a graded diagonal over the whole range of doubles.
    const Dense<double> nearly = {{1, 1}, {1, 1 + 0x1p-52}};
    BOOST_TEST(exact::rank(reduce(compress(nearly, 2, [](std::size_t, std::size_t) { return true; }))) == 2);
    const Dense<double> graded = {{0x1p-1000, 1}, {0x1p-1074, 0x1p-74}};
    check_square(compress(graded, 2, [](std::size_t, std::size_t) { return true; })); // singular: proportional rows
    const Dense<double> tiny = {{0x1p-1000, 1}, {0x1p-1074, 0x1.0000000000001p-74}};
    const auto matrix = compress(tiny, 2, [](std::size_t, std::size_t) { return true; });
    BOOST_TEST(rational_rank(matrix) == 2);
    check_square(matrix);
}

BOOST_AUTO_TEST_CASE(independent_columns_are_the_first_ones) {
    Random random(18);
    for (int repeat = 0; repeat < testing::scaled(200); ++repeat) {
        const int rows = 1 + random.integer(12);
        const int cols = 1 + random.integer(16);
        const auto matrix =
            residues(random_pattern(rows, cols, random.integer(4 * rows), false, random), cols, random, 20);
        const auto dense = expand(matrix);
        std::vector<int> expected;
        int rank_before = 0;
        for (int c = 1; c <= cols; ++c) {
            const int rank_now = Modular(dense, c, mersenne61).rank();
            if (rank_now > rank_before) {
                expected.push_back(c - 1);
            }
            rank_before = rank_now;
        }
        BOOST_TEST((exact::independent_columns(matrix) == expected));
    }
}

BOOST_AUTO_TEST_CASE(empty_matrices_have_rank_zero) {
    sparse::Matrix<std::uint64_t> nothing{0, 0, {0}, {}, {}};
    BOOST_TEST(exact::rank(nothing) == 0);
    sparse::Matrix<std::uint64_t> no_entries{3, 2, {0, 0, 0}, {}, {}};
    BOOST_TEST(exact::rank(no_entries) == 0);
    const sparse::Ordering ordering(nothing);
    BOOST_TEST(ordering.structurally_regular());
    BOOST_TEST(exact::rank(nothing, ordering) == 0);
    BOOST_TEST(exact::rank(sparse::Matrix<std::uint32_t>{0, 0, {0}, {}, {}}, ordering) == 0);
}

BOOST_AUTO_TEST_CASE(residues_of_doubles_are_exact_at_every_magnitude) {
    oracle::Random random(1);
    std::vector<double> values = {0.0,
                                  -0.0,
                                  1.0,
                                  -1.0,
                                  0x1p61,
                                  0x1p-61,
                                  0x1p60,
                                  0x1p31 - 1, // 0 in the small field
                                  -(0x1p31 - 1),
                                  1e-300,
                                  1e150,
                                  0.1,
                                  std::numeric_limits<double>::max(),
                                  std::numeric_limits<double>::min(),
                                  std::numeric_limits<double>::denorm_min(),
                                  -std::numeric_limits<double>::denorm_min(),
                                  std::nextafter(std::numeric_limits<double>::min(), 0.0)};
    for (int k = 0; k < 4000; ++k) {
        values.push_back(std::ldexp(random.real(-1, 1), random.integer(2090) - 1070));
    }
    for (const double x : values) {
        const std::uint64_t r = exact::residue(x);
        BOOST_TEST(r < mersenne61);
        BOOST_TEST(r == reduce_modulo(mpq_class(x)));
        BOOST_TEST((r == 0) == (x == 0)); // 53 bits are fewer than p has
        BOOST_TEST(exact::residue31(x) == reduce_modulo(mpq_class(x), exact::mersenne31));
    }
}

BOOST_AUTO_TEST_CASE(residues_form_a_ring_homomorphism) {
    oracle::Random random(2);
    for (int k = 0; k < 2000; ++k) {
        // 25-bit factors: sums and products are exact doubles.
        const double a = std::floor(random.real(-0x1p25, 0x1p25)) * std::ldexp(1.0, random.integer(40) - 20);
        const double b = std::floor(random.real(-0x1p25, 0x1p25));
        BOOST_TEST(exact::residue(a * b) == exact::multiply(exact::residue(a), exact::residue(b)));
        const double c = std::floor(random.real(-0x1p50, 0x1p50));
        BOOST_TEST(exact::residue(b - c) == exact::subtract(exact::residue(b), exact::residue(c)));
    }
}

BOOST_AUTO_TEST_CASE(field_operations_agree_with_integers) {
    oracle::Random random(3);
    std::vector<std::uint64_t> values = {
        0, 1, 2, 3, 7, mersenne61 - 1, mersenne61 - 2, (mersenne61 - 1) / 2, (mersenne61 + 1) / 2};
    for (int k = 0; k < 61; ++k) {
        values.push_back(std::uint64_t{1} << k);
        values.push_back(mersenne61 - (std::uint64_t{1} << k));
        values.push_back((std::uint64_t{1} << k) - 1);
    }
    for (int k = 0; k < 500; ++k) {
        values.push_back(random.bits() % mersenne61);
    }
    for (const std::uint64_t a : values) {
        for (int k = 0; k < 20; ++k) {
            const std::uint64_t b = values[static_cast<std::size_t>(random.integer(static_cast<int>(values.size())))];
            BOOST_TEST(exact::multiply(a, b) == to_word(big(a) * big(b) % prime));
            BOOST_TEST(exact::subtract(a, b) == to_word((big(a) - big(b) + prime) % prime));
        }
        if (a != 0) {
            const std::uint64_t inverse = exact::inverse(a);
            BOOST_TEST(inverse < mersenne61);
            BOOST_TEST(exact::multiply(a, inverse) == 1U);
        }
    }
    for (int k = 0; k < 200000; ++k) {
        const std::uint64_t a = 1 + random.bits() % (mersenne61 - 1);
        if (exact::multiply(a, exact::inverse(a)) != 1) {
            BOOST_ERROR("inverse of " << a);
        }
    }
}
