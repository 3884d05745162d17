#include "contact/contact_set.hpp"
#include "contact/separation.hpp"
#include "oracle/packings.hpp"
#include "support/scale.hpp"

#include <isostat/contact/state.hpp>

#include <gmpxx.h>

using namespace isostat;
using namespace isostat::oracle;

namespace {

Packing random_pair(Random& random, double scale) {
    Packing packing;
    packing.radius = {random.real(0.5, 1) * scale, random.real(0.5, 1) * scale};
    packing.q = {random.real(0, 5) * scale,
                 random.real(0, 5) * scale,
                 random.real(0, 5) * scale,
                 random.real(0, 5) * scale,
                 6 * scale,
                 7 * scale};
    snap_to_grid(packing);
    return packing;
}

/// Centre line and distance with 400 bits.
struct Line {
    mpf_class x, y, distance;
};

Line line(const Packing& packing) {
    Line d{mpf_class(packing.q[2], 400) - packing.q[0], mpf_class(packing.q[3], 400) - packing.q[1], mpf_class(0, 400)};
    d.distance = sqrt(mpf_class(d.x * d.x + d.y * d.y));
    return d;
}

double relative_error(double value, const mpf_class& exact) {
    return std::abs(mpf_class((value - exact) / exact).get_d());
}

constexpr double u = 0x1p-53;
const Contact pair{ContactKind::disk_disk, 0, 1};
const std::vector<Contact> every_kind = {pair,
                                         {ContactKind::lower_wall, 0, 0},
                                         {ContactKind::lower_wall, 1, 1},
                                         {ContactKind::upper_wall, 0, 1},
                                         {ContactKind::upper_wall, 1, 0}};

constexpr isostat::Layout layout{2, 3};
const std::vector<double> q{1, 2, 4, 8, 16, 32, 64, 128}; // three disks, then the walls: every subset has another sum
const std::vector<Contact> contacts{{ContactKind::disk_disk, 0, 2},  {ContactKind::disk_disk, 1, 2},
                                    {ContactKind::lower_wall, 1, 0}, {ContactKind::lower_wall, 2, 1},
                                    {ContactKind::upper_wall, 0, 0}, {ContactKind::upper_wall, 1, 1}};

} // namespace

BOOST_AUTO_TEST_CASE(gaps_and_normals_keep_their_error_bounds) {
    Random random(51);
    for (int repeat = 0; repeat < testing::scaled(3000); ++repeat) {
        const double scale = repeat % 3 == 0 ? 1 : repeat % 3 == 1 ? 1e-8 : 1e8;
        const Packing packing = random_pair(random, scale);
        const Line d = line(packing);
        const mpf_class exact = d.distance - packing.radius[0] - packing.radius[1];
        // 4 ulp of the distance, one more for the sum of the radii, and the last subtraction.
        const double bound = 8 * u * d.distance.get_d() + u * (packing.radius[0] + packing.radius[1]);
        BOOST_TEST(std::abs(mpf_class(gap(packing, pair) - exact).get_d()) <= bound + u * std::abs(exact.get_d()));
        const GapGradient g = gap_gradient(packing, pair);
        BOOST_REQUIRE(g.count == 4);
        const std::array<mpf_class, 4> normal = {mpf_class(-d.x / d.distance), mpf_class(-d.y / d.distance),
                                                 mpf_class(d.x / d.distance), mpf_class(d.y / d.distance)};
        for (std::size_t k = 0; k < 4; ++k) {
            BOOST_TEST(g.coordinate[k] == static_cast<int>(k));
            BOOST_TEST(relative_error(g.value[k], normal[k]) <= 4 * u);
        }
    }
}

BOOST_AUTO_TEST_CASE(gradients_and_curvatures_are_derivatives_of_the_gap) {
    Random random(52);
    for (int repeat = 0; repeat < testing::scaled(300); ++repeat) {
        const Packing packing = random_pair(random, 1);
        std::vector<double> v(6);
        std::ranges::generate(v, [&] { return random.real(-1, 1); });
        for (const Contact& contact : every_kind) {
            const auto along = [&](double t) {
                Packing moved = packing;
                for (std::size_t k = 0; k < v.size(); ++k) {
                    moved.q[k] += t * v[k];
                }
                return gap(moved, contact);
            };
            const double distance = contact.kind == ContactKind::disk_disk ? line(packing).distance.get_d() : 1;
            const double t = 1e-4 * distance;
            const GapGradient g = gap_gradient(packing, contact);
            double slope = 0;
            for (int k = 0; k < g.count; ++k) {
                const auto e = static_cast<std::size_t>(k);
                slope += g.value[e] * v[static_cast<std::size_t>(g.coordinate[e])];
            }
            // Central differences: truncation t^2, rounding u / t.
            BOOST_TEST(std::abs((along(t) - along(-t)) / (2 * t) - slope) < 1e-6 / distance + 1e-9);
            const double curvature = (along(t) - 2 * along(0) + along(-t)) / (t * t);
            BOOST_TEST(std::abs(curvature - gap_curvature(packing, contact, v.data())) <
                       1e-4 / distance + 1e-5 / (distance * distance));
            BOOST_TEST(gap_curvature(packing, contact, v.data()) >= 0);
        }
    }
}

BOOST_AUTO_TEST_CASE(wall_gaps_of_snapped_coordinates) {
    Packing packing;
    packing.radius = {0.5, 0.25};
    packing.q = {1, 2, 3, 4, 6, 7};
    BOOST_TEST(gap(packing, {ContactKind::lower_wall, 0, 0}) == 0.5);
    BOOST_TEST(gap(packing, {ContactKind::lower_wall, 1, 1}) == 3.75);
    BOOST_TEST(gap(packing, {ContactKind::upper_wall, 0, 1}) == 4.5);
    BOOST_TEST(gap(packing, {ContactKind::upper_wall, 1, 0}) == 2.75);
    BOOST_TEST(gap(packing, {ContactKind::held, 3, 0}) == 0);
    const GapGradient lower = gap_gradient(packing, {ContactKind::lower_wall, 1, 1});
    BOOST_TEST(lower.count == 1);
    BOOST_TEST(lower.coordinate[0] == 3);
    BOOST_TEST(lower.value[0] == 1);
    const GapGradient upper = gap_gradient(packing, {ContactKind::upper_wall, 1, 0});
    BOOST_TEST(upper.count == 2);
    BOOST_TEST(upper.coordinate[0] == 2);
    BOOST_TEST(upper.value[0] == -1);
    BOOST_TEST(upper.coordinate[1] == 4);
    BOOST_TEST(upper.value[1] == 1);
    const GapGradient held = gap_gradient(packing, {ContactKind::held, 3, 0});
    BOOST_TEST(held.count == 1);
    BOOST_TEST(held.coordinate[0] == 3);
    BOOST_TEST(held.value[0] == 1);
}

BOOST_AUTO_TEST_CASE(contacts_have_names) {
    BOOST_TEST(to_string({ContactKind::disk_disk, 12, 40}) == "12-40");
    BOOST_TEST(to_string({ContactKind::lower_wall, 12, 0}) == "12-left");
    BOOST_TEST(to_string({ContactKind::lower_wall, 12, 1}) == "12-bottom");
    BOOST_TEST(to_string({ContactKind::upper_wall, 12, 0}) == "12-right");
    BOOST_TEST(to_string({ContactKind::upper_wall, 12, 1}) == "12-top");
    BOOST_TEST(to_string({ContactKind::held, 6, 0}).find("held x") == 0U);
    BOOST_TEST(to_string({ContactKind::held, 6, 0}).find('3') != std::string::npos);
}

BOOST_AUTO_TEST_CASE(contact_sets_contain_exactly_their_members) {
    Random random(53);
    for (int repeat = 0; repeat < testing::scaled(100); ++repeat) {
        const int n = 1 + random.integer(8);
        std::vector<Contact> members, others;
        const auto deal = [&](const Contact& contact) {
            (random.integer(2) == 0 ? members : others).push_back(contact);
        };
        for (int i = 0; i < n; ++i) {
            for (int j = i + 1; j < n; ++j) {
                deal({ContactKind::disk_disk, i, j});
            }
            for (int a = 0; a < 2; ++a) {
                deal({ContactKind::lower_wall, i, a});
                deal({ContactKind::upper_wall, i, a});
            }
        }
        for (std::size_t k = members.size(); k-- > 1;) {
            std::swap(members[k], members[static_cast<std::size_t>(random.integer(static_cast<int>(k) + 1))]);
        }
        const ContactSet set(members, n);
        BOOST_TEST(std::ranges::all_of(members, [&](const Contact& c) { return set.contains(c); }));
        BOOST_TEST(std::ranges::none_of(others, [&](const Contact& c) { return set.contains(c); }));
    }
}

BOOST_AUTO_TEST_CASE(a_separation_is_the_sum_of_its_coordinates_with_their_signs) {
    for (const Contact& contact : contacts) {
        isostat::PerAxis<double> sum{};
        std::vector<std::size_t> order;
        Separation(contact, layout).for_each_coordinate([&](std::size_t k, std::size_t component, int sign) {
            sum[component] += sign * q[k];
            order.push_back(k);
        });
        BOOST_TEST(std::ranges::is_sorted(order));
        if (contact.kind == ContactKind::disk_disk) {
            const auto r = separation(layout, q, contact);
            BOOST_TEST(r == sum, boost::test_tools::per_element());
            BOOST_TEST(r[0] == q[static_cast<std::size_t>(2 * contact.j)] - q[static_cast<std::size_t>(2 * contact.i)]);
        } else {
            BOOST_TEST(wall_distance(layout, q, contact) == sum[static_cast<std::size_t>(contact.j)]);
        }
    }
    BOOST_TEST(wall_distance(layout, q, contacts[5]) == 128 - 8);
}

BOOST_AUTO_TEST_CASE(a_separation_is_the_same_in_another_arithmetic) {
    const auto residue = [](std::size_t k) { return static_cast<int>(q[k]) % 101; };
    const auto minus = [](int a, int b) { return (a - b + 101) % 101; };
    for (const Contact& contact : contacts) {
        const Separation separation(contact, layout);
        const auto reduced = [](double x) { return (static_cast<int>(x) % 101 + 101) % 101; };
        if (contact.kind == ContactKind::disk_disk) {
            const auto r = isostat::separation(layout, q, contact);
            BOOST_TEST(separation.of_disks(residue, minus)[0] == reduced(r[0]));
            BOOST_TEST(separation.of_disks(residue, minus)[1] == reduced(r[1]));
        } else {
            BOOST_TEST(separation.of_wall(residue, minus) == reduced(wall_distance(layout, q, contact)));
        }
    }
}

BOOST_AUTO_TEST_CASE(grains_touch_at_the_sum_of_their_radii) {
    const std::vector<double> radius{0.5, 0.25, 1};
    BOOST_TEST(touching_distance(radius, contacts[0]) == 1.5);
    BOOST_TEST(touching_distance(radius, contacts[1]) == 1.25);
    BOOST_TEST(touching_distance(radius, contacts[2]) == 0.25);
    BOOST_TEST(touching_distance(radius, contacts[4]) == 0.5);
    BOOST_TEST(touching_distance(radius, {ContactKind::held, 2, 0}) == 0);
}
