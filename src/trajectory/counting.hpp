#pragma once
/// \file
/// Work that enters the counts later, or never: private to the room.

#include "core/work.hpp"

#include <array>

namespace isostat {

using WorkCounts = std::array<long, work_kinds>;

/// During the life of this object its thread counts work in `counts` (null: in the counts of the process).
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

/// Adds the counts to those of the process.
inline void count_all(const WorkCounts& counts) {
    for (std::size_t k = 0; k < work_kinds; ++k) {
        if (counts[k] != 0) {
            count_work(static_cast<Work>(k), counts[k]);
        }
    }
}

} // namespace isostat
