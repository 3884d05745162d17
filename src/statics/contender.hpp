#pragma once
// Contacts that may open, and the quantities by which they are ordered: private to the room.

#include "contact/words.hpp"
#include "statics/equal_forces.hpp"
#include "statics/proved_minimum.hpp"
#include "statics/quotient.hpp"

#include <functional>
#include <vector>

namespace isostat {

/// A contact that may be opened, with the quantity by which the rule orders it (smallest first).
struct Contender {
    ContactId contact;
    Enclosure force;       ///< the quantity that must be negative (for a held coordinate: minus the magnitude)
    Enclosure key;         ///< the quantity that the rule compares
    double margin;         ///< margin with which the sign of `force` is proved
    double multiplier = 0; ///< signed multiplier of a held coordinate
};

inline Named name(const Statics& statics, ContactId l) {
    return named(statics.structure().contacts()[l.index()]);
}

inline bool is_held(const Statics& statics, ContactId l) {
    return statics.structure().contacts()[l.index()].kind == ContactKind::held;
}

/// A bar bears forces of either sign, so it neither opens nor limits the load.
inline bool is_bar(const Statics& statics, ContactId l) {
    return statics.structure().contacts()[l.index()].kind == ContactKind::bar;
}

/// The quantity of one contact as an expression that the ladder evaluates.
using Quantity = std::function<ForceExpression(ContactId)>;

/// Context of a choice among contenders.
struct Choice {
    OpeningRule rule = OpeningRule::most_negative;
    std::uint64_t random_bits = 0;
    Quantity quantity;
    const Turn* turn = nullptr;            ///< at a power turn: orders the two ends of a strut
    PerturbedStatics* perturbed = nullptr; ///< first-order terms that order ties; its log records them
};

/// Picks by the rule among contenders that all carry a proved negative force, or are in one class of forces that vanish
/// together. Failure: `tie`, naming them; `undecided`.
Result<Opening> pick(Statics& statics, std::vector<Contender> contenders, const Choice& choice);

} // namespace isostat
