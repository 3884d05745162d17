#pragma once
/// \file
/// What the library requires of the machine: threads, and the arithmetic that every error bound assumes: IEEE double,
/// each operation rounded to nearest, subnormal numbers kept, no product fused into a sum. Headers with numbers include
/// this file, so that compiling with other arithmetic is refused.

#include <cfloat>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) ||                               \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "isostat: -ffast-math and its parts break every error bound: expected a compilation without them"
#endif
#if FLT_EVAL_METHOD != 0
#error                                                                                                                 \
    "isostat: double expressions are computed with more digits here: expected FLT_EVAL_METHOD 0 (-msse2 -mfpmath=sse)"
#endif

namespace isostat {

/// What is wrong with the arithmetic, in words; nullptr when nothing is: rounding to nearest
/// (of the computing unit and as `fegetround` says), subnormal numbers, no more digits than
/// a double has, and the library compiled without contraction. Tests results of operations,
/// not registers, because these differ between processors. Cost: 0.1 microseconds.
const char* floating_point_defect();

/// Throws `Error(internal)` when there is a defect. Called where work begins: by the program, by the readers, by every
/// function that proves something, and by each thread for each piece of work that it takes over.
void require_floating_point();

/// Sets the number of threads of this process, the calling one included: results have the same bits for any number.
/// \pre count >= 1, and no work is going on. Before the first call the number is 1, so that a library does not start
/// threads unasked. Where the system refuses threads, fewer threads do the work.
void set_threads(int count);

/// The number given to `set_threads`.
int threads();

/// Cores that this process may use (its affinity mask), at least 1.
int available_cores();

} // namespace isostat
