#include "linear/solve_schedule.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace isostat {

namespace {

std::size_t at(int k) {
    return static_cast<std::size_t>(k);
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

SolveSchedule::SolveSchedule(klu_symbolic& symbolic, klu_numeric& numeric)
    : rows_(at(symbolic.n)), columns_(at(symbolic.n)) {
    Lines lower(symbolic.n, numeric.lnz);
    Lines upper(symbolic.n, numeric.unz);
    Lines beside(symbolic.n, numeric.nzoff);
    std::vector<int> blocks(at(symbolic.nblocks) + 1);
    klu_common common;
    klu_defaults(&common);
    klu_extract(&numeric, &symbolic, lower.start.data(), lower.index.data(), lower.value.data(), upper.start.data(),
                upper.index.data(), upper.value.data(), beside.start.data(), beside.index.data(), beside.value.data(),
                rows_.data(), columns_.data(), nullptr, blocks.data(), &common);
    // A^T = (U^T L^T + F^T, permuted): lines are columns. U^T x = b goes up the lines, L^T x = b down.
    transposed_ = make(upper, lower, beside, blocks, true);
    matrix_ = make(lower.transposed(), upper.transposed(), beside.transposed(), blocks, false);
}

SolveSchedule::Program SolveSchedule::make(const Lines& first, const Lines& second, const Lines& beside,
                                           const std::vector<int>& blocks, bool upwards) {
    const std::size_t n = first.start.size() - 1;
    Program program;
    program.steps.reserve(2 * n);
    const std::size_t entries = first.index.size() + second.index.size() + beside.index.size();
    program.index.resize(entries);
    program.value.resize(entries);
    std::size_t end = 0;
    LevelSort sort(n);
    std::vector<int> items;
    const auto triangle = [&](const Lines& factor, const Lines* others, int from, int to) {
        items.resize(at(to - from));
        for (int k = 0; k < to - from; ++k) {
            const int j = others != nullptr ? from + k : to - 1 - k; // a line after those it depends on
            int deepest = 0;
            for (int e = factor.start[at(j)]; e < factor.start[at(j) + 1]; ++e) {
                const int i = factor.index[at(e)];
                if (i != j) {
                    deepest = std::max(deepest, sort.level[at(i)] + 1);
                }
            }
            sort.level[at(j)] = deepest;
            sort.length[at(j)] = factor.start[at(j) + 1] - factor.start[at(j)] +
                                 (others != nullptr ? others->start[at(j) + 1] - others->start[at(j)] : 0);
            items[at(k)] = j;
        }
        if (items.size() > 1) {
            sort(items);
        }
        for (const int j : items) {
            double diagonal = 1;
            for (int e = factor.start[at(j)]; e < factor.start[at(j) + 1]; ++e) {
                if (factor.index[at(e)] == j) {
                    diagonal = factor.value[at(e)];
                } else {
                    program.index[end] = factor.index[at(e)];
                    program.value[end++] = factor.value[at(e)];
                }
            }
            for (int e = others != nullptr ? others->start[at(j)] : 0;
                 others != nullptr && e < others->start[at(j) + 1]; ++e) {
                program.index[end] = others->index[at(e)];
                program.value[end++] = others->value[at(e)];
            }
            program.steps.push_back({j, static_cast<int>(end), 1 / diagonal});
        }
    };
    const std::size_t count = blocks.size() - 1;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t b = upwards ? k : count - 1 - k;
        triangle(first, &beside, blocks[b], blocks[b + 1]);
        triangle(second, nullptr, blocks[b], blocks[b + 1]);
    }
    return program;
}

void SolveSchedule::Program::run(std::span<double> rhs, const std::vector<int>& in, const std::vector<int>& out) const {
    std::vector<double> x(in.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] = rhs[at(in[k])];
    }
    double* const solution = x.data();
    const double* v = value.data();
    const int* i = index.data();
    const int* const begin = i;
    for (const Step& step : steps) {
        const int* const stop = begin + step.end;
        double even = 0;
        double odd = 0;
        for (; stop - i >= 2; i += 2, v += 2) {
            even += v[0] * solution[i[0]];
            odd += v[1] * solution[i[1]];
        }
        if (i != stop) {
            even += *v++ * solution[*i++];
        }
        solution[step.target] = (solution[step.target] - (even + odd)) * step.scale;
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
        rhs[at(out[k])] = x[k];
    }
}

} // namespace isostat
