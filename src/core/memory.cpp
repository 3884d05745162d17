#include "core/memory.hpp"

#include <malloc.h>

namespace isostat {

void keep_freed_memory() {
    constexpr int large_block = 64 << 20; // above: from the system, and back to it
    constexpr int kept = 256 << 20;
    (void)mallopt(M_MMAP_THRESHOLD, large_block);
    (void)mallopt(M_TRIM_THRESHOLD, kept);
}

} // namespace isostat
