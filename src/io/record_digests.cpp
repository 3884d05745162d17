#include "io/record_digests.hpp"

#include "io/files.hpp"
#include "io/folders.hpp"

#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

namespace fs = std::filesystem;

std::string chained_lines(const std::string& lines) {
    std::string digest;
    for (std::size_t begin = 0; begin < lines.size();) {
        const std::size_t end = std::min(lines.find('\n', begin), lines.size() - 1) + 1;
        digest = chained(digest, lines.substr(begin, end - begin));
        begin = end;
    }
    return digest;
}

/// Words for a file that is not as it was; nothing: it is.
std::string damage_of(const fs::path& path, const std::string& found, const std::string& expected) {
    return found == expected
               ? ""
               : fmt::format("{}: damaged: its digest is {}, expected {} as at the checkpoint: nothing was "
                             "changed; restore the file, or start again with --force",
                             path.string(), found, expected);
}

/// A checkpoint names the files of its run and nothing else: `resume` reads and cuts what it names.
void check_names(const json::Field& list, bool of_states) {
    for (const auto& [name, unused] : list.value().items()) {
        const bool records = name == "events.jsonl" || name == "equilibria.csv" || name == witness_records;
        const bool state = name == "start.json" || (name.starts_with("states/eq_") && run_folder.owns(name));
        if (!(of_states ? state : records)) {
            list.at(name.c_str())
                .fail(of_states ? "no file but start.json and states/eq_*.json" : "no file but the records of a run");
        }
    }
}

} // namespace

std::string chained(const std::string& before, const std::string& line) {
    return sha256(before + line);
}

std::optional<CheckedRecords> compare_records(const fs::path& directory) {
    const fs::path path = directory / "checkpoint.json";
    if (!fs::exists(path)) {
        return std::nullopt;
    }
    const std::string whole = read_text(path);
    CheckedRecords found;
    found.checkpoint = json::Field::parse(whole, path.string());
    const json::Field file(found.checkpoint, path.string());
    if (file.at("format").string() != "isostat-checkpoint") {
        file.at("format").fail("\"isostat-checkpoint\"");
    }
    (void)file.at("version").integer(1, 1);
    const auto note = [&found](const std::string& damage) {
        found.damage = found.damage.empty() ? damage : found.damage;
    };
    const std::size_t body = whole.rfind(before_digest);
    note(damage_of(path, sha256(whole.substr(0, body)), file.at("digest").string()));
    if (const std::size_t state = whole.find(before_state); state < body) {
        const std::size_t begin = state + std::string_view(before_state).size();
        found.state = whole.substr(begin, body - begin);
    }
    for (const char* list : {"bytes", "files"}) {
        check_names(file.at(list), std::string_view(list) == "files");
    }
    for (const auto& [name, unused] : file.at("files").value().items()) {
        found.files[name] = file.at("files").at(name.c_str()).string();
        const bool there = fs::exists(directory / name);
        note(damage_of(directory / name, there ? sha256(read_text(directory / name)) : "none, as it is missing",
                       found.files[name]));
    }
    for (const auto& [name, unused] : file.at("bytes").value().items()) {
        const fs::path records = directory / name;
        const long bytes = file.at("bytes").at(name.c_str()).integer();
        const std::string expected = file.at("digests").at(name.c_str()).string();
        const long size = fs::exists(records) ? static_cast<long>(fs::file_size(records)) : -1;
        if (bytes < 0 || size < bytes) {
            note(fmt::format("{}: {} bytes: expected at least {}, the length at the checkpoint: nothing was "
                             "changed; restore the file, or start again with --force",
                             records.string(), size, bytes));
            continue;
        }
        const std::string lines =
            bytes > 0 ? read_text(records).substr(0, static_cast<std::size_t>(bytes)) : std::string();
        const std::string digest = chained_lines(lines);
        note(damage_of(records, digest, expected));
        found.lines[name] = {bytes, digest};
    }
    return found;
}

std::optional<CheckedRecords> check_records(const fs::path& directory) {
    std::optional<CheckedRecords> found = compare_records(directory);
    if (found && !found->damage.empty()) {
        throw Error(ErrorKind::bad_input, found->damage);
    }
    return found;
}

} // namespace isostat
