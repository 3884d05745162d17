#include "contact/own_images.hpp"

#include "contact/candidates.hpp"
#include "contact/gap_sign.hpp"
#include "contact/near_pairs.hpp"

namespace isostat {

std::vector<Contact> touching_own_images(const Packing& packing) {
    std::vector<Contact> out;
    if (packing.cell.any()) {
        for (const Contact& pair : near_pairs(packing, 0.5 * packing.min_radius()).pairs) { // any positive reach serves
            if (pair.i == pair.j && !can_move(packing, pair) && gap_sign(packing, pair, 0) == 0) {
                out.push_back(pair);
            }
        }
    }
    return out;
}

} // namespace isostat
