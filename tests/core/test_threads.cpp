// Work in pieces on several threads.

#include <isostat/core/threads.hpp>

#include <boost/test/unit_test.hpp>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace isostat;

struct Threads {
    explicit Threads(int count) { set_threads(count); }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;
    ~Threads() { set_threads(1); }
};

} // namespace

BOOST_AUTO_TEST_SUITE(core)

BOOST_AUTO_TEST_CASE(every_piece_is_done_exactly_once) {
    for (const int count : {1, 2, 5}) {
        const Threads threads(count);
        for (int round = 0; round < 300; ++round) {
            std::vector<int> done(static_cast<std::size_t>(round % 37), 0);
            parallel_pieces(done.size(), [&](std::size_t piece) { ++done[piece]; });
            BOOST_TEST((done == std::vector<int>(done.size(), 1)));
        }
    }
}

BOOST_AUTO_TEST_CASE(pieces_within_pieces_are_done_by_the_thread_that_asks) {
    const Threads threads(3);
    std::vector<std::atomic<int>> done(8);
    parallel_pieces(8, [&](std::size_t outer) { parallel_pieces(5, [&](std::size_t) { ++done[outer]; }); });
    for (const auto& count : done) {
        BOOST_TEST(count == 5);
    }
}

BOOST_AUTO_TEST_CASE(the_exception_of_the_lowest_piece_comes_back_and_the_next_call_works) {
    for (const int count : {1, 4}) {
        const Threads threads(count);
        for (int round = 0; round < 50; ++round) {
            std::string caught;
            try {
                parallel_pieces(20, [](std::size_t piece) {
                    if (piece >= 3) {
                        throw std::runtime_error(piece == 3 ? "three" : "later");
                    }
                });
            } catch (const std::runtime_error& error) {
                caught = error.what();
            }
            BOOST_TEST(caught != "");
            if (count == 1) {
                BOOST_TEST(caught == "three");
            }
            std::atomic<int> sum{0};
            parallel_pieces(10, [&](std::size_t piece) { sum += static_cast<int>(piece); });
            BOOST_TEST(sum == 45);
        }
    }
}

BOOST_AUTO_TEST_CASE(pieces_cover_the_items_without_overlap) {
    const Pieces pieces{10, 4};
    BOOST_TEST(pieces.count() == 3U);
    BOOST_TEST(pieces.first(2) == 8U);
    BOOST_TEST(pieces.last(2) == 10U);
    BOOST_TEST((Pieces{0, 4}.count()) == 0U);
    BOOST_TEST((Pieces{8, 4}.count()) == 2U);
}

BOOST_AUTO_TEST_SUITE_END()
