#pragma once
// Two numbers in one register: private to the room.

#include <cstring>

namespace isostat {

using Two = double __attribute__((vector_size(16)));

inline Two two_at(const double* v) {
    Two two;
    std::memcpy(&two, v, sizeof two);
    return two;
}

} // namespace isostat
