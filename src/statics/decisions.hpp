#pragma once
/// \file
/// The two static decisions of a trajectory: where the supported interval ends, and which contact opens.

#include "statics/perturbed.hpp"
#include "statics/statics.hpp"

#include <isostat/core/result.hpp>
#include <isostat/statics/rules.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace isostat {

/// The contact to open, with the evidence.
struct Opening {
    ContactId contact;
    bool infinitesimal = false; ///< the infinitesimal part decided
    Enclosure force;            ///< the force, multiplier or infinitesimal force that the choice compared
    int direction = +1;         ///< rate of the gap; -1 only for a held coordinate that is pushed downwards
    double margin = 0;          ///< smallest |difference| / bound over the comparisons made
    Rung rung = Rung::none;
    bool perturbed = false;    ///< a first-order comparison was needed
    bool equal_forces = false; ///< another contact bears an equal force: in a straight strut (S4) or in an edge (S6)
    bool bears = false;        ///< with `infinitesimal`: grains that bear force move, not only rattlers
    /// The power of an arc that opens this contact is that of the infinitesimal loads.
    [[nodiscard]] bool moves_rattlers() const { return infinitesimal && !bears; }
};

/// All grains of the contact bear finite forces in other contacts. Where the finite force of the contact is 0, it holds
/// a grain against leaving the plane of such forces: when it opens, the load does no work at first order and some at
/// second order (S2). `zero(l)`: the finite force of contact l is a structural zero. Cost: O(N).
template <class Zero>
bool grains_bear_force(const std::vector<Contact>& contacts, ContactId contact, const Zero& zero) {
    const Contact& c = contacts[contact.index()];
    const auto bears = [&](int grain) {
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            const Contact& other = contacts[l];
            const bool touches = other.i == grain || (other.of_disks() && other.j == grain);
            if (l != contact.index() && other.kind != ContactKind::held && touches && !zero(l)) {
                return true;
            }
        }
        return false;
    };
    return c.kind != ContactKind::held && bears(c.i) && (!c.of_disks() || bears(c.j));
}

/// The state of a vertex at a load: nothing to open (equilibrium), or the contact to open.
struct OpeningDecision {
    std::optional<Opening> opening; ///< nothing: every force is proved positive, lexicographically in (f0, f1)
    double margin = 0;
    Rung rung = Rung::none;
    bool perturbed = false; ///< a first-order comparison was needed
    /// Finite forces that vanish in the base and are positive at first order; where ties are chosen, not negative.
    std::vector<ContactId> zeros;
};

/// Held coordinates that carry no finite force and therefore do not compete.
struct ZeroHolds {
    ContactId fresh; ///< held since the last power turn: 0 by construction, as is its infinitesimal part; or invalid
    /// Held earlier: the force of the finite loads is 0, up to the uncertainty of their turns; that of the
    /// infinitesimal loads may be different from 0.
    std::vector<ContactId> others;

    [[nodiscard]] bool has(ContactId l) const { return fresh == l || std::ranges::find(others, l) != others.end(); }
};

/// Applies the rule at the loaded stress `sigma`. The two ends of a strut that a power turn
/// (`zero.fresh`) leaves straight carry exactly the same force there (S4): rules that compare
/// forces order these two by the infinitesimal loads. Contacts that carry nothing at such a turn
/// (S4 (c)) do not compete. The answer is `undecided` when no other force is negative, and when
/// every force is positive at a turn where held coordinates carry some (S3). `random_bits` is
/// used by the rule `random` only. May climb `statics` to double-double. Failure: `undecided` (a
/// sign), `tie` (two candidates that cannot be ordered), naming the contacts and the numbers.
/// With `perturbed` first-order terms settle ties of finite forces and are written to its log: a force that vanishes in
/// the base has the sign of its first-order term, equal keys have the order of their terms. Failure: `undecided` when
/// the first-order terms cannot be told apart either, and for held coordinates that vanish. Where ties are chosen (C1)
/// a force whose first-order term cannot be told from 0 opens nothing, and equal keys are ordered by the infinitesimal
/// loads, then by the names of the contacts.
Result<OpeningDecision> decide_opening(Statics& statics, double sigma, OpeningRule rule, const ZeroHolds& zero,
                                       std::uint64_t random_bits, PerturbedStatics* perturbed = nullptr);

/// End of the supported interval in one direction of sigma.
struct LoadLimit {
    bool unbounded = false; ///< no force decreases: the structure supports every load in this direction
    double stress = 0;      ///< where the force of `opens` vanishes, to within `stress_error`
    double stress_error = 0;
    ContactId opens; ///< lexicographic choice within the tie class (smallest f1 / |slope|)
    std::vector<ContactId>
        tie_class; ///< contacts whose forces vanish together for structural reasons, `opens` included
    double margin = 0;
    Rung rung = Rung::none;
    bool perturbed = false; ///< a first-order comparison was needed
};

/// \pre every finite force positive at `sigma`. `direction` +1 or -1. Held coordinates do not limit. May climb.
/// Failure: `tie` when two forces vanish at loads that cannot be ordered, and no structural argument makes these loads
/// equal. With `perturbed` the first-order terms of the loads decide which is first; when they do not, the answer is
/// `undecided`, or, where ties are chosen, the infinitesimal loads decide, then the names.
Result<LoadLimit> find_limit(Statics& statics, double sigma, int direction, PerturbedStatics* perturbed = nullptr);

} // namespace isostat
