#pragma once
/// \file
/// Answers of proved comparisons, and how far they may climb.

#include <isostat/core/verdict.hpp>

#include <limits>

namespace isostat {

/// How far a ladder may climb.
struct LadderOptions {
    /// Of the first solutions, with factors taken over: relative, estimated. They are improved to rounding, still on
    /// the rung double, by the first climb. 0: at rounding at once, as with fresh factors.
    double first_accuracy = 0;
    int first_bits = 256;  ///< of the first rung in MPFR; doubled on every climb
    int max_bits = 4096;   ///< cap: a comparison that is open there is a tie "to max_bits bits", unless exact
    int exact_size = 2000; ///< largest N_f for exact numbers (0.04 s at 200, 1 s at 800, grows like N_f^2.5)
};

/// Answer of a comparison: the sign of a quantity or of a difference.
struct Order {
    bool decided = false; ///< false: open at the precision reached; `sign` says nothing
    int sign = 0;         ///< -1, 0 or +1; 0 is *proved*: both sides are exactly equal
    double margin = 0;    ///< |centre| / radius of the enclosure that decided; infinite for exact numbers
    Rung rung = Rung::none;
    int bits = 0; ///< of the arithmetic: 53, 106, those of MPFR, or 0 for exact numbers
    /// Without a sign (undecided, or 0): log2 of a proved bound of |quantity|, -infinity when it is exactly 0.
    double exponent = std::numeric_limits<double>::infinity();
};

/// Bits below the size of the terms to which two quantities must agree to be called tied when no exact number says so.
inline constexpr int tie_bits = 1000;

/// A tie: proved to be exactly 0, or to be smaller than `size` 2^-tie_bits. `size` > 0 is that of the terms.
bool is_tie(const Order& order, double size);

} // namespace isostat
