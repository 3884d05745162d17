#pragma once
/// \file
/// How a program treats memory that it frees or cannot get.

namespace isostat {

/// Keeps freed memory in the process for reuse: without this, glibc returns the factors of every arc to the system and
/// asks for them again, a page fault for each 4 kB (3 % of a run with 1936 disks). For programs, at their start; a
/// library does not decide this. Has no effect on results, and hardly any on peak memory.
void keep_freed_memory();

/// When memory ends, GMP and MPFR abort. After this call they end the program with a message and the status of an
/// internal failure instead. For programs, before any number is made.
void say_when_memory_ends();

/// Ends the program at once, because a normal exit would wait for threads that wait for memory.
[[noreturn]] void end_at_once(int status);

} // namespace isostat
