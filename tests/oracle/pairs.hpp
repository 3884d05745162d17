#pragma once
// Every pair of grains, by brute force.

#include <isostat/contact/state.hpp>

#include <vector>

namespace isostat::oracle {

/// Every pair of grains that the box has, contacts included; in a cell those of images up to `far` periods away.
inline std::vector<Contact> all_pairs(const Packing& packing, int far = 4) {
    std::vector<Contact> pairs;
    const auto& walls = packing.walls;
    for (int i = 0; i < packing.disk_count(); ++i) {
        for (int a = 0; a < packing.dimension; ++a) {
            if (walls.lower[static_cast<std::size_t>(a)] != WallKind::absent) {
                pairs.push_back({ContactKind::lower_wall, i, a});
            }
            if (walls.upper[static_cast<std::size_t>(a)] != WallKind::absent) {
                pairs.push_back({ContactKind::upper_wall, i, a});
            }
        }
        const auto& periodic = packing.cell.periodic;
        const int along = periodic[0] ? far : 0;
        const int across = periodic[1] ? far : 0;
        const int up = periodic[2] ? far : 0;
        for (int j = i; j < packing.disk_count(); ++j) {
            for (int m = -along; m <= along; ++m) {
                for (int p = -across; p <= across; ++p) {
                    for (int q = -up; q <= up; ++q) {
                        const Image image{
                            {static_cast<std::int8_t>(m), static_cast<std::int8_t>(p), static_cast<std::int8_t>(q)}};
                        if (i < j || image > Image{}) {
                            pairs.push_back({ContactKind::disk_disk, i, j, image});
                        }
                    }
                }
            }
        }
    }
    return pairs;
}

} // namespace isostat::oracle
