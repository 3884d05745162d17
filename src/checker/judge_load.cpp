// The claim about the supported interval of the loaded stress.
#include "checker/strut.hpp"

#include <fmt/format.h>

namespace isostat::checker {

namespace {

/// One end; direction 1 is the upper one.
struct End {
    const Evidence& evidence;
    const LoadEndClaim& claim;
    int direction;
    std::string text{};
    std::optional<Range> stress{};

    /// The force becomes smaller in this direction.
    [[nodiscard]] bool closing(const Range& slope) const { return direction > 0 ? slope.negative() : slope.positive(); }
    [[nodiscard]] bool never_closing(const Range& slope) const {
        return direction > 0 ? slope.lower >= 0 : slope.upper <= 0;
    }

    Verdict judge_unbounded() {
        const ContactForces& slopes = evidence.slopes();
        std::vector<int> unclear;
        for (std::size_t l = 0; l < slopes.size(); ++l) {
            const ContactKind kind = evidence.state.contacts[l].kind;
            if (kind == ContactKind::bar) {
                continue; // of either sign
            }
            if (kind == ContactKind::held && !slopes[l].has_zero()) {
                text = fmt::format("no interval: {} is held, and bears {} per unit of stress", evidence.name(l),
                                   shown(slopes[l]));
                return Verdict::refuted;
            }
            if (closing(slopes[l])) {
                text = fmt::format("a finite stress (the force of {} changes by {} per unit of it), claimed unbounded",
                                   evidence.name(l), shown(slopes[l]));
                return Verdict::refuted;
            }
            if (!never_closing(slopes[l])) {
                unclear.push_back(static_cast<int>(l));
            }
        }
        // Forces that do not depend on the loaded stress have a slope of exactly 0, by counting.
        const bool constant =
            unclear.empty() || vanish_structurally(evidence.problem, having_zero(slopes), evidence.unit_load());
        text = constant ? "no limit" : fmt::format("no limit, if {} slopes are not", unclear.size());
        return constant ? Verdict::proved : Verdict::undecided;
    }

    Verdict judge_bounded() {
        const auto found = std::find(evidence.state.contacts.begin(), evidence.state.contacts.end(), claim.opens);
        const auto opens = static_cast<std::size_t>(found - evidence.state.contacts.begin());
        if (opens >= evidence.slopes().size() || !claim.opens.is_unilateral()) {
            text = evidence.named(claim.opens) + ", which is no contact";
            return Verdict::refuted;
        }
        const Range& slope = evidence.slopes()[opens];
        if (!closing(slope)) {
            text = fmt::format("{}, whose force changes by {} per unit of stress", evidence.name(opens), shown(slope));
            return never_closing(slope) ? Verdict::refuted : Verdict::undecided;
        }
        const Range step = step_to_limit(evidence, opens);
        stress = Range(Rational(evidence.state.load.loaded_stress())) + step;
        text = fmt::format("{} (opens {})", shown(*stress), evidence.name(opens));
        const Verdict place = lies_in(*stress, claim.stress);
        if (place != Verdict::proved) {
            text += ", claimed in " + shown(claim.stress);
        }
        return both(place, judge_others(opens, step));
    }

    /// All other forces at the stress where the named one vanishes: >= 0.
    Verdict judge_others(std::size_t opens, const Range& step) {
        std::vector<int> unclear;
        const ForcesAfter there{evidence, step};
        for (std::size_t l = 0; l < evidence.forces.size(); ++l) {
            if (l != opens && there.positive(l)) {
                continue;
            }
            const Range force = there[l];
            const bool unilateral = evidence.state.contacts[l].is_unilateral();
            if (l != opens && force.negative() && unilateral) {
                text += fmt::format(", but {} opens before", evidence.name(l));
                return Verdict::refuted;
            }
            if (l == opens || unilateral || force.has_zero()) {
                unclear.push_back(static_cast<int>(l));
            }
        }
        // Exactly 0 there: forces that vanish at every stress, and multiples of the named one.
        if (vanish_with(evidence, unclear, opens)) {
            return Verdict::proved;
        }
        text += fmt::format(", {} other forces not proved >= 0 there", unclear.size() - 1);
        return Verdict::undecided;
    }

    Verdict judge() { return claim.unbounded ? judge_unbounded() : judge_bounded(); }
};

} // namespace

Verdict judge_load_end(const Evidence& evidence, const LoadEndClaim& claim, int direction, std::string& text) {
    End end{evidence, claim, direction};
    const Verdict verdict = end.judge();
    text = end.text;
    return verdict;
}

ClaimCheck judge_load_interval(const Evidence& evidence, const LoadIntervalClaim& claim) {
    ClaimCheck check{.claim = "load_interval", .claimed = true};
    End low{evidence, claim.low, -1};
    End high{evidence, claim.high, 1};
    const Verdict verdict = both(low.judge(), high.judge());
    if (low.stress) {
        check.numbers.emplace_back("low", rounded_up(low.stress->upper));
    }
    if (high.stress) {
        check.numbers.emplace_back("high", rounded_down(high.stress->lower));
    }
    return answer(check, verdict, fmt::format("from {} to {}", low.text, high.text));
}

} // namespace isostat::checker
