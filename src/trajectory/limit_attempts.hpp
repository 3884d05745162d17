#pragma once
/// \file
/// How a rearrangement may begin at a limit load: private to the room.

#include "trajectory/rearrangement.hpp"

#include <functional>
#include <optional>

namespace isostat {

/// A rearrangement as it was begun.
struct Attempt {
    Opening opening;
    ArcKind kind = ArcKind::limit;
    LimitLoad at;
    bool begun = false; ///< an arc was recorded
    /// Its first arc is not decided.
    [[nodiscard]] bool in_vain(const Result<Reached>& reached) const {
        return !reached.ok() && reached.failure().kind == FailureKind::undecided && !begun;
    }
};

/// Follows an attempt at a limit of the statics. In vain, and without first-order terms, it may begin with the load
/// rounded away from `sigma` in `direction`; `attempt` is then that one. `follow` carries one out and sets its `begun`;
/// counters of `recorder` are those of the attempt that is returned. Failure: that of the last attempt.
class LimitAttempts {
  public:
    using Follow = std::function<Result<Reached>(Attempt&)>;
    /// All must outlive the attempts.
    LimitAttempts(Statics& statics, double sigma, int direction, Recorder& recorder, Follow follow)
        : statics_(statics), sigma_(sigma), direction_(direction), recorder_(recorder), follow_(std::move(follow)) {}

    Result<Reached> begin(Attempt& attempt);

  private:
    std::optional<double> beyond();

    Statics& statics_;
    double sigma_;
    int direction_;
    Recorder& recorder_;
    Follow follow_;
};

} // namespace isostat
