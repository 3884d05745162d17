#include "inference.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/roots.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace isostat {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Uniform in [0, 1) with 53 bits, the same with every standard library.
double uniform(std::mt19937_64& engine) {
    return static_cast<double>(engine() >> 11U) * 0x1p-53;
}

std::vector<double> logarithms_inside(std::span<const double> values, double low, double high) {
    std::vector<double> list;
    for (const double v : values) {
        if (v >= low && v <= high) {
            list.push_back(std::log(v / low));
        }
    }
    return list;
}

/// Mean of u in [0, width] with density ~ exp(b u).
double mean_of_tilted(double b, double width) {
    const double t = b * width;
    constexpr double flat = 1e-4; // the series has an error below t^3 there
    return width * (std::abs(t) < flat ? 0.5 + t / 12 : -1 / std::expm1(-t) - 1 / t);
}

/// Distribution function of the same.
double tilted_distribution(double u, double b, double width) {
    constexpr double flat = 1e-12;
    return std::abs(b * width) < flat ? u / width : std::expm1(b * u) / std::expm1(b * width);
}

double sum_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Largest distance of the empirical distribution of sorted values from a distribution function.
template <class Distribution> double distance(const std::vector<double>& sorted, const Distribution& f) {
    const auto n = static_cast<double>(sorted.size());
    double largest = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const double at = f(sorted[i]);
        largest = std::max({largest, at - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - at});
    }
    return largest;
}

} // namespace

Estimate mean_with_t(std::span<const double> values, double level) {
    const auto n = static_cast<double>(values.size());
    if (values.empty()) {
        return {none, none, none};
    }
    const double mean = sum_of(values) / n;
    if (values.size() < 2) {
        return {mean, none, none};
    }
    double squares = 0;
    for (const double v : values) {
        squares += (v - mean) * (v - mean);
    }
    const boost::math::students_t law(n - 1);
    const double half = boost::math::quantile(law, (1 + level) / 2) * std::sqrt(squares / (n - 1) / n);
    return {mean, mean - half, mean + half};
}

Estimate poisson_rate(long count, double exposure, double level) {
    const double tail = (1 - level) / 2;
    const auto k = static_cast<double>(count);
    const double low = count == 0 ? 0 : boost::math::quantile(boost::math::chi_squared(2 * k), tail) / 2;
    const double high = boost::math::quantile(boost::math::chi_squared(2 * k + 2), 1 - tail) / 2;
    return {k / exposure, low / exposure, high / exposure};
}

Estimate proportion(long successes, long trials, double level) {
    if (trials == 0) {
        return {none, 0, 1};
    }
    using Law = boost::math::binomial;
    const double tail = (1 - level) / 2;
    const auto k = static_cast<double>(successes);
    const auto n = static_cast<double>(trials);
    return {k / n, Law::find_lower_bound_on_p(n, k, tail), Law::find_upper_bound_on_p(n, k, tail)};
}

double truncated_power_law(std::span<const double> values, double low, double high) {
    assert(low > 0 && high > low);
    const std::vector<double> u = logarithms_inside(values, low, high);
    const double width = std::log(high / low);
    const double mean = u.empty() ? 0 : sum_of(u) / static_cast<double>(u.size());
    if (u.size() < 2 || std::all_of(u.begin(), u.end(), [&](double x) { return x == u.front(); }) || !(mean > 0) ||
        !(mean < width)) {
        return none;
    }
    // density of x ~ x^-a: of u = log(x / low) ~ exp((1 - a) u)
    const auto f = [&](double b) { return mean_of_tilted(b, width) - mean; };
    double reach = 1 / width;
    while (f(-reach) > 0 || f(reach) < 0) {
        reach *= 2;
    }
    std::uintmax_t iterations = 200;
    const auto [left, right] =
        boost::math::tools::toms748_solve(f, -reach, reach, boost::math::tools::eps_tolerance<double>(40), iterations);
    return 1 - (left + right) / 2;
}

double power_law_distance(std::span<const double> values, double low, double high, double a) {
    std::vector<double> u = logarithms_inside(values, low, high);
    std::sort(u.begin(), u.end());
    const double width = std::log(high / low);
    return distance(u, [&](double x) { return tilted_distribution(x, 1 - a, width); });
}

double exponential_distance(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const double mean = sum_of(sorted) / static_cast<double>(sorted.size());
    return distance(sorted, [&](double x) { return -std::expm1(-x / mean); });
}

double exponential_p_value(std::span<const double> values, int replicates, std::uint64_t seed) {
    const double measured = exponential_distance(values);
    std::mt19937_64 engine(seed);
    std::vector<double> drawn(values.size());
    int beyond = 0;
    for (int r = 0; r < replicates; ++r) {
        for (double& x : drawn) {
            x = -std::log1p(-uniform(engine));
        }
        beyond += exponential_distance(drawn) >= measured ? 1 : 0;
    }
    return static_cast<double>(beyond) / replicates;
}

Line fit_line(std::span<const double> x, std::span<const double> y, std::span<const double> weight) {
    assert(x.size() == y.size() && x.size() == weight.size());
    double w = 0;
    double mx = 0;
    double my = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        w += weight[i];
        mx += weight[i] * x[i];
        my += weight[i] * y[i];
    }
    mx /= w;
    my /= w;
    double xx = 0;
    double xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += weight[i] * (x[i] - mx) * (x[i] - mx);
        xy += weight[i] * (x[i] - mx) * (y[i] - my);
    }
    if (!(xx > 0)) {
        return {none, none};
    }
    return {my - xy / xx * mx, xy / xx};
}

Estimate bootstrap(const std::vector<std::size_t>& group_sizes, const Statistic& statistic, int replicates,
                   std::uint64_t seed, double level) {
    std::vector<std::vector<std::size_t>> chosen(group_sizes.size());
    for (std::size_t g = 0; g < group_sizes.size(); ++g) {
        chosen[g].resize(group_sizes[g]);
        std::iota(chosen[g].begin(), chosen[g].end(), std::size_t{0});
    }
    Estimate estimate{statistic(chosen), none, none};
    if (std::any_of(group_sizes.begin(), group_sizes.end(), [](std::size_t size) { return size < 2; })) {
        return estimate;
    }
    std::mt19937_64 engine(seed);
    std::vector<double> values;
    for (int r = 0; r < replicates; ++r) {
        for (std::size_t g = 0; g < group_sizes.size(); ++g) {
            for (std::size_t& sample : chosen[g]) {
                sample = static_cast<std::size_t>(uniform(engine) * static_cast<double>(group_sizes[g]));
            }
        }
        const double value = statistic(chosen);
        if (!std::isnan(value)) {
            values.push_back(value);
        }
    }
    if (10 * values.size() < 9 * static_cast<std::size_t>(replicates)) {
        return estimate;
    }
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
        const double position = share * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(position);
        const double part = position - static_cast<double>(below);
        return values[below] + part * (values[std::min(below + 1, values.size() - 1)] - values[below]);
    };
    estimate.low = at((1 - level) / 2);
    estimate.high = at((1 + level) / 2);
    return estimate;
}

} // namespace isostat
