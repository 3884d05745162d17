#include "scene/named_input.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace fs = std::filesystem;

fs::path named_input(const fs::path& folder, const std::string& name, const std::string& where) {
    const auto refuse = [&](const char* why) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{} is \"{}\", {}: expected a regular file beside the file that names it, or below",
                                where, name, why));
    };
    const fs::path named = name;
    if (named.is_absolute() || std::find(named.begin(), named.end(), "..") != named.end()) {
        refuse("which leads elsewhere");
    }
    fs::path path = folder / named;
    std::error_code absent;
    const fs::path real = fs::canonical(path, absent);
    if (absent) {
        return path;
    }
    const fs::path below = fs::canonical(folder.empty() ? fs::path(".") : folder);
    if (std::mismatch(below.begin(), below.end(), real.begin(), real.end()).first != below.end()) {
        refuse("a link that leads elsewhere");
    }
    if (!fs::is_regular_file(real) && !fs::is_directory(real)) { // the reader reports a folder
        refuse("a device or a pipe");
    }
    return path;
}

} // namespace isostat
