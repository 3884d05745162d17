#include "bench/shared/sample.hpp"

#include <algorithm>
#include <cassert>
#include <ctime>
#include <limits>

namespace bench {

namespace {
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
}

namespace {
double milliseconds_of(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}
} // namespace

double cpu_milliseconds() {
    return milliseconds_of(CLOCK_THREAD_CPUTIME_ID);
}

double process_milliseconds() {
    return milliseconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

double wall_milliseconds() {
    return milliseconds_of(CLOCK_MONOTONIC);
}

double Sample::median() const {
    std::vector<double> x = values_;
    std::ranges::sort(x);
    const std::size_t half = x.size() / 2;
    return x.empty() ? nothing : x.size() % 2 == 1 ? x[half] : 0.5 * (x[half - 1] + x[half]);
}

double Sample::low() const {
    return values_.empty() ? nothing : *std::ranges::min_element(values_);
}

double Sample::high() const {
    return values_.empty() ? nothing : *std::ranges::max_element(values_);
}

Sample Sample::over(const Sample& unit) const {
    assert(values_.size() == unit.values_.size());
    Sample quotient;
    for (std::size_t k = 0; k < values_.size(); ++k) {
        quotient.add(values_[k] / unit.values_[k]);
    }
    return quotient;
}

Sample Sample::over(double unit) const {
    return over(Sample(std::vector<double>(values_.size(), unit)));
}

} // namespace bench
