#pragma once
// The gaps that may close along an arc: where the next one does, and what a step may have missed. Private to the room.

#include "contact/candidates.hpp"
#include "motion/arc.hpp"
#include "motion/curve_course.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace isostat {

/// A gap that is expected to close, and where: distance of the fastest coordinate from where the step begins.
struct GapEvent {
    Contact contact;
    double s = std::numeric_limits<double>::infinity(); ///< infinity: none closes
};

/// Displacement from `at` that the candidates still allow; negative when they are of other grains.
double reach_left(const CandidateList& candidates, const Packing& at);

/// Step of the fastest coordinate that they allow from there: no coordinate is faster.
double longest_step(const CandidateList& candidates, const Packing& at);

/// The candidates that take part in one arc, with their gaps and rates where the present step begins. All it says is a
/// guess: gaps are rounded, and between the ends of a step it knows a cubic.
class EventScan {
  public:
    /// `open`: the candidates that are not contacts of `structure`, if they are at hand.
    EventScan(const Contact& opened, const ArcOptions& options, CandidateList& candidates, std::vector<Contact> open);

    /// Sees to it that the list is complete about `at`; `kept` are the contacts that are not to be looked at.
    void list(const Packing& at, const std::vector<Contact>& kept);
    /// Step of the fastest coordinate that the candidates allow from there.
    [[nodiscard]] double longest_step() const { return longest_; }

    /// The first gap that the course brings to 0 within `longest`; from here on the step begins there. At the start of
    /// the arc those that leave are 0. One that is 0 to `noise` and stays so within `longest` is no event: the proof of
    /// the end judges it.
    GapEvent first_event(const CurveCourse& course, double longest, double noise, bool at_start);

    /// Where a step went and to which place. `closing`: the gap that is 0 there and is not looked at.
    struct Step {
        const Packing& from;
        const Packing& to;
        double s;
        const Contact& closing;
    };
    /// The gap below -noise at the end of a step that reached 0 first, with an estimate of where.
    [[nodiscard]] std::optional<GapEvent> first_violation(const Step& step, double noise) const;
    /// First place where a gap seems to dip to or below 0 inside a step without being negative at its end, where the
    /// tangent is `tangent`. One that falls to 0 where the step ends with an event, and not below before, as far as
    /// `noise` and a cubic tell, is left to the proof of that end.
    [[nodiscard]] std::optional<double> suspicious_dip(const Step& step, const std::vector<double>& tangent,
                                                       double noise) const;

    /// Its gap is 0 at the start, and grows.
    [[nodiscard]] bool leaves(const Contact& contact) const;
    /// The candidates that are not contacts after `closed` took the place of the opened one, in the order of the list;
    /// empty: not known. The list is given away.
    std::vector<Contact> open_at_end(const Contact& closed);

  private:
    void complete();

    Contact opened_;
    std::vector<Contact> leaving_, resting_;
    CandidateList& candidates_;
    std::vector<Contact> active_;
    std::vector<double> gap_, rate_; ///< of the active ones where the step begins
    double longest_ = 0;
};

} // namespace isostat
