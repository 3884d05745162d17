#pragma once
// The sweep for the smallest gap against brute force over all pairs.

#include "checker/gaps.hpp"
#include "oracle/truth.hpp"
#include "support/test.hpp"

namespace small_states {

/// The gaps that the sweep lists are those of the stored coordinates, the smallest of `pairs` among them.
inline void lists_the_smallest_gap(const isostat::State& state, const std::vector<isostat::Contact>& pairs) {
    using namespace isostat::checker;
    const Problem problem(state);
    TrueVertex vertex;
    vertex.middle = problem.stored;
    vertex.radius = 0;
    const isostat::oracle::TruthIn<long double> at(state, isostat::oracle::At::stored);
    const auto gap_of = [&at](const isostat::Contact& pair) { return static_cast<double>(at.gap(pair)); };
    double smallest = std::numeric_limits<double>::infinity();
    for (const isostat::Contact& pair : pairs) {
        smallest = is_free_pair(state, pair) ? std::min(smallest, gap_of(pair)) : smallest;
    }
    double found = std::numeric_limits<double>::infinity();
    for (const Gap& gap : smallest_gaps(problem, state, vertex)) {
        BOOST_REQUIRE(gap.pair.i >= 0);
        BOOST_TEST(is_free_pair(state, gap.pair));
        BOOST_TEST(std::abs(gap.value.lower.get_d() - gap_of(gap.pair)) < 1e-12);
        found = std::min(found, gap.value.lower.get_d());
    }
    BOOST_TEST((found == smallest || std::abs(found - smallest) < 1e-12), found << ", not " << smallest);
}

} // namespace small_states
