#include "linear/solve_schedule.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <numeric>
#include <utility>

namespace isostat {

namespace {

std::size_t at(int k) {
    return static_cast<std::size_t>(k);
}

/// Two numbers in one register.
using Two = double __attribute__((vector_size(16)));

Two two_at(const double* v) {
    Two two;
    std::memcpy(&two, v, sizeof two);
    return two;
}

/// Sorts by level, then by length, both counted.
class LevelSort {
  public:
    explicit LevelSort(std::size_t n) : level(n), length(n) {}
    std::vector<int> level, length; ///< by line
    void operator()(std::vector<int>& items) {
        by(length, items);
        by(level, items);
    }

  private:
    void by(const std::vector<int>& key, std::vector<int>& items) {
        int most = 0;
        for (const int item : items) {
            most = std::max(most, key[at(item)]);
        }
        count_.assign(at(most) + 2, 0);
        for (const int item : items) {
            ++count_[at(key[at(item)]) + 1];
        }
        std::partial_sum(count_.begin(), count_.end(), count_.begin());
        sorted_.resize(items.size());
        for (const int item : items) {
            sorted_[at(count_[at(key[at(item)])]++)] = item;
        }
        items.swap(sorted_);
    }
    std::vector<int> count_, sorted_;
};

} // namespace

SolveSchedule::Lines::Lines(int lines, int entries) : start(at(lines) + 1), index(at(entries)), value(at(entries)) {}

SolveSchedule::Lines SolveSchedule::Lines::transposed() const {
    const int lines = static_cast<int>(start.size()) - 1;
    Lines t(lines, static_cast<int>(index.size()));
    for (const int i : index) {
        ++t.start[at(i) + 1];
    }
    std::partial_sum(t.start.begin(), t.start.end(), t.start.begin());
    std::vector<int> next(t.start.begin(), t.start.end() - 1);
    for (int j = 0; j < lines; ++j) {
        for (int e = start[at(j)]; e < start[at(j) + 1]; ++e) {
            const std::size_t to = at(next[at(index[at(e)])]++);
            t.index[to] = j;
            t.value[to] = value[at(e)];
        }
    }
    return t;
}

/// What KLU's factors are made of.
struct SolveSchedule::Parts {
    Lines lower, upper, beside; ///< L by columns, U and F by rows
    std::vector<int> rows, columns, blocks;

    Parts(klu_symbolic& symbolic, klu_numeric& numeric)
        : lower(symbolic.n, numeric.lnz), upper(symbolic.n, numeric.unz), beside(symbolic.n, numeric.nzoff),
          rows(at(symbolic.n)), columns(at(symbolic.n)), blocks(at(symbolic.nblocks) + 1) {
        klu_common common;
        klu_defaults(&common);
        klu_extract(&numeric, &symbolic, lower.start.data(), lower.index.data(), lower.value.data(), upper.start.data(),
                    upper.index.data(), upper.value.data(), beside.start.data(), beside.index.data(),
                    beside.value.data(), rows.data(), columns.data(), nullptr, blocks.data(), &common);
        upper = upper.transposed();
        beside = beside.transposed();
    }
};

SolveSchedule::SolveSchedule(klu_symbolic& symbolic, klu_numeric& numeric) : SolveSchedule(Parts(symbolic, numeric)) {}

SolveSchedule::SolveSchedule(Parts parts)
    : rows_(std::move(parts.rows)), columns_(std::move(parts.columns)), lower_(parts.lower, parts.blocks),
      upper_(parts.upper, parts.blocks), scale_(rows_.size(), 0.0) {
    const Lines& upper = parts.upper;
    for (std::size_t k = 0; k < scale_.size(); ++k) {
        const auto begin = upper.index.begin() + upper.start[k];
        const auto end = upper.index.begin() + upper.start[k + 1];
        const auto diagonal = std::find(begin, end, static_cast<int>(k));
        scale_[k] = 1 / (diagonal != end ? upper.value[at(static_cast<int>(diagonal - upper.index.begin()))] : 0.0);
    }
    const Lines& beside = parts.beside;
    for (std::size_t b = 0; b + 1 < parts.blocks.size(); ++b) {
        beside_start_.push_back(beside_.size());
        for (int k = parts.blocks[b]; k < parts.blocks[b + 1]; ++k) {
            for (int e = beside.start[at(k)]; e < beside.start[at(k) + 1]; ++e) {
                beside_.push_back({k, beside.index[at(e)], beside.value[at(e)]});
            }
        }
    }
    beside_start_.push_back(beside_.size());
}

SolveSchedule::Triangle::Triangle(const Lines& lines, const std::vector<int>& blocks) {
    const std::size_t n = lines.start.size() - 1;
    steps_.reserve(n);
    index_.reserve(lines.index.size());
    value_.reserve(lines.index.size() + lines.index.size() / 4 + n);
    std::vector<unsigned char> two(n, 0);
    std::vector<int> seen(n, -1);         // the line where an index was met last
    std::vector<std::size_t> place(n, 0); // of its first value
    LevelSort sort(n);
    std::vector<int> items;
    const auto entries = [&](int line, auto visit) {
        for (int e = lines.start[at(line)]; e < lines.start[at(line) + 1]; ++e) {
            if (lines.index[at(e)] != line) {
                visit(lines.index[at(e)], lines.value[at(e)]);
            }
        }
    };
    for (std::size_t b = 0; b + 1 < blocks.size(); ++b) {
        block_.push_back({steps_.size(), index_.size(), value_.size()});
        const int end = blocks[b + 1];
        items.clear();
        // Two lines are one step when that leaves out more entries than it fills.
        for (int line = blocks[b]; line < end; line += 1 + two[at(line)]) {
            int own = 0;
            entries(line, [&](int i, double) {
                seen[at(i)] = line;
                own += i != line + 1 ? 1 : 0;
            });
            int common = 0;
            int next = 0;
            if (line + 1 < end) {
                entries(line + 1, [&](int i, double) {
                    common += seen[at(i)] == line ? 1 : 0;
                    ++next;
                });
            }
            const int both = own + next - common;
            two[at(line)] = line + 1 < end && 7 * both < 5 * (own + next) ? 1 : 0;
            const int last = line + two[at(line)];
            const int level = std::max(sort.level[at(line)], sort.level[at(last)]);
            sort.level[at(line)] = level;
            sort.length[at(line)] = 2 * (last > line ? both : own) + two[at(line)];
            for (int k = line; k <= last; ++k) {
                entries(k, [&](int i, double) {
                    if (i > last) {
                        sort.level[at(i)] = std::max(sort.level[at(i)], level + 1);
                    }
                });
            }
            items.push_back(line);
        }
        sort(items);
        for (const int line : items) {
            const std::size_t first = index_.size();
            if (two[at(line)] == 0) {
                entries(line, [&](int i, double v) {
                    index_.push_back(i);
                    value_.push_back(v);
                });
            } else {
                const std::size_t link = value_.size();
                value_.push_back(0);
                entries(line, [&](int i, double v) {
                    if (i == line + 1) {
                        value_[link] = v;
                        return;
                    }
                    place[at(i)] = value_.size();
                    index_.push_back(i);
                    value_.push_back(v);
                    value_.push_back(0);
                });
                entries(line + 1, [&](int i, double v) {
                    if (place[at(i)] > link) {
                        value_[place[at(i)] + 1] = v;
                    } else {
                        index_.push_back(i);
                        value_.push_back(0);
                        value_.push_back(v);
                    }
                });
            }
            steps_.push_back({line, static_cast<int>(index_.size() - first), two[at(line)] != 0});
        }
    }
    block_.push_back({steps_.size(), index_.size(), value_.size()});
}

template <bool unit> void SolveSchedule::Triangle::forwards(std::size_t b, const double* scale, double* x) const {
    const int* i = index_.data() + block_[b].index;
    const double* v = value_.data() + block_[b].value;
    for (std::size_t s = block_[b].step; s < block_[b + 1].step; ++s) {
        const Step step = steps_[s];
        const int* const stop = i + step.entries;
        const std::size_t line = at(step.line);
        const double first = unit ? x[line] : x[line] * scale[line];
        x[line] = first;
        if (step.two) {
            const double rest = x[line + 1] - *v++ * first;
            const double second = unit ? rest : rest * scale[line + 1];
            x[line + 1] = second;
            for (; i != stop; ++i, v += 2) {
                x[*i] -= v[0] * first + v[1] * second;
            }
        } else {
            for (; i != stop; ++i, ++v) {
                x[*i] -= *v * first;
            }
        }
    }
}

template <bool unit> void SolveSchedule::Triangle::backwards(std::size_t b, const double* scale, double* x) const {
    const int* i = index_.data() + block_[b + 1].index;
    const double* v = value_.data() + block_[b + 1].value;
    for (std::size_t s = block_[b + 1].step; s-- > block_[b].step;) {
        const Step step = steps_[s];
        const int* const stop = i - step.entries;
        const std::size_t line = at(step.line);
        if (step.two) {
            Two even{};
            Two odd{};
            for (; i - stop >= 2; i -= 2, v -= 4) {
                even += two_at(v - 2) * x[i[-1]];
                odd += two_at(v - 4) * x[i[-2]];
            }
            if (i != stop) {
                v -= 2;
                even += two_at(v) * x[*--i];
            }
            even += odd;
            const double link = *--v;
            double second = x[line + 1] - even[1];
            second = unit ? second : second * scale[line + 1];
            x[line + 1] = second;
            const double first = x[line] - even[0] - link * second;
            x[line] = unit ? first : first * scale[line];
        } else {
            double even = 0;
            double odd = 0;
            for (; i - stop >= 2; i -= 2, v -= 2) {
                even += v[-1] * x[i[-1]];
                odd += v[-2] * x[i[-2]];
            }
            if (i != stop) {
                even += *--v * x[*--i];
            }
            const double first = x[line] - (even + odd);
            x[line] = unit ? first : first * scale[line];
        }
    }
}

void SolveSchedule::solve(std::span<double> rhs) const {
    const auto x = std::make_unique_for_overwrite<double[]>(rhs.size()); // NOLINT(*-avoid-c-arrays)
    for (std::size_t k = 0; k < rhs.size(); ++k) {
        x[k] = rhs[at(rows_[k])];
    }
    for (std::size_t b = beside_start_.size() - 1; b-- > 0;) {
        for (std::size_t e = beside_start_[b]; e < beside_start_[b + 1]; ++e) {
            x[at(beside_[e].row)] -= beside_[e].value * x[at(beside_[e].column)];
        }
        lower_.forwards<true>(b, nullptr, x.get());
        upper_.backwards<false>(b, scale_.data(), x.get());
    }
    for (std::size_t k = 0; k < rhs.size(); ++k) {
        rhs[at(columns_[k])] = x[k];
    }
}

void SolveSchedule::solve_transposed(std::span<double> rhs) const {
    const auto x = std::make_unique_for_overwrite<double[]>(rhs.size()); // NOLINT(*-avoid-c-arrays)
    for (std::size_t k = 0; k < rhs.size(); ++k) {
        x[k] = rhs[at(columns_[k])];
    }
    for (std::size_t b = 0; b + 1 < beside_start_.size(); ++b) {
        upper_.forwards<false>(b, scale_.data(), x.get());
        lower_.backwards<true>(b, nullptr, x.get());
        for (std::size_t e = beside_start_[b]; e < beside_start_[b + 1]; ++e) {
            x[at(beside_[e].column)] -= beside_[e].value * x[at(beside_[e].row)];
        }
    }
    for (std::size_t k = 0; k < rhs.size(); ++k) {
        rhs[at(rows_[k])] = x[k];
    }
}

} // namespace isostat
