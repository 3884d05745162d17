#pragma once
/// \file
/// Results of proved comparisons, and limits of their precision.

#include <isostat/core/result.hpp>

#include <limits>

namespace isostat {

/// The precision that a ladder may climb to.
struct LadderOptions {
    /// Relative accuracy, estimated, of the first solutions with reused factors. The first climb improves them to
    /// rounding, still on the rung double. 0: to rounding at once, as with fresh factors.
    double first_accuracy = 0;
    int first_bits = 256; ///< bits of the first rung in MPFR; doubled on every climb; cost: first bits of a climb
    // cost: then undecided
    int max_bits = 4096; ///< cap: a comparison undecided there is a tie "to max_bits bits", unless exact
    // cost: larger systems are not solved exactly
    int exact_size = 2000; ///< largest N_f for exact numbers (0.04 s at 200, 1 s at 800, grows like N_f^2.5)
};

/// Result of a comparison: the sign of a quantity or of a difference.
struct Order {
    bool decided = false; ///< false: undecided at the precision reached; `sign` then means nothing
    int sign = 0;         ///< -1, 0 or +1; 0 is *proved*: both sides are exactly equal
    double margin = 0;    ///< |centre| / radius of the enclosure that decided; infinite for exact numbers
    Rung rung = Rung::none;
    int bits = 0; ///< of the arithmetic: 53, 106, those of MPFR, or 0 for exact numbers
    /// Without a sign (undecided, or 0): log2 of a proved bound of |quantity|, -infinity when it is exactly 0.
    double exponent = std::numeric_limits<double>::infinity();
};

/// Bits, below the size of the terms, to which two quantities must agree to count as tied without an exact zero.
inline constexpr int tie_bits = 1000; // choice: what perturbation.md calls a tie

/// A tie: proved to be exactly 0, or to be smaller than `size` 2^-tie_bits. `size` > 0: size of the terms.
bool is_tie(const Order& order, double size);

} // namespace isostat
