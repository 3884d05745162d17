// Grains that move as one body: the count against the exact rank with and without the row of the pair.
#include "rigidity/rigid_group.hpp"
#include "support/cells.hpp"
#include "support/crafted.hpp"
#include "support/mirror.hpp"

#include <isostat/rigidity/counting.hpp>

using namespace isostat;
using namespace crafted;

namespace {

/// A hexagon of seven equal disks: all twelve contacts but the last are independent.
State hexagon() {
    const double h = std::sqrt(3.0);
    return in_box(
        {{1, 10, 10}, {1, 12, 10}, {1, 11, 10 + h}, {1, 9, 10 + h}, {1, 8, 10}, {1, 9, 10 - h}, {1, 11, 10 - h}}, 20,
        20, 1, 1,
        {pair(0, 1), pair(0, 2), pair(0, 3), pair(0, 4), pair(0, 5), pair(0, 6), pair(1, 2), pair(2, 3), pair(3, 4),
         pair(4, 5), pair(5, 6)});
}

bool counts(const State& state, const std::vector<Contact>& among, const Contact& last) {
    return moves_as_one(DofMap(state.packing), state.packing.disk_count(), among, last);
}

/// The rank mod p of other positions of the same grains: a pair that moves with the others adds none anywhere.
bool adds_nothing(State state, const Contact& last) {
    for (std::size_t k = 0; k < state.packing.q.size(); ++k) {
        state.packing.q[k] += 0.01 * std::sin(3.0 + 7 * static_cast<double>(k));
    }
    const int before = count_contacts(state.packing, state.contacts).rank;
    BOOST_TEST_REQUIRE(before == static_cast<int>(state.contacts.size()));
    state.contacts.push_back(last);
    return count_contacts(state.packing, state.contacts).rank == before;
}

} // namespace

BOOST_AUTO_TEST_CASE(the_last_contact_of_a_hexagon_moves_with_the_others_and_not_when_one_is_missing) {
    State state = hexagon();
    const Contact last = pair(1, 6);
    BOOST_TEST(counts(state, state.contacts, last));
    BOOST_TEST(adds_nothing(state, last));
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        State open = state;
        open.contacts.erase(open.contacts.begin() + static_cast<std::ptrdiff_t>(l));
        BOOST_TEST(!counts(open, open.contacts, last));
        BOOST_TEST(!adds_nothing(open, last));
    }
}

BOOST_AUTO_TEST_CASE(a_fixed_disk_takes_away_the_translations_and_two_the_rotation_too) {
    State state = hexagon();
    state.packing.fixed = {1, 0, 0, 0, 0, 0, 0};
    BOOST_TEST(!counts(state, state.contacts, pair(1, 6))); // the rotation about it is not a motion that is counted
    state.packing.fixed = {0, 0, 0, 0, 0, 0, 0};
    BOOST_TEST(counts(state, state.contacts, pair(1, 6)));
}

BOOST_AUTO_TEST_CASE(walls_count_as_grains_and_leave_translations_along_them) {
    // Two disks side by side on the bottom slide along it together: with the wall that makes three contacts for one
    // motion that is left. The top wall, flat on both, adds a degree of freedom and a contact; the second one rests.
    const State state = equal_pair();
    const std::vector<Contact> sliding{bottom(0), bottom(1), pair(0, 1), top(0)};
    BOOST_TEST(counts(state, sliding, top(1)));
    BOOST_TEST(!counts(state, {bottom(0), bottom(1), top(0)}, top(1))); // true, but by another list
    BOOST_TEST(!counts(state, {bottom(0), pair(0, 1), top(0)}, top(1)));
    // With both side walls the box is closed: four walls' worth of contacts, and nothing slides.
    BOOST_TEST(counts(state, {bottom(0), bottom(1), pair(0, 1), top(0), left(0), right(1)}, top(1)));
}

BOOST_AUTO_TEST_CASE(a_body_across_a_side_of_the_cell_moves_as_one_and_one_that_winds_around_it_is_not_counted) {
    const State box = hexagon();
    State state = box;
    state.packing.walls = Walls::none();
    state.packing.q.push_back(3); // the tilt
    for (const bool tilts : {false, true}) {
        for (int pin = 0; pin < 7; ++pin) { // in the body, whichever
            state.packing.cell = {{true, true}, {true, true}, {tilts}, pin};
            state.contacts = box.contacts;
            state.contacts.push_back(pair(1, 6));
            State moved = cells::with_other_representatives(
                state, {cells::image(0, 0), cells::image(1, 0), cells::image(0, -1), cells::image(-1, 1),
                        cells::image(0, 0), cells::image(0, 0), cells::image(1, 1)});
            const Contact last = moved.contacts.back();
            BOOST_TEST(!last.image.is_here());
            moved.contacts.pop_back();
            BOOST_TEST(counts(moved, moved.contacts, last));
            BOOST_TEST(adds_nothing(moved, last));
            for (std::size_t l = 0; l < moved.contacts.size(); ++l) {
                State open = moved;
                open.contacts.erase(open.contacts.begin() + static_cast<std::ptrdiff_t>(l));
                BOOST_TEST(!counts(open, open.contacts, last));
            }
            // The same disks, the last pair through another image.
            const Contact other =
                pair_of(last.i, last.j, {{last.image.m[0], static_cast<std::int8_t>(last.image.m[1] + 1), 0}});
            BOOST_TEST(!counts(moved, moved.contacts, other));
            BOOST_TEST(!adds_nothing(moved, other));
        }
    }
}

BOOST_AUTO_TEST_CASE(a_held_coordinate_belongs_to_no_body) {
    State state = hexagon();
    std::vector<Contact> among = state.contacts;
    among.back() = {ContactKind::held, 0, 0};
    BOOST_TEST(!counts(state, among, pair(1, 6)));
    BOOST_TEST(!counts(state, state.contacts, {ContactKind::held, 0, 0}));
}
