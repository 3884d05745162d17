#pragma once
/// \file
/// How a rearrangement may begin at a limit load: private to the room.

#include "trajectory/rearrangement.hpp"

#include <functional>
#include <optional>

namespace isostat {

/// How a rearrangement begins.
struct Attempt {
    Opening opening;
    ArcKind kind = ArcKind::limit;
    LimitLoad at;
    bool begun = false; ///< an arc was recorded
    /// Its first arc is undecided, so another beginning may be tried.
    [[nodiscard]] bool in_vain(const Result<Reached>& reached) const {
        return !reached.ok() && reached.failure().kind == FailureKind::undecided && !begun;
    }
};

/// Follows `attempt` from a limit of the statics. After one in vain, and without first-order terms, `attempt` begins
/// again with the load rounded away from `sigma` in `direction`. `follow` carries out an attempt and sets `begun`;
/// `recorder` counts the returned attempt only. Failure: that of the last attempt.
class LimitAttempts {
  public:
    using Follow = std::function<Result<Reached>(Attempt&)>;
    /// All arguments must outlive this object.
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
