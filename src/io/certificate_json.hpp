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

/// Parses a certificate's text without the freedoms that JSON leaves: a key may not come twice in an object (readers
/// would differ in which one counts), and nesting ends at a depth that no certificate reaches. Throws
/// `Error(bad_input)`.
Json parse_strictly(const std::string& text, const std::string& source);

/// SHA-256 of a document without its field "digest", dumped without white space and with sorted keys.
std::string digest_of(const Json& document);

} // namespace isostat::json
