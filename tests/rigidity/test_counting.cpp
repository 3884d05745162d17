// Counting, the gate, and the identities of statics on crafted packings.
#include "exact/rank.hpp"
#include "linear/factorisation.hpp"
#include "support/bad_input.hpp"
#include "support/cells.hpp"
#include "support/crafted.hpp"
#include "support/free_grains.hpp"
#include "support/regular.hpp"
#include "support/threads.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/rigidity/counting.hpp>

#include <gmpxx.h>

using namespace isostat;
using namespace crafted;

namespace {

/// Determinant over the rationals.
mpq_class determinant(std::vector<std::vector<mpq_class>> a) {
    mpq_class value = 1;
    for (std::size_t k = 0; k < a.size(); ++k) {
        std::size_t pivot = k;
        while (pivot < a.size() && a[pivot][k] == 0) {
            ++pivot;
        }
        if (pivot == a.size()) {
            return 0;
        }
        if (pivot != k) {
            std::swap(a[pivot], a[k]);
            value = -value;
        }
        value *= a[k][k];
        for (std::size_t i = k + 1; i < a.size(); ++i) {
            const mpq_class factor = a[i][k] / a[k][k];
            for (std::size_t j = k; j < a.size(); ++j) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    return value;
}

/// A pile in the corner of the box: every disk on two earlier contacts (bottom and left wall, or two earlier disks).
State pile(int disks, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    State state;
    state.packing.walls.upper = {WallKind::absent, WallKind::absent};
    for (int i = 0; i < disks; ++i) {
        const double r = 1 + 0.3 * static_cast<double>(random() % 1000) / 1000;
        state.packing.radius.push_back(r);
        double x = r;
        double y = r;
        if (i == 0) {
            state.contacts.insert(state.contacts.end(), {left(0), bottom(0)});
        } else if (i % 3 != 0) { // along the bottom, against the previous base disk
            const int base = i - (i % 3 == 1 ? (i == 1 ? 1 : 2) : 1);
            const auto b = static_cast<std::size_t>(base);
            x = state.packing.q[2 * b] + 2 * std::sqrt(r * state.packing.radius[b]);
            state.contacts.insert(state.contacts.end(), {pair(base, i), bottom(i)});
        } else { // on the two previous disks
            const auto a = static_cast<std::size_t>(i - 2);
            const auto b = static_cast<std::size_t>(i - 1);
            const double d0 = r + state.packing.radius[a];
            const double d1 = r + state.packing.radius[b];
            const double ux = state.packing.q[2 * b] - state.packing.q[2 * a];
            const double uy = state.packing.q[2 * b + 1] - state.packing.q[2 * a + 1];
            const double d = std::hypot(ux, uy);
            const double along = (d0 * d0 - d1 * d1 + d * d) / (2 * d);
            const double across = std::sqrt(d0 * d0 - along * along);
            x = state.packing.q[2 * a] + (along * ux - across * uy) / d;
            y = state.packing.q[2 * a + 1] + (along * uy + across * ux) / d;
            state.contacts.insert(state.contacts.end(), {pair(i - 2, i), pair(i - 1, i)});
        }
        state.packing.q.insert(state.packing.q.end(), {x, y});
        state.load.disk_force.insert(state.load.disk_force.end(), {0, -r * r});
    }
    state.packing.q.insert(state.packing.q.end(), {0, 0});
    state.load.infinitesimal = generic_infinitesimal(state.packing.radius, 1);
    snap_to_grid(state.packing);
    return state;
}

struct Row {
    int dofs, contacts, h, k;
};

void check(const Counting& c, const Row& row) {
    BOOST_TEST(c.dof_count == row.dofs);
    BOOST_TEST(c.contact_count == row.contacts);
    BOOST_TEST(c.hyperstaticity == row.h);
    BOOST_TEST(c.mechanisms == row.k);
}

Counting strained(const State& state, Strain strain) {
    const Counting c = isostat::count_strains(state.packing, state.contacts)[static_cast<std::size_t>(strain)];
    BOOST_TEST((c.rank_exact == Verdict::proved));
    return c;
}

Counting own(const State& state) {
    return isostat::count_contacts(state.packing, state.contacts);
}

} // namespace

BOOST_AUTO_TEST_CASE(square_lattices_have_the_hyperstaticity_of_the_closed_form) {
    for (const int m : {2, 3, 5, 8}) {
        const Counting counting = own(square_lattice(m));
        check(counting, {2 * m * m + 2, 2 * m * m + 2 * m, 2 * m - 2, 0});
        BOOST_TEST((counting.rank_exact == Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(triangular_patches_have_the_counts_of_the_closed_form) {
    check(own(triangular_patch(2, 3)), {14, 17, 3, 0});
    check(own(triangular_patch(3, 3)), {20, 25, 5, 0});
}

BOOST_AUTO_TEST_CASE(the_modular_matrix_has_the_residues_of_the_exact_entries) {
    for (const State& state : {two_disks(1, 2, 1, 1), three_disks(1, 1.1, 1.3, 1, 1), pile(6, 3)}) {
        const DofMap dofs(state.packing);
        const auto matrix = exact_contact_matrix(state.packing, dofs, state.contacts);
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const Contact& c = state.contacts[l];
            for (auto e = static_cast<std::size_t>(matrix.start[l]); e < static_cast<std::size_t>(matrix.start[l + 1]);
                 ++e) {
                // Minus the gradient of the gap, times the distance: x_j - x_i on i and x_i - x_j on j, -1 on what
                // leaves a lower wall or is one.
                const int k = dofs.coordinate_of(matrix.row[e]);
                const int other = k / 2 == c.i ? 2 * c.j + k % 2 : 2 * c.i + k % 2;
                const bool away = c.kind == ContactKind::lower_wall || k / 2 != c.i;
                const auto at = [&](int coordinate) {
                    return exact::residue(state.packing.q[static_cast<std::size_t>(coordinate)]);
                };
                BOOST_TEST(matrix.value[e] == (c.kind == ContactKind::disk_disk ? exact::subtract(at(other), at(k))
                                               : away                           ? exact::subtract(0, 1)
                                                                                : 1));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(a_contact_taken_away_is_a_mechanism_and_its_release_is_found) {
    State state = two_disks(1, 2, 1, 1);
    state.contacts.pop_back();
    const Counting counting = own(state);
    check(counting, {6, 5, 0, 1});
    BOOST_TEST_REQUIRE(counting.free_dofs.size() == 1U);
    state.contacts.push_back({ContactKind::held, DofMap(state.packing).coordinate_of(counting.free_dofs.front()), 0});
    BOOST_TEST(IsostaticStructure::prove(state.packing, state.contacts).ok());
}

BOOST_AUTO_TEST_CASE(as_many_contacts_as_degrees_of_freedom_say_nothing_about_the_rank) {
    State state = square_lattice(3); // h = 4, k = 0; the middle disk has four contacts
    std::erase_if(state.contacts,
                  [](const Contact& c) { return c.i == 4 || (c.kind == ContactKind::disk_disk && c.j == 4); });
    const Counting counting = count_contacts(state.packing, state.contacts);
    BOOST_TEST_REQUIRE(counting.dof_count == counting.contact_count);
    BOOST_TEST(counting.mechanisms >= 2); // the middle disk
    BOOST_TEST(counting.hyperstaticity == counting.mechanisms);
    BOOST_TEST(counting.free_dofs.size() == static_cast<std::size_t>(counting.mechanisms));
    const Counting full = own(two_disks(1, 2, 1, 1));
    BOOST_TEST(full.rank == full.dof_count);
    check(full, {6, 6, 0, 0});
    BOOST_TEST(full.free_dofs.empty());
    BOOST_TEST((full.rank_exact == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(the_gate_is_closed_to_singular_and_to_rectangular_matrices) {
    State state = two_disks(1, 2, 1, 1);
    BOOST_TEST(IsostaticStructure::prove(state.packing, state.contacts).ok());
    State twice = state;
    twice.contacts[0] = twice.contacts[1]; // the same contact twice: two equal columns
    BOOST_TEST(!IsostaticStructure::prove(twice.packing, twice.contacts).ok());
    State fewer = state;
    fewer.contacts.pop_back();
    fails(IsostaticStructure::prove(fewer.packing, fewer.contacts), FailureKind::not_isostatic, {"N_f = 6"});
    // Six contacts, but the right and the left wall would have to carry different forces: disk 0 touches neither disk 1
    // nor the top.
    State special = one_disk(1, 1);
    special.contacts = {left(0), right(0), left(0), top(0)};
    BOOST_TEST(!IsostaticStructure::prove(special.packing, special.contacts).ok());
}

BOOST_AUTO_TEST_CASE(no_structure_is_made_of_more_coordinates_than_error_bounds_allow_for) {
    Packing packing;
    packing.radius.assign(most_coordinates / 2, 1.0);
    packing.q.assign(most_coordinates + 2, 1.0);
    expect_bad_input([&] { (void)IsostaticStructure::prove(packing, {}); },
                     {"1250000 disks have 2500002 coordinates", "at most 2500000 were expected"});
    packing.radius.pop_back();
    packing.q.resize(most_coordinates);
    BOOST_TEST((IsostaticStructure::prove(packing, {}).failure().kind == FailureKind::not_isostatic));
}

BOOST_AUTO_TEST_CASE(a_proof_under_way_has_no_evidence_until_it_is_concluded, *boost::unit_test::label("threads")) {
    for (const int count : {1, 2}) {
        const Threads threads(count);
        const State state = two_disks(1, 2, 1, 1);
        auto regular = required(RankProof::begin(state.packing, state.contacts));
        BOOST_TEST((regular.unproved().evidence() == RegularityEvidence::none));
        BOOST_TEST(regular.is_regular());
        const auto proved = required(regular.conclude());
        BOOST_TEST((proved.evidence() == RegularityEvidence::elimination));
        BOOST_TEST(&proved.matrix() == &regular.unproved().matrix());
        // Disk 2 between two fixed ones in one line, tilted: singular, but not by its pattern.
        const State strut = without_walls::held_by_two({1, 1, 1}, {-2, -1, 2, 1, 0, 0});
        auto singular = required(RankProof::begin(strut.packing, strut.contacts));
        BOOST_TEST(!singular.is_regular());
        BOOST_TEST_REQUIRE(!singular.conclude().ok());
        BOOST_TEST((singular.conclude().failure().kind == FailureKind::not_isostatic));
    }
}

BOOST_AUTO_TEST_CASE(the_rounded_and_the_exact_matrix_have_the_same_pattern) {
    const State state = triangular_patch(3, 4);
    const DofMap dofs(state.packing);
    const auto rounded = contact_matrix(state.packing, dofs, state.contacts);
    const auto exact = exact_contact_matrix(state.packing, dofs, state.contacts);
    BOOST_TEST((rounded.start == exact.start));
    BOOST_TEST((rounded.row == exact.row));
}

BOOST_AUTO_TEST_CASE(the_exact_matrix_has_the_differences_of_the_coordinates) {
    const State state = triangular_patch(3, 4);
    const DofMap dofs(state.packing);
    const auto exact = exact_contact_matrix(state.packing, dofs, state.contacts);
    const auto rounded = contact_matrix(state.packing, dofs, state.contacts);
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& contact = state.contacts[l];
        for (auto e = static_cast<std::size_t>(exact.start[l]); e < static_cast<std::size_t>(exact.start[l + 1]); ++e) {
            const int coordinate = dofs.coordinate_of(exact.row[e]);
            double expected = rounded.value[e];
            if (contact.kind == ContactKind::disk_disk) { // the other disk's minus this one's
                const int other = coordinate / 2 == contact.i ? contact.j : contact.i;
                expected = state.packing.coordinate(DiskId(other), coordinate % 2) -
                           state.packing.q[static_cast<std::size_t>(coordinate)];
                BOOST_TEST(expected * rounded.value[e] >= 0);
            } else {
                BOOST_TEST(std::abs(expected) == 1);
            }
            BOOST_TEST(exact.value[e] == exact::residue(expected));
        }
    }
}

BOOST_AUTO_TEST_CASE(forces_and_displacements_are_reciprocal) {
    const State state = three_disks(1, 1.1, 1.3, 1, 1);
    const auto proved = crafted::Regular::proved(state);
    const Factorisation factorisation(proved);
    const auto n = static_cast<std::size_t>(proved.size());
    for (std::size_t l = 0; l < n; ++l) {
        for (std::size_t mu = 0; mu < n; ++mu) {
            std::vector<double> force(n, 0.0);
            std::vector<double> velocity(n, 0.0);
            force[mu] = 1;
            velocity[l] = 1;
            factorisation.solve_forces(force);
            factorisation.solve_velocities(velocity);
            BOOST_TEST(std::abs(force[l] - velocity[mu]) <= 1e-14); // of numbers around 1, exact zeros among them
        }
    }
}

BOOST_AUTO_TEST_CASE(a_linearised_step_never_overestimates_a_gap) {
    std::mt19937_64 random(11);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
    for (int k = 0; k < 2000; ++k) {
        Packing packing;
        packing.radius = {1, 1.5};
        packing.q = {uniform(), uniform(), 3 + uniform(), 3 + uniform(), 9, 9};
        const Contact contact = pair(0, 1);
        const GapGradient g = gap_gradient(packing, contact);
        const double before = gap(packing, contact);
        double linear = before;
        Packing moved = packing;
        for (int e = 0; e < g.count; ++e) {
            const double u = 0.5 * uniform();
            moved.q[static_cast<std::size_t>(g.coordinate[static_cast<std::size_t>(e)])] += u;
            linear += g.value[static_cast<std::size_t>(e)] * u;
        }
        BOOST_TEST(gap(moved, contact) >= linear - 1e-14);
    }
}

BOOST_AUTO_TEST_CASE(bead_by_bead_piles_are_isostatic_and_balance_by_back_substitution) {
    for (const int disks : {1, 3, 6, 30}) {
        const State state = pile(disks, 3);
        const auto proved = crafted::Regular::proved(state);
        BOOST_TEST(proved.size() == 2 * disks);
        // Blocks of at most 2 x 2: the matrix is block triangular, disk by disk.
        const std::vector<int>& blocks = proved.ordering().block_start();
        for (std::size_t b = 0; b + 1 < blocks.size(); ++b) {
            BOOST_TEST(blocks[b + 1] - blocks[b] <= 2);
        }
        const auto inspection = required(inspect_vertex(state));
        double bottom_force = 0, weight = 0;
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            if (state.contacts[l].kind == ContactKind::lower_wall && state.contacts[l].j == 1) {
                bottom_force += inspection.forces[l];
            }
        }
        for (int i = 0; i < disks; ++i) {
            weight -= state.load.disk_force[2 * static_cast<std::size_t>(i) + 1];
        }
        BOOST_TEST(bottom_force == weight, boost::test_tools::tolerance(1e-10));
    }
}

BOOST_AUTO_TEST_CASE(exchanging_a_row_multiplies_the_determinant_by_the_closing_speed) {
    // det G' = det G (g . v) with G v = e_l0, over the rationals and without any rounding.
    std::mt19937_64 random(5);
    const auto entry = [&] {
        mpq_class made(static_cast<long>(random() % 41) - 20, static_cast<unsigned long>(random() % 7 + 1));
        made.canonicalize();
        return made;
    };
    for (int k = 0; k < 200; ++k) {
        const std::size_t n = 2 + random() % 6;
        std::vector<std::vector<mpq_class>> g(n, std::vector<mpq_class>(n));
        std::vector<mpq_class> row(n);
        for (auto& r : g) {
            std::ranges::generate(r, entry);
        }
        std::ranges::generate(row, entry);
        const mpq_class det = determinant(g);
        if (det == 0) {
            continue;
        }
        const std::size_t l0 = random() % n;
        // v by Cramer's rule.
        mpq_class speed = 0;
        for (std::size_t mu = 0; mu < n; ++mu) {
            auto replaced = g;
            for (std::size_t l = 0; l < n; ++l) {
                replaced[l][mu] = l == l0 ? 1 : 0;
            }
            speed += row[mu] * determinant(replaced) / det;
        }
        auto exchanged = g;
        exchanged[l0] = row;
        BOOST_TEST((determinant(exchanged) == det * speed));
    }
}

BOOST_AUTO_TEST_CASE(squares_shear) {
    for (const int m : {2, 3, 4}) {
        check(own(cells::square_lattice(m, false)), {2 * m * m, 2 * m * m, 2 * m - 2, 2 * m - 2});
        check(own(cells::square_lattice(m, true)), {2 * m * m + 1, 2 * m * m, 2 * m - 2, 2 * m - 1});
        const State state = cells::square_lattice(m, false);
        check(strained(state, Strain::none), {2 * m * m - 2, 2 * m * m, 2 * m, 2 * m - 2});
        check(strained(state, Strain::diagonal), {2 * m * m, 2 * m * m, 2 * m - 2, 2 * m - 2});
        check(strained(state, Strain::full), {2 * m * m + 1, 2 * m * m, 2 * m - 2, 2 * m - 1});
    }
}

BOOST_AUTO_TEST_CASE(triangles_do_not) {
    const State state = cells::triangular_lattice(3, 1, false); // rows two apart: pairs touch through two images
    const int n = 6;
    check(own(state), {2 * n, 3 * n, n, 0});
    check(own(cells::triangular_lattice(3, 1, true)), {2 * n + 1, 3 * n, n - 1, 0});
    check(strained(state, Strain::none), {2 * n - 2, 3 * n, n + 2, 0});
    check(strained(state, Strain::isotropic), {2 * n - 1, 3 * n, n + 1, 0});
    check(strained(state, Strain::full), {2 * n + 1, 3 * n, n - 1, 0});
}

BOOST_AUTO_TEST_CASE(one_square_with_a_tilt_has_a_mechanism) {
    const State state =
        cells::in_cell({{1, 0, 0}}, {2, 2, 0}, true, 1, 1, {cells::across(0, 0, 0, 1), cells::across(0, 0, 1, 0)});
    check(own(state), {3, 2, 0, 1});
}

BOOST_AUTO_TEST_CASE(two_disks_of_a_centred_rectangle_bear_a_shear_alone) {
    // For an open set of radii: T7 is false in rectangular cells.
    check(own(cells::two_disks(false, 1, 1)), {4, 4, 1, 1});
    check(own(cells::two_disks(true, 1, 1)), {5, 4, 0, 1});
    State state = cells::two_disks(false, 1, 1);
    state.contacts.push_back(cells::across(0, 0, 1, 0));
    check(own(state), {4, 5, 1, 0});
    state.packing.cell.tilt_moves = {true};
    check(own(state), {5, 5, 0, 0});
}

BOOST_AUTO_TEST_CASE(three_disks_on_the_hexagonal_torus) {
    // Distances along y in units of sqrt(3)/2 keep the rank in the fixed cell: then all coordinates are dyadic after a
    // factor of 6. Disks at 0, (1/2, 1/3 sqrt(3)/2), (1, 2/3 sqrt(3)/2) of the torus of side 1.
    State state = cells::in_cell({{1, 0, 0}, {1, 3, 2}, {1, 6, 4}}, {6, 6, 3}, false, 1, 1, {});
    const auto keep = [&](const std::vector<Contact>& contacts, const Row& row) {
        state.contacts = contacts;
        check(strained(state, Strain::none), row);
    };
    // Every pair of different disks is at distance 1/sqrt(3) through three images.
    const std::vector<Contact> all{cells::across(0, 1, 0, 0),   cells::across(0, 1, -1, 0), cells::across(0, 1, 0, -1),
                                   cells::across(1, 2, 0, 0),   cells::across(1, 2, -1, 0), cells::across(1, 2, 0, -1),
                                   cells::across(0, 2, -1, -1), cells::across(0, 2, -1, 0), cells::across(0, 2, 0, -1)};
    keep(all, {4, 9, 5, 0});
    // Radius 1/4: each touches the two others through two images.
    state = cells::in_cell({{1, 2, 0}, {1, 1, 2}, {1, 3, 2}}, {4, 4, 2}, false, 1, 1, {});
    keep({cells::across(0, 1, 0, 0), cells::across(0, 1, 1, -1), cells::across(0, 2, 0, 0), cells::across(0, 2, 0, -1),
          cells::across(1, 2, 0, 0), cells::across(1, 2, -1, 0)},
         {4, 6, 3, 1});
    // Radius 1/6: a row.
    state = cells::in_cell({{1, 0, 0}, {1, 2, 0}, {1, 4, 0}}, {6, 6, 3}, false, 1, 1, {});
    keep({cells::across(0, 1, 0, 0), cells::across(1, 2, 0, 0), cells::across(0, 2, -1, 0)}, {4, 3, 1, 2});
}

BOOST_AUTO_TEST_CASE(rattlers_are_left_out_and_the_pin_moves_on) {
    State state = cells::two_disks(true, 1, 1);
    state.packing.radius.push_back(0.1);
    state.packing.q.insert(state.packing.q.begin() + 4, {1.2, 0.2});
    state.packing.cell.pin = 2;
    const auto rest = isostat::without_disks(state.packing, isostat::untouched(3, state.contacts));
    const Counting c = isostat::count_strains(rest, state.contacts).back();
    check(c, {5, 4, 0, 1});
}

BOOST_AUTO_TEST_CASE(the_count_of_elastic_moduli) {
    BOOST_TEST(isostat::contacts_for_bulk_modulus(15, 2) == 29);
    BOOST_TEST(isostat::contacts_for_all_moduli(15, 2) == 31);
}
