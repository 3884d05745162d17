#pragma once
/// \file
/// Natural logarithms, enclosed.

#include "checker/rational.hpp"

namespace isostat::checker {

/// A narrow range that contains ln of all numbers of the range (K27, proofs/checker.md). \pre x.positive()
Range logarithm(const Range& x);

} // namespace isostat::checker
