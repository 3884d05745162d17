#include "io/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
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

void Digits::see(std::string_view number) {
    const auto value = written_number(number);
    if (!value || *value == 0) {
        return;
    }
    int digits = 0;
    for (const char c : number.substr(0, number.find_first_of("eEdD"))) {
        digits += std::isdigit(static_cast<unsigned char>(c)) != 0 && (digits > 0 || c != '0') ? 1 : 0;
    }
    most_ = std::max(most_, digits);
    largest_ = std::max(largest_, std::abs(*value));
}

void Digits::see(const Digits& others) {
    most_ = std::max(most_, others.most_);
    largest_ = std::max(largest_, others.largest_);
}

double Digits::rounding(int others) const {
    constexpr int few = 4;
    if (largest_ == 0) {
        return 0;
    }
    const double last =
        most_ <= few ? 0 : 0.5 * std::pow(10.0, std::floor(std::log10(largest_)) - std::max(most_, others) + 1);
    return std::max(last, 0x1p-53 * largest_);
}

double rounding_of_gaps(double place, double side, double radius, BoxKind box) {
    constexpr double up = 1 + 0x1p-40;
    // r_a = x_j - x_i + sum A_ab m_b, |m_b| <= 1. A period is a difference of two bounds, in a tilted dump less |A_ab|
    // of the axes after it: with A_ab m_b itself r_a is off by up to 2 and 2 for each of them, (4, 2) and (6, 4, 2).
    const double of_sides = !box.tilted ? 4 : box.dimension == 2 ? std::sqrt(20.0) : std::sqrt(56.0);
    return up * (2 * std::sqrt(static_cast<double>(box.dimension)) * place + of_sides * side + 2 * radius);
}

} // namespace isostat
