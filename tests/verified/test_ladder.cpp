// Every rung of the ladder against exact rationals (FLINT), on thousands of random, special and extreme structures.
#include "core/dot.hpp"
#include "exact/rank.hpp"
#include "oracle/forces.hpp"
#include "oracle/refined.hpp"
#include "oracle/structures.hpp"
#include "oracle/truth.hpp"
#include "support/regular.hpp"
#include "verified/force_ladder.hpp"
#include "verified/inverse_bound.hpp"

using namespace isostat;
using namespace isostat::oracle;

namespace {

constexpr unsigned bits = IntegerSystem::bits;

struct Count {
    int cases = 0, regular = 0;
    std::array<int, 3> inverse{}; ///< bounds of the inverse, by route
    int exact_only = 0;           ///< no bound of the inverse in the range of double
    std::map<std::string, int> settled;
};

/// The proved sigma_min against the columns of the exact inverse: |H^-1 e_i|_2 <= |H^-1|_2 <= sum over i of them.
void check_inverse(const IntegerSystem& oracle, const InverseBound& bound, std::size_t n, const std::string& name) {
    mpf_class largest(0, bits);
    std::vector<mpq_class> unit(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        unit[i] = 1;
        const std::vector<mpq_class> column = oracle.solve(unit);
        unit[i] = 0;
        mpf_class sum(0, bits);
        for (std::size_t l = 0; l < n; ++l) {
            const mpf_class c = oracle.value(column[l], l);
            sum += c * c;
        }
        largest = std::max(largest, mpf_class(sqrt(sum)));
    }
    // Bool first: expression templates do not outlive a BOOST_TEST.
    const mpf_class product = mpf_class(bound.sigma_min, bits) * largest;
    const bool below = product <= 1;
    BOOST_TEST(below, name << ": sigma_min " << bound.sigma_min);
    if (bound.sigma_min > 1e-290) { // and not useless: the 1- and infinity-norms lose at most a factor of about n
        const bool sharp = product * static_cast<double>(100 * n * n) >= 1;
        BOOST_TEST(sharp, name << ": sigma_min " << bound.sigma_min << " is far too small");
    }
}

void check_solution(const IntegerSystem& oracle, const std::vector<mpq_class>& x, const ForceSolution& s,
                    const std::string& name) {
    if (!std::isfinite(s.bound)) {
        return; // nothing is claimed
    }
    const mpf_class bound(s.bound, bits);
    for (std::size_t l = 0; l < x.size(); ++l) {
        mpf_class error = mpf_class(s.value[l], bits) - oracle.value(x[l], l);
        if (!s.low.empty()) {
            error += mpf_class(s.low[l], bits);
        }
        if (!(abs(error) <= bound)) {
            BOOST_ERROR(name << ", " << to_string(s.rung) << " " << s.bits << " bits: error of f_" << l << " is "
                             << mpf_class(abs(error)).get_d() << ", claimed " << s.bound);
            return;
        }
    }
}

void check(const Structure& s, Random& random, Count& count) {
    const DofMap dofs(s.packing);
    if (static_cast<int>(s.contacts.size()) != dofs.dof_count()) {
        return;
    }
    ++count.cases;
    const auto n = s.contacts.size();
    const std::string name = s.family + ", N = " + std::to_string(n);
    const IntegerSystem oracle(s.packing, s.contacts);
    const bool regular = oracle.rank() == static_cast<int>(n);
    auto proved = IsostaticStructure::prove(s.packing, s.contacts);
    BOOST_TEST(proved.ok() == regular, name << ": rank " << oracle.rank());
    if (!proved.ok() || !regular) {
        return;
    }
    ++count.regular;
    const IsostaticStructure& structure = proved.value();
    const Factorisation factorisation(structure);
    InverseBoundCache cache;
    InverseBound inverse = bound_inverse(structure, factorisation, cache);
    if (inverse.verdict != Verdict::proved) {
        inverse = bound_inverse_multiprecision(s.packing, structure);
    }
    if (inverse.verdict == Verdict::proved) {
        ++count.inverse[static_cast<std::size_t>(inverse.route)];
        check_inverse(oracle, inverse, n, name);
    } else {
        ++count.exact_only;
    }
    const std::vector<double> force = random_load(static_cast<int>(n), random);
    const std::vector<mpq_class> x = oracle.solve({force.begin(), force.end()});
    BOOST_TEST_REQUIRE(x.size() == n);
    LadderOptions options{.max_bits = 512};
    ForceLadder ladder(s.packing, structure, factorisation, inverse, options);
    const int part = ladder.add(force);
    // Two comparisons and a sign on every rung: right where decided, and decided at the end.
    const std::size_t l = static_cast<std::size_t>(random.integer(static_cast<int>(n)));
    const std::size_t m = static_cast<std::size_t>(random.integer(static_cast<int>(n)));
    ForceExpression a{.contact = ContactId(l), .part = part};
    ForceExpression b = a;
    b.contact = ContactId(m);
    bool first = true;
    do {
        check_solution(oracle, x, ladder.solution(part), name);
        const Order sign = ladder.sign(a);
        const Order order = ladder.compare(a, b);
        if (sign.decided) {
            BOOST_TEST(sign.sign == sgn(x[l]), name << ", " << to_string(ladder.rung()));
        }
        if (order.decided) {
            BOOST_TEST(order.sign == oracle.compare(x[l], l, x[m], m), name << ", " << to_string(ladder.rung()));
            if (first) {
                ++count.settled[std::string(to_string(ladder.rung()))];
            }
            first = false;
        }
    } while (ladder.climb());
    BOOST_TEST((ladder.rung() == Rung::exact), name);
    BOOST_TEST((ladder.sign(a).decided && ladder.compare(a, b).decided), name);
    // The exact rung is accurate, not only right: to the rounding of double-double, in its range.
    const ForceSolution& exact = ladder.solution(part);
    if (std::isfinite(exact.bound)) {
        BOOST_TEST(exact.bound <= isostat::largest(exact.value) * 0x1p-100 + 0x1p-1070, name << ": " << exact.bound);
    }
}

void report(const char* what, const Count& count) {
    std::string settled;
    for (const auto& [rung, number] : count.settled) {
        settled += " " + rung + " " + std::to_string(number);
    }
    BOOST_TEST_MESSAGE(what << ": " << count.cases << " structures, " << count.regular
                            << " regular; inverse bounded by cholesky/double-double/mpfr " << count.inverse[0] << "/"
                            << count.inverse[1] << "/" << count.inverse[2] << ", not " << count.exact_only
                            << "; comparisons settled by:" << settled);
}

} // namespace

BOOST_AUTO_TEST_CASE(every_rung_agrees_with_exact_rationals_on_random_and_special_structures) {
    Random random(20240611);
    for (int place = 0; place < place_count; ++place) {
        Count count;
        for (int k = 0; k < 400; ++k) {
            const int disks = 1 + random.integer(k % 20 == 0 ? 20 : 5);
            check(random_structure(disks, static_cast<Place>(place), k % 2 == 0, random), random, count);
        }
        report(name(static_cast<Place>(place)), count);
        BOOST_TEST(count.regular > 100);
        BOOST_TEST(count.regular < count.cases); // both sides are seen
    }
}

BOOST_AUTO_TEST_CASE(a_regular_matrix_is_proved_so_down_to_the_smallest_singular_values) {
    Random random(5);
    Count count;
    for (int decade = 0; decade <= 300; decade += decade < 20 ? 1 : 20) {
        for (const int disks : {1, 2, 7}) {
            const Structure s = needle(disks, std::pow(10.0, -decade));
            const auto proved = required(IsostaticStructure::prove(s.packing, s.contacts));
            const InverseBound bound = bound_inverse_multiprecision(s.packing, proved);
            BOOST_TEST((bound.verdict == Verdict::proved), "sigma_min ~ 1e-" << decade);
            BOOST_TEST(bound.sigma_min < 10 * std::pow(10.0, -decade));
            check(s, random, count);
        }
    }
    // At 0 it is singular, and nobody says otherwise.
    BOOST_TEST(!IsostaticStructure::prove(needle(3, 0).packing, needle(3, 0).contacts).ok());
    report("needles", count);
    BOOST_TEST(count.inverse[2] > 20);
}

namespace {

using Digits = Decimal<451>;

/// All rungs in floating point against forces to 1500 bits.
void check_layers(int rows, int top, double height, LadderOptions options) {
    Random random(11);
    const Structure s = layers(rows, top, height, random);
    const crafted::Regular at(s.packing, s.contacts);
    BOOST_TEST_REQUIRE((at.inverse.verdict == Verdict::proved));
    std::vector<double> force;
    for (std::size_t i = 0; i < s.contacts.size(); ++i) {
        force.push_back(i % 2 == 0 ? random.real(-0.1, 0.1) : -1);
    }
    const std::vector<Digits> reference = refined_forces<Digits>(s.packing, s.contacts, force, 1400);
    BOOST_TEST_REQUIRE(!reference.empty());
    ForceLadder ladder(s.packing, at.structure, at.factorisation, at.inverse, options);
    const int part = ladder.add(force);
    double before = std::numeric_limits<double>::infinity();
    do {
        const ForceSolution& solution = ladder.solution(part);
        Digits worst = 0;
        for (std::size_t l = 0; l < reference.size(); ++l) {
            const Digits value = Digits(solution.value[l]) + (solution.low.empty() ? 0.0 : solution.low[l]);
            worst = std::max(worst, Digits(abs(value - reference[l])));
        }
        BOOST_TEST(worst <= solution.bound, "N = " << s.contacts.size() << ", " << to_string(solution.rung) << " "
                                                   << solution.bits << " bits: error " << as_double(worst)
                                                   << ", claimed " << solution.bound);
        BOOST_TEST(solution.bound <= before);
        before = solution.bound;
        if (solution.rung == Rung::multiprecision) { // more digits than value + low hold
            const auto read = from_hexadecimal<Digits>(ladder.digits(part, ContactId(0), solution.bits));
            const Digits error = abs(read - reference[0]);
            BOOST_TEST(error <= ldexp(Digits(abs(reference[0])), -solution.bits / 2),
                       solution.bits << " bits: error " << as_double(error));
        }
    } while (ladder.climb());
    BOOST_TEST((ladder.rung() == (2 * rows * top > options.exact_size ? Rung::multiprecision : Rung::exact)));
}

} // namespace

BOOST_AUTO_TEST_CASE(rungs_in_floating_point_hold_at_400_disks) {
    LadderOptions options{.max_bits = 512, .exact_size = 100};
    check_layers(16, 18, 0.5, options);
    check_layers(16, 18, 1e-4, options);
}

BOOST_AUTO_TEST_CASE(rungs_in_floating_point_hold_at_5000_disks) {
    LadderOptions options{.max_bits = 512};
    check_layers(60, 54, 0.5, options);
    check_layers(60, 54, 1e-3, options);
}

BOOST_AUTO_TEST_CASE(what_a_stress_lacks_to_a_limit_is_known_after_the_ladder_was_moved_and_ended) {
    Random random(5);
    const Structure s = layers(3, 4, 0.5, random);
    const crafted::Regular at(s.packing, s.contacts);
    std::vector<double> down, aside;
    for (std::size_t i = 0; i < s.contacts.size(); ++i) {
        down.push_back(i % 2 == 0 ? 0 : -1);
        aside.push_back(i % 2 == 0 ? 0.3 : -0.1);
    }
    const auto loaded = [&](double factor) {
        ForceLadder ladder(s.packing, at.structure, at.factorisation, at.inverse);
        std::vector<double> force = down;
        std::ranges::for_each(force, [&](double& f) { f *= factor; });
        ladder.add(force);
        ladder.add(aside);
        return ladder;
    };
    ForceExpression force{.contact = ContactId(0), .slope_part = 1};
    ForceLadder other = loaded(1);
    std::shared_ptr<const LoadShift> shift;
    {
        ForceLadder first = loaded(1);
        shift = first.zero_of(force);
        const ForceLadder second = std::move(first);
    }
    const ForceLadder later = loaded(2); // in the memory of those that ended
    other.without_exact_numbers();
    force.shift = shift.get();
    BOOST_TEST(!other.sign(force).decided);
    while (other.bits() < 256) {
        BOOST_TEST_REQUIRE(other.climb());
    }
    const Order order = other.sign(force); // 0, to the bits of the rung
    BOOST_TEST(!order.decided);
    BOOST_TEST(order.exponent < -150);
}

BOOST_AUTO_TEST_CASE(distances_to_a_limit_are_ordered_as_the_rationals_order_them) {
    Random random(77);
    int settled_above_double = 0;
    for (int k = 0; k < 200; ++k) {
        const auto place = static_cast<Place>(k % place_count);
        const Structure s = random_structure(2 + k % 3, place, true, random);
        const auto proved = IsostaticStructure::prove(s.packing, s.contacts);
        if (!proved.ok()) {
            continue;
        }
        const Factorisation factorisation(proved.value());
        InverseBoundCache cache;
        const InverseBound inverse = bound_inverse(proved.value(), factorisation, cache);
        const std::size_t n = s.contacts.size();
        const IntegerSystem oracle(s.packing, s.contacts);
        std::vector<double> load = random_load(static_cast<int>(n), random);
        std::vector<double> unit(n, 0.0);
        unit[0] = 0.25;
        unit[n - 1] = 1;
        const auto x = oracle.solve({load.begin(), load.end()});
        const auto y = oracle.solve({unit.begin(), unit.end()});
        ForceLadder ladder(s.packing, proved.value(), factorisation, inverse);
        const int part = ladder.add(load);
        const int slope = ladder.add(unit);
        ForceExpression a;
        a.part = part;
        a.slope_part = slope;
        a.at = 0.1;
        a.from = 0.3;
        ForceExpression b = a;
        a.contact = ContactId(random.integer(static_cast<int>(n)));
        b.contact = ContactId(random.integer(static_cast<int>(n)));
        const std::size_t l = a.contact.index();
        const std::size_t m = b.contact.index();
        if (y[l] == 0 || y[m] == 0) {
            continue;
        }
        const mpq_class change = mpq_class(0.1) - mpq_class(0.3);
        const mpq_class at_l = x[l] + change * y[l];
        const mpq_class at_m = x[m] + change * y[m];
        const auto check_order = [&](int divisor, int expected) {
            ForceLadder fresh(s.packing, proved.value(), factorisation, inverse);
            fresh.add(load);
            fresh.add(unit);
            a.divisor_part = divisor;
            b.divisor_part = divisor;
            Order order = fresh.compare(a, b);
            while (true) {
                if (order.decided) {
                    BOOST_TEST(order.sign == expected, s.family << ", " << to_string(order.rung));
                    settled_above_double += order.rung > Rung::double_bound ? 1 : 0;
                }
                if (!fresh.climb()) {
                    break;
                }
                order = fresh.compare(a, b);
            }
            BOOST_TEST(order.decided);
        };
        check_order(-1, oracle.compare(at_l, l, at_m, m));
        check_order(slope, sgn(mpq_class(at_l / abs(y[l]) - at_m / abs(y[m]))));
    }
    BOOST_TEST(settled_above_double > 100);
}
