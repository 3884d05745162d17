#pragma once
/// \file
/// The interface that proposes the arcs of a rearrangement, and the proposals: private to the room.

#include "contact/candidates.hpp"
#include "linear/approximate_inverse.hpp"
#include "motion/arc.hpp"
#include "rigidity/isostatic.hpp"
#include "statics/decisions.hpp"
#include "trajectory/counting.hpp"

#include <isostat/core/result.hpp>
#include <isostat/trajectory/records.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// The start of an arc.
struct ArcStart {
    Opening opening;
    ArcKind kind = ArcKind::limit;
    long step = 0; ///< number of the arc in the run
    const Load* load = nullptr;
    std::vector<TieDecision> settled; ///< ties settled between the previous arc and this opening
};

/// The kind of an arc that starts with an opening of a contact, except the first arc at a limit load.
ArcKind kind_of(const Contact& opened, bool infinitesimal);

/// The load whose power an arc follows. The power of a load that does no work at first order grows from 0.
inline PowerLoad power_load(const Load& load, const Opening& opening, ArcKind kind) {
    return {&load, opening.moves_rattlers(), kind == ArcKind::limit || opening.bears};
}

/// An end at which steering found no negative force. Nothing is proved of this end.
struct SteeredEnd {
    Packing packing;
    std::vector<Contact> contacts;
    ZeroHolds zero;                                            ///< holds whose multipliers are 0 at this end
    std::shared_ptr<const RegularTriangulation> triangulation; ///< triangulation of a nearby configuration
};

/// An arc that was followed, and its end. Every part is a guess, which a prover proves or refutes.
struct ArcProposal {
    ArcRecord record; ///< what the followed path determines
    Opening opening;  ///< the opening at its start
    Packing end;
    std::vector<double> tangent;                   ///< tangent at the end, on coordinates
    std::optional<ExchangedContacts> contacts;     ///< contacts at the end; absent: structurally singular
    std::optional<ApproximateInverse> approximate; ///< approximate inverse of their matrix
    std::vector<double> forces;                    ///< finite forces at the end; empty: not known
    double cost_before = 0;                        ///< see `Vertex`
    bool ahead = false;                            ///< the start of the arc is not proved either
    /// With first-order terms:
    bool stays = false;                    ///< the path is of length O(eps)
    bool relists = false;                  ///< only the list changes; pairs that touch may overlap at first order
    std::vector<Contact> kept_touching;    ///< pairs that touch all along the path
    std::vector<Contact> assumed_touching; ///< pairs assumed to touch; the gaps at the end decide
    std::vector<TieDecision> settled;      ///< ties at the start of the path
    std::optional<SteeredEnd> last;        ///< filled when no force is negative at the end
    WorkCounts work{};                     ///< counted when the arc is recorded
};

struct ArcProof;

/// Proposes arc after arc. The two kinds start from different data:
/// - `BoundedSteering`: a proved vertex and its proved opening; the next arc is known only when the end of this one is
///   proved. Finds the true next contact, ties included, or says why not;
/// - `FloatingSteering`: the end of the previous proposal in refined double precision.
///   Goes ahead of every proof; *no rank, sign or order that it proposes is proved or
///   even bounded*, and it does not notice when a proposal leaves the true path.
class Steering {
  public:
    Steering() = default;
    Steering(const Steering&) = delete;
    Steering& operator=(const Steering&) = delete;
    virtual ~Steering() = default;
    /// Whether the start of the next arc is known.
    [[nodiscard]] virtual bool goes_on() const = 0;
    /// The next arc. \pre goes_on(). Failures: those of `follow_arc`, and what each kind adds.
    virtual Result<ArcProposal> propose() = 0;
    /// The last proposal was refused: whether the steering has another one for the same arc.
    [[nodiscard]] virtual bool may_revise(const ArcProof& /*refused*/) const { return false; }
    /// Makes that one the next proposal. \pre may_revise
    virtual void revise(const ArcProof& /*refused*/) {}
};

} // namespace isostat
