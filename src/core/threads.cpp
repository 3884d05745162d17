#include "core/parallel.hpp"
#include "core/work.hpp"

#include <isostat/core/machine.hpp>

#include <mpfr.h>
#include <sched.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace isostat {

/// Whoever turns `stage` from waiting to begun does the work.
struct Task::State {
    enum Stage : int { waiting, begun, done };
    std::function<void()> work;
    std::exception_ptr failure;
    std::array<long, work_kinds> counted{};
    std::atomic<int> stage{waiting};
    bool sent = false; ///< to the other threads

    explicit State(std::function<void()> w) : work(std::move(w)) {}
    bool claim() {
        int expected = waiting;
        return stage.compare_exchange_strong(expected, begun, std::memory_order_acq_rel);
    }
    void perform() {
        std::array<long, work_kinds>* const before = count_work_in(&counted);
        try {
            require_floating_point(); // of the thread that does it
            work();
        } catch (...) {
            failure = std::current_exception();
        }
        count_work_in(before);
        work = nullptr;
        stage.store(done, std::memory_order_release);
        stage.notify_all();
    }
};

namespace {

void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#else
    std::this_thread::yield();
#endif
}

constexpr long longest_spin = 1000; // a pause is some 40 ns

} // namespace

/// Workers that take pieces of one job at a time. The job number and the pieces left share one word, so a worker that
/// comes late cannot take a piece of a job that it has not seen.
class Pool {
  public:
    /// Fewer workers where the system gives no more. The last ones took what memory was left for their stacks: half of
    /// them are given back, so that there is some for the work.
    explicit Pool(std::size_t workers) {
        if (const std::size_t started = start(workers); started < workers) {
            end();
            start(started / 2);
        }
    }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;
    ~Pool() { end(); }

    /// \pre as for `run`: one thread at a time
    void send(std::shared_ptr<Task::State> task) {
        {
            const std::scoped_lock lock(tasks_guard_);
            tasks_.push_back(std::move(task));
        }
        tasks_waiting_.fetch_add(1, std::memory_order_release);
        ticket_.fetch_add(next_job, std::memory_order_release);
        ticket_.notify_all();
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

    bool take_one() {
        std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
        while (ticket % next_job != 0) {
            if (ticket_.compare_exchange_weak(ticket, ticket - 1, std::memory_order_acq_rel)) {
                const auto piece = static_cast<std::size_t>(ticket % next_job - 1);
                try {
                    require_floating_point();
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

    /// Does one task that nobody has begun, if there is one.
    bool take_task() {
        while (tasks_waiting_.load(std::memory_order_acquire) > 0) {
            std::shared_ptr<Task::State> task;
            {
                const std::scoped_lock lock(tasks_guard_);
                if (tasks_.empty()) {
                    return false;
                }
                task = std::move(tasks_.front());
                tasks_.pop_front();
            }
            tasks_waiting_.fetch_sub(1, std::memory_order_relaxed);
            if (task->claim()) {
                task->perform();
                return true;
            }
        }
        return false;
    }

    void serve();

    /// How many there are then.
    std::size_t start(std::size_t count) {
        ending_.store(false, std::memory_order_relaxed);
        try {
            workers_.reserve(count);
            while (workers_.size() < count) {
                workers_.emplace_back([this] { serve(); });
            }
        } catch (const std::system_error&) { // no thread
        } catch (const std::bad_alloc&) {    // no memory for one
        }
        return workers_.size();
    }
    void end() {
        ending_.store(true, std::memory_order_relaxed);
        ticket_.fetch_add(next_job, std::memory_order_release);
        ticket_.notify_all();
        for (std::thread& worker : workers_) {
            worker.join();
        }
        workers_.clear();
    }

    const std::function<void(std::size_t)>* work_ = nullptr;
    alignas(64) std::atomic<std::uint64_t> ticket_{0};
    alignas(64) std::atomic<std::size_t> done_{0};
    std::atomic<bool> ending_{false};
    std::mutex failure_guard_;
    std::exception_ptr failure_;
    std::size_t failed_piece_ = 0;
    std::mutex tasks_guard_;
    std::deque<std::shared_ptr<Task::State>> tasks_;
    std::atomic<int> tasks_waiting_{0};
    std::vector<std::thread> workers_; ///< last: they use the rest
};

namespace {

thread_local bool inside = false; // a piece or a task is being worked on by this thread

} // namespace

void Pool::serve() {
    inside = true;
    long spins = 0;
    while (!ending_.load(std::memory_order_relaxed)) {
        if (take_one() || take_task()) {
            spins = 0;
        } else if (++spins < longest_spin) {
            pause_briefly();
        } else {
            const std::uint64_t seen = ticket_.load(std::memory_order_acquire);
            if (seen % next_job == 0 && tasks_waiting_.load(std::memory_order_relaxed) == 0 &&
                !ending_.load(std::memory_order_relaxed)) {
                ticket_.wait(seen, std::memory_order_acquire);
            }
            spins = 0;
        }
    }
    mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE); // constants that MPFR keeps for each thread, and leaves behind
}

namespace {

struct SharedPool {
    std::mutex in_use;
    int wanted = 1;
    std::unique_ptr<Pool> pool; ///< made at the first call that has use for it
};

SharedPool& shared_pool() {
    static SharedPool the_pool;
    return the_pool;
}

} // namespace

void set_threads(int count) {
    assert(count >= 1);
    SharedPool& shared = shared_pool();
    const std::scoped_lock lock(shared.in_use);
    if (count != shared.wanted) {
        shared.pool.reset();
        shared.wanted = count;
    }
}

int threads() {
    return shared_pool().wanted;
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
    SharedPool& shared = shared_pool();
    std::unique_lock lock(shared.in_use, std::defer_lock);
    if (pieces < 2 || inside || shared.wanted < 2 || !lock.try_lock()) {
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            work(piece);
        }
        return;
    }
    if (!shared.pool) {
        shared.pool = std::make_unique<Pool>(static_cast<std::size_t>(shared.wanted - 1));
    }
    inside = true;
    const struct Outside {
        ~Outside() { inside = false; }
    } outside;
    shared.pool->run(pieces, work);
}

Task::Task(std::function<void()> work) : state_(std::make_shared<State>(std::move(work))) {
    SharedPool& shared = shared_pool();
    std::unique_lock lock(shared.in_use, std::defer_lock);
    if (inside || shared.wanted < 2 || !lock.try_lock()) {
        return;
    }
    if (!shared.pool) {
        shared.pool = std::make_unique<Pool>(static_cast<std::size_t>(shared.wanted - 1));
    }
    state_->sent = true;
    shared.pool->send(state_);
}

Task::Task(Task&&) noexcept = default;

Task& Task::operator=(Task&& other) noexcept {
    Task before(std::move(*this));
    state_ = std::move(other.state_);
    return *this;
}

Task::~Task() {
    if (state_ != nullptr && !state_->claim()) {
        state_->stage.wait(State::begun, std::memory_order_acquire);
    }
}

bool Task::underway() const {
    return state_ != nullptr && state_->sent && state_->stage.load(std::memory_order_acquire) != State::done;
}

void Task::begin_here() {
    if (state_ != nullptr && state_->claim()) {
        state_->perform();
    }
}

void Task::finish() {
    if (state_ == nullptr) {
        return;
    }
    const std::shared_ptr<State> state = std::move(state_);
    if (state->claim()) {
        state->perform();
    }
    for (long spins = 0; state->stage.load(std::memory_order_acquire) != State::done; ++spins) {
        if (spins < longest_spin) {
            pause_briefly();
        } else {
            state->stage.wait(State::begun, std::memory_order_acquire);
        }
    }
    for (std::size_t k = 0; k < work_kinds; ++k) {
        if (state->counted[k] != 0) {
            count_work(static_cast<Work>(k), state->counted[k]);
        }
    }
    if (state->failure) {
        std::rethrow_exception(state->failure);
    }
}

} // namespace isostat
