#pragma once
/// \file
/// Bad input is refused in one way: by its place, and by what was expected there.

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <string>
#include <utility>

namespace isostat {

/// Throws `Error(bad_input)`: "WHERE: WHAT".
[[noreturn]] void refuse(const std::string& where, const std::string& what);
template <class... Values>
[[noreturn]] void refuse(const std::string& where, fmt::format_string<Values...> what, Values&&... values) {
    refuse(where, fmt::format(what, std::forward<Values>(values)...));
}

/// Throws an error whose place is in the words already, or an error of usage.
template <class... Values>
[[noreturn]] void refuse(ErrorKind kind, fmt::format_string<Values...> what, Values&&... values) {
    throw Error(kind, fmt::format(what, std::forward<Values>(values)...));
}

} // namespace isostat
