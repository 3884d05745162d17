#pragma once
/// \file
/// A file descriptor that closes itself: what the standard streams do not give (append, truncate, fsync, lock).

#include <filesystem>
#include <optional>
#include <string_view>

namespace isostat {

/// Owns one open file. Every failure throws `Error(cannot_write)` with the file and the system's reason.
class Descriptor {
  public:
    Descriptor() = default;
    /// `flags` as for open(2); new files get mode 0666 under the user's mask.
    static Descriptor open(const std::filesystem::path& path, int flags);
    /// A new file to write; nothing when there is something of that name, a link too.
    static std::optional<Descriptor> make(const std::filesystem::path& path);
    ~Descriptor();
    Descriptor(Descriptor&& other) noexcept;
    Descriptor& operator=(Descriptor&& other) noexcept;
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    /// All of `text` in the kernel's hands when it returns: a later kill of this process loses nothing of it.
    void write(std::string_view text);
    /// On the disk when it returns: survives a power cut.
    void sync();
    /// Length in bytes.
    [[nodiscard]] long size() const;
    void truncate(long bytes);
    /// Exclusive advisory lock, released by the kernel when the process ends in any way. False when another process
    /// holds it.
    [[nodiscard]] bool try_lock();

  private:
    Descriptor(int fd, std::filesystem::path path) : fd_(fd), path_(std::move(path)) {}
    [[noreturn]] void fail() const;
    int fd_ = -1;
    std::filesystem::path path_;
};

} // namespace isostat
