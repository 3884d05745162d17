#pragma once
/// \file
/// Ctrl-C and SIGTERM.

#include <atomic>

namespace isostat::cli {

/// From now on SIGINT and SIGTERM set a flag: the work stops at its next safe point and leaves valid files. A second
/// signal ends the program at once (files are still valid up to the last record). Only for commands that test the flag:
/// the others end at the first signal.
void catch_interrupts();

/// From now on SIGINT and SIGTERM end the program as usual, after a line. For long commands without a safe point, which
/// write their files as a whole or not at all.
void end_at_interrupts();

/// At a limit of the file size writing fails with its message, instead of a signal.
void ignore_file_size_signals();

/// The flag, for options that take one.
const std::atomic<bool>& stop_flag();

} // namespace isostat::cli
