#include "crafted/told_ranges.hpp"

#include <algorithm>

namespace isostat::crafted {

namespace {

/// Whether two ranges begin at the same list or overlap.
bool meet(const PlateauRange& a, const PlateauRange& b) {
    return a.candidates == b.candidates || std::max(a.first, b.first) < std::min(a.last, b.last);
}

} // namespace

Told told_of(const Plateau& plateau) {
    Told out;
    const auto in_widest = [&plateau](const PlateauRange& range) { // no range is the widest where no contact can carry
        return plateau.widest && meet(range, plateau.widest->range);
    };
    for (const PlateauRange& range : plateau.ranges) {
        if (!range.told) {
            ++out.noise;
        } else {
            (in_widest(range) ? out.backbone : out.elsewhere).push_back(range);
        }
    }
    for (const PlateauRange& range : plateau.ranges_all) {
        if (range.told && in_widest(range)) {
            out.all.push_back(range);
        }
    }
    out.special = std::any_of(plateau.special.begin(), plateau.special.end(),
                              [&](const auto& range) { return range.told && in_widest(range); });
    return out;
}

} // namespace isostat::crafted
