#include "verified/centre.hpp"

#include "core/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

Centre::Centre(Packing p, IsostaticStructure s)
    : packing(std::move(p)), structure(std::move(s)), factorisation(structure) {
    using roundoff::u;
    InverseBoundCache cache;
    inverse = bound_inverse(structure, factorisation, cache);
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
    return std::unique_ptr<Centre>(new Centre(std::move(packing), std::move(proved.value())));
}

} // namespace isostat
