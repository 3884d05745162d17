// Counts of foreign packings against the gap threshold.
// Which contacts of spheres can carry, and counts of spheres against the gap threshold.
#include "crafted/able.hpp"
#include "oracle/pairs.hpp"
#include "support/scale.hpp"
#include "support/spheres.hpp"

#include <isostat/crafted/exact_packing.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/rigidity/counting.hpp>

#include <crafted/inspection_parts.hpp>

namespace {

using namespace isostat::crafted;
namespace crafted = isostat::crafted;
using isostat::Packing;
using isostat::Verdict;

std::vector<double> decades(int from, int to) {
    std::vector<double> out;
    for (int e = 2 * from; e <= 2 * to; ++e) {
        out.push_back(std::pow(10.0, e / 2.0));
    }
    return out;
}

void shake(Packing& packing, double size, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    for (double& x : packing.q) {
        x += size * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
    }
}

/// gap <= threshold, in rationals. The sum of the radii and the threshold is positive.
bool closer(const Packing& packing, const isostat::Contact& c, double threshold) {
    const auto number = [](double x) { return Number::from_double(x); };
    const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
    const Number r = number(packing.radius[i]) + number(threshold);
    if (c.kind == isostat::ContactKind::lower_wall) {
        return (number(packing.q[2 * i + j]) - r).sign() <= 0;
    }
    if (c.kind == isostat::ContactKind::upper_wall) {
        return (number(packing.length(c.j)) - number(packing.q[2 * i + j]) - r).sign() <= 0;
    }
    const Number x = number(packing.q[2 * j]) - number(packing.q[2 * i]);
    const Number y = number(packing.q[2 * j + 1]) - number(packing.q[2 * i + 1]);
    const Number s = r + number(packing.radius[j]);
    return (x * x + y * y - s * s).sign() <= 0;
}

Packing rounded_example(const std::string& name) {
    return approximate(read_packing(std::string(ISOSTAT_EXAMPLES) + "/packings/" + name).packing);
}

using isostat::Contact;
using isostat::ContactKind;
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

BOOST_AUTO_TEST_CASE(noise_moves_the_lower_end_of_the_plateau) {
    for (const double noise : {1e-9, 1e-6, 1e-3}) {
        Packing packing = rounded_example("three_disks_and_a_rattler.toml");
        shake(packing, noise, 7);
        const Plateau answer = plateau(packing, decades(-12, -1));
        BOOST_REQUIRE_EQUAL(answer.ranges.size(), 1u);
        // Gaps of the eight contacts are within a few times the noise; the next gaps are of the order of the disks.
        BOOST_TEST(answer.ranges[0].first < 6 * noise);
        BOOST_TEST(answer.ranges[0].first > noise / 100);
        // The small disk on the floor is sqrt(1.64) - 1.2 away from both base disks: counted as contacts, these hold
        // it.
        BOOST_TEST(std::abs(answer.ranges[0].last - (std::sqrt(1.64) - 1.2)) < 6 * noise);
        BOOST_TEST(std::abs(answer.deepest_overlap) < 6 * noise);
        BOOST_TEST(answer.steps.back().backbone.hyperstaticity == 1);
        const PlateauStep& last = answer.steps[answer.steps.size() - 2];
        BOOST_TEST(last.rattlers == 1);
        BOOST_TEST(last.backbone.dof_count == 8);
        BOOST_TEST(last.backbone.contact_count == 8);
        BOOST_TEST(last.backbone.hyperstaticity == 0);
        BOOST_TEST(last.backbone.mechanisms == 0);
        BOOST_TEST((last.backbone.isostatic == Verdict::proved));
        BOOST_TEST((answer.steps.front().backbone.isostatic == Verdict::refuted));
    }
}

BOOST_AUTO_TEST_CASE(an_end_of_the_plateau_is_the_gap_that_closes_it) {
    // The top disk is given 1e-3 of room to each of two fixed stops: at a threshold above it h = 1, then 2.
    Packing packing = rounded_example("three_disks.toml");
    const double root = std::sqrt(3.0);
    for (const double side : {-1.0, 1.0}) {
        packing.radius.push_back(0.25);
        packing.q.insert(packing.q.end() - 2, {2 + side * (1.25 + 1e-3), 1 + root});
    }
    packing.fixed = {0, 0, 0, 1, 1};
    shake(packing, 1e-7, 3);
    const Plateau answer = plateau(packing, decades(-9, -2));
    BOOST_REQUIRE_EQUAL(answer.ranges.size(), 1u);
    BOOST_TEST(answer.ranges[0].first < 1e-6);
    BOOST_TEST(std::abs(answer.ranges[0].last - 1e-3) < 1e-6);
    BOOST_TEST(answer.steps.back().backbone.hyperstaticity == 2);
    BOOST_TEST((answer.steps.back().backbone.isostatic == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(ranges_lie_between_the_thresholds_and_are_told_beyond_the_rounding) {
    Packing packing = rounded_example("three_disks.toml");
    shake(packing, 1e-7, 3);
    const Plateau whole = plateau(packing, -1e-3, 1e-3, 0);
    BOOST_REQUIRE_EQUAL(whole.ranges.size(), 1u);
    const PlateauRange& range = whole.ranges.front();
    BOOST_REQUIRE(whole.widest.has_value());
    BOOST_TEST(whole.widest->range.first == range.first);
    BOOST_TEST((whole.widest->counts.isostatic == Verdict::proved));
    BOOST_TEST(range.told);
    // Within it, up to its lower end, and below it.
    BOOST_TEST(plateau(packing, 1e-5, 1e-4, 0).ranges.at(0).first == 1e-5);
    BOOST_TEST(plateau(packing, -1e-3, range.first, 0).ranges.size() == 1u);
    const Plateau below = plateau(packing, -1e-3, std::nextafter(range.first, -1.0), 0);
    BOOST_TEST(below.ranges.empty());
    // A rounding of the size of the gaps: known of the thresholds beyond it only.
    const auto told = [&](double first, double last, double rounding) {
        const Plateau found = plateau(packing, first, last, 0, isostat::Strain::isotropic, rounding);
        return !found.ranges.empty() && found.ranges.front().told;
    };
    BOOST_TEST(told(-1e-3, 1e-3, 1e-6));
    BOOST_TEST(told(1e-4, 1e-4, 1e-6)); // one threshold, far from every gap
    BOOST_TEST(!told(-1e-3, 2e-6, 1e-6));
    BOOST_TEST(!told(-1e-3, 1e-3, 1e-3));
}

BOOST_AUTO_TEST_CASE(a_lattice_has_no_plateau) {
    Packing packing = rounded_example("triangular_patch_3x3.toml");
    shake(packing, 1e-8, 5);
    const Plateau answer = plateau(packing, {1e-6, 1e-5, 1e-4, 1e-3});
    BOOST_TEST(answer.ranges.empty());
    for (const PlateauStep& step : answer.steps) {
        BOOST_TEST(step.backbone.hyperstaticity == 5);
        BOOST_TEST(step.backbone.mechanisms == 0);
    }
}

BOOST_AUTO_TEST_CASE(counts_agree_with_the_exact_inspection_of_the_examples) {
    for (const char* name : {"two_disks.toml", "three_disks.toml", "square_lattice_4.toml", "apollonian.toml",
                             "triangular_patch_2x3.toml"}) {
        const ExactPacking exact = read_packing(std::string(ISOSTAT_EXAMPLES) + "/packings/" + name).packing;
        const auto inspection = required(inspect(exact));
        const Plateau answer = plateau(approximate(exact), {1e-12});
        BOOST_TEST_INFO_SCOPE(name);
        BOOST_TEST(answer.steps[0].backbone.rank == inspection.rank);
        BOOST_TEST(answer.steps[0].backbone.hyperstaticity == inspection.hyperstaticity);
        BOOST_TEST(answer.steps[0].backbone.mechanisms == inspection.mechanisms);
    }
}

BOOST_AUTO_TEST_CASE(a_prepared_packing_with_noise_is_isostatic_over_decades) {
    isostat::PreparationOptions options{.disks = 100, .seed = 4};
    isostat::PreparationReport report;
    Packing packing = required(isostat::prepare(options, report)).packing;
    shake(packing, 1e-9, 9);
    const Plateau answer = plateau(packing, decades(-11, -1));
    BOOST_REQUIRE(!answer.ranges.empty());
    BOOST_TEST_MESSAGE("isostatic from " << answer.ranges[0].first << " to " << answer.ranges[0].last);
    BOOST_TEST(answer.ranges[0].first < 1e-8);
    BOOST_TEST(answer.ranges[0].last > 1e-6);
    for (const PlateauStep& step : answer.steps) {
        if (step.backbone.isostatic == Verdict::proved) {
            BOOST_TEST(step.rattlers == report.rattlers);
            BOOST_TEST(step.backbone.contact_count == 2 * (100 - report.rattlers) + 2);
        }
    }
}

BOOST_AUTO_TEST_CASE(what_follows_from_monotony_is_what_an_elimination_says, *boost::unit_test::label("slow")) {
    std::mt19937_64 random(21);
    int proved = 0, hyperstatic = 0, skipped = 0;
    for (int sample = 0; sample < isostat::testing::scaled(40); ++sample) {
        // Disks on a lattice, moved and resized: some lists are isostatic, some have rattlers, some are special.
        Packing packing;
        packing.walls = sample % 2 == 0 ? isostat::Walls::box() : isostat::Walls::none();
        const double noise = sample % 4 < 2 ? 0.03 : 0;
        for (int i = 0; i < 16; ++i) {
            packing.q.push_back(0.5 + i % 4 + noise * static_cast<double>(random() % 1000) / 1000);
            packing.q.push_back(0.5 + i / 4 + noise * static_cast<double>(random() % 1000) / 1000); // NOLINT
            packing.radius.push_back(0.5 - (random() % 3 == 0 ? 0.01 * static_cast<double>(random() % 7) : 0));
        }
        packing.q.insert(packing.q.end(), {4, 4});
        if (sample % 7 == 0) {
            packing.fixed.assign(16, 0);
            packing.fixed[3] = packing.fixed[12] = 1;
        }
        const Plateau answer = plateau(packing, -0.05, 0.5, 0);
        skipped += 2 * static_cast<int>(answer.steps.size()) - answer.ranks_computed;
        for (const PlateauStep& step : answer.steps) {
            std::vector<isostat::Contact> contacts = isostat::oracle::all_pairs(packing);
            std::erase_if(contacts, [&](const isostat::Contact& c) {
                const bool fixed = packing.is_fixed(isostat::DiskId(static_cast<std::size_t>(c.i)));
                const bool partner = c.kind == isostat::ContactKind::disk_disk
                                         ? packing.is_fixed(isostat::DiskId(static_cast<std::size_t>(c.j)))
                                         : c.kind == isostat::ContactKind::lower_wall;
                return !closer(packing, c, step.threshold) || (fixed && partner);
            });
            const auto all = isostat::count_contacts(packing, contacts);
            BOOST_REQUIRE_EQUAL(step.candidate_count, static_cast<int>(contacts.size()));
            BOOST_REQUIRE_EQUAL(step.all.rank, all.rank);
            BOOST_REQUIRE_EQUAL(step.all.dof_count, all.dof_count);
            crafted::Inspection backbone;
            backbone.contacts = contacts;
            judge_holds(backbone, exact_copy(packing));
            int left = 0;
            std::vector<isostat::Contact> carrying;
            Packing rest = packing;
            rest.fixed.resize(16, 0);
            for (std::size_t l = 0; l < contacts.size(); ++l) {
                if (backbone.carrying[l] != 0) {
                    carrying.push_back(contacts[l]);
                }
            }
            for (std::size_t i = 0; i < 16; ++i) {
                const bool rattler = backbone.hold[i] == DiskHold::rattler;
                left += rattler ? 1 : 0;
                rest.fixed[i] = rattler || rest.fixed[i] != 0 ? 1 : 0;
            }
            const auto counting = isostat::count_contacts(rest, carrying);
            BOOST_REQUIRE_EQUAL(step.rattlers, left);
            BOOST_REQUIRE_EQUAL(step.backbone.dof_count, counting.dof_count);
            BOOST_REQUIRE_EQUAL(step.backbone.contact_count, counting.contact_count);
            BOOST_REQUIRE_EQUAL(step.backbone.rank, counting.rank);
            const bool inside = std::ranges::any_of(answer.ranges, [&](const PlateauRange& r) {
                return r.first <= step.threshold && (step.threshold < r.last || r.open);
            });
            BOOST_REQUIRE_EQUAL(step.backbone.isostatic == Verdict::proved, inside);
            proved += inside ? 1 : 0;
            hyperstatic += step.backbone.hyperstaticity > 0 ? 1 : 0;
        }
    }
    BOOST_TEST_MESSAGE("isostatic " << proved << ", hyperstatic " << hyperstatic << ", eliminations saved " << skipped);
    BOOST_TEST(proved > 5);
    BOOST_TEST(hyperstatic > 20);
    BOOST_TEST(skipped > 50);
}

BOOST_AUTO_TEST_CASE(equal_gaps_enter_together) {
    // Four tangent disks in their box: 12 gaps of exactly 0, one change of the list, h = 2.
    Packing packing;
    packing.radius = {0.5, 0.5, 0.5, 0.5};
    packing.q = {0.5, 0.5, 1.5, 0.5, 0.5, 1.5, 1.5, 1.5, 2, 2};
    const Plateau answer = plateau(packing, -1e-300, 1e-300, 0);
    BOOST_TEST(answer.changes == 1);
    BOOST_TEST(answer.candidates == 12);
    BOOST_REQUIRE_EQUAL(answer.steps.size(), 3u);
    BOOST_TEST(answer.steps[1].threshold == 0.0);
    BOOST_TEST(answer.steps[0].candidate_count == 0);
    BOOST_TEST(answer.steps[1].backbone.hyperstaticity == 2);
    BOOST_TEST(answer.ranges.empty());
}

BOOST_AUTO_TEST_CASE(lengths_beyond_the_squares_of_doubles_are_refused) {
    Packing packing = rounded_example("two_disks.toml");
    packing.q[0] = 1e200;
    BOOST_CHECK_THROW((void)plateau(packing, {0.1}), isostat::Error);
    packing = rounded_example("two_disks.toml");
    packing.radius[0] = 1e-200;
    BOOST_CHECK_THROW((void)plateau(packing, {0.1}), isostat::Error);
    BOOST_CHECK_THROW((void)plateau(rounded_example("two_disks.toml"), {1e200}), isostat::Error);
}

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
        BOOST_TEST_INFO_SCOPE(name);
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

BOOST_AUTO_TEST_CASE(two_spheres_at_one_place_are_refused) {
    const Packing packing = star({{{1, 0, 0}}, {{1, 0, 0}}});
    const std::vector<Contact> contacts{{ContactKind::disk_disk, 1, 2}};
    BOOST_CHECK_THROW(isostat::crafted::peel(packing, contacts), isostat::Error);
}
