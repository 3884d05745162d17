// Members of one body are no pairs, however they overlap; all other pairs are found.
#include "contact/candidates.hpp"
#include "contact/images.hpp"
#include "contact/near_pairs.hpp"
#include "contact/other_pairs.hpp"
#include "packing/bodies.hpp"
#include "support/cells.hpp"
#include "support/free_grains.hpp"

using isostat::Contact;
using isostat::Packing;
using isostat::State;

namespace {

/// Every pair with a gap below `reach` among images up to 8 periods away, by the definition.
std::vector<Contact> by_definition(const Packing& packing, double reach) {
    std::vector<Contact> pairs;
    const bool x = packing.cell.periodic[0];
    const bool y = packing.cell.periodic[1];
    for (int i = 0; i < packing.disk_count(); ++i) {
        for (int j = i; j < packing.disk_count(); ++j) {
            for (int m = x ? -8 : 0; m <= (x ? 8 : 0); ++m) {
                for (int p = y ? -8 : 0; p <= (y ? 8 : 0); ++p) {
                    const Contact pair = isostat::pair_of(i, j, cells::image(m, p));
                    const bool twice = i == j && pair.image != cells::image(m, p);
                    if ((i != j || m != 0 || p != 0) && !twice && isostat::gap(packing, pair) < reach) {
                        pairs.push_back(pair);
                    }
                }
            }
        }
    }
    std::ranges::sort(pairs);
    return pairs;
}

struct Draw {
    int disks;
    double largest;
    bool tilted, channel;
};

/// Disks that do not overlap, some of them outside the cell.
Packing random_cell(const Draw& draw, std::mt19937_64& random) {
    const auto uniform = [&](double a, double b) {
        return a + (b - a) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    const double side = draw.largest * std::max(2.3, 1.4 * std::sqrt(draw.disks));
    std::vector<crafted::DiskAt> disks;
    const cells::Periods periods{side * uniform(0.9, 1.3), side * uniform(0.9, 1.3),
                                 draw.tilted ? side * uniform(-0.7, 0.7) : 0};
    for (int tries = 0; static_cast<int>(disks.size()) < draw.disks && tries < 400; ++tries) {
        disks.push_back({uniform(draw.largest > 1 ? 0.3 : 0.6, draw.largest), uniform(-1.5, 2.5) * periods.x,
                         uniform(-1, 2) * periods.y});
        State state = cells::in_cell(disks, periods, draw.tilted, 1, 1, {});
        if (draw.channel) {
            state.packing.cell.periodic[1] = state.packing.cell.period_moves[1] = false;
        }
        const auto near = by_definition(state.packing, 0);
        if (!near.empty()) {
            disks.pop_back();
        }
    }
    Packing packing = cells::in_cell(disks, periods, draw.tilted, 1, 1, {}).packing;
    if (draw.channel) {
        packing.cell.periodic[1] = packing.cell.period_moves[1] = false;
    }
    return packing;
}

bool all_there(const std::vector<Contact>& wanted, const std::vector<Contact>& found) {
    return std::ranges::includes(found, wanted);
}

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

BOOST_AUTO_TEST_CASE(a_pair_many_periods_apart_is_listed_whatever_its_sums_lose) {
    // Each of 116 periods is rounded the same way: the gap as computed is 8.5e-13 above the true one.
    const double x = -0x1.6174d7ec396b3p+6, y = 118;
    State state = cells::in_cell({{0.5, x, -y}, {0.5, 0, y}}, {2, 4, 0.5}, true, 1, 1, {});
    Packing& packing = state.packing;
    packing.q = {x, -y, 0x1.6024c1add3ea5p+6, y, 0x1.0000000081e40p+0, 4, 0x1.000000000006fp+1};
    const Contact pair(isostat::ContactKind::disk_disk, 0, 1, cells::image(-57, -59));
    const double computed = isostat::gap(packing, pair);
    BOOST_TEST(computed == 0x1.6666666667584p+0 - 1);
    const auto near = isostat::near_pairs(packing, computed - 8e-13).pairs;
    BOOST_TEST((std::ranges::find(near, pair) != near.end()));
}

BOOST_AUTO_TEST_CASE(pairs_are_all_found_in_cells_of_one_disk_and_more) {
    std::mt19937_64 random(11);
    int seen = 0;
    for (const Draw& draw :
         {Draw{1, 1, false, false}, Draw{1, 1, true, false}, Draw{2, 1, true, false}, Draw{2, 3, true, false},
          Draw{5, 1, true, false}, Draw{8, 3, true, false}, Draw{6, 1, false, true}}) {
        for (int k = 0; k < 25; ++k) {
            const Packing packing = random_cell(draw, random);
            const double reach = 0.82 * packing.min_radius();
            const auto wanted = by_definition(packing, reach);
            const auto found = isostat::near_pairs(packing, reach).pairs;
            BOOST_TEST(all_there(wanted, found));
            BOOST_TEST(found.size() <= wanted.size() + 1); // one at the reach, by rounding
            seen += static_cast<int>(wanted.size());
        }
    }
    BOOST_TEST(seen > 50);
}

BOOST_AUTO_TEST_CASE(a_flat_cell_has_images_several_periods_away) {
    // The disk touches itself two periods back and one up.
    const State state = cells::in_cell({{1, 0, 0}}, {2, std::sqrt(3.0), 5}, true, 1, 1, {});
    const auto found = isostat::near_pairs(state.packing, 0.5).pairs;
    const std::vector<Contact> wanted = by_definition(state.packing, 0.5);
    BOOST_TEST((found == wanted));
    BOOST_TEST((std::ranges::find(found, cells::across(0, 0, -2, 1)) != found.end()));
}

BOOST_AUTO_TEST_CASE(overlaps_with_images_are_found) {
    const State touching = cells::one_disk(1, 1);
    BOOST_TEST((isostat::certify_admissible(touching.packing, 0).verdict == isostat::Verdict::proved));
    State smaller = touching;
    smaller.packing.length(0) = std::nextafter(2.0, 1.0);
    const auto result = isostat::certify_admissible(smaller.packing, 0);
    BOOST_TEST((result.verdict == isostat::Verdict::refuted));
    BOOST_TEST((result.worst == cells::across(0, 0, 1, 0)));
}

BOOST_AUTO_TEST_CASE(a_disk_and_its_image_in_a_period_that_stays_are_no_candidate) {
    State state = cells::one_disk(1, 1);
    BOOST_TEST(isostat::find_candidates(state.packing, 0.8).contacts.size() == 2);
    state.packing.cell.period_moves = {true, false};
    const auto list = isostat::find_candidates(state.packing, 0.8).contacts;
    BOOST_TEST_REQUIRE(list.size() == 1);
    BOOST_TEST((list.front() == cells::across(0, 0, 1, 0)));
    state.packing.length(1) = 1.9;
    BOOST_TEST((isostat::fixed_overlap(state.packing) == cells::across(0, 0, 0, 1)));
}

BOOST_AUTO_TEST_CASE(representatives_far_away_are_refused) {
    State state = cells::one_disk(1, 1);
    state.packing.q[0] = 70;
    BOOST_CHECK_THROW(isostat::near_pairs(state.packing, 0.5), isostat::Error);
}

BOOST_AUTO_TEST_CASE(one_contact_has_one_name) {
    BOOST_TEST((cells::across(3, 1, 1, -1) == cells::across(1, 3, -1, 1)));
    BOOST_TEST((cells::across(2, 2, -1, 1) == cells::across(2, 2, 1, -1)));
    BOOST_TEST((cells::across(1, 3, 0, 0) != cells::across(1, 3, 1, 0)));
    BOOST_TEST(isostat::to_string(cells::across(3, 1, 1, -1)) == "1-3(-1,1)");
}

BOOST_AUTO_TEST_CASE(a_nearest_pair_that_no_list_reaches_is_far) {
    // One disk that touches its image; the next image is a period further, in a cell that leans over `lean` heights.
    const auto next_pair = [](double lean) {
        Packing packing = without_walls::free_grains({1}, {0, 0, 2, 100, 100 * lean});
        packing.cell = {{true, true}, {true, true}, {true}, 0};
        return isostat::other_pairs(packing, {cells::across(0, 0, 1, 0)});
    };
    const isostat::OtherPairs found = next_pair(5);
    BOOST_TEST(!found.far());
    BOOST_TEST((found.near == std::vector<Contact>{cells::across(0, 0, 2, 0)}));
    const isostat::OtherPairs none = next_pair(15);
    BOOST_TEST(none.far());
    BOOST_TEST(none.reach > 0); // complete so far
    BOOST_TEST(none.reach <= 2);
}

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
    Packing p = without_walls::free_grains({1, 1}, {5, 5, 6, 5, 3.1, 9, 0});
    p.cell.repeat();
    p.cell.move(true, true);
    p.bars = {{0, 1, 1}};
    const std::vector<Contact> found = isostat::near_pairs(p, 0.3).pairs;
    BOOST_TEST((std::ranges::find(found, isostat::pair_of(0, 1, {{-1, 0, 0}})) != found.end()));
    BOOST_TEST((std::ranges::find(found, isostat::pair_of(0, 1)) == found.end()));
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
