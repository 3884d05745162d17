// Structures at the edge: loads from nothing to everything, forces that vanish, needles, places far away, lattices.
#include "extreme/catalogue.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"

using namespace isostat;
using namespace crafted;

namespace {

std::string power(double value) {
    return fmt::format("{:.0e}", value);
}

/// A state of free and fixed disks without walls under forces on the disks.
State cluster(const std::vector<DiskAt>& disks, std::vector<unsigned char> fixed, std::vector<double> forces,
              std::vector<Contact> contacts) {
    State state = in_box(disks, 0, 0, 0, 0, std::move(contacts));
    state.packing.walls = Walls::none();
    state.packing.fixed = std::move(fixed);
    state.load.disk_force = std::move(forces);
    return state;
}

/// Bead k = 1 ... m rests on bead k - 1 (bead 0 is fixed) and on a fixed disk, nearly in line with both, and carries
/// bead k + 1 at a right angle; the last one carries the force 1. Each needle multiplies the force, by 1 / sin(2
/// angle), the last one by 1 / (2 sin(angle)). Disks of radius 1; everything is moved by `offset` along both axes.
State needle_chain(int m, double angle, double offset) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    std::vector<DiskAt> disks{{1, offset, offset}};
    std::vector<unsigned char> fixed{1};
    std::vector<Contact> contacts;
    std::vector<double> forces{0, 0};
    for (int k = 1; k <= m; ++k) {
        const bool turned = k % 2 == 0;
        const auto at = [&](double x, double y, double along, double across) {
            return turned ? DiskAt{1, x + 2 * across, y + 2 * along} : DiskAt{1, x + 2 * along, y + 2 * across};
        };
        const int before = k == 1 ? 0 : 2 * k - 3;
        const DiskAt last = disks[static_cast<std::size_t>(before)];
        const DiskAt bead = at(last.x, last.y, c, s);
        disks.push_back(bead);
        disks.push_back(at(bead.x, bead.y, c, -s));
        fixed.insert(fixed.end(), {0, 1});
        contacts.push_back(pair(before, 2 * k - 1));
        contacts.push_back(pair(2 * k - 1, 2 * k));
        const double push = k == m ? -1 : 0;
        forces.insert(forces.end(), {turned ? push : 0, turned ? 0 : push, 0, 0});
    }
    return cluster(disks, fixed, forces, contacts);
}

/// Three disks of radius 1/2 between two fixed ones, on an arch that rises by `slope` per unit, under the weights for
/// which it is the line of thrust (horizontal thrust 1).
State arch(double slope) {
    const double steep = 2 * slope;
    const auto step = [](double tangent) {
        return std::pair{1 / std::hypot(1, tangent), tangent / std::hypot(1, tangent)};
    };
    const auto [x1, y1] = step(steep);
    const auto [x2, y2] = step(slope);
    const std::vector<DiskAt> disks{
        {0.5, 0, 0}, {0.5, x1, y1}, {0.5, x1 + x2, y1 + y2}, {0.5, x1 + 2 * x2, y1}, {0.5, 2 * x1 + 2 * x2, 0}};
    return cluster(disks, {1, 0, 0, 0, 1}, {0, 0, 0, -slope, 0, -2 * slope, 0, -slope, 0, 0},
                   {pair(0, 1), pair(1, 2), pair(2, 3), pair(3, 4)});
}

} // namespace

BOOST_AUTO_TEST_CASE(stress_ratios_from_nothing_to_everything) {
    for (const double ratio : {1e-12, 1e-8, 1e-4, 1.0, 1e4, 1e8, 1e12}) {
        const auto one = extreme::inspect("stress ratio", "one disk, σ₂/σ₁ = " + power(ratio), one_disk(1, ratio));
        BOOST_TEST((one && one->equilibrium));
        // Closed form: the second contact with the bottom carries F2 - F1 t, t = 1 / (2 sqrt 2): negative below t.
        const auto two =
            extreme::inspect("stress ratio", "two disks, σ₂/σ₁ = " + power(ratio), two_disks(1, 2, 1, ratio));
        BOOST_REQUIRE(two);
        BOOST_TEST(two->equilibrium == (ratio > 1 / (2 * std::sqrt(2.0))));
        const auto three =
            extreme::inspect("stress ratio", "three disks, σ₂/σ₁ = " + power(ratio), three_disks(1, 1, 1.5, 1, ratio));
        BOOST_REQUIRE(three);
        BOOST_TEST(three->equilibrium == (ratio < 2 * std::sqrt(1.5 * 3.5)));
    }
}

BOOST_AUTO_TEST_CASE(two_disks_that_are_nearly_equal_nearly_let_go) {
    // The force on the bottom below the first disk is F1 t with t = (R2 - R1) / (2 sqrt(R1 R2)).
    for (int k = 1; k <= 15; ++k) {
        const double r = 1 + std::pow(10.0, -k);
        const auto said =
            extreme::inspect("vanishing force", fmt::format("two disks, R₂ - R₁ = 1e-{}", k), two_disks(1, r, 1, 1));
        if (said && said->equilibrium) {
            BOOST_TEST(said->record.min_force == (r - 1) / (2 * std::sqrt(r)),
                       boost::test_tools::tolerance(1e-15 * std::pow(10.0, k)));
        }
    }
    for (int k = 1; k <= 15; k += 2) { // and the other end: disk 2 nearly over disk 1
        const double r = (3 + 2 * std::sqrt(2.0)) * (1 - std::pow(10.0, -k));
        extreme::inspect("vanishing gap", fmt::format("two disks, R₂/R₁ = (3 + 2√2)(1 - 1e-{})", k),
                         two_disks(1, r, 1, 5));
    }
}

BOOST_AUTO_TEST_CASE(loads_next_to_the_limit) {
    State state = ::prepared(30, 1);
    const double limit = required(inspect_vertex(state)).record.stress_high;
    BOOST_REQUIRE(std::isfinite(limit));
    for (const int side : {-1, 1}) {
        for (int k = 2; k <= 16; k += 2) {
            state.load.stress[1] = limit * (1 + side * std::pow(10.0, -k));
            const auto said = extreme::inspect(
                "near failure", fmt::format("30 disks, σ₂ = limit (1 {} 1e-{})", side < 0 ? "-" : "+", k), state);
            if (k <= 10) { // far from rounding: it must be decided
                BOOST_REQUIRE(said);
                BOOST_TEST((said->record.verdict == (side < 0 ? Verdict::proved : Verdict::refuted)), said->remark);
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(needles_up_to_a_condition_number_of_1e15) {
    for (const int m : {1, 3, 5}) {
        for (int k = 1; k <= 15; k += m == 1 ? 1 : 2) {
            const double angle = 0.5 * std::pow(10.0, -static_cast<double>(k) / m);
            const State state = needle_chain(m, angle, 0);
            const auto said = extreme::inspect("needles", fmt::format("{} in a chain, condition 1e{}", m, k), state);
            if (said && said->equilibrium) {
                // The rounding of the fixed disks turns the needles by up to condition x 1e-16, and the force is as
                // sensitive to that again.
                const double expected_error = 1e-14 + 1e-15 * std::pow(10.0, 2 * k);
                double force = 1 / (2 * std::sin(angle));
                for (int b = m; b >= 1 && expected_error < 0.1; --b, force /= std::sin(2 * angle)) {
                    BOOST_TEST(said->forces[2 * static_cast<std::size_t>(b) - 2] == force,
                               boost::test_tools::tolerance(expected_error));
                }
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(arches_balance_and_are_never_called_stable) {
    for (int k = 0; k <= 15; ++k) {
        const auto said =
            extreme::inspect("arch", fmt::format("three disks, slope 1e-{}", k), arch(std::pow(10.0, -k)));
        BOOST_TEST(!(said && said->equilibrium)); // two mechanisms
        BOOST_TEST(!(said && said->stable == Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(packings_far_from_the_origin) {
    for (const double offset : {0.0, 1e3, 1e6, 1e9, 1e12, 1e15}) {
        extreme::inspect("far away", "a needle of angle 0.1 at " + power(offset), needle_chain(1, 0.1, offset));
        extreme::inspect("far away", "three needles of angle 0.1 at " + power(offset), needle_chain(3, 0.1, offset));
    }
}

BOOST_AUTO_TEST_CASE(lattices_of_equal_disks_have_self_stresses) {
    for (const int m : {2, 3, 5, 8}) {
        const State state = square_lattice(m);
        BOOST_TEST(!extreme::inspect("equal radii", fmt::format("square lattice {0} x {0}", m), state));
        const Counting counting = count_contacts(state.packing, state.contacts);
        BOOST_TEST(counting.hyperstaticity == 2 * m - 2); // closed form
        BOOST_TEST(counting.mechanisms == 0);
    }
}
