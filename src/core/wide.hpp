#pragma once
/// \file
/// Four numbers at a time where the processor can. The operations are the same everywhere and never contracted
/// (compiler options of the project), hence the bits are the same with and without.

#include <cstring>

/// Marks a function that is compiled for each kind of processor; the version is chosen when the program starts. Not
/// under ThreadSanitizer, because resolvers of clones run before it is ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define ISOSTAT_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define ISOSTAT_WIDE
#endif
/// Marks helpers of such functions, which take the processor of the function that calls them.
#define ISOSTAT_WITHIN_WIDE __attribute__((always_inline)) inline

namespace isostat {

using Wide = double __attribute__((vector_size(32))); // exact: bytes of four doubles

// The argument is a reference because how a Wide is passed by value depends on the processor.
ISOSTAT_WITHIN_WIDE void read(Wide& to, const double* from) {
    std::memcpy(&to, from, sizeof to);
}
ISOSTAT_WITHIN_WIDE void write(double* to, const Wide& from) {
    std::memcpy(to, &from, sizeof from);
}

/// Two numbers in one register.
using Two = double __attribute__((vector_size(16))); // exact: bytes of two doubles

inline Two two_at(const double* v) {
    Two two;
    std::memcpy(&two, v, sizeof two);
    return two;
}

} // namespace isostat
