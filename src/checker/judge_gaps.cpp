// The claim about the gaps of all other pairs.
#include "checker/evidence.hpp"
#include "checker/gaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::checker {

namespace {

/// Gaps that differ by less are equally near: 2^-46 of the largest coordinate or radius.
Rational equally_near(const State<2>& state) {
    double largest = 0;
    const Packing<2>& packing = state.packing;
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        const std::size_t axis = k % 2;
        const bool exists =
            k < 2 * packing.radius.size() || packing.cell.any() || packing.walls.upper[axis] != WallKind::absent;
        largest = exists ? std::max(largest, std::abs(packing.q[k])) : largest;
    }
    for (const double r : packing.radius) {
        largest = std::max(largest, r);
    }
    return Rational(largest) * power_of_two(-46);
}

constexpr const char* too_far = "the cell is too sheared, or a disk too far from it, for a search among its images";

} // namespace

ClaimCheck judge_gaps(const Evidence& evidence, const GapsClaim& claim) {
    ClaimCheck check{.claim = "gaps", .claimed = true};
    if (const auto pair = fixed_overlap(evidence.problem, evidence.state)) {
        return pair->i < 0
                   ? answer(check, Verdict::undecided, too_far)
                   : answer(check, Verdict::refuted, fmt::format("{} overlap, and cannot move", to_string<2>(*pair)));
    }
    const std::vector<Gap> near = smallest_gaps(evidence.problem, evidence.state, evidence.vertex);
    if (near.empty()) {
        return answer(check, std::isinf(claim.smallest) ? Verdict::proved : Verdict::refuted,
                      "there is no pair besides the contacts");
    }
    if (near[0].pair.i < 0) {
        return answer(check, Verdict::undecided, too_far);
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
    const Rational room = equally_near(evidence.state);
    if (named == nullptr || named->value.lower > most + room) {
        return answer(check, Verdict::refuted, fmt::format("{}; claimed of {}", found, to_string<2>(claim.where)));
    }
    if (least >= Rational(claim.smallest) && named->value.upper <= least + room) {
        return answer(check, Verdict::proved, found);
    }
    return answer(check, Verdict::undecided,
                  fmt::format("{}; claimed >= {:.17g} of {}", found, claim.smallest, to_string<2>(claim.where)));
}

} // namespace isostat::checker
