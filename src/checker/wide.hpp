#pragma once
/// \file
/// Integers of 128 bits.

namespace isostat::checker {

__extension__ using Wide = __int128;
__extension__ using WideMagnitude = unsigned __int128;

inline WideMagnitude magnitude(Wide value) {
    return value < 0 ? -static_cast<WideMagnitude>(value) : static_cast<WideMagnitude>(value);
}

} // namespace isostat::checker
