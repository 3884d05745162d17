#include <isostat/io/state_file.hpp>
#include <isostat/linear/factorisation.hpp>

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace isostat;

BOOST_AUTO_TEST_SUITE(linear)

namespace {

State<2> vertex400() {
    return read_state<2>(std::string(ISOSTAT_TEST_DATA) + "/vertex400.txt").state;
}

double largest(const std::vector<double>& x) {
    return std::transform_reduce(
        x.begin(), x.end(), 0.0, [](double a, double b) { return std::max(a, b); },
        [](double c) { return std::abs(c); });
}

/// |H f - rhs| and |G v - rhs|.
double residual_of_forces(const sparse::Matrix<double>& h, const std::vector<double>& f, std::vector<double> rhs) {
    for (std::size_t l = 0; l < f.size(); ++l) {
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            rhs[static_cast<std::size_t>(h.row[static_cast<std::size_t>(e)])] -=
                h.value[static_cast<std::size_t>(e)] * f[l];
        }
    }
    return largest(rhs);
}
double residual_of_velocities(const sparse::Matrix<double>& h, const std::vector<double>& v, std::vector<double> rhs) {
    for (std::size_t l = 0; l < v.size(); ++l) {
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            rhs[l] -=
                h.value[static_cast<std::size_t>(e)] * v[static_cast<std::size_t>(h.row[static_cast<std::size_t>(e)])];
        }
    }
    return largest(rhs);
}

std::vector<double> some_numbers(std::size_t n) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<double> x(n);
    std::generate(x.begin(), x.end(), [&] { return number(random); });
    return x;
}

/// Columns replaced by those of contacts with other partners: contact l gets what contact l + n/2 had, slightly turned.
sparse::Matrix<double> with_exchanges(const sparse::Matrix<double>& h, const std::vector<int>& slots) {
    sparse::Matrix<double> next;
    next.rows = next.cols = h.rows;
    next.start.push_back(0);
    for (int l = 0; l < h.cols; ++l) {
        const bool exchanged = std::find(slots.begin(), slots.end(), l) != slots.end();
        const auto c = static_cast<std::size_t>(l);
        for (int e = h.start[c]; e < h.start[c + 1]; ++e) {
            const auto at = static_cast<std::size_t>(e);
            // The same grains, another direction: regular, and no longer close to the base.
            next.row.push_back(h.row[at]);
            next.value.push_back(exchanged ? h.value[at] * (e % 2 == 0 ? 1.3 : 0.4) : h.value[at]);
        }
        next.start.push_back(static_cast<int>(next.row.size()));
    }
    return next;
}

void check_solves(const ApproximateInverse& inverse, const sparse::Matrix<double>& h, const std::vector<double>& rhs) {
    auto f = rhs;
    inverse.forces(f);
    BOOST_TEST(residual_of_forces(h, f, rhs) < 1e-10 * largest(f));
    auto v = rhs;
    inverse.velocities(v);
    BOOST_TEST(residual_of_velocities(h, v, rhs) < 1e-10 * largest(v));
}

} // namespace

BOOST_AUTO_TEST_CASE(exchanged_operators_solve_with_the_exchanged_matrix) {
    const State<2> state = vertex400();
    const auto h = contact_matrix(state.packing, DofMap<2>(state.packing), state.contacts);
    ApproximateInverse inverse(h); // its blocks: many of one contact, some of a few, one of most
    std::vector<int> slots;
    const std::vector<double> rhs = some_numbers(static_cast<std::size_t>(h.rows));
    for (const int slot : {3, 250, 777, 3}) { // one of them twice
        slots.push_back(slot);
        const auto next = with_exchanges(h, slots);
        inverse = inverse.exchanged(slot, next);
        check_solves(inverse, next, rhs);
    }
    BOOST_TEST(inverse.exchanges() == 4);
}

BOOST_AUTO_TEST_CASE(renewed_factors_are_those_of_the_new_matrix) {
    const State<2> state = vertex400();
    const auto h = contact_matrix(state.packing, DofMap<2>(state.packing), state.contacts);
    ApproximateInverse inverse(h);
    std::vector<int> slots;
    const std::vector<double> rhs = some_numbers(static_cast<std::size_t>(h.rows));
    for (int round = 0; round < 12; ++round) { // the order is taken over, and given up when it has filled the factors
        slots = {40 + 60 * round, 13 * round};
        auto next = with_exchanges(h, slots);
        for (const int slot : slots) {
            inverse = inverse.exchanged(slot, next);
        }
        inverse = inverse.renewed(next);
        BOOST_TEST(inverse.valid());
        BOOST_TEST(inverse.exchanges() == 0);
        check_solves(inverse, next, rhs);
    }
}

BOOST_AUTO_TEST_CASE(solving_until_it_is_enough_says_how_far_it_is_from_the_solution) {
    const State<2> state = vertex400();
    const auto proved = IsostaticStructure<2>::prove(state.packing, state.contacts);
    BOOST_TEST_REQUIRE(proved.ok());
    sparse::Matrix<double> stale = proved.value().matrix();
    for (std::size_t e = 0; e < stale.value.size(); ++e) {
        stale.value[e] *= 1 + 1e-3 * std::sin(static_cast<double>(e));
    }
    const Factorisation taken_over(proved.value(), ApproximateInverse(stale));
    const std::vector<double> load(static_cast<std::size_t>(proved.value().size()), 1.0);
    auto solution = load;
    taken_over.solve_forces(solution);
    int passes = taken_over.passes();
    int previous = 0;
    for (const double wanted : {1e-3, 1e-6, 1e-9}) {
        auto f = load;
        const double said = taken_over.solve_forces_until(
            f, {}, [&](std::span<const double>, double error) { return error <= wanted * largest(solution); });
        BOOST_TEST(said > 0);
        BOOST_TEST(said <= wanted * largest(solution));
        double off = 0;
        for (std::size_t l = 0; l < f.size(); ++l) {
            off = std::max(off, std::abs(f[l] - solution[l]));
        }
        BOOST_TEST(off <= 30 * said); // an estimate
        const int needed = taken_over.passes() - passes;
        BOOST_TEST(needed > previous);
        previous = needed;
        passes = taken_over.passes();
    }
    auto never = load;
    BOOST_TEST(taken_over.solve_forces_until(never, {}, [](std::span<const double>, double) { return false; }) == 0);
    BOOST_TEST(largest(never) == largest(solution), boost::test_tools::tolerance(1e-11));
}

BOOST_AUTO_TEST_SUITE_END()
