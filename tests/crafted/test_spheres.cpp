// Which contacts of spheres can carry, and counts of spheres against the gap threshold.
#include "crafted/peeling.hpp"
#include "support/spheres.hpp"
#include "support/test.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/exact/number.hpp>

namespace {

using isostat::Contact;
using isostat::ContactKind;
using isostat::Packing;
using isostat::Verdict;
using isostat::exact::Number;

/// A free sphere at 0 and fixed ones at integer places.
Packing star(const std::vector<std::array<int, 3>>& places) {
    Packing packing;
    packing.dimension = packing.cell.dimension = 3;
    packing.walls = isostat::Walls::none();
    packing.q = {0, 0, 0};
    packing.radius.assign(places.size() + 1, 0.5);
    for (const auto& place : places) {
        packing.q.insert(packing.q.end(), place.begin(), place.end());
    }
    packing.q.insert(packing.q.end(), 3, 0);
    packing.fixed.assign(packing.radius.size(), 1);
    packing.fixed[0] = 0;
    return packing;
}

/// Whether forces >= 0 from the first m places balance with that of place l equal to 1, by exact linear programming.
bool can_carry(const std::vector<std::array<int, 3>>& places, std::size_t m, std::size_t l) {
    std::vector<std::vector<Number>> rows(4, std::vector<Number>(m, Number(0)));
    for (std::size_t k = 0; k < m; ++k) {
        for (std::size_t a = 0; a < 3; ++a) {
            rows[a][k] = Number(places[k][a]);
        }
    }
    rows[3][l] = Number(1);
    return isostat::exact::feasible_point(rows, {Number(0), Number(0), Number(0), Number(1)}, static_cast<int>(m))
        .feasible;
}

} // namespace

BOOST_AUTO_TEST_SUITE(crafted_spheres)

BOOST_AUTO_TEST_CASE(contacts_of_a_sphere_carry_where_exact_linear_programming_says_so) {
    std::mt19937_64 random(1);
    int carrying = 0, idle = 0;
    for (int trial = 0; trial < 300; ++trial) {
        // Few integers: coplanar, opposite and parallel directions are frequent. Some lists lie in a plane or on a
        // line.
        const std::array<int, 3> range{2, trial % 3 == 0 ? 0 : 2, trial % 5 == 0 ? 0 : 1};
        std::vector<std::array<int, 3>> places;
        while (places.size() < 3 + random() % 6) {
            std::array<int, 3> place{};
            for (std::size_t a = 0; a < 3; ++a) {
                place[a] = static_cast<int>(random() % static_cast<unsigned>(2 * range[a] + 1)) - range[a];
            }
            if (place != std::array<int, 3>{}) {
                places.push_back(place);
            }
        }
        std::vector<Contact> contacts;
        for (std::size_t k = 0; k < places.size(); ++k) {
            contacts.emplace_back(ContactKind::disk_disk, 0, static_cast<int>(k + 1));
        }
        const auto peeled = isostat::crafted::peel(star(places), contacts);
        for (std::size_t m = 1; m <= places.size(); ++m) {
            bool any = false;
            for (std::size_t l = 0; l < m; ++l) {
                const bool expected = can_carry(places, m, l);
                any = any || expected;
                (expected ? carrying : idle) += 1;
                BOOST_TEST((peeled.contact_from[l] <= static_cast<int>(m)) == expected,
                           "trial " << trial << ", contact " << l << " of the first " << m);
            }
            BOOST_TEST((peeled.disk_from[0] <= static_cast<int>(m)) == any);
        }
    }
    BOOST_TEST(carrying > 300); // both answers are tried
    BOOST_TEST(idle > 300);
}

BOOST_AUTO_TEST_CASE(a_packing_of_another_program_is_isostatic_in_its_widest_range_of_thresholds) {
    for (const std::string name : {"box_uniform_30_1", "slab_uniform_30_1", "ortho_uniform_30_1"}) {
        BOOST_TEST_CONTEXT(name) {
            const auto file = isostat::test::read_spheres(name);
            const Packing packing = isostat::test::state_of_spheres(file).packing;
            const auto strain = name[0] == 'o' ? isostat::Strain::diagonal : isostat::Strain::isotropic;
            const auto plateau = isostat::crafted::plateau(packing, 1e-11, 1e-4, 8, strain);
            BOOST_TEST_REQUIRE(plateau.widest.has_value());
            const auto& [range, counts] = *plateau.widest;
            BOOST_TEST(counts.contact_count == file["expected"]["contacts_with_force"].get<int>());
            BOOST_TEST(range.rattlers == static_cast<int>(file["expected"]["rattlers"].size()));
            BOOST_TEST((counts.isostatic == Verdict::proved));
            BOOST_TEST(counts.hyperstaticity == 0);
        }
    }
}

BOOST_AUTO_TEST_CASE(two_spheres_at_one_place_are_refused) {
    const Packing packing = star({{{1, 0, 0}}, {{1, 0, 0}}});
    const std::vector<Contact> contacts{{ContactKind::disk_disk, 1, 2}};
    BOOST_CHECK_THROW(isostat::crafted::peel(packing, contacts), isostat::Error);
}

BOOST_AUTO_TEST_SUITE_END()
