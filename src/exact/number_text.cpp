#include "exact/terms.hpp"

#include <isostat/core/result.hpp>

#include <string>

namespace isostat::exact {

namespace {

constexpr long largest_exponent = 10000;
constexpr std::size_t longest_text = 20000;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

int hex_value(char c) {
    if (is_digit(c)) {
        return c - '0';
    }
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

mpz_class power(unsigned long base, long exponent) {
    mpz_class out;
    mpz_ui_pow_ui(out.get_mpz_t(), base, static_cast<unsigned long>(exponent));
    return out;
}

/// Recursive descent for the grammar sum = [sign] product { sign product }; product = factor { (* | /) factor }; factor
/// = number | sqrt ( number [/ number] ).
class Reader {
  public:
    explicit Reader(std::string_view text) : text_(text) {}

    Number sum() {
        if (text_.size() > longest_text) {
            fail("at most " + std::to_string(longest_text) + " characters");
        }
        Number total;
        bool first = true;
        for (;;) {
            const char c = peek();
            bool negative = false;
            if (c == '+' || c == '-') {
                negative = c == '-';
                ++at_;
            } else if (!first) {
                if (c == '\0' && at_ >= text_.size()) {
                    return total;
                }
                fail("one of + - * / or the end");
            }
            const Number term = product();
            total = negative ? total - term : total + term;
            first = false;
        }
    }

  private:
    Number product() {
        Number value = factor();
        for (;;) {
            const char c = peek();
            if (c != '*' && c != '/') {
                return value;
            }
            ++at_;
            peek();
            const std::size_t start = at_;
            const Number next = factor();
            if (c == '/' && next.is_zero()) {
                at_ = start;
                fail("a divisor other than zero");
            }
            value = c == '*' ? value * next : value / next;
        }
    }

    Number factor() {
        const char c = peek();
        if (text_.substr(at_, 4) == "sqrt") {
            at_ += 4;
            expect('(', "\"(\" after sqrt");
            return root();
        }
        if (!is_digit(c) && c != '.') {
            fail("a decimal, a quotient p/q, a hex float or sqrt(p/q)");
        }
        return make_rational(literal());
    }

    Number root() {
        peek();
        const std::size_t start = at_;
        if (peek() == '-') {
            fail("a non-negative rational under the root");
        }
        const auto rational_literal = [&] {
            const char c = peek();
            if (!is_digit(c) && c != '.') {
                fail("a rational number under the root (no nested root, no sum)");
            }
            return literal();
        };
        mpq_class value = rational_literal();
        if (peek() == '/') {
            ++at_;
            peek();
            const std::size_t divisor_start = at_;
            const mpq_class divisor = rational_literal();
            if (divisor == 0) {
                at_ = divisor_start;
                fail("a divisor other than zero");
            }
            value /= divisor;
        }
        expect(')', "\")\" or \"/\" after the number under the root");
        try {
            return sqrt(make_rational(value));
        } catch (const Error& error) {
            at_ = start;
            fail(std::string("a radicand that can be factored: ") + error.what());
        }
    }

    mpq_class literal() {
        const bool hex =
            text_[at_] == '0' && at_ + 1 < text_.size() && (text_[at_ + 1] == 'x' || text_[at_ + 1] == 'X');
        if (hex) {
            at_ += 2;
        }
        const unsigned base = hex ? 16 : 10;
        mpz_class digits = 0;
        long fraction = 0;
        bool any = false, point = false;
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '.' && !point) {
                point = true;
                continue;
            }
            const int digit = hex ? hex_value(c) : (is_digit(c) ? c - '0' : -1);
            if (digit < 0) {
                break;
            }
            any = true;
            fraction += point ? 1 : 0;
            digits = digits * base + digit;
        }
        if (!any) {
            fail(hex ? "a hexadecimal digit" : "a digit");
        }
        const char mark = at_ < text_.size() ? static_cast<char>(text_[at_] | 0x20) : '\0';
        long exponent = 0;
        if (mark == (hex ? 'p' : 'e')) {
            ++at_;
            exponent = signed_integer();
        }
        // A fraction digit counts 4 bits in a hex float, whose exponent is binary.
        const long shift = exponent - (hex ? 4 * fraction : fraction);
        const mpz_class factor = power(hex ? 2 : 10, shift < 0 ? -shift : shift);
        mpq_class value = shift < 0 ? mpq_class(digits, factor) : mpq_class(digits * factor);
        value.canonicalize();
        return value;
    }

    long signed_integer() {
        bool negative = false;
        if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) {
            negative = text_[at_] == '-';
            ++at_;
        }
        if (at_ >= text_.size() || !is_digit(text_[at_])) {
            fail("a digit of the exponent");
        }
        const std::size_t start = at_;
        long value = 0;
        for (; at_ < text_.size() && is_digit(text_[at_]); ++at_) {
            value = value * 10 + (text_[at_] - '0');
            if (value > largest_exponent) {
                at_ = start;
                fail("an exponent between -10000 and 10000");
            }
        }
        return negative ? -value : value;
    }

    /// The next character after spaces, or '\0' at the end.
    char peek() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) {
            ++at_;
        }
        return at_ < text_.size() ? text_[at_] : '\0';
    }

    void expect(char wanted, const char* description) {
        if (peek() != wanted) {
            fail(description);
        }
        ++at_;
    }

    [[noreturn]] void fail(const std::string& expected) const {
        const std::string found = at_ < text_.size() ? "\"" + std::string(text_.substr(at_, 12)) + "\"" : "the end";
        throw Error(ErrorKind::bad_input, "number \"" + std::string(text_.substr(0, 80)) + "\", position " +
                                              std::to_string(at_ + 1) + ": found " + found + ", expected " + expected);
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

} // namespace

Number Number::parse(std::string_view text) {
    return Reader(text).sum();
}

} // namespace isostat::exact
