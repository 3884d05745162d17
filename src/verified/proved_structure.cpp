#include "verified/proved_structure.hpp"

#include "core/roundoff.hpp"
#include "verified/enclosed_vertex.hpp"
#include "verified/regularity_prover.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

using roundoff::u;

bool ProvedStructure::is_of(const Packing& other, const std::vector<Contact>& contacts) const {
    return structure.evidence() == RegularityEvidence::elimination && factorisation.is_fresh() &&
           inverse.verdict == Verdict::proved && inverse.route != InverseBound::Route::carried &&
           inverse.route != InverseBound::Route::multiprecision && structure.contacts() == contacts && packing == other;
}

ProvedStructure::ProvedStructure(Packing p, IsostaticStructure s, Factorisation factors, const InverseBound& bound)
    : packing(std::move(p)), structure(std::move(s)), factorisation(std::move(factors)), inverse(bound) {}

Result<std::unique_ptr<ProvedStructure>> ProvedStructure::make(Packing packing, std::vector<Contact> contacts) {
    auto proved = IsostaticStructure::prove(packing, std::move(contacts));
    if (!proved.ok()) {
        return proved.failure();
    }
    InverseBoundCache cache;
    Factorisation factors(proved.value());
    const InverseBound bound = bound_inverse(proved.value(), factors, cache);
    return std::unique_ptr<ProvedStructure>(
        new ProvedStructure(std::move(packing), std::move(proved.value()), std::move(factors), bound));
}

std::unique_ptr<ProvedStructure> ProvedStructure::shared() const {
    return std::unique_ptr<ProvedStructure>(new ProvedStructure(packing, structure, factorisation.shared(), inverse));
}

Result<std::unique_ptr<ProvedStructure>> ProvedStructure::moved(Packing there, double farthest) const {
    // precision.md B1 (last operations)
    const double distance = std::sqrt(static_cast<double>(there.q.size())) * farthest * (1 + 4 * u);
    const double gaps = worst_gap_ratio(packing, structure.contacts());
    const double turning = lipschitz(packing, structure.contacts());
    InverseBound bound = inverse;
    // precision.md B1 (last operations)
    bound.sigma_min -= normal_rate(turning) * distance * (1 + 4 * u);
    bound.sigma_min *= 1 - 2 * u;
    // true_vertex.md V5 (a centre that was moved)
    const bool near = gaps < 1e-3 && distance * turning < 1e-3; // then distance < D_min / 1000
    const ContactId any(0);                                     // nothing is exchanged
    auto same = near && bound.sigma_min > inverse.sigma_min / 2
                    ? IsostaticStructure::exchange(structure, there, any, structure.contacts().front())
                    : std::nullopt;
    if (!same) {
        return make(std::move(there), structure.contacts());
    }
    const RegularityProof proof = RegularityProver::proof(same->matrix(), bound.sigma_min);
    IsostaticStructure proved = IsostaticStructure::exchanged(std::move(*same), proof);
    // One pass errs by K distance / sigma_min at most, and whoever solves here refines with residuals at this place.
    Factorisation factors = Factorisation::of(proved, factorisation.approximate());
    return std::unique_ptr<ProvedStructure>(
        new ProvedStructure(std::move(there), std::move(proved), std::move(factors), bound));
}

} // namespace isostat
