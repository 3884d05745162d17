#include "core/decimal.hpp"

#include <fmt/format.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace isostat {

namespace {

std::string rounded(double value, int digits, const char* format) {
    if (!std::isfinite(value)) {
        return fmt::format("{}", value);
    }
    mpfr_t exact;
    mpfr_init2(exact, 53); // exact: bits of a double
    mpfr_set_d(exact, value, MPFR_RNDN);
    char* text = nullptr;
    mpfr_asprintf(&text, format, digits, exact);
    std::string result(text);
    mpfr_free_str(text);
    mpfr_clear(exact);
    return result;
}

} // namespace

std::string rounded_up(double value, int digits) {
    return rounded(value, digits, "%.*RUg");
}

std::string rounded_down(double value, int digits) {
    return rounded(value, digits, "%.*RDg");
}

std::string with_bound(double lower, double upper) {
    constexpr int enough = 17;                       // exact: so many digits distinguish all doubles
    const double middle = 0.5 * lower + 0.5 * upper; // exact: a half
    for (int digits = 12;; ++digits) {               // message: digits, or more
        const std::string shown = fmt::format("{:.{}g}", middle, digits);
        const double value = std::strtod(shown.c_str(), nullptr);
        // The text itself differs from its double by up to half a unit of the last place.
        const double off = std::abs(value) * 0x1p-53; // exact: half a unit of the last place of what is printed
        // exact: above the rounding of a sum and a product
        const double bound = (std::max(upper - value, value - lower) + off) * (1 + 0x1p-50);
        // message: shares of a width that a printed bound may take
        if (digits == enough || bound <= 0.75 * (upper - lower)) {
            return fmt::format("{} +- {}", shown, rounded_up(bound, 2));
        }
    }
}

} // namespace isostat
