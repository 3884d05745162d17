#pragma once
/// \file
/// Work that is counted later, or not at all: private to the room.

#include "core/work.hpp"

#include <array>

namespace isostat {

using WorkCounts = std::array<long, work_kinds>;

/// While it lives this thread counts its work there (null: for the process).
class CountingIn {
  public:
    explicit CountingIn(WorkCounts* counts) : before_(count_work_in(counts)) {}
    CountingIn(const CountingIn&) = delete;
    CountingIn& operator=(const CountingIn&) = delete;
    ~CountingIn() { count_work_in(before_); }

  private:
    WorkCounts* before_;
};

inline void add(WorkCounts& to, const WorkCounts& counts) {
    for (std::size_t k = 0; k < work_kinds; ++k) {
        to[k] += counts[k];
    }
}

/// Counts them after all.
inline void count_all(const WorkCounts& counts) {
    for (std::size_t k = 0; k < work_kinds; ++k) {
        if (counts[k] != 0) {
            count_work(static_cast<Work>(k), counts[k]);
        }
    }
}

} // namespace isostat
