#pragma once
/// \file
/// A queue of work that one other thread carries out in order: private to the room.

#include "core/parallel.hpp"

#include <isostat/core/machine.hpp>

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace isostat {

/// Items are worked on in the order in which they were submitted, one at a time: in another thread where one is free,
/// else when the caller asks. The first item without a result ends the pipeline: later items are dropped. What is done,
/// and with which results, does not depend on the number of threads.
template <class Item, class Result> class Pipeline {
  public:
    /// `work` must not touch data that the caller uses meanwhile. At most `window` items wait; with 0 each item is
    /// finished when `submit` returns.
    Pipeline(std::function<std::optional<Result>(Item&)> work, std::size_t window)
        : work_(std::move(work)), window_(window) {}
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;
    ~Pipeline() { drop(); }

    void submit(Item item) {
        if (window_ == 0) {
            if (!ended_) {
                take(work_(item));
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
            items_.push_back(std::move(item));
            idle = !std::exchange(busy_, true);
            full = items_.size() > window_;
        }
        if (idle) {
            server_.finish(); // the task has no item left to work on
            server_ = Task([this] { serve(); });
        }
        if (full || threads() < 2) {
            server_.finish();
        }
    }
    /// Waits until every submitted item is finished or dropped.
    void finish() { server_.finish(); }
    /// The result of the next item, if it is finished.
    std::optional<Result> next() {
        const std::scoped_lock lock(guard_);
        if (results_.empty()) {
            return std::nullopt;
        }
        Result result = std::move(results_.front());
        results_.pop_front();
        return result;
    }
    /// No further item will be worked on.
    [[nodiscard]] bool ended() {
        const std::scoped_lock lock(guard_);
        return ended_;
    }
    /// Drops items that were not begun, and waits for the one that was.
    void drop() {
        {
            const std::scoped_lock lock(guard_);
            ended_ = true;
            items_.clear();
        }
        server_ = Task();
    }

  private:
    void serve() {
        while (true) {
            std::optional<Item> item;
            {
                const std::scoped_lock lock(guard_);
                if (ended_ || items_.empty()) {
                    items_.clear();
                    busy_ = false;
                    return;
                }
                item = std::move(items_.front());
                items_.pop_front();
            }
            std::optional<Result> result;
            try {
                result = work_(*item);
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

    std::function<std::optional<Result>(Item&)> work_;
    std::size_t window_;
    std::mutex guard_;
    std::deque<Item> items_;
    std::deque<Result> results_;
    bool busy_ = false;
    bool ended_ = false;
    Task server_; ///< last because it uses the other members
};

} // namespace isostat
