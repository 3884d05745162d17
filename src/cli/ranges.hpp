#pragma once
/// \file
/// The ranges of numbers on the command line. Each number must be finite, take up its whole word, and be within its
/// bounds: CLI11's own checks accept nan in any range, and read 010 as 8.

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace CLI { // NOLINT(readability-identifier-naming): a library's
class Validator;
}

namespace isostat::cli::ranges {

constexpr double largest = 1e100; ///< for stresses and stiffnesses, as in scenes
constexpr double smallest = 1 / largest;
constexpr std::int64_t largest_seed = std::numeric_limits<std::int64_t>::max(); ///< as in scenes

CLI::Validator number(double low, double high);
CLI::Validator integer(std::int64_t low, std::int64_t high);

/// A number that is part of a word on the command line; nothing when it is no number or beyond its bounds.
std::optional<double> number_in(std::string_view word, double low = -largest, double high = largest);
std::optional<std::int64_t> integer_in(std::string_view word, std::int64_t low, std::int64_t high);

} // namespace isostat::cli::ranges
