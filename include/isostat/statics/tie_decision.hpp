#pragma once
/// \file
/// A decision that a first-order comparison settled (proofs/perturbation.md), or a choice (proofs/degenerate.md).

#include <isostat/contact/contact.hpp>
#include <isostat/core/enclosure.hpp>

#include <string>

namespace isostat {

/// What a decision rests on where first-order terms do not tell, under `ties = "choose"` (statement C1).
enum class TieChoice : unsigned char {
    none,   ///< nothing was chosen: first-order terms decided
    loads,  ///< the infinitesimal loads, by the rule
    names,  ///< the order of contacts: disks by their numbers, then walls
    zero,   ///< what vanishes in the base is left at 0: such a force opens nothing, such a gap stays watched
    watched ///< a gap of 0 stays watched though radii R + eps rho would have closed it on the way
};
constexpr const char* to_string(TieChoice choice) {
    switch (choice) {
    case TieChoice::none: return "none";
    case TieChoice::loads: return "infinitesimal loads";
    case TieChoice::names: return "names";
    case TieChoice::zero: return "zero";
    case TieChoice::watched: break;
    }
    return "watched";
}

/// One decision that a first-order comparison settled: in the base, quantities that cannot be told apart; their
/// derivatives with respect to eps can. With a `choice` the first-order terms do not tell them apart either.
struct TieDecision {
    /// - "force": the force in `chosen` vanishes; `first` is its first-order term (no `against`);
    /// - "opening": two contacts that the rule orders alike; first-order terms of both keys;
    /// - "limit": two forces that vanish at one load; first-order terms of the two loads;
    /// - "zero all along": a force and its slope vanish; `first`: its first-order term at the limit (no `against`);
    /// - "gap": `against` touches where `chosen` closes (or touches on from before); `other` is its first-order gap;
    /// - "step": both close on the way of length O(eps); first-order lengths of the two ways.
    std::string what;
    Contact chosen;
    Enclosure first;
    Contact against{ContactKind::disk_disk, -1, -1}; ///< i = -1: none
    Enclosure other;
    double exponent = 0; ///< log2 of a proved bound of the base quantity; -infinity: exactly 0
    int bits = 0;        ///< of the arithmetic that found no difference; 0: exact numbers
    TieChoice choice = TieChoice::none;
};

} // namespace isostat
