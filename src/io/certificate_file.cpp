#include "io/files.hpp"
#include "io/state_json.hpp"

#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nettle/sha2.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string_view>

namespace isostat {

namespace {

using json::Field;
using json::member_line;

bool is_hash(const std::string& text) {
    return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Copies a document that was dumped here, without white space and with sorted keys: what parsing and dumping it would
/// give, ten times faster. \pre no backslash, so that the next quote ends a string and keys are sorted as they stand
class SortedCopy {
  public:
    explicit SortedCopy(std::string_view text) : rest_(text) {}
    void value(std::string& copy) {
        const char first = next();
        if (first == '{') {
            object(copy);
        } else if (first == '[') {
            copy += take(1);
            while (next() != ']') {
                if (next() == ',') {
                    copy += take(1);
                }
                value(copy);
            }
            copy += take(1);
        } else {
            copy += first == '"' ? take(rest_.find('"', 1) + 1) : take(length_of_word());
        }
    }

  private:
    char next() {
        rest_.remove_prefix(rest_.find_first_not_of(" \n"));
        return rest_.front();
    }
    /// Of a number, true, false or null.
    [[nodiscard]] std::size_t length_of_word() const {
        const auto ends = [](char c) { return c == ',' || c == ']' || c == ' ' || c == '\n' || c == '}'; };
        return static_cast<std::size_t>(std::ranges::find_if(rest_, ends) - rest_.begin());
    }
    std::string_view take(std::size_t size) {
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(taken.size());
        return taken;
    }
    void object(std::string& copy) {
        std::map<std::string, std::string> members; // names without the last quote, which sorts after a space
        take(1);
        while (next() != '}') {
            std::string name;
            value(name);
            name.pop_back();
            next();
            take(1); // the colon
            value(members[name]);
            if (next() == ',') {
                take(1);
            }
        }
        take(1);
        copy += '{';
        for (auto member = members.begin(); member != members.end(); ++member) {
            copy += (member == members.begin() ? "" : ",") + member->first + "\":" + member->second;
        }
        copy += '}';
    }

    std::string_view rest_;
};

/// `digest_of` of a document that was dumped here.
std::string digest_of_text(const std::string& text) {
    if (text.find('\\') != std::string::npos) {
        return json::digest_of(json::Json::parse(text));
    }
    std::string sorted;
    SortedCopy(text).value(sorted);
    return sha256(sorted);
}

} // namespace

std::string sha256(const std::string& bytes) {
    sha256_ctx context;
    sha256_init(&context);
    std::vector<std::uint8_t> input(bytes.begin(), bytes.end());
    sha256_update(&context, input.size(), input.data());
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
    sha256_digest(&context, digest.size(), digest.data());
    return fmt::format("{:02x}", fmt::join(digest, ""));
}

std::string json::digest_of(const json::Json& document) {
    nlohmann::json sorted = document;
    sorted.erase("digest");
    return sha256(sorted.dump());
}

std::string certificate_text(const Certificate& certificate) {
    return json::certificate_text(certificate, state_text(certificate.state));
}

std::string json::certificate_text(const Certificate& certificate, std::string state) {
    while (state.ends_with('\n')) {
        state.pop_back();
    }
    std::string text = "{\n\"format\": \"isostat-certificate\",\n\"version\": 1,\n";
    text += member_line("program", certificate.program) + ",\n";
    text += member_line("input", certificate.input) + ",\n";
    text += member_line("input_hash", certificate.input_hash) + ",\n";
    text += json::claims_text(certificate.claims, certificate.state.packing.dimension) + ",\n";
    text += "\"state\": " + state;
    return text + ",\n" + member_line("digest", digest_of_text(text + "}")) + "\n}\n";
}

void write_certificate(const std::filesystem::path& path, const Certificate& certificate) {
    write_output(path, certificate_text(certificate), "\"isostat-certificate\"");
}

Certificate parse_certificate(const std::string& text, const std::string& source) {
    const json::Json parsed = Field::parse(text, source);
    const Field document(parsed, source);
    if (!document.value().is_object()) {
        document.fail("an object with \"format\": \"isostat-certificate\"");
    }
    if (document.at("format").string() != "isostat-certificate") {
        document.at("format").fail("\"isostat-certificate\"");
    }
    if (document.at("version").integer() != 1) {
        document.at("version").fail("1, the version that this program reads");
    }
    document.only({"format", "version", "program", "input", "input_hash", "claims", "state", "digest"});
    const std::string digest = json::digest_of(parsed);
    if (document.at("digest").string() != digest) {
        document.at("digest").fail("\"" + digest + "\", the SHA-256 of the content: was the file altered?");
    }
    Certificate certificate;
    certificate.program = document.at("program").string();
    certificate.input = document.at("input").string();
    certificate.input_hash = document.at("input_hash").string();
    if (!is_hash(certificate.input_hash)) {
        document.at("input_hash").fail("a SHA-256 of 64 hexadecimal digits");
    }
    const Field state = document.at("state");
    if (state.has("forces")) {
        state.at("forces").fail("no such field in a certificate: forces are claims");
    }
    certificate.state = json::state_from_json(state, source).state;
    certificate.claims = json::claims_of(document.at("claims"), certificate.state);
    return certificate;
}

Certificate read_certificate(const std::filesystem::path& path) {
    return parse_certificate(read_text(path), path.string());
}

} // namespace isostat
