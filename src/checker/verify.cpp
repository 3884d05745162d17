#include "checker/evidence.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/core/floating_point.hpp>

#include <algorithm>
#include <optional>

namespace isostat {

namespace {

using namespace checker;

/// What stands in the way of judging a claim at all; empty: nothing.
std::string obstacle(const Evidence& evidence, bool claimed) {
    return claimed ? evidence.problem.unsupported : "not claimed";
}

/// The same for a claim about the true vertex, which must be claimed and proved to exist where it is claimed.
std::string vertex_obstacle(const Evidence& evidence, const CertificateClaims& claims, bool claimed, bool exists) {
    const std::string first = obstacle(evidence, claimed);
    if (!first.empty()) {
        return first;
    }
    if (!claims.vertex) {
        return "speaks of a true vertex, which is not claimed";
    }
    if (!evidence.vertex.found) {
        return "speaks of a true vertex, which is not proved: " + evidence.why_no_vertex();
    }
    return exists ? "" : "speaks of a true vertex within the claimed radius, which is not proved";
}

Verification judge(const CertificateClaims& claims, const Evidence& evidence) {
    Verification result;
    bool exists = false;
    const auto add = [&result](const char* name, bool claimed, const std::string& why_not, const auto& judge) {
        result.checks.push_back(why_not.empty() ? judge()
                                                : ClaimCheck{.claim = name, .claimed = claimed, .detail = why_not});
    };
    const auto about_vertex = [&](bool claimed) { return vertex_obstacle(evidence, claims, claimed, exists); };

    const bool counting = claims.counting.has_value();
    add("counting", counting, obstacle(evidence, counting),
        [&] { return judge_counting(evidence, *claims.counting, claims.vertex.has_value()); });
    const bool vertex = claims.vertex.has_value();
    add("vertex", vertex, obstacle(evidence, vertex), [&] { return judge_vertex(evidence, *claims.vertex, exists); });
    const bool forces = claims.forces.has_value();
    add("forces", forces, about_vertex(forces), [&] { return judge_forces(evidence, *claims.forces); });
    const bool gaps = claims.gaps.has_value();
    add("gaps", gaps, about_vertex(gaps), [&] { return judge_gaps(evidence, *claims.gaps); });
    const bool load = claims.load_interval.has_value();
    add("load_interval", load, about_vertex(load),
        [&] { return judge_load_interval(evidence, *claims.load_interval); });
    add("stable", claims.stable, about_vertex(claims.stable), [&] { return judge_stability(evidence, result.checks); });

    result.verdict = Verdict::proved;
    for (const ClaimCheck& check : result.checks) {
        result.verdict = both(result.verdict, check.verdict);
    }
    return result;
}

/// Whether a claim is made and not decided.
bool leaves_open(const Verification& result, std::string_view claim) {
    return std::any_of(result.checks.begin(), result.checks.end(), [claim](const ClaimCheck& check) {
        return check.claim == claim && check.claimed && check.verdict == Verdict::undecided;
    });
}

} // namespace

Verification verify(const Certificate& certificate, CheckerArithmetic arithmetic) {
    require_floating_point();
    const auto judged = [&certificate](const Evidence& evidence) { return judge(certificate.claims, evidence); };
    std::optional<Verification> first;
    {
        const Evidence evidence(certificate.state, arithmetic);
        first = judged(evidence);
        if (arithmetic != CheckerArithmetic::automatic || evidence.inverse.singular_value == 0 ||
            !leaves_open(*first, "vertex")) {
            // An end of the interval may be claimed to more digits than the usual ones tell.
            const bool vague = arithmetic == CheckerArithmetic::automatic && leaves_open(*first, "load_interval");
            return vague && evidence.vertex.found
                       ? judged(Evidence(certificate.state, arithmetic, false, {}, most_digits))
                       : *first;
        }
    }
    Verification by_rows = judged(Evidence(certificate.state, CheckerArithmetic::rows));
    return leaves_open(by_rows, "vertex") ? *first : by_rows;
}

} // namespace isostat
