#pragma once
/// \file
/// Numbers as text that a page can hold.

#include <cstdint>
#include <string>

namespace isostat {

/// Integers of few bytes each when they are small: seven bits per byte, lowest first, the sign in the lowest bit.
void append_varint(std::string& bytes, std::int64_t value);

/// Base64 of the bytes in zlib's format, which browsers undo (`DecompressionStream("deflate")`).
std::string packed(const std::string& bytes);

} // namespace isostat
