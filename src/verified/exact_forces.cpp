#include "verified/exact_forces.hpp"

#include "contact/separation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

/// value = mantissa 2^exponent, mantissa odd or 0.
struct Dyadic {
    mpz_class mantissa;
    long exponent = 0;
};

Dyadic dyadic(const mpq_class& value) {
    Dyadic result{value.get_num(), 0};
    if (result.mantissa != 0) {
        const auto zeros = mpz_scan1(result.mantissa.get_mpz_t(), 0);
        result.mantissa >>= zeros;
        // The denominator is a power of two.
        result.exponent = static_cast<long>(zeros) - static_cast<long>(mpz_scan1(value.get_den_mpz_t(), 0));
    }
    return result;
}

/// Integers value 2^-shift with the largest common shift; returns the shift (0 when all are 0).
long common_integers(const std::vector<mpq_class>& values, std::vector<mpz_class>& integers) {
    std::vector<Dyadic> parts;
    long shift = std::numeric_limits<long>::max();
    for (const mpq_class& value : values) {
        parts.push_back(dyadic(value));
        if (parts.back().mantissa != 0) {
            shift = std::min(shift, parts.back().exponent);
        }
    }
    integers.clear();
    for (const Dyadic& part : parts) {
        integers.push_back(part.mantissa == 0
                               ? mpz_class(0)
                               : mpz_class(part.mantissa << static_cast<mp_bitcnt_t>(part.exponent - shift)));
    }
    return shift == std::numeric_limits<long>::max() ? 0 : shift;
}

} // namespace

sparse::Matrix<mpz_class> ExactForces::scaled(const Packing& packing, const IsostaticStructure& structure,
                                              std::vector<mpz_class>& square) {
    const sparse::Matrix<double>& h = structure.matrix();
    const DofMap& dofs = structure.dofs();
    sparse::Matrix<mpz_class> matrix{h.rows, h.cols, h.start, h.row, {}};
    matrix.value.resize(h.value.size());
    for (std::size_t l = 0; l < structure.contacts().size(); ++l) {
        const Contact& contact = structure.contacts()[l];
        std::vector<mpz_class> integers;
        const Separation separation(contact, packing.layout());
        const bool pair = contact.of_disks();
        mpz_class sum = pair ? 0 : 1;
        if (pair) {
            const auto d =
                separation.of_disks([&](std::size_t k) { return mpq_class(packing.q[k]); },
                                    [](const mpq_class& x, const mpq_class& y) -> mpq_class { return x - y; });
            common_integers(std::vector<mpq_class>(d.begin(), d.end()), integers);
            for (const mpz_class& c : integers) {
                sum += c * c;
            }
        }
        square.push_back(sum);
        PerAxis<mpz_class> normal; // times the square root of `sum`
        std::copy(integers.begin(), integers.end(), normal.begin());
        auto entry = matrix.value.begin() + h.start[l];
        separation.for_each_entry(dofs, normal, [&](int, const mpz_class& value) { *entry++ = value; });
    }
    return matrix;
}

ExactForces::ExactForces(const Packing& packing, const IsostaticStructure& structure)
    : solver_(scaled(packing, structure, square_), structure.ordering()) {}

std::vector<mpq_class> ExactForces::solve(const std::vector<double>& force,
                                          std::span<const ExactProduct> products) const {
    std::vector<mpq_class> values(force.begin(), force.end());
    for (const ExactProduct& product : products) {
        values[static_cast<std::size_t>(product.row)] =
            -((mpq_class(product.a) + product.rest[0] + product.rest[1]) * product.b * product.c);
    }
    std::vector<mpz_class> b;
    const long shift = common_integers(values, b);
    const auto x = solver_.solve(b);
    assert(x && "asked only when regular");
    std::vector<mpq_class> unknown;
    unknown.reserve(b.size());
    for (const mpz_class& numerator : x->numerator) {
        mpq_class value(numerator, x->denominator);
        value.canonicalize();
        if (shift >= 0) {
            value <<= static_cast<mp_bitcnt_t>(shift);
        } else {
            value >>= static_cast<mp_bitcnt_t>(-shift);
        }
        unknown.push_back(std::move(value));
    }
    return unknown;
}

} // namespace isostat
