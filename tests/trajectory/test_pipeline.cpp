// Tasks done in order beside the thread that submits them.
#include "support/test.hpp"
#include "support/threads.hpp"
#include "trajectory/pipeline.hpp"

#include <stdexcept>

using namespace isostat;

BOOST_AUTO_TEST_CASE(tasks_are_done_in_order_up_to_the_first_without_a_result, *boost::unit_test::label("threads")) {
    for (const int count : {1, 2, 3}) {
        const Threads threads(count);
        for (const int fails_at : {0, 1, 57, 200, 1000}) {
            int last = -1; // of the tasks only
            bool in_order = true;
            Pipeline<int, int> pipeline(
                [&](int& task) -> std::optional<int> {
                    in_order = in_order && task == last + 1;
                    last = task;
                    return task == fails_at ? std::nullopt : std::optional<int>(10 * task);
                },
                4);
            int seen = 0;
            const auto take = [&] {
                while (auto result = pipeline.next()) {
                    BOOST_TEST_REQUIRE(*result == 10 * seen);
                    ++seen;
                }
            };
            int submitted = 0;
            for (; submitted < 300 && !pipeline.ended(); ++submitted) {
                pipeline.submit(submitted);
                take();
            }
            pipeline.finish();
            take();
            BOOST_TEST(in_order);
            BOOST_TEST(seen == std::min(fails_at, 300));
            BOOST_TEST(pipeline.ended() == (fails_at < 300));
            BOOST_TEST(last == (fails_at < 300 ? fails_at : 299));
            if (count == 1) {
                BOOST_TEST(submitted == std::min(fails_at + 1, 300));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(an_exception_of_a_task_reaches_who_waits_and_ends_the_rest, *boost::unit_test::label("threads")) {
    for (const int count : {1, 2}) {
        const Threads threads(count);
        int done = 0;
        Pipeline<int, int> pipeline(
            [&](int& task) -> std::optional<int> {
                ++done;
                if (task == 3) {
                    throw std::runtime_error("task 3");
                }
                return task;
            },
            100);
        const auto all = [&] {
            for (int task = 0; task < 50; ++task) {
                pipeline.submit(task);
            }
            pipeline.finish();
        };
        BOOST_CHECK_THROW(all(), std::runtime_error);
        BOOST_TEST(done == 4);
        BOOST_TEST(pipeline.ended());
    }
}

BOOST_AUTO_TEST_CASE(tasks_that_are_dropped_are_not_begun_afterwards, *boost::unit_test::label("threads")) {
    for (const int count : {1, 2}) {
        const Threads threads(count);
        int done = 0;
        {
            Pipeline<int, int> pipeline(
                [&](int& task) -> std::optional<int> {
                    ++done;
                    return task;
                },
                1000);
            for (int task = 0; task < 100; ++task) {
                pipeline.submit(task);
            }
            pipeline.drop();
            const int before = done;
            pipeline.submit(100);
            pipeline.finish();
            BOOST_TEST(done == before);
        }
        BOOST_TEST(done <= 100);
    }
}
