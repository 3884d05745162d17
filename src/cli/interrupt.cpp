#include "cli/terminal.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace isostat::cli {

namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

extern "C" void on_signal(int signal) {
    if (stop.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

} // namespace

void catch_interrupts() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
}

void end_at_interrupts() {
    for (const int signal : {SIGINT, SIGTERM}) {
        std::signal(signal, [](int number) {
            constexpr std::string_view words = "\nisostat: stopped\n";
            const auto written [[maybe_unused]] = ::write(STDERR_FILENO, words.data(), words.size());
            std::signal(number, SIG_DFL);
            std::raise(number);
        });
    }
}

void ignore_file_size_signals() {
    std::signal(SIGXFSZ, SIG_IGN);
}

const std::atomic<bool>& stop_flag() {
    return stop;
}

} // namespace isostat::cli
