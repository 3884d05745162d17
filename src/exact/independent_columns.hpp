#pragma once
/// \file
/// The first independent columns of a matrix over the prime field.

#include "sparse/pattern.hpp"

#include <cstdint>
#include <vector>

namespace isostat::exact {

/// Columns that are independent mod 2^61 - 1 of the columns before them, in increasing order:
/// their number is the rank mod p, and they are independent over Q (statement T4). Other columns
/// are dependent mod p, which proves nothing over Q. Rows are eliminated sparsest column entry
/// first; cost grows with the fill of the natural column order, so this is for inspection.
std::vector<int> independent_columns(const sparse::Matrix<std::uint64_t>& matrix);

} // namespace isostat::exact
