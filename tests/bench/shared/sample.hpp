#pragma once
// Repeated measurements: CPU time of the thread, medians and extremes.

#include <vector>

namespace bench {

/// CPU milliseconds of this thread: other processes disturb it little.
double cpu_milliseconds();
/// CPU milliseconds of all threads of this process.
double process_milliseconds();
/// For what several threads do: only a quiet machine measures it.
double wall_milliseconds();

/// Measurements of one quantity, in the order in which they were made. NaN for what an empty one is asked.
class Sample {
  public:
    Sample() = default;
    explicit Sample(std::vector<double> values) : values_(std::move(values)) {}
    void add(double x) { values_.push_back(x); }
    [[nodiscard]] double median() const; ///< of an even number: the mean of the two in the middle
    [[nodiscard]] double low() const;
    [[nodiscard]] double high() const;
    [[nodiscard]] const std::vector<double>& values() const { return values_; }
    /// Repeat by repeat. \pre equal sizes
    [[nodiscard]] Sample over(const Sample& unit) const;
    [[nodiscard]] Sample over(double unit) const;

  private:
    std::vector<double> values_;
};

/// Milliseconds of several calls.
template <class Work> Sample milliseconds(Work work, int repeats = 9) {
    Sample times;
    for (int k = 0; k < repeats; ++k) {
        const double begin = cpu_milliseconds();
        work();
        times.add(cpu_milliseconds() - begin);
    }
    return times;
}

} // namespace bench
