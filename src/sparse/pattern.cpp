#include "sparse/pattern.hpp"

#include <btf.h>
#include <klu.h>

#include <algorithm>
#include <cassert>
#include <new>
#include <utility>

namespace isostat::sparse {

Ordering::Ordering(int n, std::span<const int> start, std::span<const int> row) : n_(n) {
    if (n == 0) {
        block_start_ = {0}; // KLU refuses an empty matrix
        return;
    }
    if (row.empty()) {
        return; // KLU refuses null arrays
    }
    klu_common common;
    klu_defaults(&common);
    choose_order(common, n, static_cast<int>(row.size()));
    // KLU's interface is not const-correct; the pattern is only read.
    klu_symbolic* symbolic =
        klu_analyze(n, const_cast<int*>(start.data()), // NOLINT(cppcoreguidelines-pro-type-const-cast)
                    const_cast<int*>(row.data()),      // NOLINT(cppcoreguidelines-pro-type-const-cast)
                    &common);
    if (symbolic == nullptr) {
        assert(common.status != KLU_INVALID); // n < 0, or no arrays: a programming error; otherwise memory is short
        throw std::bad_alloc();
    }
    symbolic_ = std::shared_ptr<void>(symbolic, [](void* pointer) {
        klu_common release;
        klu_defaults(&release);
        auto* typed = static_cast<klu_symbolic*>(pointer);
        klu_free_symbolic(&typed, &release);
    });
    structural_rank_ = symbolic->structural_rank;
    if (structural_rank_ == n) {
        row_order_.assign(symbolic->P, symbolic->P + n);
        column_order_.assign(symbolic->Q, symbolic->Q + n);
        block_start_.assign(symbolic->R, symbolic->R + symbolic->nblocks + 1);
    }
}

std::vector<int> perfect_matching(int n, std::span<const int> start, std::span<const int> row) {
    std::vector<int> matched(static_cast<std::size_t>(n));
    std::vector<int> work(5 * static_cast<std::size_t>(n));
    double operations = 0;
    // BTF's interface is not const-correct; the pattern is only read. The work has no limit.
    const int rank = btf_maxtrans(n, n, const_cast<int*>(start.data()), // NOLINT(cppcoreguidelines-pro-type-const-cast)
                                  const_cast<int*>(row.data()),         // NOLINT(cppcoreguidelines-pro-type-const-cast)
                                  0, &operations, matched.data(), work.data());
    if (rank < n) {
        matched.clear();
    }
    return matched;
}

std::vector<int> repaired_matching(std::vector<int> matched, std::span<const int> start, std::span<const int> row,
                                   int column) {
    const auto free_row = std::ranges::find(matched, column) - matched.begin();
    // Breadth-first search from the column along alternating edges: came_from[r] is the column that reached row r.
    std::vector<int> came_from(matched.size(), -1);
    std::vector<int> row_of(matched.size()); // row of each column in the queue
    std::vector<int> queue{column};
    for (std::size_t k = 0; k < queue.size(); ++k) {
        const int c = queue[k];
        for (int e = start[static_cast<std::size_t>(c)]; e < start[static_cast<std::size_t>(c) + 1]; ++e) {
            const auto r = static_cast<std::size_t>(row[static_cast<std::size_t>(e)]);
            if (came_from[r] >= 0) {
                continue;
            }
            came_from[r] = c;
            if (static_cast<std::ptrdiff_t>(r) != free_row) {
                queue.push_back(matched[r]);
                row_of[static_cast<std::size_t>(matched[r])] = static_cast<int>(r);
                continue;
            }
            // Walks back along the path: each row takes the column that
            // reached it, and this column leaves its old row to the next.
            auto at = r;
            for (int taken = came_from[at]; taken != column; taken = came_from[at]) {
                matched[at] = taken;
                at = static_cast<std::size_t>(row_of[static_cast<std::size_t>(taken)]);
            }
            matched[at] = column;
            return matched;
        }
    }
    return {};
}

std::vector<unsigned char> structural_nonzeros(std::span<const int> start, std::span<const int> row,
                                               const Ordering& ordering, std::span<const int> loaded_rows) {
    const std::size_t n = ordering.row_order().size();
    std::vector<int> matched(n);
    for (std::size_t k = 0; k < n; ++k) {
        matched[static_cast<std::size_t>(ordering.row_order()[k])] = ordering.column_order()[k];
    }
    return structural_nonzeros(start, row, matched, loaded_rows);
}

std::vector<unsigned char> structural_nonzeros(std::span<const int> start, std::span<const int> row,
                                               std::span<const int> matched, std::span<const int> loaded_rows,
                                               std::vector<unsigned char> reached) {
    assert(matched.size() + 1 == start.size());
    std::vector<unsigned char> nonzero = std::move(reached);
    nonzero.resize(matched.size(), 0);
    std::vector<int> queue;
    const auto reach = [&](int r) {
        const int c = matched[static_cast<std::size_t>(r)];
        if (nonzero[static_cast<std::size_t>(c)] == 0) {
            nonzero[static_cast<std::size_t>(c)] = 1;
            queue.push_back(c);
        }
    };
    for (const int r : loaded_rows) {
        reach(r);
    }
    while (!queue.empty()) {
        const auto c = static_cast<std::size_t>(queue.back());
        queue.pop_back();
        for (int e = start[c]; e < start[c + 1]; ++e) {
            reach(row[static_cast<std::size_t>(e)]);
        }
    }
    return nonzero;
}

} // namespace isostat::sparse
