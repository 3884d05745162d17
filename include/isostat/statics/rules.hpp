#pragma once
/// \file
/// Which contact with a negative force opens; and, where quantities cannot be told apart, what first-order terms
/// (proofs/perturbation.md) or a choice of the rule (proofs/degenerate.md) settled.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace isostat {

/// Which contact with a negative force is opened during a rearrangement. The paper's rule is `most_negative`.
/// - most_negative: smallest f;  - random: uniformly among f < 0;  - least_negative: largest f < 0;
/// - least_index: the first f < 0 in the order of contacts (disks by their numbers, then walls, then held coordinates).
/// This rule compares no forces, so that equal forces make no tie. For linear programmes it is the rule of Bland (Math.
/// Oper. Res. 2, 103, 1977). In all rules a held coordinate competes with -|multiplier|, and infinitesimal forces
/// decide only when no finite force is negative.
enum class OpeningRule : std::uint8_t { most_negative, random, least_negative, least_index };
/// The words of scenes, in the order of `OpeningRule`.
inline constexpr auto opening_rule_words =
    words_of<OpeningRule>("most_negative", "random", "least_negative", "least_index");

/// What a decision was based on when first-order terms do not decide, under `ties = "choose"` (statement C1).
enum class TieChoice : unsigned char {
    none,   ///< nothing was chosen: first-order terms decided
    loads,  ///< the infinitesimal loads, by the rule
    names,  ///< the order of contacts: disks by their numbers, then walls
    zero,   ///< what vanishes in the base counts as 0: such a force opens nothing, such a gap stays watched
    watched ///< a gap of 0 stays watched though radii R + eps rho would have closed it on the way
};
inline constexpr auto tie_choice_words = words_of<TieChoice>("none", "infinitesimal loads", "names", "zero", "watched");
constexpr const char* to_string(TieChoice choice) {
    return word_of(choice, tie_choice_words);
}

/// One decision that a first-order comparison settled: the quantities cannot be told apart in the base, but their
/// derivatives with respect to eps can. With a `choice` the derivatives cannot be told apart either.
struct TieDecision {
    /// - "force": the force in `chosen` vanishes; `first` is its first-order term (no `against`);
    /// - "opening": two contacts that the rule orders alike; first-order terms of both keys;
    /// - "start": as "opening", at the start of a run, in the record of the first arc;
    /// - "limit": two forces that vanish at one load; first-order terms of the two loads;
    /// - "zero all along": a force and its slope vanish; `first`: its first-order term at the limit (no `against`);
    /// - "gap": `against` touches where `chosen` closes (or touches since before); `other` is its first-order gap;
    /// - "step": both close on a path of length O(eps); first-order lengths of the two paths.
    /// - "second order": `chosen` touches, would overlap, and replaced `against` in the list (C3, degenerate.md);
    ///   `first`: second derivative of the gap of `chosen`, `other`: the coefficient of `against` in its row;
    /// - "end": `chosen` touches, keeps gap 0, and replaced `against` in the list, as the contacts at the end of the
    ///   arc would be dependent otherwise (C5); `first`: the rate of its gap, `other`: the coefficient of `against`;
    /// - "rest": `chosen` touches, and neither the second derivative `first` of its gap nor the rate `other` can be
    ///   told from 0 when `against` opens: assumed to keep touching; the end of the arc confirms or refutes this (C4).
    std::string what;
    Contact chosen;
    Enclosure first;
    Contact against{ContactKind::disk_disk, -1, -1}; ///< i = -1: no contact
    Enclosure other;
    double exponent = 0; ///< log2 of a proved bound of the base quantity; -infinity: exactly 0
    int bits = 0;        ///< precision of the arithmetic that found no difference; 0: exact numbers
    TieChoice choice = TieChoice::none;
};

} // namespace isostat
