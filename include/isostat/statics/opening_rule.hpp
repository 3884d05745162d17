#pragma once
/// \file
/// Which contact opens where forces are negative.

#include <array>
#include <cstdint>

namespace isostat {

/// Which contact with a negative force is opened during a rearrangement. The paper's rule is `most_negative`.
/// - most_negative: smallest f;  - steepest: smallest f / |v|, v the mechanism that opens the contact at unit rate;
/// - random: uniformly among f < 0;  - least_negative: largest f < 0;  - least_index: the first f < 0 in the order of
/// contacts (disks by their numbers, then walls, then held coordinates). It compares no forces, so that equal ones are
/// no tie. With linear programmes it is the rule of Bland (Math. Oper. Res. 2, 103, 1977).
/// In all of them a held coordinate competes with -|multiplier|, and infinitesimal forces decide only when no finite
/// force is negative.
enum class OpeningRule : std::uint8_t { most_negative, steepest, random, least_negative, least_index };
/// The words of scenes, in that order.
inline constexpr std::array opening_rule_words{"most_negative", "steepest", "random", "least_negative", "least_index"};

} // namespace isostat
