#include <isostat/core/threads.hpp>

#include <sched.h>

#include <atomic>
#include <cassert>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace isostat {

namespace {

void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#else
    std::this_thread::yield();
#endif
}

/// Workers that take pieces of one job at a time. The job number and the pieces left share one word, so a worker that
/// comes late cannot take a piece of a job that it has not seen.
class Pool {
  public:
    explicit Pool(int workers) {
        for (int k = 0; k < workers; ++k) {
            workers_.emplace_back([this] { serve(); });
        }
    }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;
    ~Pool() {
        ending_.store(true, std::memory_order_relaxed);
        ticket_.fetch_add(next_job, std::memory_order_release);
        ticket_.notify_all();
        for (std::thread& worker : workers_) {
            worker.join();
        }
    }

    void run(std::size_t pieces, const std::function<void(std::size_t)>& work) {
        assert(pieces < next_job);
        work_ = &work;
        done_.store(0, std::memory_order_relaxed);
        const std::uint64_t job = (ticket_.load(std::memory_order_relaxed) / next_job + 1) * next_job;
        ticket_.store(job + pieces, std::memory_order_release);
        ticket_.notify_all();
        while (take_one()) {
        }
        // Only pieces that a worker has begun are left.
        for (long spins = 0; done_.load(std::memory_order_acquire) != pieces; ++spins) {
            if (spins < longest_spin) {
                pause_briefly();
            } else {
                std::this_thread::yield();
            }
        }
        if (failure_) {
            std::rethrow_exception(std::exchange(failure_, nullptr));
        }
    }

  private:
    static constexpr std::uint64_t next_job = std::uint64_t{1} << 32U;
    static constexpr long longest_spin = 1000; // a pause is some 40 ns

    bool take_one() {
        std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
        while (ticket % next_job != 0) {
            if (ticket_.compare_exchange_weak(ticket, ticket - 1, std::memory_order_acq_rel)) {
                const auto piece = static_cast<std::size_t>(ticket % next_job - 1);
                try {
                    (*work_)(piece);
                } catch (...) {
                    const std::scoped_lock lock(failure_guard_);
                    if (!failure_ || piece < failed_piece_) {
                        failure_ = std::current_exception();
                        failed_piece_ = piece;
                    }
                }
                done_.fetch_add(1, std::memory_order_release);
                return true;
            }
        }
        return false;
    }

    void serve();

    const std::function<void(std::size_t)>* work_ = nullptr;
    alignas(64) std::atomic<std::uint64_t> ticket_{0};
    alignas(64) std::atomic<std::size_t> done_{0};
    std::atomic<bool> ending_{false};
    std::mutex failure_guard_;
    std::exception_ptr failure_;
    std::size_t failed_piece_ = 0;
    std::vector<std::thread> workers_;
};

thread_local bool inside = false; // a piece is being worked on by this thread

void Pool::serve() {
    inside = true;
    long spins = 0;
    while (!ending_.load(std::memory_order_relaxed)) {
        if (take_one()) {
            spins = 0;
        } else if (++spins < longest_spin) {
            pause_briefly();
        } else {
            const std::uint64_t seen = ticket_.load(std::memory_order_acquire);
            if (seen % next_job == 0 && !ending_.load(std::memory_order_relaxed)) {
                ticket_.wait(seen, std::memory_order_acquire);
            }
            spins = 0;
        }
    }
}

struct Crew {
    std::mutex in_use;
    int wanted = 1;
    std::unique_ptr<Pool> pool; ///< made at the first call that has use for it
};

Crew& crew() {
    static Crew the_crew;
    return the_crew;
}

} // namespace

void set_threads(int count) {
    assert(count >= 1);
    Crew& c = crew();
    const std::scoped_lock lock(c.in_use);
    if (count != c.wanted) {
        c.pool.reset();
        c.wanted = count;
    }
}

int threads() {
    return crew().wanted;
}

int available_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0) {
        return CPU_COUNT(&set);
    }
    const unsigned cores = std::thread::hardware_concurrency();
    return cores > 0 ? static_cast<int>(cores) : 1;
}

void parallel_pieces(std::size_t pieces, const std::function<void(std::size_t)>& work) {
    Crew& c = crew();
    std::unique_lock lock(c.in_use, std::defer_lock);
    if (pieces < 2 || inside || c.wanted < 2 || !lock.try_lock()) {
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            work(piece);
        }
        return;
    }
    if (!c.pool) {
        c.pool = std::make_unique<Pool>(c.wanted - 1);
    }
    inside = true;
    const struct Outside {
        ~Outside() { inside = false; }
    } outside;
    c.pool->run(pieces, work);
}

} // namespace isostat
