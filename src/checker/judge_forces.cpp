// The claim about the forces.
#include "checker/evidence.hpp"
#include "checker/index.hpp"

#include <fmt/format.h>

namespace isostat::checker {

namespace {

/// Keeps the worst answer so far and the sentence that belongs to the first one of its kind, which is made then.
template <class Text> void worsen(ClaimCheck& check, Verdict verdict, const Text& text) {
    if (both(check.verdict, verdict) != check.verdict) {
        check.verdict = verdict;
        check.detail = text();
    }
}

Verdict is_positive(const Range& force) {
    if (force.positive()) {
        return Verdict::proved;
    }
    return force.upper <= 0 ? Verdict::refuted : Verdict::undecided;
}

/// The smallest of some forces, and where.
struct Smallest {
    std::optional<Rational> lower;
    std::size_t contact = 0;
    void offer(const Range& force, std::size_t at) {
        if (!lower || force.lower < *lower) {
            lower = force.lower;
            contact = at;
        }
    }
};

/// The infinitesimal forces of the structural zeros; the smallest one of a contact.
Smallest judge_infinitesimal(ClaimCheck& check, const Evidence& evidence, const ForcesClaim& claim) {
    const std::vector<int>& zeros = claim.structural_zeros;
    Smallest infinitesimal;
    for (std::size_t k = 0; k < zeros.size(); ++k) {
        const auto l = static_cast<std::size_t>(zeros[k]);
        const Range& force = evidence.infinitesimal()[l];
        const auto is = [&](const std::string& claimed) {
            return fmt::format("the infinitesimal force of {} is in {}, {}", evidence.name(l), shown(force), claimed);
        };
        worsen(check, lies_in(force, claim.infinitesimal[k]),
               [&] { return is("claimed in " + shown(claim.infinitesimal[k])); });
        if (!evidence.state.contacts[l].is_unilateral()) {
            continue;
        }
        worsen(check, is_positive(force), [&] { return is("claimed positive"); });
        infinitesimal.offer(force, l);
    }
    return infinitesimal;
}

/// What is held bears nothing, by counting, and no infinitesimal load acts there.
void judge_held(ClaimCheck& check, const Evidence& evidence, const std::vector<int>& zeros) {
    const std::vector<double>& g = evidence.state.load.infinitesimal;
    const bool pressed = std::any_of(g.begin(), g.end(), [](double x) { return x != 0; });
    for (std::size_t l = 0; l < evidence.forces.size(); ++l) {
        if (evidence.state.contacts[l].kind != ContactKind::held) {
            continue;
        }
        const Range& force = evidence.forces[l];
        if (!contains(zeros, l)) {
            worsen(check, force.has_zero() ? Verdict::undecided : Verdict::refuted, [&] {
                return fmt::format("the force of {} is in {}, and the coordinate is held", evidence.name(l),
                                   shown(force));
            });
        }
        if (pressed) {
            worsen(check, Verdict::undecided, [] { return "infinitesimal loads act where coordinates are held"; });
        }
    }
}

} // namespace

ClaimCheck judge_forces(const Evidence& evidence, const ForcesClaim& claim) {
    ClaimCheck check{.claim = "forces", .claimed = true, .verdict = Verdict::proved};
    const std::vector<int>& zeros = claim.structural_zeros;
    const bool zeros_vanish = vanish_structurally(evidence.problem, zeros, evidence.finite_load);
    // Whatever is claimed: if all forces that may vanish do so by counting, they are exactly 0.
    const std::vector<int> small = having_zero(evidence.forces);
    const bool small_vanish = vanish_structurally(evidence.problem, small, evidence.finite_load);

    Smallest smallest;
    Rational widest = 0;
    int positive = 0;
    for (std::size_t l = 0; l < evidence.forces.size(); ++l) {
        const bool listed = contains(zeros, l);
        const bool vanishes = (listed && zeros_vanish) || (small_vanish && contains(small, l));
        const Range force = vanishes ? Range(Rational(0)) : evidence.forces[l];
        const auto is = [&](const std::string& claimed) {
            return fmt::format("the force of {} is in {}, {}", evidence.name(l), shown(force), claimed);
        };
        worsen(check, lies_in(force, claim.finite[l]), [&] { return is("claimed in " + shown(claim.finite[l])); });
        if (listed) {
            const Verdict zero = force.has_zero() ? Verdict::undecided : Verdict::refuted;
            worsen(check, vanishes ? Verdict::proved : zero, [&] { return is("claimed to be a structural zero"); });
            continue;
        }
        widest = std::max<Rational>(widest, force.upper - force.lower);
        if (!evidence.state.contacts[l].is_unilateral()) {
            continue; // of either sign
        }
        ++positive;
        worsen(check, is_positive(force), [&] { return is("claimed positive"); });
        smallest.offer(force, l);
    }
    worsen(check, zeros_vanish ? Verdict::proved : Verdict::undecided, [&] {
        return fmt::format("{} structural zeros are listed, but {} unloaded degrees of freedom are touched by no other "
                           "contact",
                           zeros.size(), free_of_others(evidence.problem, zeros, evidence.finite_load));
    });

    const Smallest infinitesimal = judge_infinitesimal(check, evidence, claim);
    judge_held(check, evidence, zeros);
    check.numbers = {{"structural_zeros", static_cast<double>(zeros.size())}, {"widest_range", rounded_up(widest)}};
    std::string proved = fmt::format("{} forces > 0", positive);
    if (smallest.lower) {
        check.numbers.emplace_back("smallest_force", rounded_down(*smallest.lower));
        proved += fmt::format(", smallest {:.6g} in {} (ranges up to {:.1g} wide)", rounded_down(*smallest.lower),
                              evidence.name(smallest.contact), rounded_up(widest));
    }
    if (infinitesimal.lower) {
        check.numbers.emplace_back("smallest_infinitesimal_force", rounded_down(*infinitesimal.lower));
        proved += fmt::format("; {} structural zeros, infinitesimal forces >= {:.3g}", zeros.size(),
                              rounded_down(*infinitesimal.lower));
    }
    return check.verdict == Verdict::proved ? answer(check, Verdict::proved, proved) : check;
}

} // namespace isostat::checker
