#pragma once
/// \file
/// How a rearrangement may begin at a limit load: private to the room.

#include "trajectory/rearrangement.hpp"

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace isostat {

/// A rearrangement as it was begun.
template <int Dim> struct Attempt {
    Opening opening;
    ArcKind kind = ArcKind::limit;
    LimitLoad<Dim> at;
    std::vector<TieDecision> chosen{}; ///< why this one opens, where the rule takes another first
    bool begun = false;                ///< an arc was recorded
    /// Its first arc is not decided.
    [[nodiscard]] bool in_vain(const Result<Reached<Dim>>& reached) const {
        return !reached.ok() && reached.failure().kind == FailureKind::undecided && !begun;
    }
};

/// Follows an attempt at a limit of the statics. In vain, and without first-order terms, it may begin with the load
/// rounded away from `sigma` in `direction`, or, by `TiePolicy::by_class`, with another force that vanishes at the same
/// load; `attempt` is then that one. `follow` carries one out and sets its `begun`; counters of `recorder` are those of
/// the attempt that is returned. Failure: that of the first attempt, or of the last.
template <int Dim> class LimitAttempts {
  public:
    using Follow = std::function<Result<Reached<Dim>>(Attempt<Dim>&)>;
    /// All must outlive the attempts.
    LimitAttempts(Statics<Dim>& statics, double sigma, int direction, Recorder<Dim>& recorder, Follow follow)
        : statics_(statics), sigma_(sigma), direction_(direction), recorder_(recorder), follow_(std::move(follow)) {}

    Result<Reached<Dim>> begin(Attempt<Dim>& attempt);

  private:
    std::optional<double> beyond();
    std::optional<Result<Reached<Dim>>> open_another(Attempt<Dim>& attempt, const std::array<LimitLoad<Dim>, 2>& loads,
                                                     const RunCounters& before);
    [[nodiscard]] Failure offering_class(const Failure& failure, ContactId first) const;

    Statics<Dim>& statics_;
    double sigma_;
    int direction_;
    Recorder<Dim>& recorder_;
    Follow follow_;
};

extern template class LimitAttempts<2>;

} // namespace isostat
