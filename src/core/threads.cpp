#include "core/parallel.hpp"
#include "core/work.hpp"

#include <isostat/core/machine.hpp>

#include <mpfr.h>
#include <sched.h>

#include <array>
#include <atomic>
#include <cassert>
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

constexpr long longest_spin = 1000; // a pause is some 40 ns; cost: how long a thread waits awake

} // namespace

namespace {

thread_local bool inside = false; // a piece or a task is being worked on by this thread

} // namespace

/// Workers that take tasks.
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

    /// `first`: before all that wait.
    void send(std::shared_ptr<Task::State> task, bool first) {
        if (workers_.empty()) {
            return; // who waits for the task does it
        }
        {
            const std::scoped_lock lock(guard_);
            tasks_.insert(first ? tasks_.begin() : tasks_.end(), std::move(task));
        }
        waiting_.fetch_add(1, std::memory_order_release);
        waiting_.notify_one();
    }

  private:
    /// Does one task that nobody has begun, if there is one.
    bool take() {
        while (waiting_.load(std::memory_order_acquire) > 0) {
            std::shared_ptr<Task::State> task;
            {
                const std::scoped_lock lock(guard_);
                if (tasks_.empty()) {
                    return false;
                }
                task = std::move(tasks_.front());
                tasks_.pop_front();
            }
            waiting_.fetch_sub(1, std::memory_order_relaxed);
            if (task->claim()) {
                task->perform();
                return true;
            }
        }
        return false;
    }
    void serve() {
        inside = true;
        for (long spins = 0; !ending_.load(std::memory_order_relaxed);) {
            if (take()) {
                spins = 0;
            } else if (++spins < longest_spin) {
                pause_briefly();
            } else {
                waiting_.wait(0, std::memory_order_acquire);
                spins = 0;
            }
        }
        mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE); // constants that MPFR keeps for each thread, and leaves behind
    }

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
        waiting_.fetch_add(1, std::memory_order_release); // no worker sleeps any more
        waiting_.notify_all();
        for (std::thread& worker : workers_) {
            worker.join();
        }
        waiting_.fetch_sub(1, std::memory_order_relaxed);
        workers_.clear();
    }

    std::mutex guard_;
    std::deque<std::shared_ptr<Task::State>> tasks_;
    alignas(64) std::atomic<int> waiting_{0}; ///< number of `tasks_`; cost: bytes of a cache line
    std::atomic<bool> ending_{false};
    std::vector<std::thread> workers_; ///< last: they use the rest
};

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
    const std::size_t others =
        inside ? 0 : std::min(pieces, static_cast<std::size_t>(threads())) - (pieces > 0 ? 1 : 0);
    if (others == 0) {
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            work(piece);
        }
        return;
    }
    std::atomic<std::size_t> next{0};
    std::mutex guard;
    std::exception_ptr failure;
    std::size_t failed = pieces;
    const auto take = [&] {
        for (std::size_t piece = next.fetch_add(1); piece < pieces; piece = next.fetch_add(1)) {
            try {
                work(piece);
            } catch (...) {
                const std::scoped_lock lock(guard);
                if (piece < failed) {
                    failure = std::current_exception();
                    failed = piece;
                }
            }
        }
    };
    std::vector<Task> tasks;
    for (std::size_t k = 0; k < others; ++k) {
        tasks.emplace_back(take, true);
    }
    inside = true;
    const struct Outside {
        ~Outside() { inside = false; }
    } outside;
    require_floating_point();
    take();
    for (Task& task : tasks) {
        task.finish();
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
}

Task::Task(std::function<void()> work, bool first) : state_(std::make_shared<State>(std::move(work))) {
    SharedPool& shared = shared_pool();
    if (inside || shared.wanted < 2) {
        return;
    }
    const std::scoped_lock lock(shared.in_use);
    if (!shared.pool) {
        shared.pool = std::make_unique<Pool>(static_cast<std::size_t>(shared.wanted - 1));
    }
    state_->sent = true;
    shared.pool->send(state_, first);
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
