// The claim about the gaps of all other pairs.
#include "checker/evidence.hpp"
#include "checker/gaps.hpp"

#include <fmt/format.h>

namespace isostat::checker {

ClaimCheck judge_gaps(const Evidence& evidence, const GapsClaim& claim) {
    ClaimCheck check{.claim = "gaps", .claimed = true};
    if (const auto pair = fixed_overlap(evidence.problem, evidence.state)) {
        return answer(check, Verdict::refuted, fmt::format("{} overlap, and cannot move", to_string<2>(*pair)));
    }
    const std::vector<Gap> near = smallest_gaps(evidence.problem, evidence.state, evidence.vertex);
    if (near.empty()) {
        return answer(check, std::isinf(claim.smallest) ? Verdict::proved : Verdict::refuted,
                      "there is no pair besides the contacts");
    }
    const Gap* nearest = near.data();
    const Gap* named = nullptr;
    Rational least = near[0].value.lower;
    for (const Gap& gap : near) {
        nearest = gap.value.upper < nearest->value.upper ? &gap : nearest;
        named = gap.pair == claim.where ? &gap : named;
        least = std::min(least, gap.value.lower);
    }
    const Rational& most = nearest->value.upper;
    check.numbers = {{"smallest_gap", rounded_down(least)}};
    const std::string found =
        fmt::format("smallest gap in {}, of {}", shown(Range(least, most)), to_string<2>(nearest->pair));
    if (std::isinf(claim.smallest) || most < Rational(claim.smallest)) {
        return answer(check, Verdict::refuted, fmt::format("{}; claimed >= {:.17g}", found, claim.smallest));
    }
    if (named == nullptr || named->value.lower > most) {
        return answer(check, Verdict::refuted, fmt::format("{}; claimed of {}", found, to_string<2>(claim.where)));
    }
    const bool comes_first = std::all_of(near.begin(), near.end(), [named](const Gap& other) {
        return &other == named || named->value.upper <= other.value.lower;
    });
    if (least >= Rational(claim.smallest) && comes_first) {
        return answer(check, Verdict::proved, found);
    }
    return answer(check, Verdict::undecided,
                  fmt::format("{}; claimed >= {:.17g} of {}", found, claim.smallest, to_string<2>(claim.where)));
}

} // namespace isostat::checker
