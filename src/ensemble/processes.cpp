#include "ensemble/processes.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <map>
#include <thread>

namespace isostat {

namespace {

constexpr int not_started = 127; // exit status, as in shells, of a child whose program could not be started

/// The child between fork and exec, with only calls that are safe there.
[[noreturn]] void become(const char* program, char* const* arguments, int log, pid_t parent) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) {
        ::_exit(not_started); // the parent died before prctl
    }
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    const int null = ::open("/dev/null", O_RDONLY);
    ::dup2(null, STDIN_FILENO);
    ::execv(program, arguments);
    ::_exit(not_started);
}

pid_t start(const Command& command) {
    std::vector<std::string> words{command.program.filename().string()};
    words.insert(words.end(), command.arguments.begin(), command.arguments.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    constexpr mode_t mode = 0666;
    const int log = ::open(command.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, mode);
    if (log < 0) {
        return -1;
    }
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0) {
        become(command.program.c_str(), pointers.data(), log, parent);
    }
    const int error = errno;
    ::close(log);
    errno = error;
    return child;
}

/// Id of the child when it has ended; 0: still running.
pid_t ended(ProcessEnd& ending, pid_t which) {
    int status = 0;
    const pid_t pid = ::waitpid(which, &status, WNOHANG);
    if (pid > 0) {
        ending = WIFEXITED(status) ? ProcessEnd{WEXITSTATUS(status), 0} : ProcessEnd{0, WTERMSIG(status)};
    }
    return pid;
}

} // namespace

void run_processes(SampleQueue& queue, int jobs, const std::atomic<bool>& stop,
                   const std::function<std::optional<Command>(std::size_t)>& command_of,
                   const std::function<void(std::size_t)>& on_start,
                   const std::function<void(std::size_t, const ProcessEnd&)>& on_end,
                   const std::function<void()>& on_wait) {
    assert(jobs >= 1);
    constexpr auto pause = std::chrono::milliseconds(5);
    std::map<pid_t, std::size_t> running;
    bool more = true;
    bool told = false;
    while (more || !running.empty()) {
        if (stop && !told) {
            told = true;
            more = false;
            queue.stop();
            for (const auto& [pid, number] : running) {
                ::kill(pid, SIGTERM);
            }
        }
        while (more && running.size() < static_cast<std::size_t>(jobs)) {
            const auto number = queue.next();
            if (!number) {
                more = false;
                break;
            }
            const auto command = command_of(*number);
            if (!command) {
                queue.done(*number);
                continue;
            }
            on_start(*number);
            const pid_t pid = start(*command);
            if (pid < 0) {
                on_end(*number, ProcessEnd{errno, -1});
                queue.done(*number);
            } else {
                running.emplace(pid, *number);
            }
        }
        for (auto entry = running.begin(); entry != running.end();) {
            ProcessEnd ending;
            const pid_t pid = ended(ending, entry->first);
            if (pid == 0) {
                ++entry;
                continue;
            }
            on_end(entry->second, ending);
            queue.done(entry->second);
            entry = running.erase(entry);
        }
        queue.idle();
        on_wait();
        if (!running.empty()) {
            std::this_thread::sleep_for(pause);
        }
    }
}

} // namespace isostat
