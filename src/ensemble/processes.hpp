#pragma once
/// \file
/// Samples as processes of their own: what one of them does to itself (crash, no memory, exit) it does to no other.

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
    int signal = 0; ///< otherwise: what killed it; -1 when it could not be started (status: errno)
};

/// Takes numbers from the queue and runs command_of(number) for each (none: nothing to do, it is done), at most `jobs`
/// at a time, until there are no more or `stop` is set; then the running ones get SIGTERM once and are waited for.
/// Every process has a process group of its own (Ctrl-C reaches only the caller) and gets SIGTERM when the caller dies
/// in any way. `on_start` and `on_end` are called from this thread. Throws nothing of its own.
void run_processes(SampleQueue& queue, int jobs, const std::atomic<bool>& stop,
                   const std::function<std::optional<Command>(std::size_t)>& command_of,
                   const std::function<void(std::size_t)>& on_start,
                   const std::function<void(std::size_t, const ProcessEnd&)>& on_end,
                   const std::function<void()>& on_wait);

} // namespace isostat
