#include "checker/evidence.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/core/machine.hpp>

#include <algorithm>
#include <optional>

namespace isostat {

namespace {

using namespace checker;

/// Whether a claim is made and not decided.
bool leaves_open(const Verification& result, std::string_view claim) {
    return std::any_of(result.checks.begin(), result.checks.end(), [claim](const ClaimCheck& check) {
        return check.claim == claim && check.claimed && check.verdict == Verdict::undecided;
    });
}

} // namespace

Verification verify(const Certificate& certificate, CheckerArithmetic arithmetic) {
    require_floating_point();
    const bool clumps = !certificate.state.packing.bars.empty(); // which may hold coordinates of free motions
    const auto judged = [&certificate](const Evidence& evidence) { return judge(certificate.claims, evidence); };
    std::optional<Verification> first;
    {
        const Evidence evidence(certificate.state, arithmetic, clumps);
        first = judged(evidence);
        if (arithmetic != CheckerArithmetic::automatic || evidence.inverse.singular_value == 0 ||
            !leaves_open(*first, "vertex")) {
            // An end of the interval, or a small force, may be claimed to more digits than the usual ones prove.
            const bool vague = arithmetic == CheckerArithmetic::automatic &&
                               (leaves_open(*first, "load_interval") || leaves_open(*first, "forces"));
            return vague && evidence.vertex.found
                       ? judged(Evidence(certificate.state, arithmetic, clumps, {}, most_digits))
                       : *first;
        }
    }
    Verification by_rows = judged(Evidence(certificate.state, CheckerArithmetic::rows, clumps));
    return leaves_open(by_rows, "vertex") ? *first : by_rows;
}

} // namespace isostat
