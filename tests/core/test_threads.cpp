// Work in pieces on several threads.

#include "core/parallel.hpp"
#include "core/work.hpp"
#include "support/test.hpp"
#include "support/threads.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

using namespace isostat;

BOOST_AUTO_TEST_CASE(every_piece_is_done_exactly_once, *boost::unit_test::label("threads")) {
    for (const int count : {1, 2, 5}) {
        const Threads threads(count);
        for (int round = 0; round < 300; ++round) {
            std::vector<int> done(static_cast<std::size_t>(round % 37), 0);
            parallel_pieces(done.size(), [&](std::size_t piece) { ++done[piece]; });
            BOOST_TEST((done == std::vector<int>(done.size(), 1)));
        }
    }
}

BOOST_AUTO_TEST_CASE(pieces_within_pieces_are_done_by_the_thread_that_asks, *boost::unit_test::label("threads")) {
    const Threads threads(3);
    std::vector<std::atomic<int>> done(8);
    parallel_pieces(8, [&](std::size_t outer) { parallel_pieces(5, [&](std::size_t) { ++done[outer]; }); });
    for (const auto& count : done) {
        BOOST_TEST(count == 5);
    }
}

BOOST_AUTO_TEST_CASE(the_exception_of_the_lowest_piece_comes_back_and_the_next_call_works,
                     *boost::unit_test::label("threads")) {
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

BOOST_AUTO_TEST_CASE(a_task_is_done_once_whoever_does_it, *boost::unit_test::label("threads")) {
    for (const int count : {1, 2, 4}) {
        const Threads threads(count);
        for (int round = 0; round < 500; ++round) {
            std::atomic<int> done{0};
            std::vector<Task> tasks;
            for (int k = 0; k < round % 7; ++k) {
                tasks.emplace_back([&done] { ++done; });
            }
            std::vector<int> pieces(5, 0); // the others keep serving
            parallel_pieces(pieces.size(), [&](std::size_t piece) { ++pieces[piece]; });
            for (Task& task : tasks) {
                task.finish();
                BOOST_TEST(!task.pending());
                task.finish(); // nothing left
            }
            BOOST_TEST(done == round % 7);
            BOOST_TEST((pieces == std::vector<int>(pieces.size(), 1)));
        }
    }
}

BOOST_AUTO_TEST_CASE(a_task_runs_beside_its_caller, *boost::unit_test::label("threads")) {
    const Threads threads(2);
    std::atomic<bool> begun{false};
    Task task([&] { begun = true; });
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(10);
    while (!begun && std::chrono::steady_clock::now() < until) {
        std::this_thread::yield();
    }
    BOOST_TEST(begun.load());
    task.finish();
}

BOOST_AUTO_TEST_CASE(a_task_is_under_way_only_while_another_thread_has_it, *boost::unit_test::label("threads")) {
    Task alone([] {});
    BOOST_TEST(!alone.underway()); // nobody else will do it
    const Threads threads(2);
    std::atomic<bool> go{false};
    Task task([&] {
        while (!go) {
            std::this_thread::yield();
        }
    });
    BOOST_TEST(task.underway());
    go = true;
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(10);
    while (task.underway() && std::chrono::steady_clock::now() < until) {
        std::this_thread::yield();
    }
    BOOST_TEST(!task.underway());
    task.finish();
    std::atomic<int> waited_for{0};
    parallel_pieces(4, [&](std::size_t) { // samples of an ensemble: their tasks are their own work
        Task own([] {});
        waited_for += own.underway() ? 1 : 0;
        own.finish();
    });
    BOOST_TEST(waited_for == 0);
}

BOOST_AUTO_TEST_CASE(one_thread_does_an_task_when_it_is_asked_for_and_not_at_all_otherwise) {
    int done = 0;
    {
        Task task([&] { ++done; });
        BOOST_TEST(done == 0);
        task.finish();
        BOOST_TEST(done == 1);
        task = Task([&] { ++done; });
        BOOST_TEST(task.pending());
    }
    BOOST_TEST(done == 1);
}

BOOST_AUTO_TEST_CASE(a_task_begun_by_its_caller_is_done_once_and_tells_when_it_is_finished,
                     *boost::unit_test::label("threads")) {
    for (const int count : {1, 2}) {
        const Threads threads(count);
        for (int round = 0; round < 200; ++round) {
            std::atomic<int> done{0};
            const long before = work_done()[static_cast<std::size_t>(Work::factorisations)];
            const auto counted = [before] {
                return work_done()[static_cast<std::size_t>(Work::factorisations)] - before;
            };
            Task task([&] {
                ++done;
                count_work(Work::factorisations);
            });
            task.begin_here();
            BOOST_TEST(done <= 1); // another thread may be at it
            BOOST_TEST(task.pending());
            BOOST_TEST(counted() == 0);
            task.finish();
            BOOST_TEST(done == 1);
            BOOST_TEST(counted() == 1);
            task.begin_here(); // nothing left
            BOOST_TEST(done == 1);
        }
        Task bad([] { throw std::runtime_error("bad"); });
        bad.begin_here();
        BOOST_CHECK_THROW(bad.finish(), std::runtime_error);
    }
    int dropped = 0;
    {
        Task task([&] { ++dropped; });
        task.begin_here();
        BOOST_TEST(dropped == 1);
    }
    BOOST_TEST(dropped == 1);
}

BOOST_AUTO_TEST_CASE(nothing_of_an_task_is_left_running_when_it_is_dropped, *boost::unit_test::label("threads")) {
    const Threads threads(3);
    for (int round = 0; round < 200; ++round) {
        std::vector<int> written(1000, 0);
        {
            Task task([&] { std::ranges::fill(written, 1); });
        }
        BOOST_TEST((written == std::vector<int>(written.size(), written.front())));
    }
}

BOOST_AUTO_TEST_CASE(what_an_task_threw_comes_out_of_finish, *boost::unit_test::label("threads")) {
    for (const int count : {1, 2}) {
        const Threads threads(count);
        Future<int> good([] { return 7; });
        Future<int> bad([]() -> int { throw std::runtime_error("bad"); });
        BOOST_CHECK_THROW((void)bad.get(), std::runtime_error);
        BOOST_TEST(good.get() == 7);
        BOOST_TEST(!good.pending());
    }
}

BOOST_AUTO_TEST_CASE(tasks_within_tasks_and_pieces_end, *boost::unit_test::label("threads")) {
    const Threads threads(2);
    for (int round = 0; round < 100; ++round) {
        std::atomic<int> sum{0};
        const auto nested = [&sum] {
            Task inner([&sum] { sum += 1; });
            parallel_pieces(4, [&sum](std::size_t) { sum += 10; });
            inner.finish();
        };
        Task outer(nested);
        parallel_pieces(3, [&](std::size_t) { nested(); });
        outer.finish();
        BOOST_TEST(sum == 4 * 41);
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

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // they take terabytes of addresses
BOOST_AUTO_TEST_CASE(where_the_system_refuses_threads_fewer_do_the_work) {
    // In a child: its address space is limited to what it has and a little more, too little for 64 stacks of 8 MB.
    const pid_t child = ::fork();
    BOOST_REQUIRE(child >= 0);
    if (child == 0) {
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const auto room = static_cast<rlim_t>(pages) * 4096 + (100U << 20U);
        const rlimit limit{room, room};
        if (::setrlimit(RLIMIT_AS, &limit) != 0) {
            ::_exit(2);
        }
        set_threads(64);
        std::atomic<long> sum{0};
        for (int round = 0; round < 20; ++round) {
            parallel_pieces(200, [&](std::size_t piece) { sum += static_cast<long>(piece); });
        }
        ::_exit(sum == 20 * 199 * 100 ? 0 : 1);
    }
    int status = -1;
    BOOST_REQUIRE(::waitpid(child, &status, 0) == child);
    BOOST_TEST(WIFEXITED(status));
    BOOST_TEST(WEXITSTATUS(status) == 0);
}
#endif
