#pragma once
// The real program in the background, to be killed or stopped.

#include "support/scratch.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <thread>

extern char** environ; // NOLINT(readability-redundant-declaration)

namespace program {

/// A program that runs by itself.
class Background {
  public:
    explicit Background(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), ISOSTAT_PROGRAM);
        std::vector<char*> pointers;
        for (std::string& argument : arguments) {
            pointers.push_back(argument.data());
        }
        pointers.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        for (const int fd : {1, 2}) {
            posix_spawn_file_actions_addopen(&actions, fd, "/dev/null", O_WRONLY, 0);
        }
        BOOST_REQUIRE(::posix_spawn(&pid_, pointers[0], &actions, nullptr, pointers.data(), environ) == 0);
        posix_spawn_file_actions_destroy(&actions);
    }
    /// Sends a signal as soon as the file has so many lines; false when the program ended before.
    bool signal_at(const std::filesystem::path& file, long lines, int signal) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(10);
        while (std::chrono::steady_clock::now() < deadline) {
            const std::string text = scratch::read(file);
            if (std::ranges::count(text, '\n') >= lines) {
                return ::kill(pid_, signal) == 0;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        ::kill(pid_, SIGKILL);
        return false;
    }
    [[nodiscard]] pid_t pid() const { return pid_; }
    int wait() {
        int status = 0;
        ::waitpid(pid_, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

  private:
    pid_t pid_ = 0;
};

} // namespace program
