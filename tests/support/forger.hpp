#pragma once
// Who alters the records of a run can compute its digests too: a checker must not rest on them.

#include "io/record_digests.hpp"
#include "support/scratch.hpp"

#include <isostat/io/certificate_file.hpp>

#include <filesystem>
#include <string>

namespace forger {

/// Makes every digest in checkpoint.json that of what the folder holds now, and its state that of states/last.json.
inline void seal(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "checkpoint.json";
    if (!std::filesystem::exists(path)) {
        return;
    }
    const std::string old = scratch::read(path);
    auto object = isostat::json::Json::parse(old);
    object.erase("digest");
    object.erase("state");
    for (auto& [name, digest] : object["files"].items()) {
        digest = isostat::sha256(scratch::read(folder / name));
    }
    for (auto& [name, bytes] : object["bytes"].items()) {
        const std::string text = scratch::read(folder / name);
        std::string digest;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
            digest = isostat::chained(digest, text.substr(begin, end - begin));
            begin = end;
        }
        bytes = text.size();
        object["digests"][name] = digest;
    }
    std::string text = object.dump();
    text.pop_back();
    text += isostat::before_state + scratch::read(folder / "states" / "last.json");
    scratch::write(path, text + isostat::before_digest + '"' + isostat::sha256(text) + "\"}\n");
}

} // namespace forger
