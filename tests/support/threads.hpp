#pragma once
// A number of threads for one scope: back to one when it ends, however it ends.

#include <isostat/core/machine.hpp>

struct Threads {
    explicit Threads(int count) { isostat::set_threads(count); }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;
    ~Threads() { isostat::set_threads(1); }
};
