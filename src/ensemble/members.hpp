#pragma once
/// \file
/// The runs of an ensemble, for commands that take the folder of one in place of a run.

#include <cstdint>
#include <filesystem>
#include <vector>

namespace isostat {

struct Member {
    std::uint64_t seed = 0;
    std::filesystem::path folder;
    bool begun = false; ///< its run.json exists
    int further = 0;    ///< for a run not begun: so many following ones are not begun either
};

/// Whether this is the folder of an ensemble (and not that of a run).
bool is_ensemble(const std::filesystem::path& directory);

/// The samples that ensemble.json names, by seed; the first one of each series not begun. Throws `Error(bad_input)`.
std::vector<Member> members_of(const std::filesystem::path& directory);

} // namespace isostat
