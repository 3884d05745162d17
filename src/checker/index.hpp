#pragma once
/// \file
/// Indices: numbers of disks, contacts and coordinates are int, positions in a vector std::size_t.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace isostat::checker {

inline std::size_t at(int k) {
    return static_cast<std::size_t>(k);
}

inline bool contains(const std::vector<int>& sorted, std::size_t value) {
    return std::binary_search(sorted.begin(), sorted.end(), static_cast<int>(value));
}

} // namespace isostat::checker
