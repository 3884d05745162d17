#pragma once
/// \file
/// The records of a run against its checkpoint: private to the library.

#include "io/json.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace isostat {

/// The records of arcs for a checker, one line per arc, in the folder of a run of level `arcs`.
inline constexpr const char* witness_records = "certificates/arcs.jsonl";

/// Digest of a list of records: each line together with the digest of those before it.
std::string chained(const std::string& before, const std::string& line);

/// What stands in checkpoint.json between the checkpoint and its own digest.
inline constexpr const char* before_digest = ",\n\"digest\": ";
/// What stands before the state in it; the state has the bytes of its own file.
inline constexpr const char* before_state = ",\n\"state\": ";

/// checkpoint.json, every digest in it looked for again.
struct CheckedRecords {
    struct Lines {
        long bytes = 0; ///< of the records before the checkpoint
        std::string digest;
    };
    json::Json checkpoint;
    std::string state; ///< the bytes of its state file
    std::map<std::string, Lines> lines;
    std::map<std::string, std::string> files; ///< SHA-256 of the others
    std::string damage; ///< the first file that is not as it was at the checkpoint, in words; empty: all are
};

/// Nothing: there is no checkpoint yet. Throws `Error(bad_input)` where checkpoint.json cannot be read. Records after
/// the checkpoint are not looked at.
std::optional<CheckedRecords> compare_records(const std::filesystem::path& directory);

/// The same, and every file is as it was: else it throws `Error(bad_input)` naming the first one with a byte changed or
/// a record missing.
std::optional<CheckedRecords> check_records(const std::filesystem::path& directory);

} // namespace isostat
