#include "checker/rational.hpp"

namespace isostat::checker {

namespace {

constexpr long digits = 512; ///< of the terms, after the binary point; cost: bits of a logarithm (checker.md K27)
// cost: beyond, the series takes too long, and 0 <= ln x <= x - 1 is used (checker.md K27)
constexpr long widest = 1024;

/// z + z^3/3 + z^5/5 + ... without the remainder, in units of 2^-digits. `terms`: their number.
Integer series(const Integer& z, long& terms) {
    Integer sum = 0;
    Integer power = z;
    for (terms = 0; power > 0; ++terms) {
        sum += power / (2 * terms + 1);
        power = (power * z >> digits) * z >> digits;
    }
    return sum;
}

/// ln x = 2 artanh z, z = (x - 1) / (x + 1). \pre x >= 1
Rational at_most(const Rational& x) {
    long terms = 0;
    return x > widest ? Rational(0) : dyadic(2 * series(floor_of((x - 1) / (x + 1), digits), terms), -digits);
}

Rational at_least(const Rational& x) {
    if (x > widest) {
        return x - 1;
    }
    long terms = 0;
    const Integer sum = series(ceiling_of((x - 1) / (x + 1), digits), terms);
    return dyadic(2 * (sum + 2 * terms + ceiling_of((x + 1) * (x + 1) / x)), -digits);
}

} // namespace

Range logarithm(const Range& x) {
    return {x.lower >= 1 ? at_most(x.lower) : -at_least(1 / x.lower),
            x.upper >= 1 ? at_least(x.upper) : -at_most(1 / x.upper)};
}

} // namespace isostat::checker
