#pragma once
// One job after the other, beside the thread that hands them out: private to the room.

#include <isostat/core/threads.hpp>

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace isostat {

/// Jobs are done in the order in which they were handed out, each after the one before, by an errand: beside the caller
/// where a thread is free, else when the caller asks. The first job without a result ends it: later ones are dropped
/// undone. What is done, and with which results, does not depend on the number of threads.
template <class Job, class Result> class Behind {
  public:
    /// `work` must not touch what the caller uses meanwhile. At most `most` jobs wait.
    Behind(std::function<std::optional<Result>(Job&)> work, std::size_t most) : work_(std::move(work)), most_(most) {}
    Behind(const Behind&) = delete;
    Behind& operator=(const Behind&) = delete;
    ~Behind() { drop(); }

    void hand_out(Job job) {
        bool idle = false;
        bool full = false;
        {
            const std::scoped_lock lock(guard_);
            if (ended_) {
                return;
            }
            jobs_.push_back(std::move(job));
            idle = !std::exchange(busy_, true);
            full = jobs_.size() > most_;
        }
        if (idle) {
            errand_.finish(); // it has nothing left to do
            errand_ = Errand([this] { serve(); });
        }
        if (full || threads() < 2) {
            errand_.finish();
        }
    }
    /// Waits until all is done that was handed out.
    void finish() { errand_.finish(); }
    /// The result of the next job, if it is there.
    std::optional<Result> next() {
        const std::scoped_lock lock(guard_);
        if (results_.empty()) {
            return std::nullopt;
        }
        Result result = std::move(results_.front());
        results_.pop_front();
        return result;
    }
    /// Nothing more will be done.
    [[nodiscard]] bool ended() {
        const std::scoped_lock lock(guard_);
        return ended_;
    }
    /// Jobs that were not begun are not done; waits for the one that was.
    void drop() {
        {
            const std::scoped_lock lock(guard_);
            ended_ = true;
            jobs_.clear();
        }
        errand_ = Errand();
    }

  private:
    void serve() {
        while (true) {
            std::optional<Job> job;
            {
                const std::scoped_lock lock(guard_);
                if (ended_ || jobs_.empty()) {
                    jobs_.clear();
                    busy_ = false;
                    return;
                }
                job = std::move(jobs_.front());
                jobs_.pop_front();
            }
            std::optional<Result> result;
            try {
                result = work_(*job);
            } catch (...) {
                const std::scoped_lock lock(guard_);
                ended_ = true;
                busy_ = false;
                throw; // from `finish`
            }
            const std::scoped_lock lock(guard_);
            if (result) {
                results_.push_back(std::move(*result));
            } else {
                ended_ = true;
            }
        }
    }

    std::function<std::optional<Result>(Job&)> work_;
    std::size_t most_;
    std::mutex guard_;
    std::deque<Job> jobs_;
    std::deque<Result> results_;
    bool busy_ = false;
    bool ended_ = false;
    Errand errand_; ///< last: it uses the rest
};

} // namespace isostat
