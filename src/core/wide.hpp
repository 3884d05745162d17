#pragma once
/// \file
/// Four numbers at a time where the processor can. The same operations everywhere and no contraction (compiler options
/// of the project), hence the same bits with and without.

#include <cstring>

/// For functions: a version for each kind of processor, chosen when the program starts. Not under ThreadSanitizer:
/// resolvers of clones run before it is ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define ISOSTAT_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define ISOSTAT_WIDE
#endif
/// For what such functions are made of: it takes the processor of the function that it is in.
#define ISOSTAT_WITHIN_WIDE __attribute__((always_inline)) inline

namespace isostat {

using Wide = double __attribute__((vector_size(32)));

// By reference: how a Wide is passed by value depends on the processor.
ISOSTAT_WITHIN_WIDE void read(Wide& to, const double* from) {
    std::memcpy(&to, from, sizeof to);
}
ISOSTAT_WITHIN_WIDE void write(double* to, const Wide& from) {
    std::memcpy(to, &from, sizeof from);
}

} // namespace isostat
