#include "io/descriptor.hpp"

#include "core/refuse.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace isostat {

Descriptor Descriptor::open(const std::filesystem::path& path, int flags) {
    constexpr mode_t mode = 0666;
    Descriptor file(::open(path.c_str(), flags | O_CLOEXEC, mode), path); // NOLINT(cppcoreguidelines-pro-type-vararg)
    if (file.fd_ < 0) {
        file.fail();
    }
    return file;
}

std::optional<Descriptor> Descriptor::make(const std::filesystem::path& path) {
    constexpr mode_t mode = 0666;
    Descriptor file(::open(path.c_str(), // NOLINT(cppcoreguidelines-pro-type-vararg)
                           O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode),
                    path);
    if (file.fd_ < 0) {
        if (errno == EEXIST) {
            return {};
        }
        file.fail();
    }
    return file;
}

Descriptor::~Descriptor() {
    if (fd_ >= 0) {
        ::close(fd_);
    }
}

Descriptor::Descriptor(Descriptor&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), path_(std::move(other.path_)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    std::swap(path_, other.path_);
    return *this;
}

void Descriptor::write(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(fd_, text.data(), text.size());
        if (written < 0) {
            if (errno == EINTR) {
                continue; // a signal that only sets the stop flag must not lose a record
            }
            fail();
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void Descriptor::sync() {
    // EINVAL, ENOTSUP: pipes and some special files cannot be synchronised, and need not be.
    if (::fsync(fd_) != 0 && errno != EINVAL && errno != ENOTSUP) {
        fail();
    }
}

long Descriptor::size() const {
    struct stat status {};
    if (::fstat(fd_, &status) != 0) {
        fail();
    }
    return static_cast<long>(status.st_size);
}

void Descriptor::truncate(long bytes) {
    if (::ftruncate(fd_, bytes) != 0) {
        fail();
    }
}

bool Descriptor::try_lock() {
    if (::flock(fd_, LOCK_EX | LOCK_NB) == 0) {
        return true;
    }
    if (errno == EWOULDBLOCK) {
        return false;
    }
    fail();
}

void Descriptor::fail() const {
    refuse(ErrorKind::cannot_write, "{}: cannot write: {}", path_.string(), std::strerror(errno));
}

} // namespace isostat
