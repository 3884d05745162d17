// Reduction mod p, rank, kernel and inequalities over multi-quadratic fields, against dense elimination in the field
// itself.

#include "exact/reduction.hpp"
#include "support/test.hpp"

#include <isostat/exact/number.hpp>

namespace {

using isostat::Verdict;
using namespace isostat::exact;

Number random_number(std::mt19937_64& random, int fields) {
    static const int radicands[] = {1, 3, 2, 6, 5, 15};
    Number sum;
    const auto terms = random() % 3;
    for (std::size_t k = 0; k < terms; ++k) {
        sum += Number(static_cast<int>(random() % 7) - 3) / Number(1 + static_cast<int>(random() % 3)) *
               sqrt(Number(radicands[random() % static_cast<std::size_t>(fields)]));
    }
    return sum;
}

using Rows = std::vector<std::vector<Number>>; // rows

NumberMatrix sparse_of(const Rows& a, int cols) {
    NumberMatrix out;
    out.rows = static_cast<int>(a.size());
    out.column.resize(static_cast<std::size_t>(cols));
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < a[i].size(); ++j) {
            if (!a[i][j].is_zero()) {
                out.column[j].emplace_back(static_cast<int>(i), a[i][j]);
            }
        }
    }
    return out;
}

/// Rank by elimination in the field: the oracle, no prime involved.
int field_rank(Rows a, int cols) {
    std::size_t rank = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(cols) && rank < a.size(); ++j) {
        std::size_t r = rank;
        while (r < a.size() && a[r][j].is_zero()) {
            ++r;
        }
        if (r == a.size()) {
            continue;
        }
        std::swap(a[r], a[rank]);
        for (std::size_t i = rank + 1; i < a.size(); ++i) {
            const Number factor = a[i][j] / a[rank][j];
            for (std::size_t c = j; c < static_cast<std::size_t>(cols); ++c) {
                a[i][c] -= factor * a[rank][c];
            }
        }
        ++rank;
    }
    return static_cast<int>(rank);
}

/// A random matrix, often of lower rank than its shape: a product of two thin ones.
Rows random_matrix(std::mt19937_64& random, int rows, int cols, int fields) {
    const auto inner = 1 + random() % static_cast<std::size_t>(std::min(rows, cols) + 1);
    Rows left(static_cast<std::size_t>(rows), std::vector<Number>(inner)), out(static_cast<std::size_t>(rows));
    Rows right(inner, std::vector<Number>(static_cast<std::size_t>(cols)));
    for (auto* factor : {&left, &right}) {
        for (auto& row : *factor) {
            std::ranges::generate(row, [&] { return random_number(random, fields); });
        }
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i].resize(static_cast<std::size_t>(cols));
        for (std::size_t j = 0; j < out[i].size(); ++j) {
            for (std::size_t k = 0; k < inner; ++k) {
                out[i][j] += left[i][k] * right[k][j];
            }
        }
    }
    return out;
}

} // namespace

BOOST_AUTO_TEST_CASE(reduction_is_a_ring_homomorphism_for_every_choice_of_signs) {
    std::mt19937_64 random(11);
    const std::vector<Number> ring = {sqrt(Number(2)), sqrt(Number(3)), sqrt(Number(6)), sqrt(Number(15)),
                                      Number::parse("1/6")};
    std::vector<const Number*> pointers;
    for (const Number& x : ring) {
        pointers.push_back(&x);
    }
    std::uint64_t below = largest_prime_bound;
    for (int prime = 0; prime < 4; ++prime) {
        const Reduction map = Reduction::suitable(pointers, below);
        const PrimeField& field = map.field();
        BOOST_TEST(field.prime() < below);
        below = field.prime();
        BOOST_REQUIRE_EQUAL(map.root_count(), 3);
        for (unsigned signs = 0; signs < 8; ++signs) {
            // What independent roots of 2, 3 and 6 would break.
            BOOST_REQUIRE_EQUAL(field.multiply(map.residue(ring[0], signs), map.residue(ring[1], signs)),
                                map.residue(ring[2], signs));
            for (int k = 0; k < 200; ++k) {
                const Number a = random_number(random, 6), b = random_number(random, 6);
                BOOST_REQUIRE_EQUAL(map.residue(a + b, signs), field.add(map.residue(a, signs), map.residue(b, signs)));
                BOOST_REQUIRE_EQUAL(map.residue(a * b, signs),
                                    field.multiply(map.residue(a, signs), map.residue(b, signs)));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(a_prime_in_a_denominator_is_avoided) {
    const Number first = Number(1);
    const std::uint64_t p = Reduction::suitable({&first}).field().prime();
    const Number bad = Number(1) / Number(static_cast<long long>(p));
    BOOST_TEST(Reduction::suitable({&bad}).field().prime() < p);
    const Number root = sqrt(Number(1000003)); // a radicand that is no square mod some primes
    const Reduction map = Reduction::suitable({&root});
    BOOST_TEST(map.field().multiply(map.residue(root), map.residue(root)) == 1000003u);
}

BOOST_AUTO_TEST_CASE(rank_and_kernel_agree_with_elimination_in_the_field) {
    std::mt19937_64 random(3);
    int deficient = 0;
    for (int k = 0; k < 1500; ++k) {
        const int rows = 1 + static_cast<int>(random() % 6), cols = 1 + static_cast<int>(random() % 6);
        const int fields = 1 + static_cast<int>(random() % 6);
        const Rows a = random_matrix(random, rows, cols, fields);
        const NumberMatrix matrix = sparse_of(a, cols);
        const int rank = field_rank(a, cols);
        deficient += rank < std::min(rows, cols) ? 1 : 0;
        const Kernel answer = kernel(matrix);
        BOOST_REQUIRE_EQUAL(answer.rank, rank);
        BOOST_REQUIRE(answer.exact == Verdict::proved);
        BOOST_REQUIRE_EQUAL(answer.basis.size(), static_cast<std::size_t>(cols - rank));
        BOOST_REQUIRE_EQUAL(rank_bound(matrix).rank, rank);
        BOOST_REQUIRE_EQUAL(kernel(transposed(matrix)).rank, rank);
        for (std::size_t v = 0; v < answer.basis.size(); ++v) {
            for (const Number& x : product(matrix, answer.basis[v])) {
                BOOST_REQUIRE(x.is_zero());
            }
            for (std::size_t w = 0; w < answer.free.size(); ++w) {
                BOOST_REQUIRE((answer.basis[v][static_cast<std::size_t>(answer.free[w])] == Number(v == w ? 1 : 0)));
            }
        }
    }
    BOOST_TEST(deficient > 300);
}

BOOST_AUTO_TEST_CASE(entries_from_1e_minus_150_to_1e150_need_many_primes_and_get_them) {
    std::mt19937_64 random(4);
    for (int k = 0; k < 20; ++k) {
        Rows a(3, std::vector<Number>(4));
        for (auto& row : a) {
            for (Number& x : row) {
                const auto exponent = std::to_string(static_cast<int>(random() % 301) - 150);
                x = Number::parse(std::to_string(random() % 1000000) + "e" + exponent) *
                    sqrt(Number(static_cast<int>(1 + random() % 3)));
            }
        }
        for (std::size_t j = 0; j < 4; ++j) {
            a[2][j] = a[0][j] * Number::parse("sqrt(2)") - a[1][j]; // rank 2
        }
        const Kernel answer = kernel(sparse_of(a, 4));
        BOOST_REQUIRE_EQUAL(answer.rank, 2);
        BOOST_REQUIRE(answer.exact == Verdict::proved);
        a[2][3] += Number::parse("1e-300"); // regular by a hair
        const Kernel regular = kernel(sparse_of(a, 4));
        BOOST_REQUIRE_EQUAL(regular.rank, 3);
        BOOST_REQUIRE(regular.exact == Verdict::proved);
    }
}

BOOST_AUTO_TEST_CASE(too_few_primes_leave_the_upper_bound_undecided) {
    NumberMatrix matrix = sparse_of({{Number::parse("1e40"), Number::parse("1/3e50")}}, 2);
    const Kernel answer = kernel(matrix, {100000, 1});
    BOOST_TEST(answer.rank == 1);
    BOOST_TEST((answer.exact == Verdict::undecided));
    BOOST_TEST(answer.basis.empty());
    BOOST_TEST((kernel(matrix, {1, 512}).exact == Verdict::undecided));
    BOOST_TEST((kernel(matrix).exact == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(inequalities_have_a_certificate_for_either_answer) {
    std::mt19937_64 random(6);
    int yes = 0, no = 0;
    for (int k = 0; k < 1000; ++k) {
        const int rows = 1 + static_cast<int>(random() % 4), cols = 1 + static_cast<int>(random() % 5);
        Rows a(static_cast<std::size_t>(rows), std::vector<Number>(static_cast<std::size_t>(cols)));
        std::vector<Number> b(static_cast<std::size_t>(rows));
        for (std::size_t i = 0; i < a.size(); ++i) {
            std::ranges::generate(a[i], [&] { return random_number(random, 2); });
            b[i] = random_number(random, 2);
        }
        // The certificates are checked inside by substitution; a false one throws.
        (feasible_point(a, b, cols).feasible ? yes : no) += 1;
    }
    BOOST_TEST(yes > 100);
    BOOST_TEST(no > 100);
}

BOOST_AUTO_TEST_CASE(the_least_cost_is_that_of_the_best_vertex) {
    std::mt19937_64 random(7);
    int found = 0, none = 0;
    for (int k = 0; k < 500; ++k) {
        // One row, costs >= 0: the least is at one column. A second row that repeats it changes nothing.
        const std::size_t cols = 1 + random() % 5;
        std::vector<Number> row(cols), cost(cols);
        const Number b = random_number(random, 2);
        std::optional<Number> wanted;
        if (b.is_zero()) {
            wanted = Number(0);
        }
        for (std::size_t c = 0; c < cols; ++c) {
            row[c] = random_number(random, 2);
            cost[c] = random_number(random, 2);
            cost[c] = cost[c].sign() < 0 ? -cost[c] : cost[c];
            if (row[c].sign() * b.sign() > 0) {
                const Number there = cost[c] * b / row[c];
                wanted = !wanted || (there - *wanted).sign() < 0 ? there : wanted;
            }
        }
        const std::vector<Number> twice{b, b + b};
        std::vector<Number> doubled = row;
        for (Number& x : doubled) {
            x += x;
        }
        const auto once = least({row}, {b}, cost), again = least({row, doubled}, twice, cost);
        BOOST_TEST((once.has_value() == wanted.has_value() && again.has_value() == wanted.has_value()));
        BOOST_TEST((!wanted || (*once == *wanted && *again == *wanted)));
        (wanted ? found : none) += 1;
    }
    BOOST_TEST(found > 100);
    BOOST_TEST(none > 50);
}

BOOST_AUTO_TEST_CASE(one_sign_of_a_span) {
    const auto v = [](std::vector<int> entries) { return std::vector<Number>(entries.begin(), entries.end()); };
    BOOST_TEST((one_sign({v({1, 2, 3})}, 3).kind == OneSign::strict));
    BOOST_TEST((one_sign({v({-1, -2, -3})}, 3).kind == OneSign::strict));
    BOOST_TEST((one_sign({v({1, 0, 3})}, 3).kind == OneSign::partial));
    BOOST_TEST((one_sign({v({1, -1, 3})}, 3).kind == OneSign::none));
    BOOST_TEST((one_sign({v({1, -1, 3}), v({0, 2, -1})}, 3).kind == OneSign::strict));
    BOOST_TEST((one_sign({v({1, -1, 0}), v({0, 1, -1})}, 3).kind == OneSign::none));
    BOOST_TEST((one_sign({v({1, -1, 0}), v({0, 1, 0})}, 3).kind == OneSign::partial));
    BOOST_TEST((one_sign({}, 3).kind == OneSign::none));
    // Decided by the 40th digit: sqrt 2 against its expansion.
    const Number gap = Number::parse("sqrt(2) - 1.4142135623730950488016887242096980785697");
    BOOST_TEST((one_sign({{Number(1), -gap}}, 2).kind == (gap.sign() < 0 ? OneSign::strict : OneSign::none)));
}
