#pragma once
/// \file
/// How a program of ours treats the memory it frees.

namespace isostat {

/// Freed memory stays with the process, to be used again: without this, glibc gives the factors of every arc back to
/// the system and asks for them again, a page fault for each 4 kB (3 % of a run with 1936 disks). For programs, at
/// their start; a library does not decide that. No effect on results, nor on peak memory to speak of.
void keep_freed_memory();

/// Without memory GMP and MPFR abort. After this they end the program with a message and the status of an internal
/// failure. For programs, before any number is made.
void say_when_memory_ends();

/// Ends the program at once: at exit, threads of a library that wait for memory would be waited for.
[[noreturn]] void end_at_once(int status);

} // namespace isostat
