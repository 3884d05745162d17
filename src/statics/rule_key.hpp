#pragma once
// What the opening rules compare, in any arithmetic.

#include "statics/decisions.hpp"

#include <isostat/core/verdict.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace isostat {

/// a / b, for b > 0; a radius of infinity when that is not proved.
Enclosure quotient(const Enclosure& a, const Enclosure& b);
inline double quotient(double a, double b) {
    return a / b;
}
inline Enclosure opposite(const Enclosure& a) {
    return {-a.value, a.radius};
}
inline double opposite(double a) {
    return -a;
}

/// The contact with the smallest key opens. `force`: that is negative, of a held coordinate minus its magnitude;
/// `norm()`: of the mechanism that opens the contact at unit rate.
template <class Number, class Norm> Number rule_key(OpeningRule rule, const Number& force, Norm norm) {
    return rule == OpeningRule::least_negative ? opposite(force)
           : rule == OpeningRule::steepest     ? quotient(force, norm())
                                               : force;
}

/// Of rules that compare no numbers: the place, among `count` contacts sorted by their names, of the one that opens.
inline std::optional<std::size_t> rule_place(OpeningRule rule, std::size_t count, std::uint64_t random_bits) {
    return rule == OpeningRule::random        ? std::optional<std::size_t>(random_bits % count)
           : rule == OpeningRule::least_index ? std::optional<std::size_t>(0)
                                              : std::nullopt;
}

} // namespace isostat
