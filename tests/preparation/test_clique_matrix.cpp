// Sums of blocks: solved to rounding, refused when not positive.

#include "../../src/preparation/clique_matrix.hpp"
#include "check.hpp"

#include <cmath>

namespace {

using isostat::preparation::CliqueMatrix;

/// Springs along a ring of points: l joins points l and l + 1.
struct Ring {
    static constexpr std::size_t points = 50;
    std::vector<int> start{0};
    std::vector<int> column;
    Ring() {
        for (std::size_t l = 0; l < points; ++l) {
            column.push_back(static_cast<int>(l));
            column.push_back(static_cast<int>((l + 1) % points));
            start.push_back(static_cast<int>(column.size()));
        }
    }
    static double stiffness(std::size_t l) { return 1 + 0.5 * std::sin(static_cast<double>(l)); }
    static double block(std::size_t l, std::size_t p, std::size_t r) { return p == r ? stiffness(l) : -stiffness(l); }
};

} // namespace

BOOST_AUTO_TEST_SUITE(preparation)

BOOST_AUTO_TEST_CASE(a_sum_of_blocks_is_solved_again_and_again) {
    const Ring ring;
    CliqueMatrix matrix(Ring::points, ring.start, ring.column);
    for (const double ground : {1.0, 1e-3, 10.0}) {
        BOOST_REQUIRE(matrix.factorise(Ring::block, std::vector<double>(Ring::points, ground)));
        std::vector<double> x(Ring::points);
        for (std::size_t k = 0; k < x.size(); ++k) {
            x[k] = std::cos(static_cast<double>(k * k));
        }
        std::vector<double> b(Ring::points, 0.0);
        for (std::size_t k = 0; k < x.size(); ++k) {
            const std::size_t next = (k + 1) % x.size();
            b[k] += ground * x[k] + Ring::stiffness(k) * (x[k] - x[next]);
            b[next] += Ring::stiffness(k) * (x[next] - x[k]);
        }
        BOOST_REQUIRE(matrix.solve(b));
        for (std::size_t k = 0; k < x.size(); ++k) {
            BOOST_TEST(std::abs(b[k] - x[k]) < 1e-11);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_sum_of_blocks_that_is_not_positive_has_no_factor) {
    const Ring ring;
    CliqueMatrix matrix(Ring::points, ring.start, ring.column);
    BOOST_TEST(!matrix.factorise(Ring::block, std::vector<double>(Ring::points, -0.1)));
    BOOST_TEST(matrix.factorise(Ring::block, std::vector<double>(Ring::points, 0.1)));
}

BOOST_AUTO_TEST_SUITE_END()
