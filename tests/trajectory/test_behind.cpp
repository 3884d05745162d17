// Jobs done in order behind the thread that hands them out.
#include "support/threads.hpp"
#include "trajectory/behind.hpp"

#include <boost/test/unit_test.hpp>

#include <stdexcept>

using namespace isostat;

BOOST_AUTO_TEST_SUITE(trajectory)

BOOST_AUTO_TEST_CASE(jobs_behind_are_done_in_order_up_to_the_first_without_a_result,
                     *boost::unit_test::label("threads")) {
    for (const int count : {1, 2, 3}) {
        const Threads threads(count);
        for (const int fails_at : {0, 1, 57, 200, 1000}) {
            int last = -1; // of the jobs only
            bool in_order = true;
            Behind<int, int> behind(
                [&](int& job) -> std::optional<int> {
                    in_order = in_order && job == last + 1;
                    last = job;
                    return job == fails_at ? std::nullopt : std::optional<int>(10 * job);
                },
                4);
            int seen = 0;
            const auto take = [&] {
                while (auto result = behind.next()) {
                    BOOST_TEST_REQUIRE(*result == 10 * seen);
                    ++seen;
                }
            };
            int handed_out = 0;
            for (; handed_out < 300 && !behind.ended(); ++handed_out) {
                behind.hand_out(handed_out);
                take();
            }
            behind.finish();
            take();
            BOOST_TEST(in_order);
            BOOST_TEST(seen == std::min(fails_at, 300));
            BOOST_TEST(behind.ended() == (fails_at < 300));
            BOOST_TEST(last == (fails_at < 300 ? fails_at : 299));
            if (count == 1) {
                BOOST_TEST(handed_out == std::min(fails_at + 1, 300));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(an_exception_of_a_job_behind_reaches_who_waits_and_ends_the_rest,
                     *boost::unit_test::label("threads")) {
    for (const int count : {1, 2}) {
        const Threads threads(count);
        int done = 0;
        Behind<int, int> behind(
            [&](int& job) -> std::optional<int> {
                ++done;
                if (job == 3) {
                    throw std::runtime_error("job 3");
                }
                return job;
            },
            100);
        const auto all = [&] {
            for (int job = 0; job < 50; ++job) {
                behind.hand_out(job);
            }
            behind.finish();
        };
        BOOST_CHECK_THROW(all(), std::runtime_error);
        BOOST_TEST(done == 4);
        BOOST_TEST(behind.ended());
    }
}

BOOST_AUTO_TEST_CASE(jobs_behind_that_are_dropped_are_not_begun_afterwards, *boost::unit_test::label("threads")) {
    for (const int count : {1, 2}) {
        const Threads threads(count);
        int done = 0;
        {
            Behind<int, int> behind(
                [&](int& job) -> std::optional<int> {
                    ++done;
                    return job;
                },
                1000);
            for (int job = 0; job < 100; ++job) {
                behind.hand_out(job);
            }
            behind.drop();
            const int before = done;
            behind.hand_out(100);
            behind.finish();
            BOOST_TEST(done == before);
        }
        BOOST_TEST(done <= 100);
    }
}

BOOST_AUTO_TEST_SUITE_END()
