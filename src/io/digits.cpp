#include "io/digits.hpp"

#include "io/numbers.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace isostat {

void Digits::see(std::string_view number) {
    const auto value = finite_number(number);
    if (!value || *value == 0) {
        return;
    }
    int digits = 0;
    for (const char c : number.substr(0, number.find_first_of("eE"))) {
        digits += std::isdigit(static_cast<unsigned char>(c)) != 0 && (digits > 0 || c != '0') ? 1 : 0;
    }
    most_ = std::max(most_, digits);
    largest_ = std::max(largest_, std::abs(*value));
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

double rounding_of_gaps(double place, double side, double radius) {
    constexpr double up = 1 + 0x1p-40;
    return up * (2 * std::sqrt(2.0) * place + 4 * side + 2 * radius); // an image: periods and tilt
}

} // namespace isostat
