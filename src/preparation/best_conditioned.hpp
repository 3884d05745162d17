#pragma once
/// \file
/// Another list of contacts at a vertex where more pairs touch.

#include <isostat/contact/state.hpp>

#include <optional>
#include <vector>

namespace isostat::preparation {

/// As many of the touching pairs as there are degrees of freedom, with rows as independent as an orthogonal
/// factorisation with column pivoting finds them, because a linear solver may keep contacts whose rows are independent
/// only by rounded coordinates: those of equal disks in line. Nothing: too few pairs touch, their rows are dependent up
/// to rounding, or the packing is too large for full matrices. A guess, which later proofs judge. Cost: N_f^3.
std::optional<std::vector<Contact>> best_conditioned(const Packing& packing);

} // namespace isostat::preparation
