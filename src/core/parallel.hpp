#pragma once
/// \file
/// Several cores for independent pieces of work. The number of threads decides who computes a piece, never what the
/// pieces are nor the order in which their results are put together: results have the same bits for any number.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace isostat {

/// work(0), ..., work(pieces - 1), each exactly once, in any order and on any thread; returns when all are done. The
/// pieces must not touch each other's results. An exception of a piece is thrown again here, after the others have
/// ended (that of the lowest piece that threw; later ones may not have been begun). Called from within a piece, or
/// while another thread's call is under way, it does all the work itself. Cost beyond the work: none with one thread or
/// one piece, else about a microsecond; the threads wait busily for some 50 microseconds after a call, then sleep.
void parallel_pieces(std::size_t pieces, const std::function<void(std::size_t)>& work);

/// One piece of work beside what the caller goes on with. A thread that has nothing else to do begins it; `finish` does
/// it where none has, so that with one thread it is done there and then. What the work reads must not change until
/// then, and nothing else may read what it writes. Begun or not, its results have the same bits.
class Task {
  public:
    Task() = default; ///< nothing to do
    explicit Task(std::function<void()> work);
    Task(Task&&) noexcept;
    /// As if the one before ended.
    Task& operator=(Task&&) noexcept;
    /// Waits for work that was begun; work that was not is never done.
    ~Task();

    /// Does the work in this thread unless another has begun it. `finish` is still due: what the work threw and counted
    /// waits for it.
    void begin_here();
    /// Returns when the work is done; throws what it threw. Afterwards there is nothing to do.
    void finish();
    /// There is work that `finish` was not called for.
    [[nodiscard]] bool pending() const { return state_ != nullptr; }
    /// Another thread does it, or will as soon as it is free, and has not ended: time to go on with something else.
    /// False too where `finish` would do the work itself: with one thread, or within a piece.
    [[nodiscard]] bool underway() const;

  private:
    friend class Pool;
    struct State;
    std::shared_ptr<State> state_;
};

/// A value that a task makes.
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
