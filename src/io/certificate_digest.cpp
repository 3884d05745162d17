#include "io/certificate_json.hpp"

#include <isostat/io/certificate_file.hpp>

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <array>
#include <cstdint>

namespace isostat {

std::string sha256(const std::string& bytes) {
    sha256_ctx context;
    sha256_init(&context);
    std::vector<std::uint8_t> input(bytes.begin(), bytes.end());
    sha256_update(&context, input.size(), input.data());
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
    sha256_digest(&context, digest.size(), digest.data());
    return fmt::format("{:02x}", fmt::join(digest, ""));
}

namespace json {

std::string digest_of(const Json& document) {
    nlohmann::json sorted = nlohmann::json::parse(dumped(document));
    sorted.erase("digest");
    return sha256(sorted.dump());
}

} // namespace json

} // namespace isostat
