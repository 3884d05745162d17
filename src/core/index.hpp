#pragma once
/// \file
/// Numbers of disks, contacts and coordinates are int, positions in a vector std::size_t.

#include <cstddef>

namespace isostat {

constexpr std::size_t at(int k) {
    return static_cast<std::size_t>(k);
}

} // namespace isostat
