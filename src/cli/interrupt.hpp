#pragma once
/// \file
/// Ctrl-C and SIGTERM.

#include <atomic>

namespace isostat::cli {

/// From now on SIGINT and SIGTERM set a flag: the work stops at its next safe point and leaves valid files. A second
/// one ends the program at once (files are still valid up to the last record). Only for commands that look at the flag:
/// the others end at the first one.
void catch_interrupts();

/// From now on SIGINT and SIGTERM end the program as they do, with a line. For long commands without a safe
/// point: what they write is there as a whole or not at all.
void end_at_interrupts();

/// A limit of the file size is a failed write, with its message.
void ignore_file_size_signals();

/// The flag, for the options that take one.
const std::atomic<bool>& stop_flag();

} // namespace isostat::cli
