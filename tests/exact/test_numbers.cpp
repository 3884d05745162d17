// Exact numbers: field laws, canonical form, signs against MPFR, text form in both directions.

#include "support/bad_input.hpp"

#include <isostat/exact/number.hpp>

#include <mpfr.h>

namespace {

using isostat::Error;
using isostat::exact::Number;

Number n(const char* text) {
    return Number::parse(text);
}

Number random_number(std::mt19937_64& random) {
    static const int radicands[] = {1, 2, 3, 5, 6, 7, 10, 15, 30, 42};
    Number sum;
    const auto terms = 1 + random() % 4;
    for (std::size_t k = 0; k < terms; ++k) {
        const long long numerator = static_cast<long long>(random() % 41) - 20;
        const long long denominator = 1 + static_cast<long long>(random() % 9);
        sum += Number(numerator) / Number(denominator) * sqrt(Number(radicands[random() % 10]));
    }
    return sum;
}

/// Sign and value by 2000-bit MPFR from the text: parsed here by hand, so that nothing of the library but `text` is
/// used. The text form is "c*sqrt(d)" terms separated by " + " and " - ".
int mpfr_sign(const std::string& text, double& value) {
    mpfr_t sum, term, factor;
    mpfr_inits2(2000, sum, term, factor, static_cast<mpfr_ptr>(nullptr));
    mpfr_set_zero(sum, 1);
    std::size_t at = 0;
    while (at < text.size()) {
        bool negative = false;
        while (text[at] == ' ' || text[at] == '+' || text[at] == '-') {
            negative = negative || text[at] == '-';
            ++at;
        }
        const std::size_t end = std::min(text.find(' ', at), text.size());
        std::string word = text.substr(at, end - at);
        const auto root = word.find("sqrt(");
        mpfr_set_ui(term, 1, MPFR_RNDN);
        if (root != std::string::npos) {
            mpfr_set_str(factor, word.substr(root + 5, word.size() - root - 6).c_str(), 10, MPFR_RNDN);
            mpfr_sqrt(term, factor, MPFR_RNDN);
            word = root == 0 ? "1" : word.substr(0, root - 1);
        }
        const auto slash = word.find('/');
        mpfr_set_str(factor, word.substr(0, slash).c_str(), 10, MPFR_RNDN);
        mpfr_mul(term, term, factor, MPFR_RNDN);
        if (slash != std::string::npos) {
            mpfr_set_str(factor, word.substr(slash + 1).c_str(), 10, MPFR_RNDN);
            mpfr_div(term, term, factor, MPFR_RNDN);
        }
        (negative ? mpfr_sub : mpfr_add)(sum, sum, term, MPFR_RNDN);
        at = end;
    }
    value = mpfr_get_d(sum, MPFR_RNDN);
    const int sign = mpfr_sgn(sum);
    mpfr_clears(sum, term, factor, static_cast<mpfr_ptr>(nullptr));
    return sign < 0 ? -1 : (sign > 0 ? 1 : 0);
}

void refused_at(const char* text, int position) {
    BOOST_TEST_INFO_SCOPE(text);
    expect_bad_input([&] { (void)Number::parse(text); }, {fmt::format("position {}:", position), "expected"});
}

} // namespace

BOOST_AUTO_TEST_CASE(text_is_read_exactly) {
    BOOST_TEST((n("0.1") * Number(10) == Number(1)));
    BOOST_TEST((n("1e-3") * Number(1000) == Number(1)));
    BOOST_TEST((n("0x1.8p+3") == Number(12)));
    BOOST_TEST((n("0x.8") * Number(2) == Number(1)));
    BOOST_TEST((n("-7/3") * Number(3) == Number(-7)));
    BOOST_TEST((n("1/2*sqrt(3)") * n("1/2*sqrt(3)") == n("3/4")));
    BOOST_TEST((n("sqrt(3)/2") == n("0.5*sqrt(3)")));
    BOOST_TEST((n("sqrt(8)") == n("2*sqrt(2)")));
    BOOST_TEST((n("sqrt(5/7)") == n("1/7*sqrt(35)")));
    BOOST_TEST((n("sqrt(2)*sqrt(3)") == n("sqrt(6)")));
    BOOST_TEST((n("sqrt(6)*sqrt(10)") == n("2*sqrt(15)")));
    BOOST_TEST((n("1/sqrt(2)") == n("sqrt(0.5)")));
    BOOST_TEST((n(" + 1 - 1 ") == Number(0)));
    BOOST_TEST((n("1 + 3/2*sqrt(2) - sqrt(5/7)").text() == "1 + 3/2*sqrt(2) - 1/7*sqrt(35)"));
    BOOST_TEST((n("sqrt(1000000014000000049)") == Number(1000000007)));
    BOOST_TEST((n("sqrt(0)") == Number(0)));
}

BOOST_AUTO_TEST_CASE(anything_else_is_refused_with_the_position) {
    refused_at("", 1);
    refused_at("sqrt(sqrt(2))", 6);
    refused_at("sqrt(1+1)", 7);
    refused_at("sqrt(-1)", 6);
    refused_at("sin(1)", 1);
    refused_at("1 2", 3);
    refused_at("1/2 x", 5);
    refused_at("(1)", 1);
    refused_at("1/0", 3);
    refused_at("1/sqrt(0)", 3);
    refused_at("sqrt(1/0)", 8);
    refused_at("1e", 3);
    refused_at("1e99999", 3);
    refused_at("0x", 3);
    refused_at("0x1p", 5);
    refused_at(".", 2);
    refused_at("1.2.3", 4);
    refused_at("- -3", 3);
    refused_at("nan", 1);
    refused_at("inf", 1);
    refused_at("1,5", 2);
    refused_at("sqrt 3", 6);
    refused_at("sqrt(3", 7);
    refused_at("2*", 3);
    // 1000003 * 1000033 * 1000037 * 1000039: four primes above 10^6, no way to see that it is square-free.
    refused_at("sqrt(1000112004278059472142857)", 6);
}

BOOST_AUTO_TEST_CASE(random_text_never_crashes_and_reads_back) {
    std::mt19937_64 random(5);
    const std::string alphabet = "0123456789.+-*/sqrt()ex p";
    int accepted = 0;
    for (int k = 0; k < 20000; ++k) {
        std::string text;
        for (std::size_t length = 1 + random() % 8; text.size() < length;) {
            text += random() % 16 == 0 ? "sqrt(" : std::string(1, alphabet[random() % alphabet.size()]);
        }
        try {
            const Number value = Number::parse(text);
            ++accepted;
            BOOST_REQUIRE_MESSAGE(Number::parse(value.text()) == value, text);
        } catch (const Error&) {
        }
    }
    BOOST_TEST(accepted > 500);
}

BOOST_AUTO_TEST_CASE(square_roots_are_brought_to_square_free_radicands) {
    std::mt19937_64 random(8);
    for (int k = 0; k < 2000; ++k) {
        const Number q =
            Number(1 + static_cast<long>(random() % 100000)) / Number(1 + static_cast<long>(random() % 1000));
        const Number root = sqrt(q);
        BOOST_REQUIRE((root * root == q));
        BOOST_REQUIRE_EQUAL(root.sign(), 1);
        // Square-free by trial division, and the root of a square is rational.
        const long radicand = std::stol(root.radicands().front());
        for (long d = 2; d * d <= radicand; ++d) {
            BOOST_REQUIRE(radicand % (d * d) != 0);
        }
        BOOST_REQUIRE((sqrt(q * q) == q));
    }
}

BOOST_AUTO_TEST_CASE(field_laws_hold_for_random_numbers) {
    std::mt19937_64 random(1);
    for (int k = 0; k < 3000; ++k) {
        const Number a = random_number(random), b = random_number(random), c = random_number(random);
        BOOST_REQUIRE((a + b == b + a));
        BOOST_REQUIRE(((a + b) + c == a + (b + c)));
        BOOST_REQUIRE((a * (b + c) == a * b + a * c));
        BOOST_REQUIRE(((a * b) * c == a * (b * c)));
        BOOST_REQUIRE((a - a).is_zero());
        BOOST_REQUIRE((Number::parse(a.text()) == a));
        if (!b.is_zero()) {
            BOOST_REQUIRE((a / b * b == a));
        }
        BOOST_REQUIRE((a * b).is_zero() == (a.is_zero() || b.is_zero()));
    }
}

BOOST_AUTO_TEST_CASE(signs_and_enclosures_agree_with_2000_bits) {
    std::mt19937_64 random(2);
    for (int k = 0; k < 3000; ++k) {
        const Number a = random_number(random);
        double value = 0;
        BOOST_REQUIRE_EQUAL(a.sign(), mpfr_sign(a.text(), value));
        const auto enclosure = a.enclosure();
        BOOST_REQUIRE(std::abs(enclosure.value - value) <= std::abs(value) * 0x1p-52);
        BOOST_REQUIRE(enclosure.radius <= std::abs(value) * 0x1p-52);
        BOOST_REQUIRE(a.is_zero() || enclosure.decided());
    }
}

BOOST_AUTO_TEST_CASE(sign_of_a_near_zero_needs_hundreds_of_digits) {
    // (sqrt 2 - 1)^m -> 0 and its expansion a - b sqrt 2 cancels: m = 500 leaves 10^-191.
    const Number small = n("sqrt(2) - 1");
    Number power = 1;
    for (int m = 1; m <= 500; ++m) {
        power *= small;
        BOOST_REQUIRE_EQUAL(power.sign(), 1);
        BOOST_REQUIRE_EQUAL((power - power).sign(), 0);
    }
    const auto enclosure = power.enclosure();
    BOOST_TEST(std::abs(std::log10(enclosure.value) + 500 * std::log10(1 + std::sqrt(2.0))) < 1e-9);
    BOOST_TEST(enclosure.decided());
    // Bounds one unit apart in the 32nd decimal.
    // twin.
    BOOST_TEST((n("sqrt(2) + sqrt(3)") > n("3.14626436994197234232913506571557")));
    BOOST_TEST((n("sqrt(2) + sqrt(3)") < n("3.14626436994197234232913506571558")));
}

BOOST_AUTO_TEST_CASE(enclosures_hold_for_extreme_magnitudes) {
    for (const char* text : {"1e-320", "3e-324", "1e-400", "1e308", "1e400", "sqrt(2)*1e-310", "1/3", "0.1"}) {
        const Number a = n(text);
        const auto enclosure = a.enclosure();
        if (std::isinf(enclosure.radius)) {
            BOOST_TEST((a > Number::from_double(1.7976931348623157e308)));
            continue;
        }
        BOOST_TEST((Number::from_double(enclosure.value) - Number::from_double(enclosure.radius) <= a));
        BOOST_TEST((Number::from_double(enclosure.value) + Number::from_double(enclosure.radius) >= a));
    }
    BOOST_TEST(n("0.5").enclosure().radius == 0);
    BOOST_TEST(n("0.1").enclosure().radius > 0);
    BOOST_TEST((Number::from_double(0.1) != n("0.1")));
}
