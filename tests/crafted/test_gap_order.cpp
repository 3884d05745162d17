// Exact order of gaps, and rattlers of all initial parts of a contact list at once, against slow twins.

#include "carrying_by_angles.hpp"
#include "crafted/able.hpp"
#include "oracle/pairs.hpp"
#include "support/free_grains.hpp"
#include "support/scale.hpp"

#include <isostat/exact/number.hpp>

#include <crafted/gap_order.hpp>
#include <mpfr.h>

namespace {

using namespace isostat;
using namespace isostat::crafted;

double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Disks near a lattice: coordinates, radii and so gaps agree often, or differ in the last bits.
Packing near_lattice(std::mt19937_64& random, int m, double noise, bool walls) {
    Packing out;
    out.walls = walls ? Walls::box() : Walls::none();
    const auto jitter = [&] { return random() % 2 == 0 ? 0.0 : noise * (uniform(random) - 0.5); };
    for (int i = 0; i < m; ++i) {
        for (int j = 0; j < m; ++j) {
            out.q.push_back(0.5 + i + jitter());
            out.q.push_back(0.5 + j * (random() % 2 == 0 ? 1 : std::sqrt(3.0) / 2) + jitter());
            out.radius.push_back(0.5 + jitter());
        }
    }
    out.q.insert(out.q.end(), {static_cast<double>(m), static_cast<double>(m)});
    return out;
}

std::vector<Contact> all_candidates(const Packing& packing, double largest) {
    std::vector<Contact> out = isostat::oracle::all_pairs(packing);
    std::erase_if(out, [&](const Contact& c) { return gap(packing, c) > largest; });
    return out;
}

/// The gap to 3000 bits: enough to tell any two of these apart, or to call them equal.
class Gap {
  public:
    Gap(const Packing& packing, const Contact& c) {
        mpfr_init2(value_, 3000);
        mpfr_t d;
        mpfr_init2(d, 3000);
        const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
        if (c.kind == ContactKind::disk_disk) {
            mpfr_set_zero(value_, 1);
            for (std::size_t a = 0; a < 2; ++a) {
                mpfr_set_d(d, packing.q[2 * j + a], MPFR_RNDN);
                mpfr_sub_d(d, d, packing.q[2 * i + a], MPFR_RNDN);
                mpfr_sqr(d, d, MPFR_RNDN);
                mpfr_add(value_, value_, d, MPFR_RNDN);
            }
            mpfr_sqrt(value_, value_, MPFR_RNDN);
            mpfr_sub_d(value_, value_, packing.radius[j], MPFR_RNDN);
        } else {
            mpfr_set_d(value_, c.kind == ContactKind::lower_wall ? packing.q[2 * i + j] : packing.length(c.j),
                       MPFR_RNDN);
            if (c.kind == ContactKind::upper_wall) {
                mpfr_sub_d(value_, value_, packing.q[2 * i + j], MPFR_RNDN);
            }
        }
        mpfr_sub_d(value_, value_, packing.radius[i], MPFR_RNDN);
        mpfr_clear(d);
    }
    ~Gap() { mpfr_clear(value_); }
    Gap(const Gap&) = delete;
    Gap& operator=(const Gap&) = delete;
    [[nodiscard]] int compare(const Gap& other) const {
        return sign_of([&](mpfr_t d) { mpfr_sub(d, value_, other.value_, MPFR_RNDN); });
    }
    [[nodiscard]] int compare(double t) const {
        return sign_of([&](mpfr_t d) { mpfr_sub_d(d, value_, t, MPFR_RNDN); });
    }

  private:
    template <class Subtract> static int sign_of(Subtract subtract) {
        mpfr_t d;
        mpfr_init2(d, 3000);
        subtract(d);
        const int out = mpfr_zero_p(d) != 0 || mpfr_get_exp(d) < -2000 ? 0 : mpfr_sgn(d);
        mpfr_clear(d);
        return out;
    }
    mpfr_t value_;
};

int sign(int x) {
    return (x > 0 ? 1 : 0) - (x < 0 ? 1 : 0);
}

/// Differences rounded like those of the room, exact on demand.
struct Direction {
    exact::Number x, y;
};
int cross_sign(const Direction& a, const Direction& b) {
    return (a.x * b.y - a.y * b.x).sign();
}
int dot_sign(const Direction& a, const Direction& b) {
    return (a.x * b.x + a.y * b.y).sign();
}

} // namespace

BOOST_AUTO_TEST_CASE(the_order_of_gaps_is_that_of_3000_bits) {
    std::mt19937_64 random(11);
    int equal = 0, close = 0;
    for (const double noise : {0.0, 1e-16, 1e-15, 1e-3}) {
        for (int sample = 0; sample < testing::scaled(3); ++sample) {
            const Packing packing = near_lattice(random, 4, noise, sample % 2 == 0);
            const GapOrder order(packing);
            const auto contacts = all_candidates(packing, 0.3);
            for (const Contact& a : contacts) {
                const Gap exact(packing, a);
                for (const Contact& b : contacts) {
                    const int expected = exact.compare(Gap(packing, b));
                    BOOST_REQUIRE_EQUAL(sign(order.compare(order.item(a), order.item(b))), expected);
                    equal += expected == 0 && a != b ? 1 : 0;
                    close += expected != 0 && gap(packing, a) == gap(packing, b) ? 1 : 0;
                }
                // The threshold reported is the smallest double that is not below the gap.
                const double t = order.threshold_of(order.item(a));
                BOOST_TEST(exact.compare(t) <= 0);
                BOOST_TEST(exact.compare(std::nextafter(t, -1.0)) > 0);
                for (const double s : {0.0, t, std::nextafter(t, 1.0), std::nextafter(t, -1.0)}) {
                    BOOST_REQUIRE_EQUAL(sign(order.compare(order.item(a), s)), exact.compare(s));
                }
            }
        }
    }
    BOOST_TEST(equal > 100); // both kinds of hard cases occurred
    BOOST_TEST(close > 10);
}

BOOST_AUTO_TEST_CASE(gaps_of_far_and_tiny_disks_are_ordered) {
    // The difference of the two gaps is far below the rounding of either, or is a denormal.
    const Packing packing =
        without_walls::free_grains({1, 1, 1, 1}, {1e15, 0, 1e15 + 2, 0, 0, 0, 2 + 0x1p-51, 0x1p-1060});
    const GapOrder order(packing);
    const auto item = [&](int i, int j) { return order.item({ContactKind::disk_disk, i, j}); };
    BOOST_TEST(order.compare(item(0, 1), item(2, 3)) < 0);
    BOOST_TEST(order.compare(item(0, 1), 0.0) == 0);
    BOOST_TEST(order.threshold_of(item(0, 1)) == 0.0);
    BOOST_TEST(order.compare(item(2, 3), 0x1p-51) > 0); // by 2^-2121 or so
    BOOST_TEST(order.threshold_of(item(2, 3)) == std::nextafter(0x1p-51, 1.0));
}

BOOST_AUTO_TEST_CASE(peeling_agrees_with_excluding_contacts_for_every_initial_part) {
    std::mt19937_64 random(12);
    int bridges = 0, rattlers = 0, carrying_contacts = 0;
    for (int sample = 0; sample < testing::scaled(60); ++sample) {
        Packing packing = near_lattice(random, 4, sample % 3 == 0 ? 0.0 : 0.2, sample % 2 == 0);
        if (sample % 5 == 0) {
            packing.fixed.assign(packing.radius.size(), 0);
            packing.fixed[0] = packing.fixed[5] = 1;
        }
        std::vector<Contact> contacts = all_candidates(packing, 0.25);
        std::ranges::shuffle(contacts, random);
        const Peeling peeling = peel(packing, contacts);
        const std::size_t n = packing.radius.size();
        for (std::size_t m = 0; m <= contacts.size(); ++m) {
            std::vector<Arms<Direction>> arms(n);
            for (std::size_t l = 0; l < m; ++l) {
                const auto i = static_cast<std::size_t>(contacts[l].i), j = static_cast<std::size_t>(contacts[l].j);
                const auto at = [&](std::size_t k) { return exact::Number::from_double(packing.q[k]); };
                if (contacts[l].kind == ContactKind::disk_disk) {
                    const exact::Number x = at(2 * j) - at(2 * i), y = at(2 * j + 1) - at(2 * i + 1);
                    arms[i].push_back({l, {x, y}});
                    arms[j].push_back({l, {-x, -y}});
                } else {
                    const int s = contacts[l].kind == ContactKind::lower_wall ? -1 : 1;
                    arms[i].push_back({l, {j == 0 ? s : 0, j == 1 ? s : 0}});
                }
            }
            std::vector<unsigned char> carrying(m, 1);
            std::vector<DiskHold> hold(n, DiskHold::held);
            for (std::size_t i = 0; i < n; ++i) {
                hold[i] = packing.is_fixed(DiskId(i)) ? DiskHold::fixed : DiskHold::held;
            }
            exclude_contacts(arms, carrying, hold);
            for (std::size_t l = 0; l < m; ++l) {
                BOOST_REQUIRE_EQUAL(carrying[l] != 0, peeling.contact_from[l] <= static_cast<int>(m));
                carrying_contacts += carrying[l];
            }
            for (std::size_t i = 0; i < n; ++i) {
                BOOST_REQUIRE_EQUAL(hold[i] == DiskHold::rattler, peeling.disk_from[i] > static_cast<int>(m));
                bridges += hold[i] == DiskHold::bridge ? 1 : 0;
                rattlers += hold[i] == DiskHold::rattler ? 1 : 0;
            }
        }
    }
    BOOST_TEST(bridges > 100);
    BOOST_TEST(rattlers > 100);
    BOOST_TEST(carrying_contacts > 100);
}

BOOST_AUTO_TEST_CASE(two_disks_at_one_point_are_refused) {
    const Packing packing = without_walls::free_grains({1, 2}, {0.5, 0.5, 0.5, 0.5});
    BOOST_CHECK_THROW((void)peel(packing, {{ContactKind::disk_disk, 0, 1}}), isostat::Error);
}
