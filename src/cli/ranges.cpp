#include "cli/ranges.hpp"

#include "io/numbers.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace isostat::cli::ranges {

namespace {

/// Replaces the word by the shortest one of its value, which CLI11 reads as this program does.
template <class T>
CLI::Validator validator(const char* kind, T low, T high, std::optional<T> (*value_in)(std::string_view, T, T)) {
    const std::string range = fmt::format("{} from {} to {}", kind, low, high);
    return {[=](std::string& word) {
                const std::optional<T> value = value_in(word, low, high);
                std::string wrong = value ? "" : "is " + word + ": expected " + range;
                word = value ? fmt::format("{}", *value) : word;
                return wrong;
            },
            range};
}

template <class T> std::optional<T> within(std::optional<T> value, T low, T high) {
    return value && *value >= low && *value <= high ? value : std::nullopt;
}

} // namespace

CLI::Validator number(double low, double high) {
    return validator("a number", low, high, &number_in);
}

CLI::Validator integer(std::int64_t low, std::int64_t high) {
    return validator("an integer", low, high, &integer_in);
}

std::optional<double> number_in(std::string_view word, double low, double high) {
    return within(finite_number(word), low, high);
}

std::optional<std::int64_t> integer_in(std::string_view word, std::int64_t low, std::int64_t high) {
    return within(plain_integer(word), low, high);
}

} // namespace isostat::cli::ranges
