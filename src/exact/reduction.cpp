#include "exact/reduction.hpp"

#include "exact/terms.hpp"

#include <algorithm>
#include <cassert>

namespace isostat::exact {

namespace {

__extension__ using Wide = unsigned __int128;
static_assert(sizeof(unsigned long) == 8, "GMP's unsigned long carries a residue");

/// GMP 6.2 documents a Baillie-PSW test from 24 repetitions on, which has no counterexample below 2^64.
bool is_prime(std::uint64_t candidate) {
    return mpz_probab_prime_p(mpz_class(candidate).get_mpz_t(), 25) != 0;
}

} // namespace

std::uint64_t PrimeField::multiply(std::uint64_t a, std::uint64_t b) const {
    return static_cast<std::uint64_t>(static_cast<Wide>(a) * b % prime_);
}

std::uint64_t PrimeField::power(std::uint64_t a, std::uint64_t exponent) const {
    std::uint64_t out = 1;
    for (; exponent != 0; exponent >>= 1) {
        if ((exponent & 1) != 0) {
            out = multiply(out, a);
        }
        a = multiply(a, a);
    }
    return out;
}

Reduction Reduction::suitable(const std::vector<const Number*>& numbers, std::uint64_t below) {
    std::vector<mpz_class> radicands, denominators;
    const auto remember = [](std::vector<mpz_class>& set, const mpz_class& value) {
        const auto place = std::ranges::lower_bound(set, value);
        if (value != 1 && (place == set.end() || *place != value)) {
            set.insert(place, value);
        }
    };
    for (const Number* number : numbers) {
        if (number->terms() == nullptr) {
            continue;
        }
        for (const Term& term : number->terms()->list) {
            remember(radicands, term.radicand);
            remember(denominators, term.coefficient.get_den());
        }
    }
    const std::vector<mpz_class> base = coprime_base(radicands);
    assert(below <= largest_prime_bound && below > 3);
    // below = 4 m + r: the largest number 3 mod 4 under it is 4 m - 1 (r <= 3).
    const std::uint64_t first = below - below % 4 - 1;
    for (std::uint64_t candidate = first; candidate > 3; candidate -= 4) {
        const auto divides = [&](const mpz_class& value) {
            return mpz_divisible_ui_p(value.get_mpz_t(), candidate) != 0;
        };
        if (!is_prime(candidate) || std::ranges::any_of(denominators, divides)) {
            continue;
        }
        Reduction out(candidate);
        for (const mpz_class& b : base) {
            // p = 3 mod 4: the root of a square is its power (p + 1) / 4; the check refuses a number that is no square.
            const std::uint64_t image = mpz_fdiv_ui(b.get_mpz_t(), candidate);
            const std::uint64_t root = out.field_.power(image, (candidate + 1) / 4);
            if (image == 0 || out.field_.multiply(root, root) != image) {
                break;
            }
            out.base_.push_back(b.get_str());
            out.root_.push_back(root);
        }
        if (out.root_.size() == base.size()) {
            return out;
        }
    }
    assert(false && "a suitable prime has positive density");
    return Reduction(3);
}

std::uint64_t Reduction::residue(const Number& number, unsigned signs) const {
    if (number.is_zero()) {
        return 0;
    }
    std::uint64_t sum = 0;
    for (const Term& term : number.terms()->list) {
        const std::uint64_t numerator = mpz_fdiv_ui(term.coefficient.get_num_mpz_t(), field_.prime());
        std::uint64_t image = numerator;
        if (term.coefficient.get_den() != 1) {
            image =
                field_.multiply(image, field_.inverse(mpz_fdiv_ui(term.coefficient.get_den_mpz_t(), field_.prime())));
        }
        mpz_class left = term.radicand;
        for (std::size_t i = 0; i < base_.size() && left != 1; ++i) {
            const mpz_class b(base_[i]);
            if (mpz_divisible_p(left.get_mpz_t(), b.get_mpz_t()) != 0) {
                left /= b;
                const bool other = ((signs >> i) & 1u) != 0;
                image = field_.multiply(image, other ? field_.prime() - root_[i] : root_[i]);
            }
        }
        assert(left == 1);
        sum = field_.add(sum, image);
    }
    return sum;
}

} // namespace isostat::exact
