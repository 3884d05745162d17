#pragma once
// The gaps that may close along an arc: where the next one closes, what a step may have missed. Private to the room.

#include "contact/candidates.hpp"
#include "motion/arc.hpp"
#include "motion/curve_course.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace isostat {

/// A gap that is expected to close, and where: the change of the fastest coordinate since the start of the step.
struct GapEvent {
    Contact contact;
    double s = std::numeric_limits<double>::infinity(); ///< infinity: no gap closes
};

/// Displacement from `at` within which the list stays complete; negative when it belongs to other grains.
double reach_left(const CandidateList& candidates, const Packing& at);

/// Step of the fastest coordinate within that displacement: no other coordinate is faster.
double longest_step(const CandidateList& candidates, const Packing& at);

/// The candidates that take part in one arc, with their gaps and rates at the start of the current step. All results
/// are guesses: gaps are rounded, and inside a step they are known only through a cubic.
class EventScan {
  public:
    /// `open`: the candidates that are not contacts of `structure`, if the caller has them.
    EventScan(const Contact& opened, const ArcOptions& options, CandidateList& candidates, std::vector<Contact> open);

    /// Makes the list complete around `at`; `kept` are the contacts, which are not scanned.
    void list(const Packing& at, const std::vector<Contact>& kept);
    /// Step of the fastest coordinate that the candidates allow at the start of the step.
    [[nodiscard]] double longest_step() const { return longest_; }

    /// The first gap that `course` brings to 0 within `longest`; this call also starts a new step there. At the start
    /// of the arc the leaving pairs have gap 0. A gap that is 0 to `noise` and stays so within `longest` is no event:
    /// the proof of the end judges it.
    GapEvent first_event(const CurveCourse& course, double longest, double noise, bool at_start);

    /// A step from one configuration to another. `closing`: the contact whose gap is 0 at `to`, which is not scanned.
    struct Step {
        const Packing& from;
        const Packing& to;
        double s;
        const Contact& closing;
    };
    /// The gap that is below -noise at the end of a step and that reached 0 first, with an estimate of where.
    [[nodiscard]] std::optional<GapEvent> first_violation(const Step& step, double noise) const;
    /// First place where a gap seems to dip to or below 0 inside a step without being negative at its end, where the
    /// tangent is `tangent`. A gap that only falls to 0 at the event that ends the step, as far as `noise` and a cubic
    /// tell, is left to the proof of that end.
    [[nodiscard]] std::optional<double> suspicious_dip(const Step& step, const std::vector<double>& tangent,
                                                       double noise) const;

    /// The gap of the contact is 0 at the start, and grows.
    [[nodiscard]] bool leaves(const Contact& contact) const;
    /// The candidates that are not contacts after `closed` replaced the opened contact, in the order of the list;
    /// empty: not known. Moves the list out of this object.
    std::vector<Contact> open_at_end(const Contact& closed);

  private:
    void complete();

    Contact opened_;
    std::vector<Contact> leaving_, touching_;
    CandidateList& candidates_;
    std::vector<Contact> active_;
    std::vector<double> gap_, rate_; ///< of `active_`, at the start of the step
    double longest_ = 0;
};

} // namespace isostat
