// The triangulation that lists are read from: made by CGAL, and carried along with disks that move.
#include "contact/candidates.hpp"
#include "contact/near_pairs.hpp"
#include "oracle/packings.hpp"
#include "support/scale.hpp"

#include <isostat/io/state_file.hpp>

#include <gmpxx.h>

using namespace isostat;
using namespace isostat::oracle;

namespace {

using Triangulation = RegularTriangulation;
using Edges = std::set<std::pair<int, int>>;

Edges edges_of(const Triangulation& triangulation) {
    Edges edges;
    triangulation.for_each_edge([&](int i, int j) { BOOST_TEST(edges.emplace(i, j).second); });
    return edges;
}

/// Every coordinate by at most `distance`.
Packing moved(Packing packing, double distance, Random& random) {
    for (double& x : packing.q) {
        x += random.real(-distance, distance);
    }
    return packing;
}

/// Whether some point has the same power with respect to i and j, and no smaller one with respect to any other disk:
/// the definition of an edge, by rationals. The points of the radical line are c + t w; each disk k leaves a half-line.
bool power_cells_meet(const Packing& packing, int i, int j) {
    const auto x = [&](int k) { return mpq_class(packing.q[static_cast<std::size_t>(2 * k)]); };
    const auto y = [&](int k) { return mpq_class(packing.q[static_cast<std::size_t>(2 * k + 1)]); };
    const auto weight = [&](int k) { // as rounded
        const double r = packing.radius[static_cast<std::size_t>(k)];
        return mpq_class(r * r);
    };
    const mpq_class dx = x(j) - x(i);
    const mpq_class dy = y(j) - y(i);
    const mpq_class square = dx * dx + dy * dy;
    const mpq_class s = (square + weight(i) - weight(j)) / (2 * square); // c = c_i + s d
    std::optional<mpq_class> least, most;
    for (int k = 0; k < packing.disk_count(); ++k) {
        if (k == i || k == j) {
            continue;
        }
        // pow_k - pow_i at c_i + s d + t (-dy, dx): linear in t, a - 2 b t.
        const mpq_class ex = x(k) - x(i);
        const mpq_class ey = y(k) - y(i);
        const mpq_class a = ex * ex + ey * ey - weight(k) + weight(i) - 2 * s * (ex * dx + ey * dy);
        const mpq_class b = ey * dx - ex * dy;
        if (b == 0) {
            if (a < 0) {
                return false;
            }
            continue;
        }
        const mpq_class t = a / (2 * b);
        if (b > 0 && (!most || t < *most)) {
            most = t;
        } else if (b < 0 && (!least || t > *least)) {
            least = t;
        }
    }
    return !least || !most || *least <= *most;
}

/// Every edge is one by definition.
void check_edges(const Packing& packing, const Triangulation& triangulation) {
    int wrong = 0;
    for (const auto& [i, j] : edges_of(triangulation)) {
        wrong += power_cells_meet(packing, i, j) ? 0 : 1;
    }
    BOOST_TEST(wrong == 0);
}

/// And no pair that is near is left out.
void check_complete(const Packing& packing, const Triangulation& triangulation) {
    check_edges(packing, triangulation);
    const double reach = 0.82 * packing.min_radius();
    BOOST_TEST((required(near_edges(packing, reach, triangulation)) == pairs_within(packing, reach)));
}

} // namespace

BOOST_AUTO_TEST_CASE(edges_are_pairs_whose_power_cells_meet) {
    Random random(2022);
    for (const double ratio : {1.0, 4.0, 100.0}) {
        for (const int n : {1, 2, 3, 5, 30, 80}) {
            const Packing packing = grown_cluster(n, ratio, random, [&] { return random.real(0, 0.5); });
            const auto triangulation = Triangulation::build(packing);
            BOOST_REQUIRE(triangulation != nullptr);
            BOOST_TEST(triangulation->disk_count() == packing.disk_count());
            check_complete(packing, *triangulation);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_triangulation_carried_to_where_disks_went_is_the_one_made_there) {
    Random random(2023);
    int unchanged = 0, flipped = 0, lost = 0;
    for (int repeat = 0; repeat < testing::scaled(150); ++repeat) {
        const double distance = std::ldexp(2.0, -(repeat % 10)); // 2 to 4e-3, the smallest radius being 1
        const Packing from = grown_cluster(50,
                                           repeat % 3 == 0   ? 1
                                           : repeat % 3 == 1 ? 2
                                                             : 20,
                                           random, [&] { return random.real(0, 0.5); });
        const Packing to = moved(from, 0.5 * distance, random);
        const auto before = Triangulation::build(from);
        const Edges edges_before = edges_of(*before);
        const auto carried = Triangulation::carry(before, to);
        BOOST_TEST((edges_of(*before) == edges_before)); // others share it
        if (!carried) {
            ++lost;
            continue;
        }
        ++(carried == before ? unchanged : flipped);
        BOOST_TEST((edges_of(*carried) == edges_of(*Triangulation::build(to)))); // in general position there is one
        if (repeat < 60 && carried != before) {
            check_edges(to, *carried); // it is regular though disks may overlap here
        }
    }
    BOOST_TEST_MESSAGE("unchanged " << unchanged << ", flipped " << flipped << ", lost " << lost);
    BOOST_TEST(unchanged >= 20); // every way was taken
    BOOST_TEST(flipped >= 30);
    BOOST_TEST(lost >= 5);
}

BOOST_AUTO_TEST_CASE(a_long_way_in_small_steps_is_carried_all_along) {
    Random random(2024);
    Packing packing = grown_cluster(100, 2, random, [&] { return random.real(0.3, 0.8); });
    const Packing start = packing;
    auto triangulation = Triangulation::build(packing);
    const Edges first = edges_of(*triangulation);
    for (int step = 0; step < 100; ++step) { // a shear of 1, in which no two disks come nearer than they are allowed
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            packing.q[2 * i] = start.q[2 * i] + 0.0025 * step * start.q[2 * i + 1];
        }
        triangulation = Triangulation::carry(triangulation, packing);
        BOOST_REQUIRE(triangulation != nullptr);
        if (step % 10 == 9) {
            BOOST_TEST((edges_of(*triangulation) == edges_of(*Triangulation::build(packing))));
        }
    }
    BOOST_TEST((edges_of(*triangulation) != first));
}

BOOST_AUTO_TEST_CASE(squares_of_a_lattice_keep_either_diagonal) {
    // Every square is cocircular: both diagonals are regular, and a flip back and forth must not go on for ever.
    const Packing lattice = square_lattice(8, 2.25);
    const auto made = Triangulation::build(lattice);
    check_complete(lattice, *made);
    BOOST_TEST((Triangulation::carry(made, lattice) == made));
    for (const double slope : {0.03, -0.03}) {
        Packing sheared = lattice;
        for (std::size_t i = 0; i < sheared.radius.size(); ++i) {
            sheared.q[2 * i] += slope * sheared.q[2 * i + 1];
        }
        const auto tilted = Triangulation::carry(made, sheared);
        BOOST_REQUIRE(tilted != nullptr);
        check_complete(sheared, *tilted);
        const auto back = Triangulation::carry(tilted, lattice);
        BOOST_REQUIRE(back != nullptr);
        check_complete(lattice, *back);
    }
}

BOOST_AUTO_TEST_CASE(a_list_does_not_depend_on_the_triangulation_it_is_carried_from) {
    Random random(2025);
    const Packing packing = grown_cluster(80, 3, random, [&] { return random.real(0, 0.5); });
    const std::vector<Contact> expected = find_candidates(packing, 0.8).contacts;
    // Near, far, the same disks in other places (two of them exchanged, mirrored), other radii, another number.
    Packing exchanged = packing;
    std::swap(exchanged.q[0], exchanged.q[20]);
    std::swap(exchanged.q[1], exchanged.q[21]);
    Packing mirrored = packing;
    for (std::size_t i = 0; i < mirrored.radius.size(); ++i) {
        mirrored.q[2 * i] = -mirrored.q[2 * i];
    }
    Packing smaller = packing;
    for (double& r : smaller.radius) {
        r *= random.real(0.5, 1);
    }
    const Packing fewer = grown_cluster(79, 3, random, [&] { return random.real(0, 0.5); });
    const Packing other = grown_cluster(80, 3, random, [&] { return random.real(0, 0.5); });
    for (const Packing& elsewhere :
         {packing, moved(packing, 1e-3, random), exchanged, mirrored, smaller, fewer, other}) {
        const auto from = Triangulation::build(elsewhere);
        BOOST_REQUIRE(from != nullptr);
        const CandidateList list = find_candidates(packing, 0.8, from);
        BOOST_TEST((list.contacts == expected));
        BOOST_TEST((list.triangulation != nullptr));
    }
    BOOST_TEST((find_candidates(packing, 0.8, Triangulation::build(packing)).triangulation != nullptr));
}

BOOST_AUTO_TEST_CASE(disks_that_come_to_overlap_are_found_by_the_grid) {
    Random random(2026);
    const Packing packing = grown_cluster(60, 2, random, [&] { return random.real(0, 0.5); });
    const auto from = find_candidates(packing, 0.8).triangulation;
    BOOST_REQUIRE(from != nullptr);
    int by_grid = 0;
    for (int repeat = 0; repeat < testing::scaled(30); ++repeat) {
        Packing to = packing;
        const auto i = static_cast<std::size_t>(random.integer(to.disk_count()));
        const auto j = static_cast<std::size_t>(random.integer(to.disk_count()));
        const double share = random.real(0, 1); // of the way from i to j
        to.q[2 * i] += share * (to.q[2 * j] - to.q[2 * i]);
        to.q[2 * i + 1] += share * (to.q[2 * j + 1] - to.q[2 * i + 1]);
        const CandidateList list = find_candidates(to, 0.8, from);
        BOOST_TEST((list.contacts == pairs_within(to, list.reach)));
        by_grid += list.triangulation ? 0 : 1;
    }
    BOOST_TEST(by_grid > 10);
    BOOST_TEST(by_grid < 30);
}

BOOST_AUTO_TEST_CASE(a_disk_that_comes_to_be_hidden_is_not_carried) {
    // In the middle of six, beside the centre: hidden when the disk in the centre grows. No face turns over, but an
    // edge that is not regular has no place to go.
    Packing packing = empty_cluster();
    append(packing, 0, 0, 0.2);
    append(packing, 0.5, 0.0625, 0.2);
    for (int k = 0; k < 6; ++k) {
        append(packing, 2 * std::cos(k * std::numbers::pi / 3), 2 * std::sin(k * std::numbers::pi / 3), 0.9);
    }
    const auto before = Triangulation::build(packing);
    BOOST_REQUIRE(before != nullptr);
    packing.radius[0] = 0.95;
    BOOST_TEST((Triangulation::build(packing) == nullptr));
    BOOST_TEST((Triangulation::carry(before, packing) == nullptr));
    const CandidateList list = find_candidates(packing, 0.8, before);
    BOOST_TEST((list.contacts == pairs_within(packing, list.reach)));
}

BOOST_AUTO_TEST_CASE(pairs_at_the_reach_are_listed_alike) {
    // Gaps a few roundings below and above the reach, along an axis and far from the origin.
    int near = 0, apart = 0;
    for (const double from : {0.0, -1.4, 1000.0}) {
        for (int ulps = -40; ulps <= 40; ++ulps) {
            for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
                Packing packing = empty_cluster();
                append(packing, from, from, 1);
                append(packing, from, from, 1);
                packing.q[2 + axis] = from + (2.8 + ulps * 0x1p-51);
                const NearPairs pairs = near_pairs(packing, 0.8);
                BOOST_REQUIRE(pairs.triangulation != nullptr);
                BOOST_TEST((pairs.pairs == pairs_within(packing, 0.8)));
                ++(pairs.pairs.empty() ? apart : near);
            }
        }
    }
    BOOST_TEST(near > 100);
    BOOST_TEST(apart > 100);
}

BOOST_AUTO_TEST_CASE(equal_disks_in_one_place_are_not_taken_for_one) {
    Random random(2027);
    Packing packing = grown_cluster(30, 20, random, [&] { return random.real(0, 0.5); });
    append(packing, packing.q[0], packing.q[1], packing.radius[0]);
    BOOST_TEST((Triangulation::build(packing) == nullptr));
    const CandidateList list = find_candidates(packing, 0.8);
    BOOST_TEST(std::ranges::binary_search(list.contacts, Contact{ContactKind::disk_disk, 0, 30}));
    BOOST_TEST((list.contacts == pairs_within(packing, list.reach)));
}

BOOST_AUTO_TEST_CASE(samples_of_the_paper_are_triangulated) {
    for (const std::string name : {"vertex100.txt", "vertex400.txt", "vertex1936.txt"}) {
        const Packing packing = read_state(std::string(ISOSTAT_TEST_DATA) + "/" + name).state.packing;
        const CandidateList list = find_candidates(packing, 0.8);
        BOOST_REQUIRE(list.triangulation != nullptr);
        Random random(7);
        const Packing near = moved(packing, 1e-9, random);
        BOOST_TEST((find_candidates(near, 0.8, list.triangulation).triangulation == list.triangulation));
        BOOST_TEST((near_pairs(packing, list.reach).pairs == pairs_within(packing, list.reach)));
    }
}

BOOST_AUTO_TEST_CASE(coordinates_far_larger_than_the_radii_are_listed_completely) {
    // Centres are rounded, and those of the outer disks too: they must not come to lie on others.
    for (const double away : {0x1p40, 0x1p60}) {
        Packing one = empty_cluster();
        append(one, -away, away, 1);
        BOOST_TEST((Triangulation::build(one) != nullptr));
        Packing packing = square_lattice(3, 2.25);
        for (double& x : packing.q) {
            x -= away;
        }
        BOOST_TEST((near_pairs(packing, 0.8).pairs == pairs_within(packing, 0.8)));
    }
}
