// These functions are not in the header because a user's compiler may have other flags.
#include <isostat/core/result.hpp>

namespace isostat {

Enclosure operator-(const Enclosure& a, const Enclosure& b) {
    const double value = a.value - b.value;
    return {value, (a.radius + b.radius + 0x1p-52 * std::abs(value)) * (1 + 0x1p-50)}; // precision.md B9
}

} // namespace isostat
