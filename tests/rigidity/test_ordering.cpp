// The ordering of an exchanged structure, whoever asks for it first.

#include "rigidity/isostatic.hpp"
#include "support/regular.hpp"
#include "support/same_sequence.hpp"

#include <barrier>
#include <thread>

using namespace isostat;

BOOST_AUTO_TEST_CASE(an_ordering_is_made_once_for_all_copies_whatever_thread_asks_first,
                     *boost::unit_test::label("threads")) {
    const State state = prepared(30, 3);
    const auto proved = crafted::Regular::proved(state);
    for (int round = 0; round < 20; ++round) {
        const auto contacts = IsostaticStructure::exchange(proved, state.packing, ContactId(0), state.contacts[0]);
        BOOST_TEST_REQUIRE(contacts.has_value());
        const auto structure = IsostaticStructure::without_proof(*contacts);
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
