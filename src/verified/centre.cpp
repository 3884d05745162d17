#include "verified/centre.hpp"

#include "core/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

bool ProvedStructure::is_of(const Packing& other, const std::vector<Contact>& contacts) const {
    return structure.evidence() == RegularityEvidence::elimination && factorisation.is_fresh() &&
           inverse.verdict == Verdict::proved && inverse.route != InverseBound::Route::carried &&
           inverse.route != InverseBound::Route::multiprecision && structure.contacts() == contacts && packing == other;
}

Centre::Centre(Packing p, IsostaticStructure s, const ProvedStructure* proved)
    : packing(std::move(p)), structure(std::move(s)),
      factorisation(proved != nullptr ? proved->factorisation.shared() : Factorisation(structure)) {
    using roundoff::u;
    InverseBoundCache cache;
    inverse = proved != nullptr ? proved->inverse : bound_inverse(structure, factorisation, cache);
    for (const Contact& contact : structure.contacts()) {
        const double h = std::abs(gap(packing, contact));
        const double length = target(packing, contact);
        largest_gap = std::max(largest_gap, (h + 8 * u * (h + length)) * (1 + 4 * u));
        relative_gap = std::max(relative_gap, h / length);
    }
    neighbourhood = Neighbourhood::of(packing, structure.contacts(), inverse);
}

Result<std::unique_ptr<Centre>> Centre::make(Packing packing, std::vector<Contact> contacts) {
    auto proved = IsostaticStructure::prove(packing, std::move(contacts));
    if (!proved.ok()) {
        return proved.failure();
    }
    return std::unique_ptr<Centre>(new Centre(std::move(packing), std::move(proved.value()), nullptr));
}

std::unique_ptr<Centre> Centre::of(const ProvedStructure& proved) {
    return std::unique_ptr<Centre>(new Centre(proved.packing, proved.structure, &proved));
}

} // namespace isostat
