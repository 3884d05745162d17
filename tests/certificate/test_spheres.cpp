#include "contact/near_pairs.hpp"
#include "support/spheres.hpp"
#include "support/test.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/packing/load.hpp>

#include <tuple>

using namespace isostat;
using isostat::test::exactly;

namespace {

/// In an interval whose ends are a millionth apart at most, by all the digits that are given.
bool holds(const Interval& interval, const mpq_class& value, double scale) {
    const mpq_class digits("1/100000000000000000000000000000"); // 1e-29, of the last given digit
    const mpq_class room = digits * (abs(value) + 1);
    return mpq_class(interval.lower) <= value + room && value - room <= mpq_class(interval.upper) &&
           interval.upper - interval.lower < 1e-6 * scale;
}

void check_forces(const State& state, const Certification& truth, const nlohmann::json& file) {
    const nlohmann::json& forces = file["forces"];
    BOOST_TEST_REQUIRE(truth.finite.size() == forces.size());
    for (std::size_t l = 0; l < forces.size(); ++l) {
        const mpq_class value = exactly(forces[l].get<std::string>());
        BOOST_TEST(holds(truth.finite[l], value, 100.0), isostat::to_string(state.contacts[l], 3)
                                                             << ": " << forces[l] << " is not in ["
                                                             << truth.finite[l].lower << ", " << truth.finite[l].upper
                                                             << "]");
    }
    std::vector<int> zero;
    for (std::size_t l = 0; l < truth.structural_zero.size(); ++l) {
        if (truth.structural_zero[l] != 0) {
            zero.push_back(static_cast<int>(l));
        }
    }
    BOOST_TEST(zero == file["structural_or_exact_zero"].get<std::vector<int>>(), boost::test_tools::per_element());
}

void check_end(const State& state, const isostat::LoadEndClaim& end, const nlohmann::json& expected) {
    const mpq_class stress = exactly(expected["ratio"].get<std::string>()) * mpq_class(state.load.stress[2]);
    BOOST_TEST(!end.unbounded);
    BOOST_TEST(holds(end.stress, stress, state.load.stress[2]), expected["ratio"] << " times " << state.load.stress[2]
                                                                                  << " is not in [" << end.stress.lower
                                                                                  << ", " << end.stress.upper << "]");
    BOOST_TEST((end.opens == isostat::test::contact_of(expected["opens"])), isostat::to_string(end.opens, 3)
                                                                                << " opens, not " << expected["opens"]);
}

const std::vector<std::string> packings{"box_uniform_30_1",    "box_bidisperse_30_1", "box_jitter_30_1",
                                        "slab_uniform_30_1",   "ortho_uniform_30_1",  "tri_uniform_30_1",
                                        "tri_bidisperse_60_1", "ortho_jitter_100_1",  "box_bidisperse_100_1"};

struct Lattice {
    std::vector<std::array<double, 3>> site; ///< in the unit that makes all of them doubles
    double side, radius;                     ///< the radius rounded: a gap of 0 has no double but in the first one
};
const Lattice simple_cubic{
    {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}, {0, 0, 2}, {2, 0, 2}, {0, 2, 2}, {2, 2, 2}}, 4, 1};
const Lattice body_centred{{{0, 0, 0}, {1, 1, 1}}, 2, std::sqrt(3.0) / 2};
const Lattice face_centred{{{0, 0, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}}, 2, std::sqrt(2.0) / 2};

/// In the contacts of nearest neighbours, which are equally far apart: rows are theirs.
State state_of(const Lattice& lattice) {
    State state;
    isostat::Packing& p = state.packing;
    p.dimension = p.cell.dimension = state.load.dimension = 3;
    p.walls = isostat::Walls::none();
    p.cell.repeat();
    for (const auto& site : lattice.site) {
        p.radius.push_back(lattice.radius);
        p.q.insert(p.q.end(), site.begin(), site.end());
    }
    p.q.insert(p.q.end(), {lattice.side, lattice.side, lattice.side, 0, 0, 0});
    state.contacts = isostat::near_pairs(p, 0.05).pairs;
    state.load.loaded_axis = 2;
    state.load.stress.fill(1);
    state.load.refer_to(p);
    return state;
}

} // namespace

/// Gaps of 1-2 and 2-3 differ by less than the vertex is known to, so that their intervals in double are the same.
BOOST_AUTO_TEST_CASE(of_two_gaps_with_one_interval_the_smaller_one_is_named) {
    const State state =
        read_any_state(std::string(ISOSTAT_TEST_DATA) + "/nearly_equal_gaps.json", Dimensions::any_clumps).state;
    const std::optional<GapsClaim> gaps = certify(state).claims.gaps;
    BOOST_REQUIRE(gaps.has_value());
    BOOST_TEST(isostat::to_string(gaps->where, 3) == "2-3");
    BOOST_TEST((gaps->rung != Rung::double_bound));
}

BOOST_AUTO_TEST_CASE(the_digits_of_another_program_lie_in_every_interval) {
    for (const std::string& name : packings) {
        BOOST_TEST_INFO_SCOPE(name);
        const nlohmann::json file = isostat::test::read_spheres(name);
        const nlohmann::json& expected = file["expected"];
        const State state = isostat::test::state_of_spheres(file);
        isostat::validate(state.packing, name);
        const Certification truth = certify(state);
        BOOST_TEST((truth.verdict == Verdict::proved),
                   (truth.claims.undecided.empty() ? "" : truth.claims.undecided[0]));
        BOOST_TEST(truth.counting.dof_count == expected["N_f"].get<int>());
        BOOST_TEST(truth.counting.rank == expected["rank_mod_2147483647"].get<int>());
        BOOST_TEST(truth.counting.hyperstaticity == expected["h"].get<int>());
        BOOST_TEST(truth.counting.mechanisms == expected["k"].get<int>());
        BOOST_TEST(std::abs(state.packing.solid_fraction() - expected["solid_fraction"].get<double>()) < 1e-12);
        check_forces(state, truth, file);
        BOOST_TEST_REQUIRE(truth.claims.load_interval.has_value());
        check_end(state, truth.claims.load_interval->high, expected["triaxial_interval"]["up"]);
        check_end(state, truth.claims.load_interval->low, expected["triaxial_interval"]["down"]);
        const double sigma = expected["smallest_singular_value"].get<double>();
        BOOST_TEST(truth.smallest_sigma <= sigma * (1 + 1e-9));
        BOOST_TEST(truth.smallest_sigma >= 0.3 * sigma);
        BOOST_TEST_REQUIRE(truth.claims.gaps.has_value());
        BOOST_TEST(std::abs(truth.claims.gaps->smallest - expected["smallest_gap_of_others"].get<double>()) < 1e-9);
        BOOST_TEST((truth.claims.gaps->where == isostat::test::contact_of(expected["pair_with_smallest_gap"])));
    }
}

BOOST_AUTO_TEST_CASE(a_load_beyond_the_interval_is_refuted) {
    State state = isostat::test::state_of_spheres(isostat::test::read_spheres("box_uniform_30_1"));
    const double start = state.load.stress[2];
    state.load.stress[2] = 1.2451 * start; // the interval ends at 1.245037
    BOOST_TEST((certify(state).verdict == Verdict::refuted));
    state.load.stress[2] = 1.245 * start;
    BOOST_TEST((certify(state).verdict == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(spheres_that_overlap_are_refuted) {
    // A unit sphere between six walls, a small one in a corner: they touch at radius 2 - sqrt(3).
    for (const auto& [radius, verdict] : {std::pair(0.26, Verdict::proved), {0.27, Verdict::refuted}}) {
        State state = isostat::test::state_of_spheres(isostat::test::read_spheres("closed_one"));
        state.packing.radius.push_back(radius);
        state.packing.q.insert(state.packing.q.begin() + 3, 3, radius);
        for (int axis = 0; axis < 3; ++axis) {
            state.contacts.push_back({isostat::ContactKind::lower_wall, 1, axis});
        }
        state.load.infinitesimal = {0, 0, 0, -1, -1, -1};
        const Certification truth = certify(state);
        BOOST_TEST((truth.verdict == verdict), "radius " << radius);
        BOOST_TEST(truth.signs.structural_zero == 3);
    }
}

BOOST_AUTO_TEST_CASE(a_tetrahedron_has_the_forces_and_limits_of_its_closed_form) {
    State state = isostat::test::state_of_spheres(isostat::test::read_spheres("closed_tetra"));
    state.load.infinitesimal = isostat::generic_infinitesimal(state.packing.radius, 1, 3);
    state.load.stress = {1, 1.125, 1.25};
    // f_01 = (r_0 + r) / (2 s) (F_1 + F_2 - F_3), s = 2, and so on in a circle; walls: the components.
    const double f01 = 0.75 * (1 + 1.125 - 1.25), f02 = 0.75 * (1 + 1.25 - 1.125), f03 = 0.75 * (1.125 + 1.25 - 1);
    const Certification truth = certify(state);
    BOOST_TEST((truth.verdict == Verdict::proved));
    BOOST_TEST_REQUIRE(truth.finite.size() == 15U);
    for (const auto& [l, value] : {std::pair(12, f01), {13, f02}, {14, f03}, {3, f01 * 2 / 3}, {5, f01 / 3}}) {
        BOOST_TEST(holds(truth.finite[static_cast<std::size_t>(l)], mpq_class(value), 1.0));
    }
    // F_1 = F_2 = 1: sphere 1 leaves at F_3 = 2 with its four contacts, the floor of the large one opens at 2/5.
    state.load.stress = {1, 1, 1};
    const Certification even = certify(state);
    BOOST_TEST_REQUIRE(even.claims.load_interval.has_value());
    BOOST_TEST(holds(even.claims.load_interval->high.stress, 2, 1.0));
    BOOST_TEST(holds(even.claims.load_interval->low.stress, mpq_class(2, 5), 1.0));
    const Contact& leaves = even.claims.load_interval->high.opens;
    BOOST_TEST((leaves.i == 1 || (leaves.i == 0 && leaves.j == 1)));
    BOOST_TEST((even.claims.load_interval->low.opens == Contact(isostat::ContactKind::lower_wall, 0, 2)));
}

BOOST_AUTO_TEST_CASE(true_stresses_press_on_areas_of_the_true_lengths) {
    const nlohmann::json file = isostat::test::read_spheres("box_uniform_30_1");
    State state = isostat::test::state_of_spheres(file);
    const Certification dead = certify(state);
    state.load.kind = isostat::LoadKind::true_stress;
    for (std::size_t a = 0; a < 3; ++a) {
        const double area =
            state.packing.length(static_cast<int>((a + 1) % 3)) * state.packing.length(static_cast<int>((a + 2) % 3));
        state.load.stress[a] /= area;
    }
    const Certification truth = certify(state);
    BOOST_TEST((truth.verdict == Verdict::proved));
    for (std::size_t l = 0; l < truth.finite.size(); ++l) {
        const double middle = 0.5 * (dead.finite[l].lower + dead.finite[l].upper);
        BOOST_TEST(truth.finite[l].lower <= middle + 1e-12);
        BOOST_TEST(middle - 1e-12 <= truth.finite[l].upper);
        BOOST_TEST(truth.finite[l].upper - truth.finite[l].lower < 1e-6);
    }
}

BOOST_AUTO_TEST_CASE(cells_of_spheres_are_counted_and_judged) {
    const State state = isostat::test::state_of_spheres(isostat::test::read_spheres("tri_uniform_30_1"));
    const Certification truth = certify(state);
    const CellInspection cell = isostat::inspect_cell(state, truth);
    BOOST_TEST_REQUIRE(cell.backbone.has_value());
    BOOST_TEST(cell.backbone_disks == 29);
    for (const auto& [strain, dofs] : {std::pair(0, 84), {1, 85}, {2, 87}, {3, 90}}) {
        const isostat::Counting& c = (*cell.backbone)[static_cast<std::size_t>(strain)];
        BOOST_TEST(c.dof_count == dofs);
        BOOST_TEST(c.contact_count == 90);
        BOOST_TEST(c.mechanisms == 0);
        BOOST_TEST(c.hyperstaticity == 90 - dofs);
    }
    BOOST_TEST((cell.collective.verdict == Verdict::proved));
    // The loads of the file are no pressure of the tilted cell; whatever the forces under one are, they are decided.
    BOOST_TEST((cell.strict.verdict != Verdict::undecided), cell.strict.reason);
    const State box = isostat::test::state_of_spheres(isostat::test::read_spheres("ortho_uniform_30_1"));
    const CellInspection open = isostat::inspect_cell(box, certify(box));
    BOOST_TEST((open.strict.verdict == Verdict::refuted)); // 3 short of full strain
}

BOOST_AUTO_TEST_CASE(lattices_have_their_counts_in_four_kinds_of_cell) {
    // N_f, N, h, k: fixed, isotropic, orthorhombic, triclinic.
    using Counts = std::array<std::array<int, 4>, 4>;
    for (const auto& [lattice, expected] :
         {std::pair{simple_cubic, Counts{{{21, 24, 12, 9}, {22, 24, 11, 9}, {24, 24, 9, 9}, {27, 24, 9, 12}}}},
          std::pair{body_centred, Counts{{{3, 8, 5, 0}, {4, 8, 4, 0}, {6, 8, 4, 2}, {9, 8, 1, 2}}}},
          std::pair{face_centred, Counts{{{9, 24, 15, 0}, {10, 24, 14, 0}, {12, 24, 12, 0}, {15, 24, 9, 0}}}}}) {
        const State state = state_of(lattice);
        const auto counts = isostat::count_strains(state.packing, state.contacts);
        for (std::size_t k = 0; k < 4; ++k) {
            BOOST_TEST_INFO_SCOPE(lattice.site.size() << " sites, " << isostat::to_string(isostat::strains[k]));
            BOOST_TEST(counts[k].dof_count == expected[k][0]);
            BOOST_TEST(counts[k].contact_count == expected[k][1]);
            BOOST_TEST(counts[k].hyperstaticity == expected[k][2]);
            BOOST_TEST(counts[k].mechanisms == expected[k][3]);
            BOOST_TEST((counts[k].rank_exact == Verdict::proved));
        }
    }
}

BOOST_AUTO_TEST_CASE(lattices_in_doubles_are_jammed_if_their_contacts_close) {
    // Collectively, strictly (proofs/cells.md, C14). The rows of the simple cubic one slide: doubles do not tell that.
    using Answer = std::optional<Verdict>;
    for (const auto& [lattice, collective, strict] :
         {std::tuple{simple_cubic, Answer{}, Answer{Verdict::refuted}},
          std::tuple{body_centred, Answer{Verdict::proved}, Answer{Verdict::refuted}},
          std::tuple{face_centred, Answer{Verdict::proved}, Answer{Verdict::proved}}}) {
        const State state = state_of(lattice);
        const CellInspection seen = isostat::inspect_cell(state, certify(state));
        const auto verdict = [](const isostat::JammingAnswer& answer) {
            BOOST_TEST((answer.verdict == Verdict::undecided));
            return answer.if_closed ? Answer(answer.if_closed->verdict) : Answer{};
        };
        BOOST_TEST_INFO_SCOPE(lattice.site.size() << " sites");
        BOOST_TEST((verdict(seen.collective) == collective));
        BOOST_TEST((verdict(seen.strict) == strict));
    }
}
