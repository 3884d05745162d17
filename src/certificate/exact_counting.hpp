#pragma once
/// \file
/// Exact counting of any contact list of stored coordinates.

#include <isostat/contact/state.hpp>
#include <isostat/rigidity/counting.hpp>

namespace isostat {

/// `count_contacts`; when its rank is only a lower bound and the matrix is small, the rank from a kernel that was
/// checked in rationals (`exact::kernel`): then `rank_exact` is `proved`.
Counting exact_counting(const State& state);

} // namespace isostat
