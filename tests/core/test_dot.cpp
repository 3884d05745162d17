// Sizes of long vectors.
#include "core/dot.hpp"
#include "support/test.hpp"

BOOST_AUTO_TEST_CASE(the_largest_component_is_no_number_where_one_is_none) {
    // It was left out: what divided by 0 passed for a step of length 0.
    constexpr double infinity = std::numeric_limits<double>::infinity();
    BOOST_TEST(isostat::largest(std::vector<double>()) == 0);
    for (const std::size_t size : {1U, 7U, 8U, 9U, 40U}) {
        for (std::size_t at = 0; at < size; ++at) {
            std::vector<double> x(size, 0.5);
            x[at] = -2;
            BOOST_TEST(isostat::largest(x) == 2);
            x[at] = -infinity;
            BOOST_TEST(isostat::largest(x) == infinity);
            x[at] = std::nan("");
            BOOST_TEST(std::isnan(isostat::largest(x)));
            x[size - 1] = infinity;
            BOOST_TEST((std::isnan(isostat::largest(x)) || at == size - 1));
        }
    }
}
