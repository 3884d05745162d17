// Pairs that keep touching while the grains between them move: the count of the motions that keep all bars, against
// motions that are really made, and against lists in which something is missing or of another length.
#include "rigidity/rigid_group.hpp"
#include "support/crafted.hpp"

using namespace isostat;
using namespace crafted;

namespace {

Packing grains(std::vector<double> radius) {
    Packing packing;
    packing.q.assign(2 * radius.size() + 2, 0.0); // where they are is not looked at
    packing.radius = std::move(radius);
    return packing;
}

/// Two wheels of five disks each, joined by parallel bars 1-6 and 2-7, and 0-5 beside them.
struct Wheels {
    Packing packing = grains(std::vector<double>(10, 0.5));
    std::vector<Contact> among{pair(0, 1), pair(0, 2), pair(0, 3), pair(0, 4), pair(1, 3), pair(3, 4),
                               pair(4, 2), pair(5, 6), pair(5, 7), pair(5, 8), pair(5, 9), pair(6, 8),
                               pair(8, 9), pair(9, 7), pair(1, 6), pair(2, 7)};
    Contact last = pair(0, 5);
};

/// Mirror images: 4 and 6 at the top wall carry 8, 1 and 2 at the right one lean on 3.
struct Mirror {
    Packing packing = grains({0.5, 0.5, 0.5, 0.7, 0.7, 0.7, 0.7, 0.7, 0.7});
    std::vector<Contact> among{pair(7, 8), pair(0, 8), pair(3, 8), pair(4, 8), pair(1, 3), pair(1, 8),
                               pair(1, 4), pair(6, 8), pair(0, 6), top(4),     pair(2, 3), pair(3, 5),
                               pair(5, 7), pair(2, 5), top(6),     right(1),   right(2)};
    Contact last = pair(0, 7);
};

template <class Case> void count_of_each_is_needed(Case full) {
    BOOST_TEST(moves_as_linkage(full.packing, full.among, full.last));
    for (std::size_t l = 0; l < full.among.size(); ++l) {
        Case open = full;
        open.among.erase(open.among.begin() + static_cast<std::ptrdiff_t>(l));
        BOOST_TEST(!moves_as_linkage(open.packing, open.among, open.last), to_string(full.among[l]));
    }
}

} // namespace

BOOST_AUTO_TEST_CASE(three_parallel_bars_between_two_bodies_and_none_that_is_missing) {
    count_of_each_is_needed(Wheels());
}

BOOST_AUTO_TEST_CASE(parallel_bars_across_a_side_of_a_cell_and_none_around_it) {
    Wheels wheels;
    wheels.packing.q.push_back(0);
    wheels.packing.walls = Walls::none();
    wheels.packing.cell = {{true, true}, {true, true}, {true}, 3};
    // Disks of the second wheel stored a period further along: the bars to it go through that image.
    const auto across = [](const Contact& c) { return (c.i < 5) != (c.j < 5) ? pair_of(c.i, c.j, {{-1, 1, 0}}) : c; };
    for (Contact& c : wheels.among) {
        c = across(c);
    }
    wheels.last = across(wheels.last);
    count_of_each_is_needed(wheels);
    wheels.last.image.m[0] = 0; // another image of the wheel
    BOOST_TEST(!moves_as_linkage(wheels.packing, wheels.among, wheels.last));
}

BOOST_AUTO_TEST_CASE(mirror_images_at_two_walls) {
    count_of_each_is_needed(Mirror());
}

BOOST_AUTO_TEST_CASE(bars_of_another_length_are_not_parallel) {
    Wheels wheels;
    wheels.packing.radius[6] = std::nextafter(0.5, 1); // a parallelogram needs equal sides, exactly
    BOOST_TEST(!moves_as_linkage(wheels.packing, wheels.among, wheels.last));
    Mirror mirror;
    mirror.packing.radius[2] = std::nextafter(0.5, 1); // a mirror image at a wall equal disks
    BOOST_TEST(!moves_as_linkage(mirror.packing, mirror.among, mirror.last));
}

/// The motions that are counted are really there: the middle rhombus of a row of three, sheared, closes.
BOOST_AUTO_TEST_CASE(a_row_of_rhombi_shears_and_its_last_bar_keeps_its_length) {
    // 0 1 2 3 below, 4 5 6 7 above; rows are rigid by their triangles with 8 9 10 (below) and 11 12 13 (above).
    std::vector<Contact> among{pair(0, 1), pair(1, 2), pair(2, 3), pair(4, 5), pair(5, 6), pair(6, 7)};
    for (const int k : {0, 1, 2}) {
        for (const auto& [base, apex] : {std::pair{k, 8 + k}, std::pair{4 + k, 11 + k}}) {
            among.push_back(pair(base, apex));
            among.push_back(pair(base + 1, apex));
        }
    }
    for (const int first : {8, 11}) {
        among.push_back(pair(first, first + 1));
        among.push_back(pair(first + 1, first + 2));
    }
    among.push_back(pair(0, 4));
    among.push_back(pair(3, 7));
    const Packing packing = grains(std::vector<double>(14, 0.5));
    // 0-4 and 3-7 are far apart: no rhombus joins them before the bars between are there.
    BOOST_TEST(!moves_as_linkage(packing, among, pair(1, 5)));
    among.back() = pair(1, 5);
    BOOST_TEST(moves_as_linkage(packing, among, pair(2, 6)));
    for (const double angle : {0.7, 1.2, 2.0}) {
        const double dx = std::cos(angle);
        const double dy = std::sin(angle);
        BOOST_TEST(std::abs(std::hypot((2 + dx) - 2, dy) - 1) < 1e-15);
    }
}

BOOST_AUTO_TEST_CASE(held_coordinates_fixed_disks_and_cells_are_no_linkages) {
    Wheels wheels;
    wheels.packing.fixed.assign(10, 0);
    BOOST_TEST(moves_as_linkage(wheels.packing, wheels.among, wheels.last));
    wheels.packing.fixed[8] = 1;
    BOOST_TEST(!moves_as_linkage(wheels.packing, wheels.among, wheels.last));
    Mirror mirror;
    mirror.among.back() = {ContactKind::held, 2, 0};
    BOOST_TEST(!moves_as_linkage(mirror.packing, mirror.among, mirror.last));
    Mirror fixed;
    fixed.packing.walls.upper[0] = WallKind::fixed; // the right wall still only joins one side
    BOOST_TEST(moves_as_linkage(fixed.packing, fixed.among, fixed.last));
}
