#include "../../src/contact/near_pairs.hpp"
#include "contact/candidates.hpp"
#include "oracle/geometry.hpp"
#include "oracle/packings.hpp"
#include "oracle/pairs.hpp"
#include "support/free_grains.hpp"
#include "support/scale.hpp"
#include "support/units.hpp"

#include <gmpxx.h>

using namespace isostat;
using namespace isostat::oracle;

namespace {

/// Over the rationals.
struct ExactGaps : Geometry<mpq_class> {
    using Geometry<mpq_class>::Geometry;
    /// Sign of gap - bound (bound >= -(R_i + R_j) for disk pairs).
    [[nodiscard]] int sign_beyond(const Contact& contact, double bound) const {
        if (!is_pair(contact)) {
            return cmp(linear_gap(contact), mpq_class(bound));
        }
        const mpq_class d = target(contact) + mpq_class(bound);
        return sgn(d) < 0 ? 1 : cmp(square(between(contact)), mpq_class(d * d));
    }
};

/// Two-sided: nothing below the reach is missing, nothing above it (beyond rounding) is listed.
void check_against_every_pair(const Packing& packing, double fraction) {
    const CandidateList list = find_candidates(packing, fraction);
    BOOST_TEST(std::ranges::is_sorted(list.contacts));
    BOOST_TEST(list.reach == fraction * packing.min_radius());
    const std::set<Contact> listed(list.contacts.begin(), list.contacts.end());
    BOOST_TEST(listed.size() == list.contacts.size());
    int missing = 0, superfluous = 0;
    const ExactGaps exact(packing);
    for (const Contact& contact : all_pairs(packing)) {
        if (listed.contains(contact)) {
            superfluous += exact.sign_beyond(contact, list.reach + 1e-12 * packing.max_radius()) > 0 ? 1 : 0;
        } else {
            missing += exact.sign_beyond(contact, list.reach) < 0 ? 1 : 0;
        }
    }
    BOOST_TEST(missing == 0);
    BOOST_TEST(superfluous == 0);
}

/// The verdict of every pair by rationals.
Verdict exact_verdict(const Packing& packing, double allowance) {
    const ExactGaps exact(packing);
    const auto pairs = all_pairs(packing);
    const bool overlaps =
        std::ranges::any_of(pairs, [&](const Contact& c) { return exact.sign_beyond(c, -allowance) < 0; });
    return overlaps ? Verdict::refuted : Verdict::proved;
}

void check_verdict(const Packing& packing, double allowance) {
    const Admissibility result = certify_admissible(packing, allowance);
    BOOST_TEST((result.verdict == exact_verdict(packing, allowance)));
    if (result.verdict == Verdict::refuted) {
        BOOST_TEST(ExactGaps(packing).sign_beyond(result.worst, -allowance) < 0);
    }
}

Packing pair_at(double x, double y, double r0, double r1) {
    Packing packing = empty_cluster();
    append(packing, 0, 0, r0);
    append(packing, x, y, r1);
    return packing;
}

/// Spheres each of which touches one before it, or nearly, without overlap; `axes` that they spread along.
Packing spheres_that_cling(Random& random, int axes) {
    Packing packing = without_walls::free_grains({1}, {}, 3);
    packing.q = {0, 0, 0};
    const double ratio = random.integer(2) == 0 ? 1 : random.real(1, 4);
    for (int tries = 0; tries < 400; ++tries) {
        const double radius = random.real(1, ratio);
        const auto parent = static_cast<std::size_t>(random.integer(packing.disk_count()));
        std::array<double, 3> x{};
        std::generate_n(x.begin(), axes, [&] { return random.real(-1, 1); });
        const double gap = random.integer(2) == 0 ? 0 : random.real(0, 1);
        const double scale = (packing.radius[parent] + radius + gap) / std::hypot(x[0], x[1], x[2]);
        for (std::size_t a = 0; a < 3; ++a) {
            x[a] = packing.q[3 * parent + a] + x[a] * scale;
        }
        bool apart = true;
        for (std::size_t k = 0; k < packing.radius.size(); ++k) {
            const double distance =
                std::hypot(x[0] - packing.q[3 * k], x[1] - packing.q[3 * k + 1], x[2] - packing.q[3 * k + 2]);
            apart = apart && distance > (packing.radius[k] + radius) * (1 - 1e-14);
        }
        if (apart) {
            packing.radius.push_back(radius);
            packing.q.insert(packing.q.end(), x.begin(), x.end());
        }
    }
    packing.q.insert(packing.q.end(), {0, 0, 0});
    return packing;
}

} // namespace

BOOST_AUTO_TEST_CASE(edges_of_spheres_are_all_the_pairs_that_the_grid_finds) {
    Random random(31);
    for (int trial = 0; trial < isostat::testing::scaled(40); ++trial) {
        const Packing packing = spheres_that_cling(random, trial % 4 == 0 ? trial / 4 % 3 + 1 : 3); // flat ones too
        const double reach = 0.82 * packing.min_radius();
        const auto edges = required(near_edges_in_space(packing, reach));
        BOOST_TEST((edges == pairs_within(packing, reach)));
        BOOST_TEST(edges.size() + 1 >= packing.radius.size() / 2);
    }
    Packing octahedron = spheres_that_cling(random, 1);
    const double s = std::sqrt(2.0); // of three diagonals with the gap of T6 one is an edge
    octahedron.radius.assign(6, 1);
    octahedron.q = {s, 0, 0, -s, 0, 0, 0, s, 0, 0, -s, 0, 0, 0, s, 0, 0, -s, 0, 0, 0};
    BOOST_TEST(near_edges_in_space(octahedron, 0.825)->size() == 12U);
    octahedron.q[0] = 0.5; // it overlaps others
    BOOST_TEST(!near_edges_in_space(octahedron, 0.825));
}

BOOST_AUTO_TEST_CASE(lists_are_complete_in_random_clusters_at_any_size_ratio) {
    Random random(20240601);
    for (const double ratio : {1.0, 2.0, 10.0, 100.0}) {
        for (const int n : {1, 2, 3, 4, 7, 20, 60, 150, 500}) {
            for (int repeat = 0; repeat < (n < 100 ? 6 : 1); ++repeat) {
                // Tangent disks, and gaps up to the reach of the theorem and beyond.
                const double widest = repeat % 3 == 0 ? 0 : repeat % 3 == 1 ? 0.9 : 3;
                Packing packing = grown_cluster(n, ratio, random, [&] { return random.real(0, widest); });
                const double reach = 0.82 * packing.min_radius();
                const NearPairs by_triangulation = near_pairs(packing, reach);
                BOOST_TEST((by_triangulation.triangulation != nullptr));
                BOOST_TEST((by_triangulation.pairs == pairs_within(packing, reach))); // the grid's
                check_against_every_pair(packing, 0.82);
                if (n < 100) {
                    check_against_every_pair(packing, 0.1);
                    enclose(packing, random.real(0, 1));
                    check_against_every_pair(packing, 0.82);
                }
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(lists_are_complete_in_lattices_with_cocircular_squares) {
    for (const int m : {2, 3, 10}) {
        for (const double step : {2.0, 2.125, 2.75}) {
            check_against_every_pair(square_lattice(m, step), 0.82);
            check_against_every_pair(triangular_lattice(m, step), 0.82);
        }
    }
}

BOOST_AUTO_TEST_CASE(square_of_four_disks_is_the_limit_of_the_theorem) {
    // The diagonals of four tangent equal disks have gap 2 (sqrt 2 - 1) R = 0.8284 R: beyond the largest fraction.
    const CandidateList list = find_candidates(square_lattice(2, 2), 0.82);
    BOOST_TEST(list.contacts.size() == 4U);
    // Slightly compressed into a rhombus, one diagonal is below 0.82 R and must be found.
    Packing rhombus = empty_cluster();
    const double half = 1 + 0.5 * 0.8199;
    const double other = std::sqrt(4 - half * half);
    append(rhombus, half, 0, 1);
    append(rhombus, -half, 0, 1);
    append(rhombus, 0, other, 1);
    append(rhombus, 0, -other, 1);
    BOOST_TEST(find_candidates(rhombus, 0.82).contacts.size() == 5U);
    check_against_every_pair(rhombus, 0.82);
}

BOOST_AUTO_TEST_CASE(one_two_and_collinear_disks) {
    Packing one = empty_cluster();
    append(one, 3, 4, 2);
    BOOST_TEST(find_candidates(one, 0.5).contacts.empty());
    enclose(one, 0);
    BOOST_TEST(find_candidates(one, 0.5).contacts.size() == 4U);
    BOOST_TEST(find_candidates(pair_at(3, 4, 2, 3), 0.5).contacts.size() == 1U);
    BOOST_TEST(find_candidates(pair_at(30, 40, 2, 3), 0.5).contacts.empty());
    for (const bool along_x : {true, false}) {
        Packing line = empty_cluster();
        for (int i = 0; i < 20; ++i) { // not in the order of the line
            const double s = 2.25 * ((7 * i) % 20);
            append(line, along_x ? s : 0.5, along_x ? 0.5 : s, 1);
        }
        BOOST_TEST(find_candidates(line, 0.5).contacts.size() == 19U);
        check_against_every_pair(line, 0.82);
    }
}

BOOST_AUTO_TEST_CASE(overlapping_packings_are_still_searched_completely) {
    // The theorem does not apply: hidden disks, disks inside others, coincident centres.
    Random random(7);
    for (int repeat = 0; repeat < testing::scaled(40); ++repeat) {
        Packing packing = empty_cluster();
        for (int i = 0; i < 40; ++i) {
            append(packing, random.real(0, 10), random.real(0, 10), random.real(0.2, 2));
        }
        append(packing, packing.q[0], packing.q[1], 1);
        check_against_every_pair(packing, 0.82);
        check_verdict(packing, 0);
        check_verdict(packing, 3.9);
        check_verdict(packing, 4);
    }
}

BOOST_AUTO_TEST_CASE(the_pair_list_is_the_one_of_brute_force) {
    Random random(11);
    const auto noise = [&random] { return random.real(-1, 1); };
    for (const double ratio : {1.0, 3.0, 40.0}) {
        for (const double reach : {0.0, 0.3, 5.0}) {
            for (const int n : {1, 2, 7, 150}) {
                std::vector<double> x, radius;
                for (int i = 0; i < n; ++i) {
                    x.push_back(1e3 + 12 * noise());
                    x.push_back(n == 7 ? 0.0 : 6 * noise()); // seven disks in a row: no extent along y
                    radius.push_back(0.5 * std::pow(ratio, noise()));
                }
                PairList pairs;
                find_pairs(2, x, radius, reach, pairs);
                std::vector<std::pair<int, int>> found, expected;
                for (std::size_t i = 0; i < radius.size(); ++i) {
                    for (int k = pairs.start[i]; k < pairs.start[i + 1]; ++k) {
                        found.emplace_back(static_cast<int>(i), pairs.partner[static_cast<std::size_t>(k)]);
                    }
                    for (std::size_t j = i + 1; j < radius.size(); ++j) {
                        const double range = radius[i] + radius[j] + reach;
                        if (std::pow(x[2 * j] - x[2 * i], 2) + std::pow(x[2 * j + 1] - x[2 * i + 1], 2) <
                            range * range) {
                            expected.emplace_back(static_cast<int>(i), static_cast<int>(j));
                        }
                    }
                }
                BOOST_TEST((found == expected));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(extreme_units_and_size_ratios_fall_back_on_the_grid) {
    for (const double scale : {0x1p-1000, 0x1p-500, 0x1p-40, 1.0, 0x1p40, 0x1p500, 0x1p1000}) {
        Packing packing = square_lattice(4, 2.25 * scale);
        std::ranges::fill(packing.radius, scale);
        check_against_every_pair(packing, 0.82);
        check_verdict(packing, 0);
        packing.q[1] = packing.q[3] - 2 * scale; // tangent to the next one
        check_verdict(packing, 0);
        packing.q[1] = std::nextafter(packing.q[1], packing.q[3]);
        check_verdict(packing, 0);
    }
    Packing giant = pair_at(1e9 + 1, 0, 1e9, 1);
    append(giant, 1e9 + 1, 2.5, 1);
    check_against_every_pair(giant, 0.82);
    check_verdict(giant, 0);
}

BOOST_AUTO_TEST_CASE(a_disk_inside_another_is_found_though_no_edge_overlaps) {
    // The small disk is hidden in the triangulation; the others are apart.
    Packing packing = square_lattice(4, 2.25);
    append(packing, 2.3, 2.2, 0.25);
    BOOST_TEST((near_pairs(packing, 0.2).triangulation == nullptr));
    check_against_every_pair(packing, 0.82);
    check_verdict(packing, 0);
}

BOOST_AUTO_TEST_CASE(deep_overlaps_without_hidden_disk_are_found) {
    // Equal disks on a step far below their diameter: no vertex is hidden, most overlapping pairs are no edges.
    Packing packing = square_lattice(6, 0.5);
    BOOST_TEST((near_pairs(packing, 0.5).triangulation == nullptr));
    check_against_every_pair(packing, 0.82);
    check_verdict(packing, 0);
    check_verdict(packing, 1.5);
}

BOOST_AUTO_TEST_CASE(powers_of_two_in_the_unit_change_nothing) {
    Random random(5);
    Packing packing = grown_cluster(80, 8, random, [&] { return random.real(0, 1); });
    enclose(packing, 0.25);
    const std::vector<Contact> reference = find_candidates(packing, 0.82).contacts;
    for (const int exponent : {-900, -560, -20, 20, 560, 900}) {
        Packing scaled = packing;
        units::stretch(scaled, std::ldexp(1.0, exponent));
        BOOST_TEST((find_candidates(scaled, 0.82).contacts == reference));
        check_verdict(scaled, 0);
    }
}

BOOST_AUTO_TEST_CASE(fixed_disks_are_listed_only_against_what_can_move) {
    Packing packing = square_lattice(2, 2);
    enclose(packing, 0);
    packing.walls.upper[0] = WallKind::fixed;
    packing.fixed = {1, 1, 0, 0}; // disks 0 and 1: left column
    const CandidateList list = find_candidates(packing, 0.5);
    const std::vector<Contact> expected = {{ContactKind::disk_disk, 0, 2},  {ContactKind::disk_disk, 1, 3},
                                           {ContactKind::disk_disk, 2, 3},  {ContactKind::lower_wall, 2, 1},
                                           {ContactKind::upper_wall, 1, 1}, {ContactKind::upper_wall, 2, 0},
                                           {ContactKind::upper_wall, 3, 0}, {ContactKind::upper_wall, 3, 1}};
    BOOST_TEST((list.contacts == expected));
    packing.q[1] += 0.125; // the fixed pair overlaps: not a candidate, but not admissible either
    BOOST_TEST((certify_admissible(packing, 0).verdict == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(a_list_covers_displacements_below_half_its_reach) {
    Packing packing = square_lattice(3, 2.5);
    enclose(packing, 0.25);
    const CandidateList list = find_candidates(packing, 0.5);
    BOOST_TEST(list.covers(packing));
    BOOST_TEST(list.covers(packing, 0.49 * list.reach));
    BOOST_TEST(!list.covers(packing, 0.51 * list.reach));
    for (const std::size_t k : {std::size_t{0}, std::size_t{7}, packing.q.size() - 1}) {
        Packing moved = packing;
        moved.q[k] += 0.2499999;
        BOOST_TEST(list.covers(moved));
        moved.q[k] = packing.q[k] - 0.25;
        BOOST_TEST(!list.covers(moved));
        moved.q[k] = std::numeric_limits<double>::quiet_NaN();
        BOOST_TEST(!list.covers(moved));
    }
    Packing diagonal = packing;
    diagonal.q[4] += 0.2;
    diagonal.q[5] -= 0.2;
    BOOST_TEST(!list.covers(diagonal));
    Packing other = square_lattice(2, 2.5);
    BOOST_TEST(!list.covers(other));
}

BOOST_AUTO_TEST_CASE(exact_tangency_is_admissible_and_one_ulp_more_is_not) {
    // 3-4-5: the distance is an integer.
    BOOST_TEST((certify_admissible(pair_at(3, 4, 2, 3), 0).verdict == Verdict::proved));
    BOOST_TEST((certify_admissible(pair_at(std::nextafter(3.0, 0.0), 4, 2, 3), 0).verdict == Verdict::refuted));
    BOOST_TEST((certify_admissible(pair_at(3, 4, std::nextafter(2.0, 3.0), 3), 0).verdict == Verdict::refuted));
    BOOST_TEST((certify_admissible(pair_at(std::nextafter(3.0, 4.0), 4, 2, 3), 0).verdict == Verdict::proved));
    // The allowance is exact too.
    BOOST_TEST((certify_admissible(pair_at(3, 4, 2.25, 3), 0.25).verdict == Verdict::proved));
    BOOST_TEST((certify_admissible(pair_at(3, 4, 2.25, 3), std::nextafter(0.25, 0.0)).verdict == Verdict::refuted));
    // Walls, likewise.
    Packing boxed = square_lattice(2, 2);
    enclose(boxed, 0);
    BOOST_TEST((certify_admissible(boxed, 0).verdict == Verdict::proved));
    for (const int axis : {0, 1}) {
        Packing tight = boxed;
        tight.length(axis) = std::nextafter(tight.length(axis), 0.0);
        const Admissibility refuted = certify_admissible(tight, 0);
        BOOST_TEST((refuted.verdict == Verdict::refuted));
        BOOST_TEST((refuted.worst.kind == ContactKind::upper_wall));
        BOOST_TEST(refuted.worst.j == axis);
        BOOST_TEST((certify_admissible(tight, 1e-15).verdict == Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(overlaps_below_double_precision_are_seen) {
    // Far from the origin of the radii's exponents: the overlap is 2^-1000, invisible to double and double-double.
    Packing packing = pair_at(3, 4, 2, 3);
    append(packing, 3, 4 + 3 + 1, 1);
    check_verdict(packing, 0);
    packing.q[0] = 0x1p-1000; // disk 0 moves towards the others
    check_verdict(packing, 0);
    BOOST_TEST((certify_admissible(packing, 0).verdict == Verdict::refuted));
    packing.q[0] = -0x1p-1000;
    BOOST_TEST((certify_admissible(packing, 0).verdict == Verdict::proved));
    // A right triangle with 52-bit integer sides: double-double is full with the squares alone.
    const double m = 80000001, k = 31415926;
    Packing wide = pair_at(m * m - k * k, 2 * m * k, m * m, k * k);
    BOOST_TEST((certify_admissible(wide, 0).verdict == Verdict::proved));
    wide.q[0] = 0x1p-300;
    BOOST_TEST((certify_admissible(wide, 0).verdict == Verdict::refuted));
    wide.q[0] = -0x1p-300;
    BOOST_TEST((certify_admissible(wide, 0).verdict == Verdict::proved));
    // The same for a wall.
    Packing wall = empty_cluster();
    append(wall, 1, 1, 1);
    wall.walls = Walls::box();
    wall.q = {1, 1, 2, 2};
    BOOST_TEST((certify_admissible(wall, 0).verdict == Verdict::proved));
    BOOST_TEST((certify_admissible(wall, 0x1p-1000).verdict == Verdict::proved));
    wall.q[3] = std::nextafter(2.0, 0.0);
    BOOST_TEST((certify_admissible(wall, 0x1p-52).verdict == Verdict::proved));
    BOOST_TEST((certify_admissible(wall, std::nextafter(0x1p-52, 0.0)).verdict == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(verdicts_agree_with_rationals_on_tangent_clusters) {
    Random random(31415);
    int refuted = 0, proved = 0;
    for (int repeat = 0; repeat < testing::scaled(300); ++repeat) {
        const int n = 2 + random.integer(8);
        Packing packing = grown_cluster(n, repeat % 2 == 0 ? 1 : 20, random, [] { return 0; });
        const double allowance = repeat % 3 == 0 ? 0 : std::ldexp(packing.min_radius(), -48 - random.integer(8));
        check_verdict(packing, allowance);
        (exact_verdict(packing, allowance) == Verdict::proved ? proved : refuted) += 1;
    }
    BOOST_TEST(refuted > 50); // both answers were met
    BOOST_TEST(proved > 50);
}

BOOST_AUTO_TEST_CASE(worst_gap_is_the_smallest_gap_met) {
    Packing packing = square_lattice(3, 2.25);
    packing.q[0] += 0.125;
    const Admissibility result = certify_admissible(packing, 0);
    BOOST_TEST((result.verdict == Verdict::proved));
    BOOST_TEST(result.worst_gap == 0.125);
    BOOST_TEST((result.worst == Contact{ContactKind::disk_disk, 0, 3}));
    packing.q[0] += 0.5;
    packing.q[9] += 0.3125;
    const Admissibility overlap = certify_admissible(packing, 0);
    BOOST_TEST((overlap.verdict == Verdict::refuted));
    BOOST_TEST(overlap.worst_gap == -0.375);
    BOOST_TEST((overlap.worst == Contact{ContactKind::disk_disk, 0, 3}));
}
