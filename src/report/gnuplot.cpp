#include "report/charts.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

extern char** environ; // NOLINT(readability-redundant-declaration)

namespace isostat {

std::string run_gnuplot(const std::filesystem::path& folder, const std::string& script) {
    const std::string log = script + ".log";
    std::string program = "gnuplot";
    std::string argument = script;
    const std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    constexpr mode_t mode = 0666;
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW,
                                     mode);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t pid = 0;
    const int error = ::posix_spawnp(&pid, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        std::error_code ignored;
        std::filesystem::remove(folder / log, ignored);
        return fmt::format(
            "gnuplot cannot be started ({}): the charts are missing, their data and scripts are in {} (Debian package "
            "gnuplot-nox; then `isostat report` again)",
            std::strerror(error), folder.string());
    }
    int status = 0;
    while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        std::error_code ignored;
        std::filesystem::remove(folder / log, ignored);
        return {};
    }
    return fmt::format("gnuplot {} failed: see {}", script, (folder / log).string());
}

} // namespace isostat
