#pragma once
/// \file
/// Which process runs which sample: one process takes all, or several ranks ask rank 0.

#include <cstddef>
#include <functional>
#include <optional>

namespace isostat {

/// Hands out the numbers 0 ... count - 1, each of them once over all ranks, and is told when they are finished.
class SampleQueue {
  public:
    virtual ~SampleQueue() = default;
    /// Rank 0 hands out, reports and merges.
    [[nodiscard]] virtual int rank() const = 0;
    [[nodiscard]] virtual int ranks() const = 0;
    /// The next number for this rank; nothing when all are handed out (or `stop` was called).
    virtual std::optional<std::size_t> next() = 0;
    /// This rank has finished a number. Rank 0 learns of it through `on_done`.
    virtual void done(std::size_t number) = 0;
    /// To be called often while waiting, because rank 0 replies to the others here.
    virtual void idle() {}
    /// No more numbers for any rank (on rank 0) or for this rank (on others).
    virtual void stop() = 0;
    /// Returns when every rank has called it; rank 0 replies until then.
    virtual void finish() {}

    std::function<void(std::size_t)> on_done; ///< on rank 0: called for the numbers of all ranks
};

/// One process.
class LocalQueue final : public SampleQueue {
  public:
    explicit LocalQueue(std::size_t count) : count_(count) {}
    [[nodiscard]] int rank() const override { return 0; }
    [[nodiscard]] int ranks() const override { return 1; }
    std::optional<std::size_t> next() override {
        return next_ < count_ ? std::optional<std::size_t>(next_++) : std::nullopt;
    }
    void done(std::size_t number) override {
        if (on_done) {
            on_done(number);
        }
    }
    void stop() override { count_ = next_; }

  private:
    std::size_t count_;
    std::size_t next_ = 0;
};

} // namespace isostat
