#include "support/cells.hpp"

#include <isostat/rigidity/counting.hpp>

using namespace isostat;

namespace {

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
