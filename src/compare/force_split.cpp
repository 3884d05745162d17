#include "compare/force_split.hpp"

#include "compare/backbone.hpp"
#include "statics/statics.hpp"
#include "verified/centre.hpp"

#include <algorithm>
#include <cmath>

namespace isostat::compare {

ForceSplit split_forces(const SoftState& soft, const std::vector<double>& forces, double mean, const Snap& snap) {
    ForceSplit out;
    Packing packing = of_disks(soft.packing, snap.disks);
    (void)snap_to_grid(packing);
    const auto made = Centre::make(std::move(packing), snap.backbone.contacts);
    if (!made.ok() || !(mean > 0)) {
        return out;
    }
    const Centre& at = *made.value();
    const Load& load = snap.backbone.load;
    const Statics statics(at.packing, load, at.structure, at.factorisation, at.inverse);
    double rest = -1, stiffness = 0;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        const Enclosure f = statics.force(ContactId(l), load.loaded_stress());
        if (const double off = std::abs(forces[l] - f.value) + f.radius; off > rest) { // not of a NaN
            rest = off;
            out.worst = soft.contacts[l];
        }
        if (l < snap.truth.finite.size()) {
            const Interval& t = snap.truth.finite[l];
            stiffness =
                std::max({stiffness, std::abs(f.value - t.lower) + f.radius, std::abs(f.value - t.upper) + f.radius});
        }
    }
    if (rest >= 0) {
        out.rest = rest / mean;
    }
    if (!snap.truth.finite.empty()) {
        out.stiffness = stiffness / mean;
    }
    return out;
}

double mean_force(const std::vector<double>& forces) {
    double sum = 0;
    int count = 0;
    for (const double f : forces) {
        if (f > 0) {
            sum += f;
            ++count;
        }
    }
    return count > 0 ? sum / count : 0;
}

} // namespace isostat::compare
