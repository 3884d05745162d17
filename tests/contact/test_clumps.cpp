// Members of one body are no pairs, however they overlap; all other pairs are found.
#include "contact/candidates.hpp"
#include "contact/near_pairs.hpp"
#include "contact/other_pairs.hpp"
#include "packing/bodies.hpp"
#include "support/test.hpp"

using isostat::Contact;
using isostat::Packing;

namespace {

/// Bodies of three members each, two of which overlap deeply, at random places: bodies overlap too.
Packing random_clumps(unsigned seed, int bodies, bool cell) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    Packing p;
    for (int b = 0; b < bodies; ++b) {
        const double x = 20 * uniform(random);
        const double y = 20 * uniform(random);
        for (const auto& [dx, dy, r] : {std::array{0.0, 0.0, 1.0}, {0.25, 0.0, 0.9}, {0.0, 1.5, 0.5}}) {
            p.q.insert(p.q.end(), {x + dx, y + dy});
            p.radius.push_back(r);
        }
        p.bars.insert(p.bars.end(), {{3 * b, 3 * b + 1, 0.25}, {3 * b, 3 * b + 2, 1.5}, {3 * b + 1, 3 * b + 2, 1.52}});
    }
    p.q.insert(p.q.end(), {22.0, 22.0});
    if (cell) {
        p.walls = isostat::Walls::none();
        p.cell.repeat();
        p.cell.move(true, true);
        p.q.push_back(1);
    }
    return p;
}

} // namespace

BOOST_AUTO_TEST_CASE(pairs_of_clumps_are_all_but_those_of_one_body) {
    for (const bool cell : {false, true}) {
        for (unsigned seed = 1; seed <= 20; ++seed) {
            const Packing p = random_clumps(seed, 15, cell);
            const isostat::Bodies bodies(p);
            constexpr double reach = 0.3;
            std::set<Contact> expected;
            for (int i = 0; i < p.disk_count(); ++i) {
                for (int j = i; j < p.disk_count(); ++j) {
                    for (int mx = cell ? -2 : 0; mx <= (cell ? 2 : 0); ++mx) {
                        for (int my = cell ? -2 : 0; my <= (cell ? 2 : 0); ++my) {
                            const isostat::Image image{{static_cast<std::int8_t>(mx), static_cast<std::int8_t>(my), 0}};
                            const bool own = bodies.of(i) == bodies.of(j) && image.is_here();
                            if (!own && isostat::gap(p, isostat::pair_of(i, j, image)) < reach) {
                                expected.insert(isostat::pair_of(i, j, image));
                            }
                        }
                    }
                }
            }
            const auto found = isostat::near_pairs(p, reach).pairs;
            BOOST_TEST((std::set<Contact>(found.begin(), found.end()) == expected), "seed " << seed);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_member_and_the_image_of_another_are_a_pair) {
    Packing p;
    p.walls = isostat::Walls::none();
    p.cell.repeat();
    p.cell.move(true, true);
    p.radius = {1, 1};
    p.q = {5, 5, 6, 5, 3.1, 9, 0};
    p.bars = {{0, 1, 1}};
    const std::vector<Contact> found = isostat::near_pairs(p, 0.3).pairs;
    BOOST_TEST((std::find(found.begin(), found.end(), isostat::pair_of(0, 1, {{-1, 0, 0}})) != found.end()));
    BOOST_TEST((std::find(found.begin(), found.end(), isostat::pair_of(0, 1)) == found.end()));
}

BOOST_AUTO_TEST_CASE(a_single_body_has_no_pair_but_with_the_walls) {
    const Packing p = random_clumps(1, 1, false);
    for (const Contact& pair : isostat::other_pairs(p, {}).near) {
        BOOST_TEST(!pair.of_disks());
    }
    Packing inside = p;
    inside.q[0] = inside.q[1] = inside.q[2] = inside.q[3] = inside.q[4] = 5;
    BOOST_TEST((isostat::certify_admissible(inside, 0).verdict == isostat::Verdict::proved)); // members overlap
}
