#include "exact/field.hpp"

namespace isostat::exact {

std::uint64_t multiply(std::uint64_t a, std::uint64_t b) {
    return Field<61>::multiply(a, b);
}

std::uint64_t subtract(std::uint64_t a, std::uint64_t b) {
    return a >= b ? a - b : a + mersenne61 - b;
}

std::uint64_t inverse(std::uint64_t a) {
    return Field<61>::inverse(a);
}

std::uint64_t residue(double value) {
    return Field<61>::residue(value);
}

std::uint32_t residue31(double value) {
    return Field<31>::residue(value);
}

} // namespace isostat::exact
