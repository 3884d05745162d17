#include "io/files.hpp"

#include "io/descriptor.hpp"

#include <isostat/core/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

namespace isostat {

namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& path, int error) {
    throw Error(ErrorKind::cannot_write, fmt::format("{}: cannot write: {}", path.string(), std::strerror(error)));
}

/// The entry of a renamed file is on the disk only when its directory is. Best effort: some file systems refuse it.
void sync_directory_of(const std::filesystem::path& path) {
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    const int fd =
        ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); // NOLINT(cppcoreguidelines-pro-type-vararg)
    if (fd >= 0) {
        ::fsync(fd);
        ::close(fd);
    }
}

} // namespace

std::string read_text(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: is a directory: expected a file", path.string()));
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
    }
    std::ostringstream text;
    text << file.rdbuf();
    if (file.bad()) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: cannot read to its end", path.string()));
    }
    if (without_byte_order_mark(text.view()).find_first_not_of(" \t\r\n") == std::string_view::npos) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: is empty", path.string()));
    }
    return text.str();
}

std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

void write_atomically(const std::filesystem::path& path, const std::string& text) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_directory(status)) {
        cannot_write(path, EISDIR);
    }
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        Descriptor::open(path, O_WRONLY).write(text); // a pipe or a terminal: there is nothing to replace
        return;
    }
    if (std::filesystem::is_symlink(path, ignored)) {
        const std::filesystem::path target = std::filesystem::weakly_canonical(path, ignored);
        if (!target.empty() && target != path) {
            write_atomically(target, text); // keep the link, replace what it names
            return;
        }
    }
    const std::filesystem::path part = path.string() + ".part";
    try {
        Descriptor file = Descriptor::open(part, O_WRONLY | O_CREAT | O_TRUNC);
        file.write(text);
        file.sync();
    } catch (const Error&) {
        ::unlink(part.c_str());
        throw;
    }
    if (std::rename(part.c_str(), path.c_str()) != 0) {
        const int error = errno;
        ::unlink(part.c_str());
        cannot_write(path, error);
    }
    sync_directory_of(path);
}

bool holds_only_a_lock(const std::filesystem::path& first) {
    namespace fs = std::filesystem;
    const fs::path folder = first.parent_path();
    return fs::exists(folder / "lock") &&
           std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), [&](const fs::directory_entry& e) {
               const fs::path name = e.path().filename();
               return name == "lock" || name == first.filename().string() + ".part" ||
                      (e.is_directory() && fs::is_empty(e.path()));
           });
}

void make_directory(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error || !std::filesystem::is_directory(path)) {
        cannot_write(path, error ? error.value() : ENOTDIR);
    }
}

} // namespace isostat
