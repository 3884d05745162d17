#include "linear/solve_schedule.hpp"

#include "core/index.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <numeric>
#include <utility>

namespace isostat {

/// KLU's factors and permutations.
struct SolveSchedule::Parts {
    Lines lower, upper, off_diagonal; ///< L by columns, U and F by rows
    std::vector<int> rows, columns, blocks;

    Parts(klu_symbolic& symbolic, klu_numeric*& numeric)
        : lower(symbolic.n, numeric->lnz), upper(symbolic.n, numeric->unz), off_diagonal(symbolic.n, numeric->nzoff),
          rows(at(symbolic.n)), columns(at(symbolic.n)), blocks(at(symbolic.nblocks) + 1) {
        klu_common common;
        klu_defaults(&common);
        klu_extract(numeric, &symbolic, lower.start.data(), lower.index.data(), lower.value.data(), upper.start.data(),
                    upper.index.data(), upper.value.data(), off_diagonal.start.data(), off_diagonal.index.data(),
                    off_diagonal.value.data(), rows.data(), columns.data(), nullptr, blocks.data(), &common);
        klu_free_numeric(&numeric, &common);
        upper = upper.transposed();
        off_diagonal = off_diagonal.transposed();
        join_small_blocks();
    }

    /// The blocks of rattlers are small and many, and each has a fixed cost. Because [A F; 0 B] with A = L U equals [L
    /// 0; 0 1] [U L^-1 F; 0 B], small blocks are joined to the block that follows.
    void join_small_blocks() {
        constexpr int small = 8;
        std::vector<int> joined{0};
        std::vector<int> first_above(rows.size()); // first line of the small block that a joined row belongs to
        std::iota(first_above.begin(), first_above.end(), 0);
        for (std::size_t b = 1; b < blocks.size(); ++b) {
            if (blocks[b] - blocks[b - 1] > small || b + 1 == blocks.size()) {
                joined.push_back(blocks[b]);
            } else {
                std::fill(first_above.begin() + blocks[b - 1], first_above.begin() + blocks[b], blocks[b - 1]);
            }
        }
        blocks = std::move(joined);
        Lines inside(0, 0);
        Lines outside(0, 0);
        inside.index.reserve(upper.index.size() + off_diagonal.index.size());
        inside.value.reserve(upper.index.size() + off_diagonal.index.size());
        const auto append = [](Lines& to, int index, double value) {
            to.index.push_back(index);
            to.value.push_back(value);
        };
        std::vector<std::size_t> first(rows.size());    // first entry of L^-1 F in each row
        std::vector<std::size_t> place(rows.size(), 0); // position of a column in the current row
        std::size_t block = 1;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            block += static_cast<int>(row) == blocks[block] ? 1 : 0;
            inside.index.insert(inside.index.end(), upper.index.begin() + upper.start[row],
                                upper.index.begin() + upper.start[row + 1]);
            inside.value.insert(inside.value.end(), upper.value.begin() + upper.start[row],
                                upper.value.begin() + upper.start[row + 1]);
            first[row] = inside.index.size();
            for (std::size_t e = at(off_diagonal.start[row]); e < at(off_diagonal.start[row + 1]); ++e) {
                const int column = off_diagonal.index[e];
                if (column < blocks[block]) {
                    place[at(column)] = inside.index.size();
                }
                append(column < blocks[block] ? inside : outside, column, off_diagonal.value[e]);
            }
            for (std::size_t above = at(first_above[row]); above < row; ++above) {
                const double factor = lower.entry(above, static_cast<int>(row));
                for (std::size_t e = first[above]; factor != 0 && e < at(inside.start[above + 1]); ++e) {
                    const int column = inside.index[e];
                    const double change = -factor * inside.value[e];
                    if (place[at(column)] >= first[row]) {
                        inside.value[place[at(column)]] += change;
                    } else {
                        place[at(column)] = inside.index.size();
                        append(inside, column, change);
                    }
                }
            }
            inside.start.push_back(static_cast<int>(inside.index.size()));
            outside.start.push_back(static_cast<int>(outside.index.size()));
        }
        upper = std::move(inside);
        off_diagonal = std::move(outside);
    }
};

SolveSchedule::SolveSchedule(klu_symbolic& symbolic, klu_numeric*& numeric)
    : SolveSchedule(std::make_shared<const Parts>(symbolic, numeric)) {}

SolveSchedule::SolveSchedule(const std::shared_ptr<const Parts>& parts)
    : SolveSchedule(*parts, Future<Triangle>([parts] { return Triangle(parts->lower, parts->blocks, true); })) {}

SolveSchedule::SolveSchedule(const Parts& parts, Future<Triangle> lower)
    : rows_(parts.rows), columns_(parts.columns), upper_(parts.upper, parts.blocks, false), lower_(lower.get()) {
    const Lines& off_diagonal = parts.off_diagonal;
    for (std::size_t b = 0; b + 1 < parts.blocks.size(); ++b) {
        off_diagonal_start_.push_back(off_diagonal_.size());
        for (int k = parts.blocks[b]; k < parts.blocks[b + 1]; ++k) {
            for (int e = off_diagonal.start[at(k)]; e < off_diagonal.start[at(k) + 1]; ++e) {
                off_diagonal_.push_back({k, off_diagonal.index[at(e)], off_diagonal.value[at(e)]});
            }
        }
    }
    off_diagonal_start_.push_back(off_diagonal_.size());
}

namespace {

/// Calls work(x), x = rhs in the order `from` followed by spare unknowns; puts the result back in the order `to`.
template <class Work>
void in_order(std::span<double> rhs, const std::vector<int>& from, const std::vector<int>& to, Work work) {
    const std::size_t n = rhs.size();
    const auto x = std::make_unique_for_overwrite<double[]>(n + Triangle::spare); // NOLINT(*-avoid-c-arrays)
    for (std::size_t k = 0; k < n; ++k) {
        x[k] = rhs[at(from[k])];
    }
    std::fill_n(x.get() + n, Triangle::spare, 0.0);
    work(x.get());
    for (std::size_t k = 0; k < n; ++k) {
        rhs[at(to[k])] = x[k];
    }
}

} // namespace

void SolveSchedule::solve(std::span<double> rhs) const {
    in_order(rhs, rows_, columns_, [this](double* x) {
        for (std::size_t b = off_diagonal_start_.size() - 1; b-- > 0;) {
            for (std::size_t e = off_diagonal_start_[b]; e < off_diagonal_start_[b + 1]; ++e) {
                x[at(off_diagonal_[e].row)] -= off_diagonal_[e].value * x[at(off_diagonal_[e].column)];
            }
            lower_.forwards(b, x);
            upper_.backwards(b, x);
        }
    });
}

void SolveSchedule::solve_transposed(std::span<double> rhs) const {
    in_order(rhs, columns_, rows_, [this](double* x) {
        for (std::size_t b = 0; b + 1 < off_diagonal_start_.size(); ++b) {
            upper_.forwards(b, x);
            lower_.backwards(b, x);
            for (std::size_t e = off_diagonal_start_[b]; e < off_diagonal_start_[b + 1]; ++e) {
                x[at(off_diagonal_[e].column)] -= off_diagonal_[e].value * x[at(off_diagonal_[e].row)];
            }
        }
    });
}

} // namespace isostat
