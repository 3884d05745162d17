#include "contact/separation.hpp"
#include "support/test.hpp"

using namespace isostat;

namespace {

constexpr isostat::Layout layout{2, 3};
const std::vector<double> q{1, 2, 4, 8, 16, 32, 64, 128}; // three disks, then the walls: every subset has another sum
const std::vector<Contact> contacts{{ContactKind::disk_disk, 0, 2},  {ContactKind::disk_disk, 1, 2},
                                    {ContactKind::lower_wall, 1, 0}, {ContactKind::lower_wall, 2, 1},
                                    {ContactKind::upper_wall, 0, 0}, {ContactKind::upper_wall, 1, 1}};

} // namespace

BOOST_AUTO_TEST_CASE(a_separation_is_the_sum_of_its_coordinates_with_their_signs) {
    for (const Contact& contact : contacts) {
        isostat::PerAxis<double> sum{};
        std::vector<std::size_t> order;
        Separation(contact, layout).for_each_coordinate([&](std::size_t k, std::size_t component, int sign) {
            sum[component] += sign * q[k];
            order.push_back(k);
        });
        BOOST_TEST(std::is_sorted(order.begin(), order.end()));
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
