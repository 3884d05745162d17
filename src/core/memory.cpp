#include "core/memory.hpp"

#include <isostat/core/result.hpp>

#include <gmp.h>
#include <malloc.h>

#include <cstdio>
#include <cstdlib>

namespace isostat {

namespace {

void* or_the_end(void* block) {
    if (block == nullptr) {
        std::fputs("isostat: not enough memory\n", stderr);
        end_at_once(Error(ErrorKind::internal, "").exit_status());
    }
    return block;
}

} // namespace

void say_when_memory_ends() {
    mp_set_memory_functions(
        [](std::size_t size) { return or_the_end(std::malloc(size)); },
        [](void* block, std::size_t, std::size_t size) { return or_the_end(std::realloc(block, size)); },
        [](void* block, std::size_t) { std::free(block); });
}

void end_at_once(int status) {
    std::fflush(nullptr);
    std::_Exit(status);
}

void keep_freed_memory() {
    // 64: cost: larger blocks come from the system; 20: exact: bytes of a MiB
    constexpr int large_block = 64 << 20; // above: from the system, and back to it
    constexpr int kept = 256 << 20;       // cost: memory that is kept for the next use
    (void)mallopt(M_MMAP_THRESHOLD, large_block);
    (void)mallopt(M_TRIM_THRESHOLD, kept);
}

} // namespace isostat
