#include "contact/near_pairs.hpp"

#include "contact/candidates.hpp"
#include "contact/images.hpp"
#include "contact/separation.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace isostat {

namespace {

/// Gaps with a bound of their rounding: 8 u times the lengths that enter, for any coordinates.
class Gaps {
  public:
    struct Gap {
        double value;
        double error;
        [[nodiscard]] bool may_be_below(double reach) const { return value - error < reach; }
    };
    explicit Gaps(const Packing& packing) : packing_(packing), plain_(lengths_are_plain(packing.q, packing.radius)) {}

    [[nodiscard]] Gap of(const Contact& pair) const {
        const auto [dx, dy, dz] = separation(packing_.layout(), packing_.q, pair);
        const double distance =
            plain_ ? std::sqrt(dx * dx + dy * dy + dz * dz) : std::hypot(dx, dy, dz); // slow; error below 1 ulp
        const double radii = touching_distance(packing_.radius, pair);
        return {distance - radii, 0x1p-50 * (distance + radii + lengths_of_image(packing_, pair))};
    }

  private:
    const Packing& packing_;
    bool plain_;
};

} // namespace

std::vector<Contact> pairs_within(const Packing& packing, double reach, int most_per_disk) {
    const bool repeats = packing.cell.any();
    const Images images = repeats ? images_near_cell(packing, reach) : Images();
    const Packing& among = repeats ? images.packing : packing;
    const int most = most_per_disk * std::min(among.disk_count(), std::numeric_limits<int>::max() / most_per_disk);
    PairList list;
    find_pairs(packing.dimension, among.q, among.radius, reach + images.rounding, list, most);
    const Gaps gaps(packing);
    std::vector<Contact> pairs;
    for (int i = 0; i < among.disk_count(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        for (int p = list.start[k]; p < list.start[k + 1]; ++p) {
            const int j = list.partner[static_cast<std::size_t>(p)];
            const Contact pair = repeats ? images.contact(i, j) : pair_of(i, j);
            if (gaps.of(pair).may_be_below(reach)) {
                pairs.push_back(pair);
            }
        }
    }
    if (repeats) { // a pair and its copy moved by a period
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    }
    without_hidden_pairs(pairs, packing);
    return pairs;
}

void without_hidden_pairs(std::vector<Contact>& pairs, const Packing& packing) {
    if (packing.bars.empty()) {
        return;
    }
    const Bodies bodies(packing);
    const ArcBodies arcs(packing);
    std::erase_if(pairs, [&](const Contact& pair) {
        const bool own = pair.of_disks() && pair.image.is_here() && bodies.of(pair.i) == bodies.of(pair.j);
        return own || !arcs.is_nearest(pair);
    });
}

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

} // namespace isostat
