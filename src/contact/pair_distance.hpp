#pragma once
// Distances of disks with bounds of their rounding, and sorted lists of pairs: private to the room.

#include <isostat/contact/contact.hpp>

#include <cmath>
#include <vector>

namespace isostat {

struct Distance {
    double gap;
    double error;
};

/// 8 u times the lengths that enter bounds the rounding of distance - (R_i + R_j), for any coordinates.
inline Distance distance_between(double distance, double radii) {
    return {distance - radii, 0x1p-50 * (distance + radii)};
}

/// From the square of the distance of the centres. \pre `distances_are_plain`.
inline Distance distance_of(double square, double radii) {
    return distance_between(std::sqrt(square), radii);
}

/// Whether no square of a length that matters under- or overflows.
bool distances_are_plain(const Packing<2>& packing);

/// Sorts disk pairs in linear time.
void sort_pairs(std::vector<Contact>& pairs, std::size_t disk_count);

} // namespace isostat
