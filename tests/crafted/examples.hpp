#pragma once
// The packings of examples/packings.

#include "support/test.hpp"

/// Paths of those of disks, or of spheres, sorted.
inline std::vector<std::string> packing_files(bool spheres = false) {
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(ISOSTAT_EXAMPLES) + "/packings")) {
        const bool of_spheres = entry.path().filename().string().starts_with("spheres_");
        if (entry.path().extension() == ".toml" && of_spheres == spheres) {
            paths.push_back(entry.path().string());
        }
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}
