#include "io/certificate_json.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/certificate_file.hpp>

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <array>
#include <cstdint>
#include <set>

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

Json parse_strictly(const std::string& text, const std::string& source) {
    // Deeper documents would exhaust the stack in functions that walk them recursively.
    constexpr int deepest = 64;
    std::vector<std::set<std::string>> open;
    const Json::parser_callback_t watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > deepest) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: objects and arrays are nested deeper than {} levels: "
                                                          "expected a certificate",
                                                          source, deepest));
        }
        if (event == Json::parse_event_t::object_start) {
            open.emplace_back();
        } else if (event == Json::parse_event_t::object_end) {
            open.pop_back();
        } else if (event == Json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: the field '{}' comes twice in one object: expected once",
                                                          source, parsed.get<std::string>()));
        }
        return true;
    };
    return Field::parse(text, source, watch);
}

std::string digest_of(const Json& document) {
    nlohmann::json sorted = nlohmann::json::parse(document.dump());
    sorted.erase("digest");
    return sha256(sorted.dump());
}

} // namespace json

} // namespace isostat
