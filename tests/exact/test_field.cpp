#include "exact/rank.hpp"
#include "oracle/random.hpp"
#include "support/test.hpp"

#include <gmpxx.h>

using namespace isostat;
using exact::mersenne61;

namespace {

const mpz_class prime = (mpz_class(1) << 61) - 1;

std::uint64_t to_word(const mpz_class& x) {
    return std::stoull(x.get_str());
}

/// The residue of a rational with a power of two as denominator, by GMP.
std::uint64_t reduce_modulo(const mpq_class& x, const mpz_class& p = prime) {
    mpz_class inverse;
    mpz_invert(inverse.get_mpz_t(), x.get_den().get_mpz_t(), p.get_mpz_t());
    mpz_class r = x.get_num() * inverse % p;
    return to_word(r < 0 ? mpz_class(r + p) : r);
}

mpz_class big(std::uint64_t x) {
    return mpz_class(std::to_string(x));
}

} // namespace

BOOST_AUTO_TEST_CASE(residues_of_doubles_are_exact_at_every_magnitude) {
    oracle::Random random(1);
    std::vector<double> values = {0.0,
                                  -0.0,
                                  1.0,
                                  -1.0,
                                  0x1p61,
                                  0x1p-61,
                                  0x1p60,
                                  0x1p31 - 1, // 0 in the small field
                                  -(0x1p31 - 1),
                                  1e-300,
                                  1e150,
                                  0.1,
                                  std::numeric_limits<double>::max(),
                                  std::numeric_limits<double>::min(),
                                  std::numeric_limits<double>::denorm_min(),
                                  -std::numeric_limits<double>::denorm_min(),
                                  std::nextafter(std::numeric_limits<double>::min(), 0.0)};
    for (int k = 0; k < 4000; ++k) {
        values.push_back(std::ldexp(random.real(-1, 1), random.integer(2090) - 1070));
    }
    for (const double x : values) {
        const std::uint64_t r = exact::residue(x);
        BOOST_TEST(r < mersenne61);
        BOOST_TEST(r == reduce_modulo(mpq_class(x)));
        BOOST_TEST((r == 0) == (x == 0)); // 53 bits are fewer than p has
        BOOST_TEST(exact::residue31(x) == reduce_modulo(mpq_class(x), exact::mersenne31));
    }
}

BOOST_AUTO_TEST_CASE(residues_form_a_ring_homomorphism) {
    oracle::Random random(2);
    for (int k = 0; k < 2000; ++k) {
        // 25-bit factors: sums and products are exact doubles.
        const double a = std::floor(random.real(-0x1p25, 0x1p25)) * std::ldexp(1.0, random.integer(40) - 20);
        const double b = std::floor(random.real(-0x1p25, 0x1p25));
        BOOST_TEST(exact::residue(a * b) == exact::multiply(exact::residue(a), exact::residue(b)));
        const double c = std::floor(random.real(-0x1p50, 0x1p50));
        BOOST_TEST(exact::residue(b - c) == exact::subtract(exact::residue(b), exact::residue(c)));
    }
}

BOOST_AUTO_TEST_CASE(field_operations_agree_with_integers) {
    oracle::Random random(3);
    std::vector<std::uint64_t> values = {
        0, 1, 2, 3, 7, mersenne61 - 1, mersenne61 - 2, (mersenne61 - 1) / 2, (mersenne61 + 1) / 2};
    for (int k = 0; k < 61; ++k) {
        values.push_back(std::uint64_t{1} << k);
        values.push_back(mersenne61 - (std::uint64_t{1} << k));
        values.push_back((std::uint64_t{1} << k) - 1);
    }
    for (int k = 0; k < 500; ++k) {
        values.push_back(random.bits() % mersenne61);
    }
    for (const std::uint64_t a : values) {
        for (int k = 0; k < 20; ++k) {
            const std::uint64_t b = values[static_cast<std::size_t>(random.integer(static_cast<int>(values.size())))];
            BOOST_TEST(exact::multiply(a, b) == to_word(big(a) * big(b) % prime));
            BOOST_TEST(exact::subtract(a, b) == to_word((big(a) - big(b) + prime) % prime));
        }
        if (a != 0) {
            const std::uint64_t inverse = exact::inverse(a);
            BOOST_TEST(inverse < mersenne61);
            BOOST_TEST(exact::multiply(a, inverse) == 1U);
        }
    }
    for (int k = 0; k < 200000; ++k) {
        const std::uint64_t a = 1 + random.bits() % (mersenne61 - 1);
        if (exact::multiply(a, exact::inverse(a)) != 1) {
            BOOST_ERROR("inverse of " << a);
        }
    }
}
