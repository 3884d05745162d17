#include "crafted/inspection_parts.hpp"

#include <algorithm>

namespace isostat::crafted {

namespace {

ExactPacking without_rattlers(const ExactPacking& packing, const std::vector<DiskHold>& hold) {
    ExactPacking out = packing;
    out.load.reset();
    out.radius.clear();
    out.centre.clear();
    out.fixed.clear();
    out.cell.pin = 0;
    for (std::size_t i = 0; i < hold.size(); ++i) {
        if (hold[i] != DiskHold::rattler) {
            out.radius.push_back(packing.radius[i]);
            out.centre.push_back(packing.centre[i]);
        }
    }
    return out;
}

/// Refuted when a motion keeps every gap (`mechanisms`) or opens some and closes none (no `positive` forces).
Verdict jammed(const Inspection& seen, bool decided, bool positive) {
    if (seen.rank_exact == Verdict::proved && seen.mechanisms > 0) {
        return Verdict::refuted;
    }
    return seen.rank_exact != Verdict::proved || !decided ? Verdict::undecided
           : positive                                     ? Verdict::proved
                                                          : Verdict::refuted;
}

} // namespace

Jamming judge_jamming(const ExactPacking& packing, const std::vector<DiskHold>& hold, const InspectionLimits& limits) {
    ExactPacking rest = without_rattlers(packing, hold);
    Jamming out;
    out.disks = rest.disk_count();
    if (out.disks == 0) {
        out.collective = Verdict::refuted;
        out.strict = packing.cell.any() ? std::optional(Verdict::refuted) : std::nullopt;
        return out;
    }
    const auto inspected = [&](bool moves) {
        rest.cell.move(moves, moves);
        return inspect_contacts(rest, exact_contacts(rest).value(), limits);
    };
    const Inspection fixed = inspected(false);
    out.collective = fixed.dof_count == 0
                         ? Verdict::proved
                         : jammed(fixed, fixed.one_sign_decided, fixed.one_sign.kind == exact::OneSign::strict);
    if (!packing.cell.any()) {
        return out;
    }
    rest.load.emplace(); // a pressure of 1, so that the load is minus the derivative of the volume
    for (std::size_t a = 0; a < rest.axes(); ++a) {
        rest.load->wall[a] = 1;
        for (std::size_t b = 0; b < rest.axes(); ++b) {
            rest.load->wall[a] *= b == a ? Number(1) : rest.length[b];
        }
    }
    const Inspection strained = inspected(true);
    out.strict = jammed(strained, strained.support != Support::undecided, strained.support == Support::positive);
    return out;
}

} // namespace isostat::crafted
