#include "linear/triangle.hpp"

#include "core/index.hpp"
#include "core/roundoff.hpp"
#include "core/wide.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace isostat {

namespace {

using roundoff::infinity;

/// Number of entries between the lines of a step.
constexpr int links(int width) {
    return width * (width - 1) / 2;
}

/// Number of values of a step: inverse diagonals, links, entries.
constexpr int values_of(int width, int entries, bool unit) {
    return (unit ? 0 : width) + links(width) + width * entries;
}

/// Steps of up to this many entries have functions of their own; larger numbers are rounded up to a multiple of four.
constexpr int few = 8;

int rounded(int entries) {
    return entries <= few ? entries : (entries + 3) / 4 * 4;
}

using Kernel = void (*)(const Triangle::Run&, const int*, const double*, double*);

template <int width, int known, bool unit>
void run_forwards(const Triangle::Run& run, const int* i, const double* v, double* x) {
    const int entries = known <= few ? known : run.entries;
    for (int s = 0; s < run.steps; ++s) {
        double* const own = x + *i++;
        std::array<double, at(width)> done;
        const double* const scale = v;
        v += unit ? 0 : width;
        for (int a = 0; a < width; ++a) {
            double value = own[a];
            for (int b = 0; b < a; ++b) {
                value -= *v++ * done[at(b)];
            }
            done[at(a)] = unit ? value : value * scale[a];
            own[a] = done[at(a)];
        }
        if constexpr (width == 1) {
            for (int e = 0; e < entries; ++e) {
                x[i[e]] -= v[e] * done[0];
            }
        } else if constexpr (width == 2) {
            for (int e = 0; e < entries; ++e) {
                x[i[e]] -= v[2 * e] * done[0] + v[2 * e + 1] * done[1];
            }
        } else {
            const Two first = two_at(done.data());
            const Two second = two_at(done.data() + 2);
            for (int e = 0; e < entries; ++e) {
                const Two part = two_at(v + 4 * e) * first + two_at(v + 4 * e + 2) * second;
                x[i[e]] -= part[0] + part[1];
            }
        }
        i += entries;
        v += width * entries;
    }
}

template <int width, int known, bool unit>
void run_backwards(const Triangle::Run& run, const int* i, const double* v, double* x) {
    const int entries = known <= few ? known : run.entries;
    const int indices = 1 + entries;
    const int values = values_of(width, entries, unit);
    i += static_cast<std::ptrdiff_t>(indices) * run.steps;
    v += static_cast<std::ptrdiff_t>(values) * run.steps;
    for (int s = 0; s < run.steps; ++s) {
        i -= indices;
        v -= values;
        double* const own = x + *i;
        const int* const index = i + 1;
        const double* const scale = v;
        const double* const link = v + (unit ? 0 : width);
        const double* const value = link + links(width);
        std::array<double, at(width)> sum{};
        // The unknowns computed last are used last.
        int e = entries;
        if constexpr (width == 1) {
            double even = 0;
            double odd = 0;
            for (; e >= 2; e -= 2) {
                even += value[e - 1] * x[index[e - 1]];
                odd += value[e - 2] * x[index[e - 2]];
            }
            if (e > 0) {
                even += value[0] * x[index[0]];
            }
            sum[0] = even + odd;
        } else {
            std::array<Two, at(width)> parts{}; // sums over every second entry, then over the others
            const auto take = [&](int entry, int part) {
                for (int half = 0; half < width / 2; ++half) {
                    parts[at(part + half)] += two_at(value + width * entry + 2 * half) * x[index[entry]];
                }
            };
            for (; e >= 2; e -= 2) {
                take(e - 1, 0);
                take(e - 2, width / 2);
            }
            if (e > 0) {
                take(0, 0);
            }
            for (int half = 0; half < width / 2; ++half) {
                const Two part = parts[at(half)] + parts[at(half + width / 2)];
                sum[at(2 * half)] = part[0];
                sum[at(2 * half + 1)] = part[1];
            }
        }
        for (int b = width - 1; b >= 0; --b) {
            double rest = own[b] - sum[at(b)];
            for (int a = b + 1; a < width; ++a) {
                rest -= link[links(a) + b] * own[a];
            }
            own[b] = unit ? rest : rest * scale[b];
        }
    }
}

/// Kernels by width (1, 2, 4), and by number of entries: 0 to `few`, then more.
using Kernels = std::array<std::array<Kernel, few + 2>, 3>;

template <bool unit, int... known> constexpr Kernels forward_kernels(std::integer_sequence<int, known...>) {
    return {{{run_forwards<1, known, unit>...}, {run_forwards<2, known, unit>...}, {run_forwards<4, known, unit>...}}};
}
template <bool unit, int... known> constexpr Kernels backward_kernels(std::integer_sequence<int, known...>) {
    return {
        {{run_backwards<1, known, unit>...}, {run_backwards<2, known, unit>...}, {run_backwards<4, known, unit>...}}};
}
constexpr std::array<Kernels, 2> forward{forward_kernels<false>(std::make_integer_sequence<int, few + 2>()),
                                         forward_kernels<true>(std::make_integer_sequence<int, few + 2>())};
constexpr std::array<Kernels, 2> backward{backward_kernels<false>(std::make_integer_sequence<int, few + 2>()),
                                          backward_kernels<true>(std::make_integer_sequence<int, few + 2>())};

Kernel of(const Kernels& kernels, const Triangle::Run& run) {
    return kernels[at(run.width / 2)][at(std::min(run.entries, few + 1))];
}

} // namespace

Lines::Lines(int lines, int entries) : start(at(lines) + 1), index(at(entries)), value(at(entries)) {}

Lines Lines::transposed() const {
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

double Lines::entry(std::size_t line, int number) const {
    const auto end = index.begin() + start[line + 1];
    const auto found = std::find(index.begin() + start[line], end, number);
    return found != end ? value[at(static_cast<int>(found - index.begin()))] : 0.0;
}

/// Computes the layout of a triangle.
struct Triangle::Layout {
    /// Lines that are computed together.
    struct Step {
        int line, width;
        std::size_t first; ///< index of its first entry in `numbers`
        int different;     ///< how many entries of `numbers` it has
        int waits = 0;     ///< number of changes that steps not yet done make to its unknowns
        [[nodiscard]] int entries() const { return rounded(different); }
    };
    const Lines& lines;
    Triangle& triangle;
    std::vector<Step> steps;
    std::vector<int> numbers;       ///< the unknowns that a step changes, step by step
    std::vector<int> step_of;       ///< the step of each line
    std::vector<int> seen;          ///< by number: the last round in which it was met
    std::vector<std::size_t> place; ///< by number: the place of its values in a step
    int now = 0;
    /// Steps that wait for no other step, by shape.
    std::vector<std::vector<int>> ready;
    std::vector<std::size_t> shapes; ///< the shapes of which some step is ready

    Layout(const Lines& l, Triangle& t)
        : lines(l), triangle(t), step_of(l.start.size()), seen(l.start.size(), 0), place(l.start.size(), 0) {
        numbers.reserve(l.index.size());
    }

    [[nodiscard]] bool meet(int i) { return std::exchange(seen[at(i)], now) != now; }
    [[nodiscard]] int found_since(std::size_t first) const { return static_cast<int>(numbers.size() - first); }
    void append(int line, int behind) {
        for (int e = lines.start[at(line)]; e < lines.start[at(line) + 1]; ++e) {
            const int i = lines.index[at(e)];
            if (i > behind && meet(i)) {
                numbers.push_back(i);
            }
        }
    }
    /// Cost of entries when a step has 1, 2 or 4 lines.
    static int cost(int width, int entries) { return (width == 1 ? 5 : width == 2 ? 7 : 10) * entries; }

    /// Appends the step that begins with this line; the step has two lines when that is cheaper than two steps of one.
    Step one_or_two(int line, int end) {
        const std::size_t first = numbers.size();
        ++now;
        append(line, line);
        const int own = found_since(first);
        const int next = line + 1 < end ? lines.start[at(line) + 2] - lines.start[at(line) + 1] - 1 : 0;
        if (line + 1 == end || cost(2, std::max(own - 1, next)) >= cost(1, own + next)) {
            return {line, 1, first, own};
        }
        append(line + 1, line + 1);
        const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(first);
        const auto link = std::find(begin, begin + own, line + 1);
        const int both = found_since(first) - (link != begin + own ? 1 : 0);
        if (cost(2, both) >= cost(1, own + next - (link != begin + own ? 1 : 0))) {
            numbers.resize(first + at(own));
            return {line, 1, first, own};
        }
        if (link != begin + own) {
            numbers.erase(link);
        }
        return {line, 2, first, both};
    }
    /// Joins two steps of two lines into the first when one step of four lines is cheaper.
    bool join(Step& a, const Step& b) {
        if (a.width != 2 || b.width != 2 || b.different <= few) {
            return false;
        }
        const std::size_t end = numbers.size();
        ++now;
        for (std::size_t k = b.first; k < end; ++k) {
            (void)meet(numbers[k]);
        }
        for (std::size_t k = a.first; k < b.first; ++k) {
            if (numbers[k] >= b.line + 2 && meet(numbers[k])) {
                numbers.push_back(numbers[k]);
            }
        }
        const int all = found_since(b.first);
        if (cost(4, all) >= cost(2, a.different + b.different)) {
            numbers.resize(end);
            return false;
        }
        numbers.erase(numbers.begin() + static_cast<std::ptrdiff_t>(a.first),
                      numbers.begin() + static_cast<std::ptrdiff_t>(b.first));
        a = {a.line, 4, a.first, all};
        return true;
    }

    void group(int begin, int end) {
        steps.clear();
        numbers.clear();
        for (int line = begin; line < end;) {
            const Step step = one_or_two(line, end);
            line += step.width;
            if (steps.empty() || !join(steps.back(), step)) {
                steps.push_back(step);
            }
        }
        for (int k = 0; k < static_cast<int>(steps.size()); ++k) {
            const Step& step = steps[at(k)];
            std::fill_n(step_of.begin() + step.line, step.width, k);
            if (step.different > few) { // the unknowns of the next steps come first
                const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(step.first);
                std::sort(first, first + step.different);
            }
        }
        for (const int i : numbers) {
            ++steps[at(step_of[at(i)])].waits;
        }
    }

    void is_ready(int step) {
        const Step& s = steps[at(step)];
        const std::size_t shape = 3 * at(s.entries()) + at(s.width / 2);
        if (ready.size() <= shape) {
            ready.resize(shape + 1);
        }
        if (ready[shape].empty()) {
            shapes.push_back(shape);
        }
        ready[shape].push_back(step);
    }

    void write(const Step& s) {
        std::vector<int>& index = triangle.index_;
        std::vector<double>& value = triangle.value_;
        const std::size_t scale = value.size();
        const std::size_t link = scale + (triangle.unit_ ? 0 : at(s.width));
        std::size_t next = link + at(links(s.width));
        value.resize(next + at(s.width * s.entries()));
        index.push_back(s.line);
        for (std::size_t k = s.first; k < s.first + at(s.different); ++k) {
            index.push_back(numbers[k]);
            place[at(numbers[k])] = next;
            next += at(s.width);
        }
        for (int k = s.different; k < s.entries(); ++k) {
            index.push_back(static_cast<int>(lines.start.size()) - 1 + k % spare);
        }
        if (!triangle.unit_) { // a missing diagonal makes the results infinite
            std::fill_n(value.begin() + static_cast<std::ptrdiff_t>(scale), s.width, infinity);
        }
        for (int b = 0; b < s.width; ++b) {
            const auto line = at(s.line + b);
            for (int e = lines.start[line]; e < lines.start[line + 1]; ++e) {
                const int a = lines.index[at(e)] - s.line;
                const double v = lines.value[at(e)];
                if (a >= s.width) {
                    value[place[at(lines.index[at(e)])] + at(b)] = v;
                } else if (a > b) {
                    value[link + at(links(a) + b)] = v;
                } else if (!triangle.unit_) {
                    value[scale + at(b)] = 1 / v;
                }
            }
        }
    }

    /// Writes the steps in runs of one shape, always the shape of which most steps are ready.
    void lay_out(int begin, int end) {
        group(begin, end);
        for (int step = 0; step < static_cast<int>(steps.size()); ++step) {
            if (steps[at(step)].waits == 0) {
                is_ready(step);
            }
        }
        std::vector<int> run;
        while (!shapes.empty()) {
            const auto most = std::max_element(shapes.begin(), shapes.end(), [&](std::size_t a, std::size_t b) {
                return std::pair(ready[a].size(), b) < std::pair(ready[b].size(), a);
            });
            run.clear();
            run.swap(ready[*most]);
            *most = shapes.back();
            shapes.pop_back();
            const Step& shape = steps[at(run.front())];
            if (!triangle.unit_ || shape.different > 0 || shape.width > 1) { // otherwise the step does nothing
                triangle.runs_.push_back({shape.width, shape.entries(), static_cast<int>(run.size())});
                for (const int step : run) {
                    write(steps[at(step)]);
                }
            }
            for (const int step : run) {
                const Step& s = steps[at(step)];
                for (std::size_t k = s.first; k < s.first + at(s.different); ++k) {
                    const int waiting = step_of[at(numbers[k])];
                    if (--steps[at(waiting)].waits == 0) {
                        is_ready(waiting);
                    }
                }
            }
        }
    }
};

Triangle::Triangle(const Lines& lines, const std::vector<int>& blocks, bool unit) : unit_(unit) {
    index_.reserve(lines.index.size());
    value_.reserve(lines.index.size() + lines.index.size() / 4);
    Layout layout(lines, *this);
    for (std::size_t b = 0; b + 1 < blocks.size(); ++b) {
        block_.push_back({runs_.size(), index_.size(), value_.size()});
        layout.lay_out(blocks[b], blocks[b + 1]);
    }
    block_.push_back({runs_.size(), index_.size(), value_.size()});
}

void Triangle::forwards(std::size_t b, double* x) const {
    const int* i = index_.data() + block_[b].index;
    const double* v = value_.data() + block_[b].value;
    const Kernels& kernels = forward[unit_ ? 1 : 0];
    for (std::size_t r = block_[b].run; r < block_[b + 1].run; ++r) {
        const Run& run = runs_[r];
        of(kernels, run)(run, i, v, x);
        i += static_cast<std::ptrdiff_t>(run.steps) * (1 + run.entries);
        v += static_cast<std::ptrdiff_t>(run.steps) * values_of(run.width, run.entries, unit_);
    }
}

void Triangle::backwards(std::size_t b, double* x) const {
    const int* i = index_.data() + block_[b + 1].index;
    const double* v = value_.data() + block_[b + 1].value;
    const Kernels& kernels = backward[unit_ ? 1 : 0];
    for (std::size_t r = block_[b + 1].run; r-- > block_[b].run;) {
        const Run& run = runs_[r];
        i -= static_cast<std::ptrdiff_t>(run.steps) * (1 + run.entries);
        v -= static_cast<std::ptrdiff_t>(run.steps) * values_of(run.width, run.entries, unit_);
        of(kernels, run)(run, i, v, x);
    }
}

} // namespace isostat
