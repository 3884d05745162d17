#pragma once
/// \file
/// What reader and writer of certificates share.

#include "io/json.hpp"

#include <isostat/core/verdict.hpp>

#include <array>
#include <string>

namespace isostat::json {

/// The rungs that can settle a claim, by their words.
inline constexpr std::array<Rung, 5> settling_rungs{Rung::combinatorial, Rung::double_bound, Rung::double_double,
                                                    Rung::multiprecision, Rung::exact};

/// SHA-256 of a document without its field "digest", dumped without white space and with sorted keys.
std::string digest_of(const Json& document);

} // namespace isostat::json
