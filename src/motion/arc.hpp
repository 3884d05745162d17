#pragma once
/// \file
/// One arc: open a contact, keep the others, follow the mechanism to the first event; its end where the contacts are
/// nearly singular.

#include "contact/candidates.hpp"
#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// Choices of the path follower. They change the cost, not the events.
struct ArcOptions {
    // choice: first step of the path follower
    double step_fraction = 0.1;   ///< longest predictor step of the fastest coordinate, in units of the smallest radius
    int max_steps = 100000;       ///< cost: after so many predictor steps the motion is called unbounded
    double max_length_change = 1; ///< |L_a / L_a(start) - 1| beyond which the motion is called unbounded
    /// The tangent at an event is extrapolated from the path instead of solved for, where no close decision depends on
    /// it: for callers that do not use `Arc::tangent`. Saves two passes or more.
    bool extrapolate_tangent = false;
    /// The sign of the power at an event comes from a tangent that is solved for to the last digits: for callers who
    /// proved the power negative after the follower had taken it for positive.
    bool sharp_power = false;
    /// Points and tangents are found with residuals in double-double: for callers whose arc in double failed.
    bool precisely = false;
    std::optional<Contact> closes; ///< ends the arc: the caller proved that this contact closes earlier
    /// Pairs that touch at the start without being contacts: `leaving` are proved to separate at once (as the opened
    /// contact does), `kept_touching` are proved to keep their distance all along, `assumed_touching` are only assumed
    /// to keep it, or to graze later: they are checked at the end of each step.
    std::vector<Contact> leaving;
    std::vector<Contact> kept_touching;
    std::vector<Contact> assumed_touching;
};

/// The start of an arc: a structure made at the packing, with factors that solve accurately for it. The gap of `opened`
/// grows (`direction` +1; a held coordinate grows, or falls with -1).
struct ArcOrigin {
    const Packing& packing;
    const IsostaticStructure& structure;
    const Factorisation& factorisation;
    ContactId opened;
    int direction = 1;
};

/// The load whose power is watched along the arc: -dW/ds = F_ext . dq/ds must stay positive.
struct PowerLoad {
    const Load* load = nullptr;
    bool infinitesimal = false;  ///< only rattlers move: the power is that of the infinitesimal loads
    bool starts_at_zero = false; ///< first arc at a limit load: the power grows from 0
};

/// How an arc ended.
enum class ArcEnd : unsigned char { contact, power_turn };

/// End of an arc. \post kept gaps are 0 to rounding at `end`, which is on the dyadic grid.
struct Arc {
    Packing end;
    ArcEnd kind = ArcEnd::contact;
    Contact closed;              ///< the new contact, or the fastest coordinate at the power turn (ContactKind::held)
    double power = 0;            ///< F_ext . t at the end, t scaled to 1 in the fastest coordinate; as accurate as t
    std::vector<double> tangent; ///< t, on coordinates: a guess of the null vector of the kept contacts, not a bound
    /// The candidates that are not contacts at the end, in the order of the list; empty: not known.
    std::vector<Contact> open;
    double displacement = 0; ///< largest displacement of a coordinate
    int steps = 0;           ///< predictor steps
    int factorisations = 0;  ///< structures proved and factorised along the way (long arcs only)
    int passes = 0;          ///< applications of the factors
};

/// Follows the curve { gap_l = 0, l != opened } from the origin to the first event: a candidate's gap closes, or the
/// power of the load vanishes.
///
/// Predictor: tangent and curvature in the fastest coordinate, re-chosen at each step. Corrector: chord iterations with
/// the factors of the start (a structure proved again on the way when they become stale). The event is solved directly
/// as the root of the square system (kept gaps, new gap) = 0. A gap that dips inside a step counts: where the cubic
/// through the end values and slopes comes near 0 the step is divided. This is *not* a proof that no contact was missed
/// inside a step; the end is checked by the caller with proved bounds.
///
/// \pre `candidates` is complete at the origin; it is rebuilt when the motion leaves its reach. Failures: `unbounded`,
/// `not_converged`, `not_isostatic` (the mechanism is not unique on the path), `undecided` (a gap that touches 0 inside
/// a step). Cost: about 10 to 30 triangular solves for a short arc; no factorisation.
Result<Arc> follow_arc(const ArcOrigin& origin, const PowerLoad& power, CandidateList& candidates,
                       const ArcOptions& options);

/// Makes the candidates anew when less than a quarter of their reach is left at a configuration, and returns whether it
/// did. Every step of an arc begins with this call.
bool renew_candidates(CandidateList& candidates, const Packing& at);

/// An arc whose tangent, curvature and candidates at the start are computed: the part that can run
/// in parallel with other work on the same vertex. `follow` then does what `follow_arc` does. Objects that the
/// origin and the constructor refer to must outlive it. The candidates are made anew only when
/// `renew_candidates` would do so. `open`: candidates that are not contacts of the structure, if the
/// caller has them (`Arc::open` of the previous arc). Cost: about half the solves of a short arc.
class ArcDeparture {
  public:
    ArcDeparture(const ArcOrigin& origin, const PowerLoad& power, CandidateList& candidates, const ArcOptions& options,
                 std::vector<Contact> open = {});
    ArcDeparture(ArcDeparture&&) noexcept;
    ~ArcDeparture();
    /// The end as predicted at the start.
    struct Expected {
        Contact closes;
        Packing end; ///< near the curve, not on it
    };
    /// A guess, before `follow`. Nothing when the first step closes no contact. Cost: a copy of the coordinates.
    [[nodiscard]] std::optional<Expected> expected() const;
    /// To be called once.
    Result<Arc> follow();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// An arc that was followed in double to an end where the contacts are nearly singular.
struct RoughEnd {
    const IsostaticStructure& structure; ///< structure at the start
    ContactId opened;
    Contact closed;
    const Packing& end;
    const std::vector<double>& tangent; ///< tangent at the end, on coordinates, forwards
    double displacement;                ///< largest displacement of a coordinate along the arc
};

/// The coordinates nearest to the vertex with the contact that closed, by Newton's method with gaps in double-double
/// and fresh factors at each step. In double a gap that closes at a rate of 1e-8 is 0, up to rounding, on a stretch of
/// 1e-8 or more, and the matrix changes along this stretch. Where the gap nearly grazes, two places have gap 0: the
/// iteration begins a little before the end, so that it finds the first. Nothing: no convergence. The result is a
/// guess; the caller has to prove what it needs. Cost: some 20 factorisations.
std::optional<Packing> precise_end(const RoughEnd& rough);

} // namespace isostat
