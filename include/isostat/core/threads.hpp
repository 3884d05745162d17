#pragma once
/// \file
/// Several cores for independent pieces of work. The number of threads decides who computes a piece, never what the
/// pieces are nor the order in which their results are put together: results have the same bits for any number.

#include <cstddef>
#include <functional>

namespace isostat {

/// Threads of this process for `parallel_pieces`, the calling one included. \pre count >= 1. Not while work is going
/// on. Before the first call: 1, so that a library does not start threads unasked.
void set_threads(int count);

/// What `set_threads` asked for.
int threads();

/// Cores that this process may use (its affinity mask), at least 1.
int available_cores();

/// work(0), ..., work(pieces - 1), each exactly once, in any order and on any thread; returns when all are done. The
/// pieces must not touch each other's results. An exception of a piece is thrown again here, after the others have
/// ended (that of the lowest piece that threw; later ones may not have been begun). Called from within a piece, or
/// while another thread's call is under way, it does all the work itself. Cost beyond the work: none with one thread or
/// one piece, else about a microsecond; the threads wait busily for some 50 microseconds after a call, then sleep.
void parallel_pieces(std::size_t pieces, const std::function<void(std::size_t)>& work);

/// Number of pieces of at most `size` items each, and the bounds of one: [first, last).
struct Pieces {
    std::size_t items = 0;
    std::size_t size = 1;
    [[nodiscard]] std::size_t count() const { return (items + size - 1) / size; }
    [[nodiscard]] std::size_t first(std::size_t piece) const { return piece * size; }
    [[nodiscard]] std::size_t last(std::size_t piece) const {
        const std::size_t end = (piece + 1) * size;
        return end < items ? end : items;
    }
};

} // namespace isostat
