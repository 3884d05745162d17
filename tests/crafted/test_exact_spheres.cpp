// Exact packings of spheres: closed forms, lattices, clusters, files.
#include "examples.hpp"
#include "support/bad_input.hpp"

namespace exact_spheres {

using examples::ExactPacking, examples::inspected, examples::Inspection, examples::n, examples::Number;
using isostat::Contact;
using isostat::ContactKind;
using isostat::Verdict;

ExactPacking example(const std::string& name) {
    return examples::example("spheres_" + name + ".toml");
}

/// Spheres of radius 1 in copies of a cell, which repeats and does not move.
ExactPacking lattice(const std::array<std::string, 3>& period, const std::vector<std::array<std::string, 3>>& basis,
                     const std::array<int, 3>& copies) {
    ExactPacking out;
    out.cell.dimension = 3;
    out.cell.repeat();
    for (std::size_t a = 0; a < 3; ++a) {
        out.length[a] = n(period[a]) * Number(copies[a]);
    }
    for (int k = 0; k < copies[0] * copies[1] * copies[2]; ++k) {
        const std::array<int, 3> cell{k % copies[0], k / copies[0] % copies[1], k / (copies[0] * copies[1])};
        for (const auto& place : basis) {
            auto& centre = out.centre.emplace_back();
            for (std::size_t a = 0; a < 3; ++a) {
                centre[a] = n(place[a]) + n(period[a]) * Number(cell[a]);
            }
            out.radius.emplace_back(1);
        }
    }
    return out;
}

ExactPacking body_centred(const std::array<int, 3>& copies) {
    const std::string a = "4/3*sqrt(3)", half = "2/3*sqrt(3)";
    return lattice({a, a, a}, {{"0", "0", "0"}, {half, half, half}}, copies);
}
ExactPacking face_centred(const std::array<int, 3>& copies) {
    const std::string a = "2*sqrt(2)", half = "sqrt(2)";
    return lattice({a, a, a}, {{"0", "0", "0"}, {"0", half, half}, {half, "0", half}, {half, half, "0"}}, copies);
}
ExactPacking simple_cubic(const std::array<int, 3>& copies) {
    return lattice({"2", "2", "2"}, {{"0", "0", "0"}}, copies);
}
ExactPacking hexagonal() {
    return lattice({"2", "2*sqrt(3)", "4/3*sqrt(6)"},
                   {{"0", "0", "0"},
                    {"1", "sqrt(3)", "0"},
                    {"1", "5/3*sqrt(3)", "2/3*sqrt(6)"},
                    {"0", "2/3*sqrt(3)", "2/3*sqrt(6)"}},
                   {1, 1, 1});
}

/// A box around equal spheres of the simple cubic lattice.
ExactPacking cubic_box(int m) {
    ExactPacking out = simple_cubic({m, m, m});
    out.cell = {};
    out.cell.dimension = 3;
    out.walls = isostat::Walls::box(3);
    for (auto& centre : out.centre) {
        for (Number& x : centre) {
            x += Number(1);
        }
    }
    return out;
}

std::vector<std::string> named(const Inspection& seen, const std::vector<int>& contacts) {
    std::vector<std::string> out;
    for (const int l : contacts) {
        out.push_back(to_string(seen.contacts[static_cast<std::size_t>(l)], 3));
    }
    return out;
}

/// A cluster without walls; the spheres of the list are fixed.
ExactPacking cluster(const std::vector<std::array<int, 3>>& centres, const std::vector<int>& fixed = {}) {
    ExactPacking out;
    out.cell.dimension = 3;
    out.fixed.assign(centres.size(), 0);
    for (const auto& c : centres) {
        out.centre.push_back({Number(c[0]), Number(c[1]), Number(c[2])});
        out.radius.emplace_back(1);
    }
    for (const int i : fixed) {
        out.fixed[static_cast<std::size_t>(i)] = 1;
    }
    return out;
}

void parse(const std::string& text) {
    (void)isostat::crafted::parse_packing("format = \"isostat-packing 1\"\n" + text, "file");
}

BOOST_AUTO_TEST_CASE(lattices_have_their_counts_in_all_four_kinds_of_cell) {
    struct Case {
        const char* name;
        ExactPacking packing;
        int contacts;
        std::array<std::array<int, 3>, 4> counts; // N_f, h, k
    };
    const std::vector<Case> cases{
        {"bcc 1", body_centred({1, 1, 1}), 8, {{{3, 5, 0}, {4, 4, 0}, {6, 4, 2}, {9, 1, 2}}}},
        {"bcc 2", body_centred({2, 1, 1}), 16, {{{9, 7, 0}, {10, 6, 0}, {12, 6, 2}, {15, 3, 2}}}},
        {"fcc 1", face_centred({1, 1, 1}), 24, {{{9, 15, 0}, {10, 14, 0}, {12, 12, 0}, {15, 9, 0}}}},
        {"fcc 2", face_centred({2, 1, 1}), 48, {{{21, 27, 0}, {22, 26, 0}, {24, 24, 0}, {27, 21, 0}}}},
        {"hcp", hexagonal(), 24, {{{9, 15, 0}, {10, 14, 0}, {12, 12, 0}, {15, 9, 0}}}},
        {"sc 8", simple_cubic({2, 2, 2}), 24, {{{21, 12, 9}, {22, 11, 9}, {24, 9, 9}, {27, 9, 12}}}},
    };
    for (const Case& c : cases) {
        const Inspection seen = inspected(c.packing);
        BOOST_REQUIRE(seen.strains.has_value());
        for (std::size_t s = 0; s < 4; ++s) {
            const isostat::Counting& counting = (*seen.strains)[s];
            BOOST_TEST_INFO_SCOPE(c.name << ", strain " << s);
            BOOST_TEST(counting.contact_count == c.contacts);
            BOOST_TEST((counting.rank_exact == Verdict::proved));
            BOOST_TEST(counting.dof_count == c.counts[s][0]);
            BOOST_TEST(counting.hyperstaticity == c.counts[s][1]);
            BOOST_TEST(counting.mechanisms == c.counts[s][2]);
        }
        const bool cubic = c.packing.disk_count() == 8 && c.contacts == 24;
        BOOST_TEST((seen.jamming->collective == (cubic ? Verdict::refuted : Verdict::proved)), c.name);
        BOOST_TEST((seen.jamming->strict == (c.counts[3][2] > 0 ? Verdict::refuted : Verdict::proved)), c.name);
    }
}

BOOST_AUTO_TEST_CASE(a_body_centred_lattice_is_jammed_with_two_spheres_per_cell_and_not_with_sixteen) {
    BOOST_TEST((inspected(body_centred({1, 1, 1})).jamming->collective == Verdict::proved));
    const Inspection larger = inspected(body_centred({2, 2, 2}));
    BOOST_TEST((larger.jamming->collective == Verdict::refuted));
    BOOST_TEST((larger.rank_exact == Verdict::proved));
    BOOST_TEST(larger.mechanisms > 0);
}

BOOST_AUTO_TEST_CASE(spheres_of_the_simple_cubic_lattice_in_a_box_keep_self_stresses_whatever_their_radii) {
    for (const int m : {1, 2, 3}) {
        const Inspection seen = inspected(cubic_box(m));
        BOOST_TEST(seen.dof_count == 3 * m * m * m + 3);
        BOOST_TEST(seen.contacts.size() == static_cast<std::size_t>(3 * m * m * m + 3 * m * m));
        BOOST_TEST(seen.hyperstaticity == 3 * m * m - 3);
        BOOST_TEST(seen.mechanisms == 0);
        BOOST_TEST((seen.with_radii.rank_exact == Verdict::proved));
        BOOST_TEST((seen.with_radii.hyperstaticity > 0) == (m > 1));
    }
}

BOOST_AUTO_TEST_CASE(a_pyramid_has_unique_sums_of_forces_and_a_range_though_its_forces_are_not_unique) {
    for (const auto& [small, large, height] : std::vector<std::array<std::string, 3>>{
             {"1", "1", "sqrt(2)"}, {"2", "5/2", "7/2"}, {"1/3", "1/2", "1/6*sqrt(17)"}}) {
        const Number r = n(small), big = n(large), h = n(height), three = Number(3) * r;
        ExactPacking packing = example("pyramid");
        packing.radius = {r, r, r, r, big};
        packing.centre = {{r, r, r}, {three, r, r}, {r, three, r}, {three, three, r}, {r + r, r + r, r + h}};
        packing.length = {Number(4) * r, Number(4) * r, r + h + big};
        packing.load->wall = {Number(3), Number(3), Number(2)};
        const Inspection seen = inspected(packing);
        BOOST_TEST(seen.hyperstaticity == 3);
        BOOST_TEST(!seen.forces_unique);
        Number top, along;
        std::vector<Number> changed(2 * seen.self_stresses.size());
        for (std::size_t l = 0; l < seen.contacts.size(); ++l) {
            const std::string name = to_string(seen.contacts[l], 3);
            const bool of_top = name.size() == 3 && name.substr(1) == "-4", pair = name == "0-1" || name == "2-3";
            top += of_top ? seen.forces[l] : Number(0);
            along += pair ? seen.forces[l] : Number(0);
            for (std::size_t s = 0; s < seen.self_stresses.size() && (of_top || pair); ++s) {
                changed[2 * s + (pair ? 1 : 0)] += seen.self_stresses[s][l];
            }
        }
        BOOST_TEST((top == Number(2) * (big + r) / h));
        BOOST_TEST((along == Number(3) - Number(2) * r / (Number(2) * h)));
        BOOST_TEST(std::ranges::all_of(changed, [](const Number& x) { return x.is_zero(); }));
        BOOST_REQUIRE_EQUAL(seen.ranges.size(), 3U);
        const auto& range = seen.ranges.back();
        BOOST_TEST((range.least && range.least->is_zero()));
        BOOST_TEST((range.most && *range.most == Number(6) * h / r));
    }
}

BOOST_AUTO_TEST_CASE(the_load_range_of_a_tetrahedron_ends_where_a_sphere_leaves_and_where_a_floor_contact_opens) {
    ExactPacking packing = example("tetrahedron");
    const Inspection seen = inspected(packing);
    BOOST_REQUIRE_EQUAL(seen.ranges.size(), 3U);
    const auto& range = seen.ranges.back();
    BOOST_TEST((*range.most == Number(2)));
    BOOST_TEST((named(seen, range.zero_at_most) == std::vector<std::string>{"0-1", "1-back", "1-right", "1-top"}));
    BOOST_TEST((*range.least == n("2/5")));
    BOOST_TEST((named(seen, range.zero_at_least) == std::vector<std::string>{"0-back"}));
    for (const auto& [force, support] : {std::pair{"2", isostat::crafted::Support::with_zeros},
                                         std::pair{"2 + 1e-30", isostat::crafted::Support::none},
                                         std::pair{"2/5 - 1e-30", isostat::crafted::Support::none}}) {
        packing.load->wall[2] = n(force);
        const Inspection there = inspected(packing);
        BOOST_TEST((there.support == support), force);
        // The range does not depend on the force that is there.
        BOOST_TEST((*there.ranges.back().least == n("2/5") && *there.ranges.back().most == Number(2)));
    }
}

BOOST_AUTO_TEST_CASE(rigid_motions_of_spheres_are_those_that_move_some_sphere) {
    const std::vector<std::array<int, 3>> line{{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, bent{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}};
    BOOST_TEST(inspected(cluster({{1, 2, 3}})).rigid_motions == 3);
    BOOST_TEST(inspected(cluster(line)).rigid_motions == 5);
    BOOST_TEST(inspected(cluster(bent)).rigid_motions == 6);
    BOOST_TEST(inspected(cluster(line, {0})).rigid_motions == 2);
    BOOST_TEST(inspected(cluster(bent, {0})).rigid_motions == 3);
    BOOST_TEST(inspected(cluster(bent, {0, 1})).rigid_motions == 1); // about the line of the two
    BOOST_TEST(inspected(cluster(line, {0, 1})).rigid_motions == 0);
    // Walls normal to x: the turn about x moves spheres that are beside each other.
    for (auto [centres, motions] : {std::pair{line, 2}, std::pair{bent, 3}}) {
        for (auto& c : centres) {
            c[0] += 1;
        }
        ExactPacking packing = cluster(centres);
        packing.walls.lower[0] = isostat::WallKind::fixed;
        BOOST_TEST(inspected(packing).rigid_motions == motions);
    }
    // An axis that repeats and two without walls: everything turns about it.
    ExactPacking tube = cluster(bent);
    tube.cell.periodic[0] = true;
    tube.length[0] = Number(9);
    const Inspection seen = inspected(tube);
    BOOST_TEST(seen.rigid_motions == 3);
    BOOST_TEST(seen.mechanisms >= 3);
}

BOOST_AUTO_TEST_CASE(a_sphere_is_held_where_0_is_inside_the_hull_of_its_normals) {
    using isostat::crafted::DiskHold;
    const std::vector<std::array<int, 3>> around{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1},
                                                 {1, 1, 0}, {-1, -1, 0}, {1, -1, 0},  {0, 0, -1}};
    struct Case {
        std::vector<std::size_t> places;
        DiskHold hold;
        std::size_t carrying;
    };
    for (const Case& c : {Case{{0, 1, 2, 3}, DiskHold::held, 4}, Case{{0, 1, 2}, DiskHold::rattler, 0},
                          Case{{4, 5}, DiskHold::bridge, 2}, Case{{4, 5, 6}, DiskHold::bridge, 2},
                          Case{{4, 5, 0, 3}, DiskHold::bridge, 2}, Case{{0, 3, 7}, DiskHold::bridge, 3},
                          Case{{4, 5, 0}, DiskHold::bridge, 2}}) {
        ExactPacking packing;
        packing.cell.dimension = 3;
        packing.centre = {{}};
        packing.radius = {Number(1) / Number(2)};
        packing.fixed = {0};
        for (const std::size_t k : c.places) {
            const auto& d = around[k];
            const Number length = isostat::exact::sqrt(Number(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
            packing.centre.push_back({Number(d[0]), Number(d[1]), Number(d[2])});
            packing.radius.push_back(length - packing.radius[0]);
            packing.fixed.push_back(1);
        }
        std::vector<Contact> contacts;
        for (std::size_t k = 0; k < c.places.size(); ++k) {
            contacts.emplace_back(ContactKind::disk_disk, 0, static_cast<int>(k + 1));
        }
        const Inspection seen = inspect_contacts(packing, contacts);
        BOOST_TEST((seen.hold[0] == c.hold));
        BOOST_TEST(static_cast<std::size_t>(std::ranges::count(seen.carrying, 1)) == c.carrying);
    }
}

BOOST_AUTO_TEST_CASE(an_overlap_of_spheres_with_an_image_is_named_with_its_three_periods) {
    ExactPacking packing = body_centred({1, 1, 1});
    packing.length[2] = packing.length[2] - n("1e-20");
    fails(isostat::crafted::exact_contacts(packing), isostat::FailureKind::overlap,
          {"sphere 0 (x = 0, y = 0, z = 0, r = 1)", "-1)"});
}

BOOST_AUTO_TEST_CASE(files_of_spheres_take_three_of_everything) {
    const std::string one = "spheres = [[0, 0, 0, 1]]\n";
    const std::string cell = one + "[cell]\nperiod = [3, 3, \"none\"]\n";
    BOOST_CHECK_NO_THROW(parse(one + "[cell]\nperiod = [3, 3, 3]\ntilt = [1, 0, \"1/2\"]\nmoves = [\"z\", \"yz\"]\n"
                                     "[load]\nwall = [0, 0, 2]\ntilt = [0, 0, 1]\n"));
    for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
             {"disks = [[0, 0, 1]]\n" + one, "unknown key 'disks'"},
             {"spheres = [[0, 0, 1]]\n", "spheres is [ 0, 0, 1 ]: expected an array of 4"},
             {"[[sphere]]\nx = 0\ny = 0\nr = 1\n", "no z in [sphere]"},
             {"[[disk]]\nx = 0\ny = 0\nz = 0\nr = 1\n", "unknown key 'z' in [disk]"},
             {one + "[box]\nlength = [1, 1]\n", "length in [box] is [ 1, 1 ]: expected an array of 3"},
             {cell + "moves = [\"z\"]\n", "moves in [cell] is 'z'"},
             {cell + "moves = [\"xz\"]\n", "moves in [cell] is 'xz'"},
             {cell + "tilt = [0, 1, 0]\nmoves = []\n", "0, as one axis does not repeat"},
             {cell + "tilt = 1\nmoves = []\n", "tilt in [cell] is 1: expected an array of 3"},
             {cell + "moves = [\"x\"]\n[load]\nsphere = [[0, 0, 1, 0]]\n", "the pinned sphere would bear the rest"},
             {cell + "moves = [\"x\"]\n[load]\ndisk = [[0, 0, 1, 0]]\n", "unknown key 'disk' in [load]"},
             {cell + "moves = [\"x\"]\n[load]\ntilt = [1, 0, 0]\n", "this tilt of a cell does not move"},
             {one + "[cell]\nperiod = [3, \"none\", 1]\nmoves = []\n",
              "at least as long as the diameter 2 of sphere 0"}}) {
        BOOST_TEST_INFO_SCOPE(text);
        expect_bad_input([&, source = text] { parse(source); }, {part});
    }
}

} // namespace exact_spheres
