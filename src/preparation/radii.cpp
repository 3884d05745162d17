#include "core/refuse.hpp"
#include "preparation/random.hpp"

#include <isostat/preparation/preparation.hpp>

#include <boost/multiprecision/mpfr.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace isostat {

namespace {

using preparation::Uniform;

/// The digits suffice for the inverse of a power law, where 1 - exponent may be as small as 2^-53 and is a divisor.
/// Logarithms and exponentials are computed with these digits and rounded once: the same bits on every machine.
using Precise =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<60>, boost::multiprecision::et_off>;

bool positive(double value) {
    return value > 0 && std::isfinite(value);
}

double logarithm(double x) {
    return log(Precise(x)).convert_to<double>();
}

double exponential(double x) {
    return exp(Precise(x)).convert_to<double>();
}

/// Standard normal number by Marsaglia's polar method (SIAM Review 6, 1964); the second number of a pair is not used.
double normal(Uniform& uniform) {
    double a = 0;
    double s = 0;
    do {
        a = 2 * uniform() - 1;
        const double b = 2 * uniform() - 1;
        s = a * a + b * b;
    } while (!(s > 0 && s < 1));
    return a * std::sqrt(-2 * logarithm(s) / s);
}

/// smallest x exp(t), t = ln(1 + u (exp(m ln r) - 1)) / m with r = largest / smallest, m = 1 - exponent; t = u ln r for
/// m = 0.
double power_law(const DiameterLaw& law, double u) {
    const Precise range = log(Precise(law.largest) / law.smallest);
    const Precise m = Precise(1) - law.exponent;
    const Precise t = m == 0 ? Precise(u * range) : Precise(log1p(u * expm1(m * range)) / m);
    return Precise(law.smallest * exp(t)).convert_to<double>();
}

double draw(const DiameterLaw& law, Uniform& uniform) {
    switch (law.kind) {
    case RadiiLaw::uniform: return law.smallest + (law.largest - law.smallest) * uniform();
    case RadiiLaw::lognormal: return law.diameter * exponential(law.deviation * normal(uniform));
    case RadiiLaw::normal: return law.diameter * (1 + law.deviation * normal(uniform));
    case RadiiLaw::power: return power_law(law, uniform());
    case RadiiLaw::equal:
    case RadiiLaw::bidisperse: break; // this law draws no number
    }
    return law.diameter;
}

/// The fault of a cut whose interval is shorter than one deviation, or does not contain the middle; else empty.
std::string fault_of_cut(const DiameterLaw& law) {
    if (!(law.smallest <= law.diameter && law.diameter <= law.largest)) {
        return fmt::format("diameter is {}: expected one from {} to {}, where the law is cut", law.diameter,
                           law.smallest, law.largest);
    }
    const double widest = law.kind == RadiiLaw::normal ? (law.largest - law.smallest) / law.diameter
                                                       : logarithm(law.largest / law.smallest);
    if (!(law.deviation <= widest)) {
        return fmt::format("deviation is {}: expected at most {}, for a law that is cut at {} and {}", law.deviation,
                           widest, law.smallest, law.largest);
    }
    return "";
}

} // namespace

std::string fault_of(const DiameterLaw& law) {
    const bool one = law.kind == RadiiLaw::equal || law.kind == RadiiLaw::bidisperse;
    const bool cut = law.kind == RadiiLaw::lognormal || law.kind == RadiiLaw::normal;
    if (!one && !positive(law.smallest)) {
        return fmt::format("smallest diameter is {}: expected a positive finite number", law.smallest);
    }
    if (!one && (!(law.largest >= law.smallest) || !std::isfinite(law.largest))) {
        return fmt::format("largest diameter is {}: expected a finite number that is not below the smallest, {}",
                           law.largest, law.smallest);
    }
    for (const auto& [name, value, used] : {std::tuple{"diameter", law.diameter, one || cut},
                                            {"deviation", law.deviation, cut},
                                            {"ratio", law.ratio, law.kind == RadiiLaw::bidisperse}}) {
        if (used && !positive(value)) {
            return fmt::format("{} is {}: expected a positive finite number", name, value);
        }
    }
    if (law.kind == RadiiLaw::bidisperse && !(law.fraction >= 0 && law.fraction <= 1)) {
        return fmt::format("fraction is {}: expected a number from 0 to 1", law.fraction);
    }
    if (law.kind == RadiiLaw::power && !std::isfinite(law.exponent)) {
        return fmt::format("exponent is {}: expected a finite number", law.exponent);
    }
    return cut ? fault_of_cut(law) : "";
}

std::vector<double> draw_radii(const DiameterLaw& law, int count, std::uint64_t seed) {
    std::string fault = fault_of(law);
    if (fault.empty() && count < 1) {
        fault = fmt::format("number of disks is {}: expected at least 1", count);
    }
    if (!fault.empty()) {
        refuse("preparation", fault);
    }
    const bool cut = law.kind == RadiiLaw::lognormal || law.kind == RadiiLaw::normal;
    Uniform uniform(preparation::derived_seed(seed, preparation::Stream::radii));
    std::vector<double> radius(static_cast<std::size_t>(count));
    for (double& r : radius) {
        double d = draw(law, uniform);
        while (cut && !(law.smallest <= d && d <= law.largest)) {
            d = draw(law, uniform);
        }
        r = d / 2;
    }
    if (law.kind == RadiiLaw::bidisperse) {
        const auto large = static_cast<std::size_t>(std::floor(law.fraction * count + 0.5));
        std::fill(radius.end() - static_cast<std::ptrdiff_t>(large), radius.end(), law.ratio * law.diameter / 2);
    }
    return radius;
}

std::vector<double> with_jitter(std::vector<double> radius, double size, std::uint64_t seed) {
    Uniform uniform(preparation::derived_seed(seed, preparation::Stream::jitter));
    for (double& r : radius) {
        r += r * (size * (2 * uniform() - 1));
    }
    return radius;
}

} // namespace isostat
