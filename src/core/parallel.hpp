#pragma once
/// \file
/// Several cores for independent pieces of work. The number of threads decides which thread computes a piece, not the
/// pieces nor the order in which results are combined: results have the same bits for any number.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace isostat {

/// work(0), ..., work(pieces - 1), each exactly once, in any order and on any thread; returns when all are done. The
/// pieces must not touch each other's results. An exception of a piece is thrown again here, after the others have
/// ended (that of the lowest piece that threw; later pieces may not have been begun). A call from within a piece or a
/// task does all the work itself. Cost beyond the work: none with one thread or one piece, else about a microsecond;
/// threads wait busily for some 50 microseconds after a task, then sleep.
void parallel_pieces(std::size_t pieces, const std::function<void(std::size_t)>& work);

/// One piece of work that may run while the caller continues. An idle thread begins it; if no thread did, `finish` does
/// the work, so that with one thread it is done in that call. Until then its input must not change, and no other code
/// may read its results. Its results have the same bits in either case.
class Task {
  public:
    Task() = default; ///< no work
    /// `first`: before the tasks that no thread has begun.
    explicit Task(std::function<void()> work, bool first = false);
    Task(Task&&) noexcept;
    /// Ends the present task as its destructor does.
    Task& operator=(Task&&) noexcept;
    /// Waits for work that was begun; work that was not begun is never done.
    ~Task();

    /// Does the work in this thread unless another has begun it. `finish` must still be called, because it throws what
    /// the work threw and adds what it counted.
    void begin_here();
    /// Returns when the work is done; throws what it threw. Afterwards the task has no work.
    void finish();
    /// The task has work for which `finish` was not called.
    [[nodiscard]] bool pending() const { return state_ != nullptr; }
    /// Another thread does the work, or will as soon as it is free, and has not ended: the caller may do something else
    /// meanwhile. False too where `finish` would do the work itself: with one thread, or within a piece.
    [[nodiscard]] bool underway() const;

  private:
    friend class Pool;
    struct State;
    std::shared_ptr<State> state_;
};

/// A value that a task computes.
template <class Value> class Future {
  public:
    Future() = default;
    template <class Make>
    explicit Future(Make make)
        : value_(std::make_shared<std::optional<Value>>()),
          task_([to = value_, make = std::move(make)] { to->emplace(make()); }) {}

    /// \pre pending()
    [[nodiscard]] Value get() {
        task_.finish();
        return std::move(**value_);
    }
    [[nodiscard]] bool pending() const { return task_.pending(); }
    [[nodiscard]] bool underway() const { return task_.underway(); }
    void begin_here() { task_.begin_here(); }

  private:
    std::shared_ptr<std::optional<Value>> value_;
    Task task_;
};

/// Number of pieces of at most `size` items each, and the bounds of one: [first, last).
struct Pieces {
    std::size_t items = 0;
    std::size_t size = 1;
    [[nodiscard]] std::size_t count() const { return (items + size - 1) / size; }
    [[nodiscard]] std::size_t first(std::size_t piece) const { return piece * size; }
    [[nodiscard]] std::size_t last(std::size_t piece) const {
        const std::size_t end = (piece + 1) * size;
        return end < items ? end : items;
    }
};

} // namespace isostat
