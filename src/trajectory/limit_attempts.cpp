#include "trajectory/limit_attempts.hpp"

#include "core/roundoff.hpp"

#include <cmath>

namespace isostat {

using roundoff::infinity;

Result<Reached> LimitAttempts::begin(Attempt& attempt) {
    RunCounters& counters = recorder_.counters;
    const RunCounters before = counters;
    auto reached = follow_(attempt);
    if (!attempt.in_vain(reached) || recorder_.options.at_first_order()) {
        return reached;
    }
    if (const auto stress = beyond()) {
        counters = before;
        attempt.at.set_stress(*stress);
        reached = follow_(attempt);
    }
    return reached;
}

/// The first double beyond the limit; nothing: the limit is not known to within one double. The double nearest to the
/// limit may lie before the limit, where the force that opens is still positive by a rounding: the potential then grows
/// along the first part of the arc, which is as short as that rounding.
std::optional<double> LimitAttempts::beyond() {
    auto found = find_limit(statics_, sigma_, direction_, nullptr);
    const auto known = [&] {
        const double size = std::abs(found.value().stress);
        return found.value().stress_error <= std::nextafter(size, infinity) - size;
    };
    while (found.ok() && !known() && statics_.climb()) {
        found = find_limit(statics_, sigma_, direction_, nullptr);
    }
    if (!found.ok() || !known()) {
        return std::nullopt;
    }
    return std::nextafter(found.value().stress + direction_ * found.value().stress_error, direction_ * infinity);
}

} // namespace isostat
