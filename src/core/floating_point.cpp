#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>

#include <cfenv>
#include <string>

namespace isostat {

namespace {

// The variables are volatile so that the processor executes the operations and not the compiler.

bool rounds_to_nearest() {
    const volatile double one = 1;
    const volatile double half_ulp = 0x1p-53; // 0x1p-53: exact: u, the unit of rounding
    // exact: above half a unit by what an extended format still sees
    const volatile double above_half_ulp = 0x1p-53 + 0x1p-78; // extended precision would round this sum twice, to 1
    const volatile double down = one + half_ulp;
    const volatile double up = one + above_half_ulp;
    return down == 1 && up == 1 + 0x1p-52; // exact: from 1 to the next double
}

bool keeps_subnormals() {
    const volatile double smallest_normal = 0x1p-1022;        // exact: the smallest normal double
    const volatile double half = 0.5;                         // exact: a half
    const volatile double subnormal = smallest_normal * half; // 0 when results are flushed
    return subnormal > 0;                                     // false when operands are
}

bool contracts() {
    const volatile double given = 1 + 0x1p-27;          // exact: a probe whose square is no double
    const volatile double rounded_square = 1 + 0x1p-26; // exact: sum of a probe
    const double x = given;
    const double y = rounded_square;
    const volatile double difference = x * x - y; // 2^-54 when the square is not rounded
    return difference != 0;
}

} // namespace

const char* floating_point_defect() {
    if (std::fegetround() != FE_TONEAREST || !rounds_to_nearest()) {
        return "results are not rounded to nearest";
    }
    if (!keeps_subnormals()) {
        return "subnormal numbers are taken for 0";
    }
    return contracts() ? "products are fused into sums" : nullptr;
}

void require_floating_point() {
    if (const char* const defect = floating_point_defect()) {
        throw Error(ErrorKind::internal,
                    std::string("floating-point arithmetic: ") + defect +
                        ": expected IEEE double, rounded to nearest; nothing can be proved here (another library, or a "
                        "compiler option such as -ffast-math, has changed it)");
    }
}

} // namespace isostat
