#pragma once
/// \file
/// Numbers as words of files and of the command line.

#include <cstdint>
#include <optional>
#include <string_view>

namespace isostat {

/// A finite number, all of the word; a sign + may stand before it.
std::optional<double> finite_number(std::string_view word);

/// The same as programs write it: D or d may begin the exponent (Fortran).
std::optional<double> written_number(std::string_view word);

/// An integer as one writes it: digits, a sign - before them where it is needed, no zeros in front.
std::optional<std::int64_t> plain_integer(std::string_view word);

} // namespace isostat
