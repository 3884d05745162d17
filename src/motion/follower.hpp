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

    /// Computes tangent, curvature and the first event that they predict, at the start.
    void begin();
    /// \pre begin()
    [[nodiscard]] std::optional<ArcDeparture::Expected> expected() const;
    /// \pre begin()
    Result<Arc> run();

  private:
    using Vector = std::vector<double>;
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    /// What shortens the next step, relative to the longest step or as a length.
    struct Pace {
        double shrink = 1;           ///< reduced after failures, then recovers
        double for_dip = infinity;   ///< for one step, where a gap may dip or a power may have turned
        double for_power = infinity; ///< for the rest of an arc on which the power comes near 0
        bool renewed = false;        ///< the factors were made at the start of this step
    };
    /// The end of a step. `closing`: the contact whose gap is 0 there (`nothing`: the step ended without an event).
    struct Reached {
        CurvePoint point;
        double s = 0;
        Contact closing;
        double power = 0;
    };
    static constexpr Contact nothing{ContactKind::held, -1, 0};
    /// Nothing: try again with the changed `pace_` or factors.
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
    CurveCourse here_; ///< the start of the next step
    double step_limit_;
    double noise_;                   ///< lengths below this may be rounding
    std::optional<Failure> failure_; ///< of `begin` or `predict`
    bool predicted_ = false;         ///< curvature and `event_` belong to `here_`
    bool moved_ = false;             ///< `here_` is not the start of the arc
    GapEvent event_;                 ///< the predicted event
    double here_power_ = infinity;
    Pace pace_;
    int steps_ = 0;
};

} // namespace isostat
