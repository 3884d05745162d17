#include "core/refuse.hpp"
#include "report/page.hpp"

#include <fmt/format.h>
#include <nettle/base64.h>
#include <zlib.h>

namespace isostat {

void append_varint(std::string& bytes, std::int64_t value) {
    constexpr unsigned seven_bits = 0x7f;
    const auto doubled = static_cast<std::uint64_t>(value) << 1U;
    std::uint64_t rest = value < 0 ? ~doubled : doubled;
    for (; rest > seven_bits; rest >>= 7U) {
        bytes += static_cast<char>((rest & seven_bits) | (seven_bits + 1));
    }
    bytes += static_cast<char>(rest);
}

std::string packed(const std::string& bytes) {
    uLongf size = ::compressBound(bytes.size());
    std::string small(size, '\0');
    // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): both libraries have their own byte types
    const int status = ::compress2(reinterpret_cast<Bytef*>(small.data()), &size,
                                   reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
    if (status != Z_OK) {
        refuse(ErrorKind::internal, "zlib: {}", ::zError(status));
    }
    std::string text(BASE64_ENCODE_RAW_LENGTH(size), '\0');
    ::base64_encode_raw(text.data(), size, reinterpret_cast<const std::uint8_t*>(small.data()));
    // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
    return text;
}

} // namespace isostat
