#include "snap/pair_images.hpp"

#include "snap/soft_list.hpp"

#include <algorithm>

namespace isostat::compare {

PairImages::PairImages(const Packing& packing) {
    if (!packing.cell.any()) {
        return;
    }
    for (const Contact& c : near_contacts(packing)) {
        if (c.of_disks()) {
            images_[{c.i, c.j}].by_gap.emplace_back(gap(packing, c), c);
        }
    }
    for (auto& [pair, images] : images_) {
        std::sort(images.by_gap.begin(), images.by_gap.end());
    }
}

Contact PairImages::next(int i, int j) {
    const auto found = images_.find({std::min(i, j), std::max(i, j)});
    if (found == images_.end()) {
        return pair_of(i, j);
    }
    Images& images = found->second;
    const std::size_t row = images.rows++;
    const bool overlaps = row < images.by_gap.size() && images.by_gap[row].first < 0;
    return images.by_gap[overlaps ? row : 0].second;
}

} // namespace isostat::compare
