#include "io/numbers.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>

namespace isostat {

namespace {

template <class T> std::optional<T> parsed(std::string_view word) {
    T value{};
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

} // namespace

std::optional<double> finite_number(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) {
        word.remove_prefix(1);
    }
    const auto value = parsed<double>(word);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> written_number(std::string_view word) {
    const std::size_t d = word.find_first_of("dD");
    if (d == std::string_view::npos) {
        return finite_number(word);
    }
    std::string plain(word);
    plain[d] = 'e';
    return finite_number(plain);
}

std::optional<std::int64_t> plain_integer(std::string_view word) {
    const auto value = parsed<std::int64_t>(word);
    return value && fmt::format("{}", *value) == word ? value : std::nullopt;
}

} // namespace isostat
