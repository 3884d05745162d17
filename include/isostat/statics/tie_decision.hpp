#pragma once
/// \file
/// A decision that a first-order comparison settled (proofs/perturbation.md).

#include <isostat/contact/contact.hpp>
#include <isostat/core/enclosure.hpp>

#include <string>

namespace isostat {

/// One decision that a first-order comparison settled: in the base, quantities that cannot be told apart; their
/// derivatives with respect to eps can.
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
};

} // namespace isostat
