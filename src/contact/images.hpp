#pragma once
// The images of disks of a periodic cell that can form pairs, and the contacts of these pairs: private to the library.

#include "contact/separation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// At most this many periods along each axis are between a disk and an
/// image in a pair, so that differences are exact (proofs/cells.md, C2).
inline constexpr int farthest_image = 3; // cells.md C2 (differences are exact up to three periods)
/// The limit for contacts of a vertex during a run, whose matrix has exact multiples of normals (C10).
inline constexpr int farthest_contact = 2;

/// Whether the offset is more than `most` periods along some axis.
inline bool is_beyond(const Contact& pair, int most) {
    return std::ranges::any_of(pair.image.m, [most](int m) { return std::abs(m) > most; });
}

/// Finitely many images of the disks of a cell, as a packing without a cell. Every pair of a disk and an image with a
/// gap below `reach` is, moved by some period, a pair of these images (proofs/cells.md, C3).
struct Images {
    Packing packing;           ///< no walls, no cell; with the rounded centres
    std::vector<int> disk;     ///< of each image, the disk
    std::vector<Image> offset; ///< the periods between disk and image: it is at x_disk + A offset
    double rounding = 0;       ///< bound of the error of a gap from the rounding of two centres

    /// Adds the image of grain i of the packing m periods away.
    void add(const Packing& of, int i, const std::array<int, most_axes>& m);
    /// The contact that a pair of these images stands for.
    [[nodiscard]] Contact contact(int a, int b) const;
};

/// A disk may be at most this many periods from the origin, so that offsets and their differences fit into a byte.
inline constexpr double farthest_disk = 30;          // exact: offsets and their differences fit into a byte
inline constexpr double farthest_disk_of_a_run = 25; // exact: a run ends before a disk is beyond 30

/// Words for the first disk that is `most` periods or more from the origin, or whose images that many periods apart may
/// have a gap below `reach` (then `most` - 1); nothing: no such disk. Cost O(n).
std::optional<std::string> disk_beyond(const Packing& packing, double reach, double most);

/// \pre there are periodic axes. Throws `Error(bad_input)` when a disk is beyond `farthest_disk`, or when more than
/// 10^8 images would be needed, because a cell that flat has a better basis.
Images images_near_cell(const Packing& packing, double reach);

/// Sum of the lengths of the terms of r of an image, to which the rounding of r is relative; 0 without an image. Larger
/// where more than eight periods are added, for as many roundings (proofs/contact_candidates.md, "Filters").
inline double lengths_of_image(const Packing& packing, const Contact& pair) {
    double sum = 0;
    double periods = 0;
    if (!pair.image.is_here()) {
        Separation(pair, packing.layout()).for_each_coordinate([&](std::size_t k, std::size_t, int multiple) {
            sum += std::abs(multiple) * std::abs(packing.q[k]);
        });
        for (const std::int8_t m : pair.image.m) {
            periods += std::abs(m);
        }
    }
    return sum * std::max(1.0, periods / 8); // contact_candidates.md Filters (sums of an image)
}

} // namespace isostat
