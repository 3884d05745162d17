#pragma once
// The packings of examples/packings.

#include "support/test.hpp"

/// Paths of all of them, sorted.
inline std::vector<std::string> packing_files() {
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(ISOSTAT_EXAMPLES) + "/packings")) {
        if (entry.path().extension() == ".toml") {
            paths.push_back(entry.path().string());
        }
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}
