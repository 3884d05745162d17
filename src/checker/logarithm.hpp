#pragma once
/// \file
/// Natural logarithms, enclosed.

#include "checker/rational.hpp"

namespace isostat::checker {

/// Contains ln of all numbers of the range, and hardly more (K27, proofs/checker.md). \pre x.positive()
Range logarithm(const Range& x);

} // namespace isostat::checker
