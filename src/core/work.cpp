#include "core/work.hpp"

#include <atomic>
#include <utility>

namespace isostat {

namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): counters of the process, read by reports only
std::array<std::atomic<long>, work_kinds> counters{};
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
thread_local std::array<long, work_kinds>* elsewhere = nullptr;

} // namespace

void count_work(Work kind, long amount) {
    if (elsewhere != nullptr) {
        (*elsewhere)[static_cast<std::size_t>(kind)] += amount;
    } else {
        counters[static_cast<std::size_t>(kind)].fetch_add(amount, std::memory_order_relaxed);
    }
}

std::array<long, work_kinds>* count_work_in(std::array<long, work_kinds>* counts) {
    return std::exchange(elsewhere, counts);
}

std::array<long, work_kinds> work_done() {
    std::array<long, work_kinds> done{};
    for (std::size_t k = 0; k < work_kinds; ++k) {
        done[k] = counters[k].load(std::memory_order_relaxed);
    }
    return done;
}

} // namespace isostat
