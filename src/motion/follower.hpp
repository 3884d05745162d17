#pragma once
// Follows one arc to its end: private to the room.

#include "motion/arc.hpp"
#include "motion/chord.hpp"
#include "motion/curve_course.hpp"
#include "motion/event_scan.hpp"
#include "motion/power_along.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace isostat {

/// Predictor and corrector, step by step, until a gap closes or the power vanishes.
class Follower {
  public:
    Follower(const ArcOrigin& origin, const PowerLoad& power, CandidateList& candidates, const ArcOptions& options,
             std::vector<Contact> open);

    /// Tangent, curvature and the first event that they predict, at the start.
    void begin();
    /// \pre begin()
    [[nodiscard]] std::optional<ArcDeparture::Expected> expected() const;
    /// \pre begin()
    Result<Arc> run();

  private:
    using Vector = std::vector<double>;
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    /// What shortens the next step, in units of the longest one or as a length.
    struct Pace {
        double shrink = 1;           ///< after failures; recovers
        double for_dip = infinity;   ///< once, where a gap may dip or a power may have turned
        double for_power = infinity; ///< for the rest of an arc whose power comes near 0
        bool renewed = false;        ///< the factors are of this very step
    };
    /// Where a step came to. `closing`: the gap that is 0 there (`nothing`: it just ended).
    struct Reached {
        CurvePoint point;
        double s = 0;
        Contact closing;
        double power = 0;
    };
    static constexpr Contact nothing{ContactKind::held, -1, 0};
    /// Nothing: again, with what `pace_` and the factors are now.
    using Attempt = Result<std::optional<Reached>>;
    using Ending = Result<std::optional<Arc>>;
    enum class PowerSign { positive, shorten, turned, unclear };

    bool predict();
    Ending step();
    Attempt reach(double longest);
    Attempt reach_event(GapEvent event, double longest);
    Attempt shorten_before(const GapEvent& event, double longest);
    std::optional<CurvePoint> step_to(double s, double accuracy);
    bool converge_to(Packing& at, const Contact& closing);
    std::optional<CurvePoint> tangent_at_event(Packing at, double s, const Contact& closing);
    double power_at_start();
    Result<bool> dips_within(const Reached& there);
    PowerSign judge_power(Reached& there);
    Result<Arc> power_turn(double s, double power);
    std::optional<Failure> go_on(Reached there);
    std::optional<Failure> narrow();
    std::optional<Failure> renew();
    std::optional<Failure> sharpen();
    Arc finish(CurvePoint end, ArcEnd kind, const Contact& closed, double power);

    const Packing& start_;
    Contact opened_;
    ArcOptions options_;
    Chord chord_;
    EventScan scan_;
    PowerAlong power_;
    CurveCourse here_; ///< where the next step begins
    double step_limit_;
    double noise_;                   ///< lengths that rounding may make
    std::optional<Failure> failure_; ///< of `begin` or `predict`
    bool predicted_ = false;         ///< curvature and `event_` belong to `here_`
    bool moved_ = false;             ///< `here_` is no longer the start
    GapEvent event_;                 ///< predicted
    double here_power_ = infinity;
    Pace pace_;
    int steps_ = 0;
};

} // namespace isostat
