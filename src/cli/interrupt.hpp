#pragma once
/// \file
/// Ctrl-C and SIGTERM.

#include <atomic>

namespace isostat::cli {

/// From now on SIGINT and SIGTERM set a flag: the work stops at its next safe point and leaves valid files. A second
/// one ends the program at once (files are still valid up to the last record).
void catch_interrupts();

/// The flag, for the options that take one.
const std::atomic<bool>& stop_flag();

} // namespace isostat::cli
