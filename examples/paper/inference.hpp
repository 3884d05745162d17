#pragma once
/// \file
/// Estimates with confidence intervals from independent samples. Every interval names its method and what it assumes.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace isostat {

/// An estimate and a confidence interval [low, high]. NaN: the data do not give one.
struct Estimate {
    double value = 0;
    double low = 0;
    double high = 0;
};

/// Mean of independent values, interval of Student's t (exact for normal values, approximate for many; Boost.Math
/// students_t). NaN ends for fewer than two values.
Estimate mean_with_t(std::span<const double> values, double level);

/// Rate of events: `count` of them in a total `exposure`; the exact interval for a Poisson count (Garwood; quantiles of
/// the gamma distribution by Boost.Math). It is too narrow when events cluster.
Estimate poisson_rate(long count, double exposure, double level);

/// Probability from `successes` of `trials`: Clopper-Pearson (Boost.Math binomial), never too narrow.
Estimate proportion(long successes, long trials, double level);

/// Exponent a of a density ~ x^-a on [low, high], by maximum likelihood from the values inside (others are ignored).
/// The equation of the mean of log(x) has one root (it is monotone in a), found by Boost.Math toms748. NaN for fewer
/// than two values or when all are equal. No interval: use `bootstrap`. \pre 0 < low < high
double truncated_power_law(std::span<const double> values, double low, double high);

/// Largest distance between the distribution of the values in [low, high] and the truncated power law of exponent a.
double power_law_distance(std::span<const double> values, double low, double high, double a);

/// Largest distance between the distribution of positive values and the exponential of the same mean.
double exponential_distance(std::span<const double> values);
/// Probability of such a distance or a larger one for independent exponential values (their mean estimated too, after
/// Lilliefors), from `replicates` simulations; resolution 1 / replicates. Deterministic in `seed`.
double exponential_p_value(std::span<const double> values, int replicates, std::uint64_t seed);

/// Straight line y = intercept + slope x with weights.
struct Line {
    double intercept = 0;
    double slope = 0;
};
/// Weighted least squares; NaN unless two x differ.
Line fit_line(std::span<const double> x, std::span<const double> y, std::span<const double> weight);

/// Quantity that is computed from chosen samples: argument g, indices of the samples of group g, repetitions allowed.
using Statistic = std::function<double(const std::vector<std::vector<std::size_t>>&)>;

/// Percentile bootstrap over whole samples: values within one sample may depend on each other, samples must not. The
/// samples of each group (a system size) are drawn with replacement, `replicates` times; `value` is that of all samples
/// once. Replicates where the statistic is NaN are left out; NaN ends when more than one in ten are, or a group has
/// fewer than two samples. Deterministic in `seed`. Too narrow for few samples per group (5: by about a fifth).
Estimate bootstrap(const std::vector<std::size_t>& group_sizes, const Statistic& statistic, int replicates,
                   std::uint64_t seed, double level);

} // namespace isostat
