#include "snap/force_split.hpp"

#include "snap/backbone.hpp"
#include "statics/statics.hpp"
#include "verified/proved_structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::compare {

namespace {

/// The ratio of the mean forces where only the size of a cell gives way, because a factor is free there; else 1.
double factor_of(const Packing& packing, const Statics& statics, const Load& load, const std::vector<double>& forces) {
    double said = 0, exact = 0;
    for (std::size_t l = 0; l < forces.size() && packing.cell.keeps_shape; ++l) {
        const bool known = std::isfinite(forces[l]);
        said += known ? forces[l] : 0;
        exact += known ? statics.force(ContactId(l), load.loaded_stress()).value : 0;
    }
    return said > 0 && exact > 0 ? said / exact : 1;
}

} // namespace

Units units_of(const std::vector<double>& forces, const std::vector<double>& exact, double mean) {
    double product = 0, square = 0;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        const bool said = std::isfinite(forces[l]);
        product += said ? forces[l] * exact[l] : 0;
        square += said ? exact[l] * exact[l] : 0;
    }
    Units out{product / square, 0};
    for (std::size_t l = 0; l < forces.size(); ++l) { // comparisons ignore a NaN
        out.left = std::max(out.left, std::abs(forces[l] - out.factor * exact[l]) / mean);
    }
    return out;
}

std::string Units::words(double agreement) const {
    return left <= agreement
               ? fmt::format("they are {:.6g} times those, to {:.1e} mean forces: other units, or another load", factor,
                             left)
               : fmt::format(
                     "no factor makes them agree, with the best one, {:.3g}, they differ by {:.2g} mean forces: "
                     "is the column that of the forces?",
                     factor, left);
}

ForceSplit split_forces(const SoftState& soft, const std::vector<double>& forces, double mean, const Snap& snap) {
    ForceSplit out;
    Packing packing = of_disks(soft.packing, snap.disks);
    (void)snap_to_grid(packing);
    const auto made = ProvedStructure::make(std::move(packing), snap.backbone.contacts);
    if (!made.ok() || !(mean > 0)) {
        return out;
    }
    const ProvedStructure& at = *made.value();
    const Load& load = snap.backbone.load;
    const Statics statics(at.packing, load, at.structure, at.factorisation, at.inverse);
    const double factor = factor_of(at.packing, statics, load, forces);
    double rest = -1, stiffness = 0;
    std::vector<double> exact;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        const Enclosure f = statics.force(ContactId(l), load.loaded_stress());
        const double off = std::abs(forces[l] - factor * f.value) + factor * f.radius;
        exact.push_back(f.value);
        if (off > rest) { // false for a NaN
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
        out.units = units_of(forces, exact, mean);
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
