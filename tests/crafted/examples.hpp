#pragma once
// The packings of examples/packings.

#include "support/test.hpp"

#include <isostat/crafted/exact_packing.hpp>

namespace examples {

using isostat::crafted::ExactPacking;
using isostat::crafted::Inspection;
using isostat::exact::Number;

inline Number n(const std::string& text) {
    return Number::parse(text);
}

inline ExactPacking example(const std::string& name) {
    return isostat::crafted::read_packing(std::string(ISOSTAT_EXAMPLES) + "/packings/" + name).packing;
}

inline Inspection inspected(const ExactPacking& packing) {
    return required(isostat::crafted::inspect(packing));
}

/// Paths of those of disks, of spheres, or of clumps of either, sorted.
inline std::vector<std::string> packing_files(bool spheres = false, bool clumps = false) {
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(ISOSTAT_EXAMPLES) + "/packings")) {
        const std::string name = entry.path().filename().string();
        const bool of_spheres = name.starts_with("spheres_"), of_clumps = name.starts_with("clump_");
        if (entry.path().extension() == ".toml" && of_spheres == spheres && of_clumps == clumps) {
            paths.push_back(entry.path().string());
        }
    }
    std::ranges::sort(paths);
    return paths;
}

} // namespace examples
