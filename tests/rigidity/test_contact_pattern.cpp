// Where the contact matrix can have entries, whatever the stored numbers are.
// The ordering of an exchanged structure, whoever asks for it first.
#include "rigidity/contact_pattern.hpp"
#include "rigidity/isostatic.hpp"
#include "support/crafted.hpp"
#include "support/regular.hpp"
#include "support/same_sequence.hpp"

#include <barrier>
#include <thread>

using namespace isostat;
using namespace crafted;

namespace {

std::size_t entries(const State& state) {
    return contact_matrix(state.packing, DofMap(state.packing), state.contacts).row.size();
}

/// Two disks on the bottom, which touch; the upper wall presses on the first, the right one on the second.
State side_by_side(double second_radius, double second_height) {
    State state =
        in_box({{1, 1, 1}, {1, 3, 1}}, 4, 2, 1, 1, {left(0), bottom(0), pair(0, 1), bottom(1), right(1), top(0)});
    state.packing.radius[1] = second_radius;
    state.packing.q[3] = second_height;
    return state;
}

std::vector<unsigned char> carrying(const State& state, bool perturbed = false) {
    const auto structure = crafted::Regular::proved(state);
    const DofMap& dofs = structure.dofs();
    const std::vector<int> right_wall{dofs.dof_of(4)};
    return ContactPattern(state.packing, structure, perturbed).carrying(right_wall);
}

} // namespace

BOOST_AUTO_TEST_CASE(entries_follow_from_the_contacts_not_from_the_stored_coordinates) {
    BOOST_TEST(entries(side_by_side(1, 1)) == entries(side_by_side(1, 1 + 0x1p-52)));
    BOOST_TEST(entries(side_by_side(1, 1)) == 4U + 1 + 1 + 1 + 2 + 2);
}

BOOST_AUTO_TEST_CASE(what_vanishes_is_told_by_indices_and_by_equal_radii_on_one_wall) {
    // In the order left-0, bottom-0, 0-1, bottom-1, right-1, top-0 of the sorted list: found by contact.
    const auto bottom_of_second = [](const State& state, bool perturbed) {
        const auto found = std::ranges::find(state.contacts, bottom(1));
        return carrying(state, perturbed)[static_cast<std::size_t>(found - state.contacts.begin())] != 0;
    };
    // Equal radii: the pair is level at every true vertex, and the right wall presses on the left one alone.
    BOOST_TEST(!bottom_of_second(side_by_side(1, 1), false));
    BOOST_TEST(!bottom_of_second(side_by_side(1, 1 + 0x1p-52), false));
    // Radii that differ in the last bit, or by eps rho: it is not level, whatever is stored.
    BOOST_TEST(bottom_of_second(side_by_side(1 + 0x1p-52, 1), false));
    BOOST_TEST(bottom_of_second(side_by_side(1, 1), true));
}

BOOST_AUTO_TEST_CASE(an_ordering_is_made_once_for_all_copies_whatever_thread_asks_first,
                     *boost::unit_test::label("threads")) {
    const State state = prepared(30, 3);
    const auto proved = crafted::Regular::proved(state);
    for (int round = 0; round < 20; ++round) {
        const auto contacts =
            required(IsostaticStructure::exchange(proved, state.packing, ContactId(0), state.contacts[0]));
        const auto structure = IsostaticStructure::without_proof(contacts);
        constexpr std::size_t askers = 4;
        std::vector<const sparse::Ordering*> found(askers);
        std::barrier together(askers);
        std::vector<std::thread> threads;
        for (std::size_t k = 0; k < askers; ++k) {
            threads.emplace_back([&, k, copy = structure] {
                together.arrive_and_wait();
                found[k] = &copy.ordering();
            });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        for (const sparse::Ordering* ordering : found) {
            BOOST_TEST(ordering == &structure.ordering());
        }
        BOOST_TEST(structure.ordering().column_order() == proved.ordering().column_order());
    }
}

/// Two disks at the right wall, one on the other, and the lower one at the left wall: all but the left wall may bear
/// what the top wall does, by the entries of the matrix.
BOOST_AUTO_TEST_CASE(sums_along_an_axis_show_that_a_wall_with_one_contact_bears_the_load_of_the_other_wall) {
    const State state = in_box({{1, 1, 1}, {0.75, 1.25, 2.75}}, 2, 3.5, 1, 1,
                               {left(0), bottom(0), pair(0, 1), right(0), right(1), top(1)});
    const auto structure = crafted::Regular::proved(state);
    const DofMap& dofs = structure.dofs();
    const ContactPattern pattern(state.packing, structure);
    std::vector<double> guess;
    std::vector<unsigned char> all_but_the_left;
    std::vector<unsigned char> at_the_sides; // of the lower disk
    for (const Contact& c : state.contacts) {
        guess.push_back(c == pair(0, 1) ? 1 : 0.5);
        all_but_the_left.push_back(c == left(0) ? 0 : 1);
        at_the_sides.push_back(c == left(0) || c == right(0) ? 1 : 0);
    }
    const std::vector<int> top_wall{dofs.dof_of(5)};
    const std::vector<int> right_wall{dofs.dof_of(4)};
    BOOST_TEST(pattern.carrying(top_wall) == std::vector<unsigned char>(6, 1));
    BOOST_TEST(pattern.carrying_by_sums(dofs, top_wall, guess) == all_but_the_left);
    // The load on the right wall is in the sum along x, and by the top and the upper disk nothing else bears it.
    BOOST_TEST(pattern.carrying(right_wall) == at_the_sides);
    BOOST_TEST(pattern.carrying_by_sums(dofs, right_wall, guess) == at_the_sides);
}
