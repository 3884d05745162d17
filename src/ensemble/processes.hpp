#pragma once
/// \file
/// Samples as separate processes, so that a crash, lack of memory or exit of one has no effect on another.

#include "ensemble/sample_queue.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace isostat {

/// One program to run.
struct Command {
    std::filesystem::path program;
    std::vector<std::string> arguments; ///< without the name of the program
    std::filesystem::path log;          ///< receives standard output and standard error
};

/// How a process ended.
struct ProcessEnd {
    int status = 0; ///< exit status, when it ended by itself
    int signal = 0; ///< otherwise: the signal that ended it; -1 when it could not be started (status: errno)
};

/// Takes numbers from the queue and runs command_of(number) for each (nothing: the sample is done), at most `jobs` at a
/// time, until there are no more or `stop` is set; then the running processes get SIGTERM once and are waited for.
/// Every process has its own process group (Ctrl-C reaches only the caller) and gets SIGTERM when the caller dies in
/// any way. `on_start` and `on_end` are called from this thread. Throws nothing of its own.
void run_processes(SampleQueue& queue, int jobs, const std::atomic<bool>& stop,
                   const std::function<std::optional<Command>(std::size_t)>& command_of,
                   const std::function<void(std::size_t)>& on_start,
                   const std::function<void(std::size_t, const ProcessEnd&)>& on_end,
                   const std::function<void()>& on_wait);

} // namespace isostat
