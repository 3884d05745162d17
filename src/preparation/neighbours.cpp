#include "preparation/neighbours.hpp"

#include "contact/near_pairs.hpp"

namespace isostat::preparation {

std::vector<Contact> near_contacts(const Packing& packing, double reach, double upper_reach) {
    const bool repeats = packing.cell.any();
    std::vector<Contact> near = pairs_within(packing, repeats ? reach + upper_reach : reach);
    if (repeats) {
        std::erase_if(near, [&](const Contact& c) { return c.image.is_here() && !(gap(packing, c) < reach); });
    }
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (int i = 0; i < packing.disk_count(); ++i) {
            for (int a = 0; a < packing.dimension; ++a) {
                const Contact wall{kind, i, a};
                if (packing.cell.periodic[static_cast<std::size_t>(a)]) {
                    continue;
                }
                if (gap(packing, wall) < (kind == ContactKind::upper_wall ? upper_reach : reach)) {
                    near.push_back(wall);
                }
            }
        }
    }
    return near;
}

} // namespace isostat::preparation
