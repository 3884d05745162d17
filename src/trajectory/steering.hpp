#pragma once
/// \file
/// Who proposes the arcs of a rearrangement, and what is proposed: private to the room.

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
#include <string>
#include <vector>

namespace isostat {

/// What an arc starts with.
struct ArcStart {
    Opening opening;
    ArcKind kind = ArcKind::limit;
    long step = 0; ///< number of the arc in the run
    const Load* load = nullptr;
    std::vector<TieDecision> settled; ///< ties on the way to its opening
};

/// Of an arc that starts with an opening of a contact, but for the first one at a limit load.
ArcKind kind_of(const Contact& opened, bool infinitesimal);

/// Whose power an arc follows. That of a load that does no work at first order grows from 0.
inline PowerLoad power_load(const Load& load, const Opening& opening, ArcKind kind) {
    return {&load, opening.moves_rattlers(), kind == ArcKind::limit || opening.bears};
}

/// Where steering found no negative force. Nothing is proved of it.
struct SteeredEnd {
    Packing packing;
    std::vector<Contact> contacts;
    ZeroHolds zero; ///< what is held at the power turn where the last arc ended, or turned back where it stood
    std::shared_ptr<const RegularTriangulation> triangulation; ///< of a configuration near
};

/// An arc that was followed, and its end. A guess in every part: a prover says what is true of it.
struct ArcProposal {
    ArcRecord record; ///< as far as the path tells
    Opening opening;  ///< that it starts with
    Packing end;
    std::vector<double> tangent;                   ///< there, on coordinates
    std::optional<ExchangedContacts> contacts;     ///< there; none: structurally singular
    std::optional<ApproximateInverse> approximate; ///< of their matrix
    std::vector<double> forces;                    ///< the finite ones; empty: not known
    double cost_before = 0;                        ///< see `Vertex`
    bool ahead = false;                            ///< nothing is proved of its start either
    /// With first-order terms:
    bool stays = false;                 ///< the way is of length O(eps)
    bool relists = false;               ///< only the list changes, and pairs that touch may overlap at first order
    std::vector<Contact> resting;       ///< pairs that touch all along
    std::vector<Contact> taken_to_rest; ///< pairs that seem to: the gaps at the end tell
    std::vector<TieDecision> settled;   ///< ties at the start of the way
    std::optional<SteeredEnd> last;     ///< no force is negative at the end
    WorkCounts work{};                  ///< to be counted when it is recorded
};

struct ArcProof;

/// Proposes arc after arc. The two kinds differ in what a proposal starts from:
/// - `BoundedSteering`: a vertex that is proved, and the opening that was proved to be the one; it knows the next arc
///   only when the end of this one is proved. Finds what is there, ties included, or says why not;
/// - `FloatingSteering`: the end of the proposal before, as refined double precision knows it. Goes ahead of every
///   proof; *no rank, no sign and no order of what it proposes is proved or even bounded*, and one that took a wrong
///   turn does not know.
class Steering {
  public:
    Steering() = default;
    Steering(const Steering&) = delete;
    Steering& operator=(const Steering&) = delete;
    virtual ~Steering() = default;
    /// It knows what the next arc starts with.
    [[nodiscard]] virtual bool goes_on() const = 0;
    /// The next arc. \pre goes_on(). Failures: those of `follow_arc`, and what each kind adds.
    virtual Result<ArcProposal> propose() = 0;
    /// The last proposal was refused: whether there is another one for the same arc.
    [[nodiscard]] virtual bool may_revise(const ArcProof& /*refused*/) const { return false; }
    /// It comes next. \pre may_revise
    virtual void revise(const ArcProof& /*refused*/) {}
};

} // namespace isostat
