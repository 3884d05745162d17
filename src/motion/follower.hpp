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
template <int Dim> class Follower {
  public:
    Follower(const ArcOrigin<Dim>& origin, const PowerLoad<Dim>& power, CandidateList<Dim>& candidates,
             const ArcOptions& options, std::vector<Contact> open);

    /// Tangent, curvature and the first event that they predict, at the start.
    void begin();
    /// \pre begin()
    [[nodiscard]] std::optional<typename ArcDeparture<Dim>::Expected> expected() const;
    /// \pre begin()
    Result<Arc<Dim>> run();

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
        CurvePoint<Dim> point;
        double s = 0;
        Contact closing;
        double power = 0;
    };
    static constexpr Contact nothing{ContactKind::held, -1, 0};
    /// Nothing: again, with what `pace_` and the factors are now.
    using Attempt = Result<std::optional<Reached>>;
    using Ending = Result<std::optional<Arc<Dim>>>;
    enum class PowerSign { positive, shorten, turned, unclear };

    bool predict();
    Ending step();
    Attempt reach(double longest);
    Attempt reach_event(GapEvent event, double longest);
    Attempt shorten_before(const GapEvent& event, double longest);
    std::optional<CurvePoint<Dim>> step_to(double s, double accuracy);
    bool converge_to(Packing<Dim>& at, const Contact& closing);
    std::optional<CurvePoint<Dim>> tangent_at_event(Packing<Dim> at, double s, const Contact& closing);
    double power_at_start();
    Result<bool> dips_within(const Reached& there);
    PowerSign judge_power(Reached& there);
    Result<Arc<Dim>> power_turn(double s, double power);
    std::optional<Failure> go_on(Reached there);
    std::optional<Failure> narrow();
    std::optional<Failure> renew();
    std::optional<Failure> sharpen();
    Arc<Dim> finish(CurvePoint<Dim> end, ArcEnd kind, const Contact& closed, double power);

    const Packing<Dim>& start_;
    Contact opened_;
    ArcOptions options_;
    Chord<Dim> chord_;
    EventScan<Dim> scan_;
    PowerAlong<Dim> power_;
    CurveCourse<Dim> here_; ///< where the next step begins
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

extern template class Follower<2>;

} // namespace isostat
