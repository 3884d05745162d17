#pragma once
/// \file
/// One task after the other, beside the thread that submits them: private to the room.

#include <isostat/core/threads.hpp>

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace isostat {

/// Tasks are done in the order in which they were submitted, each after the one before: beside the caller where a
/// thread is free, else when the caller asks. The first task without a result ends it: later ones are dropped undone.
/// What is done, and with which results, does not depend on the number of threads.
template <class Task, class Result> class Pipeline {
  public:
    /// `work` must not touch what the caller uses meanwhile. At most `window` tasks wait; with 0 each is done when it
    /// is submitted.
    Pipeline(std::function<std::optional<Result>(Task&)> work, std::size_t window)
        : work_(std::move(work)), window_(window) {}
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;
    ~Pipeline() { drop(); }

    void submit(Task task) {
        if (window_ == 0) {
            if (!ended_) {
                take(work_(task));
            }
            return;
        }
        bool idle = false;
        bool full = false;
        {
            const std::scoped_lock lock(guard_);
            if (ended_) {
                return;
            }
            tasks_.push_back(std::move(task));
            idle = !std::exchange(busy_, true);
            full = tasks_.size() > window_;
        }
        if (idle) {
            server_.finish(); // it has nothing left to do
            server_ = Errand([this] { serve(); });
        }
        if (full || threads() < 2) {
            server_.finish();
        }
    }
    /// Waits until all is done that was submitted.
    void finish() { server_.finish(); }
    /// The result of the next task, if it is there.
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
    /// Tasks that were not begun are not done; waits for the one that was.
    void drop() {
        {
            const std::scoped_lock lock(guard_);
            ended_ = true;
            tasks_.clear();
        }
        server_ = Errand();
    }

  private:
    void serve() {
        while (true) {
            std::optional<Task> task;
            {
                const std::scoped_lock lock(guard_);
                if (ended_ || tasks_.empty()) {
                    tasks_.clear();
                    busy_ = false;
                    return;
                }
                task = std::move(tasks_.front());
                tasks_.pop_front();
            }
            std::optional<Result> result;
            try {
                result = work_(*task);
            } catch (...) {
                const std::scoped_lock lock(guard_);
                ended_ = true;
                busy_ = false;
                throw; // from `finish`
            }
            const std::scoped_lock lock(guard_);
            take(std::move(result));
        }
    }
    void take(std::optional<Result> result) {
        if (result) {
            results_.push_back(std::move(*result));
        } else {
            ended_ = true;
        }
    }

    std::function<std::optional<Result>(Task&)> work_;
    std::size_t window_;
    std::mutex guard_;
    std::deque<Task> tasks_;
    std::deque<Result> results_;
    bool busy_ = false;
    bool ended_ = false;
    Errand server_; ///< last: it uses the rest
};

} // namespace isostat
