/* Counts allocations of an unchanged program: LD_PRELOAD this library; the counts go to the file $ISOSTAT_ALLOCATIONS at exit. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

static atomic_long calls, bytes;

static void* next(const char* name) { return dlsym(RTLD_NEXT, name); }

void* malloc(size_t size) {
    static void* (*real)(size_t);
    if (!real) real = (void* (*)(size_t))next("malloc");
    calls++;
    bytes += (long)size;
    return real(size);
}

void* realloc(void* block, size_t size) {
    static void* (*real)(void*, size_t);
    if (!real) real = (void* (*)(void*, size_t))next("realloc");
    calls++;
    bytes += (long)size;
    return real(block, size);
}

__attribute__((destructor)) static void report(void) {
    const char* name = getenv("ISOSTAT_ALLOCATIONS");
    FILE* file = name ? fopen(name, "w") : NULL;
    if (file) {
        fprintf(file, "%ld %ld\n", (long)calls, (long)bytes);
        fclose(file);
    }
}
