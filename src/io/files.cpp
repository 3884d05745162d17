#include "io/files.hpp"

#include "core/refuse.hpp"
#include "io/descriptor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <utility>
#include <vector>

namespace isostat {

namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& path, int error) {
    refuse(ErrorKind::cannot_write, "{}: cannot write: {}", path.string(), std::strerror(error));
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

constexpr std::string_view part_suffix = ".part";

/// A new file beside `path`, under a name that nobody has.
std::pair<std::filesystem::path, Descriptor> temporary_beside(const std::filesystem::path& path) {
    std::random_device random;
    for (;;) {
        const std::uint64_t number = (std::uint64_t{random()} << 32U) | random();
        const std::filesystem::path part = fmt::format("{}.{:016x}{}", path.string(), number, part_suffix);
        if (auto file = Descriptor::make(part)) {
            return {part, std::move(*file)};
        }
    }
}

} // namespace

std::string read_packed_text(const std::filesystem::path& path) {
    std::string packed = read_text(path);
    if (!packed.starts_with("\x1f\x8b")) {
        return packed;
    }
    constexpr int gzip = 16 + MAX_WBITS;
    constexpr std::size_t most = std::size_t{1} << 32U;
    std::string text;
    std::vector<char> part(std::size_t{1} << 16U);
    z_stream stream{};
    bool sound = ::inflateInit2(&stream, gzip) == Z_OK;
    int status = Z_OK;
    for (std::size_t at = 0; sound && (at < packed.size() || status != Z_STREAM_END) && text.size() <= most;) {
        if (status == Z_STREAM_END) { // files that were joined
            ::inflateReset(&stream);
        }
        const std::size_t there = std::min<std::size_t>(packed.size() - at, std::size_t{1} << 30U);
        // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): the library wants its own names of bytes
        stream.next_in = reinterpret_cast<Bytef*>(packed.data() + at);
        stream.next_out = reinterpret_cast<Bytef*>(part.data());
        // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
        stream.avail_in = static_cast<uInt>(there);
        stream.avail_out = static_cast<uInt>(part.size());
        status = ::inflate(&stream, Z_NO_FLUSH);
        at += there - stream.avail_in;
        text.append(part.data(), part.size() - stream.avail_out);
        sound = status == Z_OK || status == Z_STREAM_END;
    }
    ::inflateEnd(&stream);
    if (!sound || text.size() > most) {
        refuse(path.string(), "is packed with gzip and {}",
               sound ? "larger than 4 GiB: unpack it" : "damaged or cut: expected all of it");
    }
    return text;
}

std::string read_text(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        refuse(path.string(), "is a directory: expected a file");
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        refuse(path.string(), "cannot read: {}", std::strerror(errno));
    }
    std::ostringstream text;
    text << file.rdbuf();
    if (file.bad()) {
        refuse(path.string(), "cannot read to its end");
    }
    if (without_byte_order_mark(text.view()).find_first_not_of(" \t\r\n") == std::string_view::npos) {
        refuse(path.string(), "is empty");
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
    auto [part, file] = temporary_beside(path);
    try {
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

std::string name_of_temporary(const std::string& name) {
    constexpr std::size_t digits = 16;
    if (!name.ends_with(part_suffix)) {
        return {};
    }
    const std::string whole = name.substr(0, name.size() - part_suffix.size());
    const std::size_t dot = whole.size() > digits ? whole.size() - digits - 1 : std::string::npos;
    const bool unique = dot != std::string::npos && whole[dot] == '.' &&
                        whole.find_first_not_of("0123456789abcdef", dot + 1) == std::string::npos;
    return unique ? whole.substr(0, dot) : whole;
}

bool is_marked(const std::filesystem::path& path, const std::string& text) {
    std::array<char, 300> first{};
    std::ifstream file(path, std::ios::binary);
    file.read(first.data(), first.size());
    return std::string_view(first.data(), static_cast<std::size_t>(file.gcount())).find(text) != std::string_view::npos;
}

void check_output(const std::filesystem::path& path, const std::string& mark,
                  std::initializer_list<std::filesystem::path> inputs) {
    std::error_code absent;
    if (!std::filesystem::is_regular_file(path, absent)) { // a pipe or a terminal is not replaced
        return;
    }
    for (const std::filesystem::path& input : inputs) {
        if (std::filesystem::equivalent(path, input, absent)) {
            refuse(ErrorKind::usage, "{}: is the input {}: expected another name to write to", path.string(),
                   input.string());
        }
    }
    if (std::filesystem::file_size(path) > 0 && !is_marked(path, mark)) {
        refuse(ErrorKind::usage, "{}: exists and holds something else than what would be written: expected a new name",
               path.string());
    }
}

void write_output(const std::filesystem::path& path, const std::string& text, const std::string& mark) {
    check_output(path, mark);
    write_atomically(path, text);
}

void check_directory_of(const std::filesystem::path& path) {
    ::unlink(temporary_beside(path).first.c_str());
}

void make_directory(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error || !std::filesystem::is_directory(path)) {
        cannot_write(path, error ? error.value() : ENOTDIR);
    }
}

} // namespace isostat
