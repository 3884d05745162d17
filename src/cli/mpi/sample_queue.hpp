#pragma once
/// \file
/// Samples handed out to the ranks of `mpirun`. Only in builds with ISOSTAT_WITH_MPI.

#include "ensemble/sample_queue.hpp"

namespace isostat::cli {

/// Initialises MPI; the destructor finalises it. Ranks ask rank 0 for numbers, and rank 0 replies in `idle` and
/// `finish`: a rank that is slower or has longer samples gets fewer.
class MpiQueue final : public SampleQueue {
  public:
    explicit MpiQueue(std::size_t count);
    ~MpiQueue() override;
    MpiQueue(const MpiQueue&) = delete;
    MpiQueue& operator=(const MpiQueue&) = delete;
    [[nodiscard]] int rank() const override { return rank_; }
    [[nodiscard]] int ranks() const override { return ranks_; }
    std::optional<std::size_t> next() override;
    void done(std::size_t number) override;
    void idle() override;
    void stop() override;
    void finish() override;

  private:
    std::optional<std::size_t> take() { return next_ < count_ ? std::optional(next_++) : std::nullopt; }
    std::size_t count_;
    std::size_t next_ = 0;
    int rank_ = 0;
    int ranks_ = 1;
    int leaving_ = 0; ///< rank 0: ranks that have called `finish`
    bool stopped_ = false;
};

} // namespace isostat::cli
