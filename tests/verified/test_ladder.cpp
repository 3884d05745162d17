// Every rung of the ladder against exact rationals (FLINT), on thousands of random, special and extreme structures.
#include "oracle/forces.hpp"
#include "oracle/structures.hpp"

#include <isostat/exact/rank.hpp>
#include <isostat/verified/force_ladder.hpp>
#include <isostat/verified/inverse_bound_multiprecision.hpp>

#include <boost/test/unit_test.hpp>

#include <array>
#include <map>

using namespace isostat;
using namespace isostat::oracle;

namespace {

constexpr unsigned bits = IntegerSystem::bits;

struct Count {
    int cases = 0;
    int regular = 0;
    std::array<int, 4> inverse{}; ///< bounds of the inverse, by route
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
    const DofMap<2> dofs(s.packing);
    if (static_cast<int>(s.contacts.size()) != dofs.dof_count()) {
        return;
    }
    ++count.cases;
    const auto n = s.contacts.size();
    const std::string name = s.family + ", N = " + std::to_string(n);
    const IntegerSystem oracle(s.packing, s.contacts);
    const bool regular = oracle.rank() == static_cast<int>(n);
    auto proved = IsostaticStructure<2>::prove(s.packing, s.contacts);
    BOOST_TEST(proved.ok() == regular, name << ": rank " << oracle.rank());
    if (!proved.ok() || !regular) {
        return;
    }
    ++count.regular;
    const IsostaticStructure<2>& structure = proved.value();
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
    LadderOptions options;
    options.max_bits = 512;
    ForceLadder<2> ladder(s.packing, structure, factorisation, inverse, options);
    const int part = ladder.add(force);
    // Two comparisons and a sign on every rung: right where decided, and decided at the end.
    const std::size_t l = static_cast<std::size_t>(random.integer(static_cast<int>(n)));
    const std::size_t m = static_cast<std::size_t>(random.integer(static_cast<int>(n)));
    ForceExpression a;
    a.contact = ContactId(l);
    a.part = part;
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
    double largest = 0;
    for (const double f : exact.value) {
        largest = std::max(largest, std::abs(f));
    }
    if (std::isfinite(exact.bound)) {
        BOOST_TEST(exact.bound <= largest * 0x1p-100 + 0x1p-1070, name << ": " << exact.bound);
    }
}

void report(const char* what, const Count& count) {
    std::string settled;
    for (const auto& [rung, number] : count.settled) {
        settled += " " + rung + " " + std::to_string(number);
    }
    BOOST_TEST_MESSAGE(what << ": " << count.cases << " structures, " << count.regular
                            << " regular; inverse bounded by cholesky/double-double/rows/mpfr " << count.inverse[0]
                            << "/" << count.inverse[1] << "/" << count.inverse[2] << "/" << count.inverse[3] << ", not "
                            << count.exact_only << "; comparisons settled by:" << settled);
}

} // namespace

BOOST_AUTO_TEST_SUITE(verified)

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
            const auto proved = IsostaticStructure<2>::prove(s.packing, s.contacts);
            BOOST_TEST_REQUIRE(proved.ok());
            const InverseBound bound = bound_inverse_multiprecision(s.packing, proved.value());
            BOOST_TEST((bound.verdict == Verdict::proved), "sigma_min ~ 1e-" << decade);
            BOOST_TEST(bound.sigma_min < 10 * std::pow(10.0, -decade));
            check(s, random, count);
        }
    }
    // At 0 it is singular, and nobody says otherwise.
    BOOST_TEST(!IsostaticStructure<2>::prove(needle(3, 0).packing, needle(3, 0).contacts).ok());
    report("needles", count);
    BOOST_TEST(count.inverse[3] > 20);
}

BOOST_AUTO_TEST_SUITE_END()
