#include "verified/block_cholesky.hpp"

#include "core/roundoff.hpp"
#include "core/wide.hpp"
#include "sparse/pattern.hpp"

#include <amd.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>

// exact: all other numbers of this file: index in a block

namespace isostat {

namespace {

using roundoff::gamma;
using roundoff::u;

/// An order of the rows, with the row that only fills up the last block. Without dissection the two rows of a block
/// stay together, and AMD is given the pairs of blocks that share a contact: columns of a symmetric pattern, both
/// halves, with repetitions.
std::vector<int> little_fill(const sparse::Matrix<double>& h, std::size_t blocks) {
    if (sparse::worth_dissection(h.rows, h.entries())) {
        std::vector<int> rows = sparse::dissection_of_products(h.rows, h.start, h.row);
        rows.resize(2 * blocks, h.rows);
        return rows;
    }
    std::vector<int> start(blocks + 1, 0);
    std::vector<int> row;
    const auto for_each_pair = [&](auto use) {
        for (std::size_t l = 0; l < static_cast<std::size_t>(h.cols); ++l) {
            for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
                for (int f = h.start[l]; f < h.start[l + 1]; ++f) {
                    const int a = h.row[static_cast<std::size_t>(e)] / 2;
                    const int b = h.row[static_cast<std::size_t>(f)] / 2;
                    if (a != b) {
                        use(static_cast<std::size_t>(a), b);
                    }
                }
            }
        }
    };
    for_each_pair([&](std::size_t a, int) { ++start[a + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    row.resize(static_cast<std::size_t>(start.back()) + 1); // AMD refuses a null array
    std::vector<int> next(start.begin(), start.end() - 1);
    for_each_pair([&](std::size_t a, int b) { row[static_cast<std::size_t>(next[a]++)] = b; });
    std::vector<int> order(blocks);
    const int status = amd_order(static_cast<int>(blocks), start.data(), row.data(), order.data(), nullptr, nullptr);
    if (status == AMD_OUT_OF_MEMORY) {
        throw std::bad_alloc();
    }
    assert(status == AMD_OK || status == AMD_OK_BUT_JUMBLED);
    std::vector<int> rows;
    for (const int block : order) {
        rows.insert(rows.end(), {2 * block, 2 * block + 1});
    }
    return rows;
}

} // namespace

void BlockCholesky::set(const sparse::Matrix<double>& h, FillOrder& order) {
    // cost: when the order is renewed
    constexpr double outgrown = 1.2; // new contacts join parts that the order keeps apart, so the work grows
    h_ = &h;
    blocks_ = (static_cast<std::size_t>(h.rows) + 1) / 2;
    const bool known = order.rows.size() == 2 * blocks_;
    if (known) {
        arrange(order.rows);
    }
    if (!known || work() > outgrown * order.work) {
        order.rows = little_fill(h, blocks_);
        arrange(order.rows);
        order.work = work();
    }
}

/// The entries of each contact by blocks, and the blocks of H H^T that they make.
void BlockCholesky::arrange(const std::vector<int>& order) {
    position_.resize(2 * blocks_);
    for (std::size_t k = 0; k < order.size(); ++k) {
        position_[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
    }
    diagonal_.assign(blocks_, Block{});
    if (h_->rows % 2 != 0) { // the last row only fills up its block: it is coupled to nothing
        const auto last = static_cast<std::size_t>(position_.back());
        diagonal_[last / 2].value[3 * (last % 2)] = 1;
    }
    pairs_.clear();
    column_start_.assign(blocks_ + 1, 0);
    row_start_.assign(blocks_ + 1, 0);
    const auto contacts = static_cast<std::size_t>(h_->cols);
    // Two spheres and the coordinates of a cell, each perhaps in a block of its own.
    std::array<Part, 2 * most_axes + most_axes + most_tilts> parts;
    for (std::size_t l = 0; l < contacts; ++l) {
        std::size_t count = 0;
        std::size_t part = 0;
        for (auto e = static_cast<std::size_t>(h_->start[l]); e < static_cast<std::size_t>(h_->start[l + 1]); ++e) {
            const int at = position_[static_cast<std::size_t>(h_->row[e])];
            if (count == 0 || parts[part].place != at / 2) { // entries of one block mostly follow each other
                part = 0;
                while (part < count && parts[part].place != at / 2) {
                    ++part;
                }
                if (part == count) {
                    parts[count++] = {at / 2, {}};
                }
            }
            parts[part].value[static_cast<std::size_t>(at % 2)] = h_->value[e];
        }
        for (std::size_t k = 0; k < count; ++k) {
            const std::array<double, 2>& v = parts[k].value;
            auto& d = diagonal_[static_cast<std::size_t>(parts[k].place)].value;
            d[0] += v[0] * v[0];
            d[1] += v[1] * v[0];
            d[2] += v[0] * v[1];
            d[3] += v[1] * v[1];
            for (std::size_t m = k + 1; m < count; ++m) {
                const bool later = parts[m].place > parts[k].place;
                pairs_.push_back({later ? parts[k] : parts[m], later ? parts[m] : parts[k]});
                ++column_start_[static_cast<std::size_t>(pairs_.back().column.place) + 1];
                ++row_start_[static_cast<std::size_t>(pairs_.back().row.place) + 1];
            }
        }
    }
    std::partial_sum(column_start_.begin(), column_start_.end(), column_start_.begin());
    std::partial_sum(row_start_.begin(), row_start_.end(), row_start_.begin());
    by_column_.resize(pairs_.size());
    by_row_.resize(pairs_.size());
    next_.assign(column_start_.begin(), column_start_.end() - 1);
    next_row_.assign(row_start_.begin(), row_start_.end() - 1);
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        const Pair& pair = pairs_[p];
        by_column_[static_cast<std::size_t>(next_[static_cast<std::size_t>(pair.column.place)]++)] =
            static_cast<int>(p);
        by_row_[static_cast<std::size_t>(next_row_[static_cast<std::size_t>(pair.row.place)]++)] = pair.column.place;
    }
    analyse();
}

double BlockCholesky::work() const {
    double sum = 0;
    for (std::size_t j = 0; j < blocks_; ++j) {
        const double count = start_[j + 1] - start_[j];
        sum += count * (count + 1);
    }
    return sum;
}

/// Pattern of L: row i has the columns on the ways up the elimination tree from the blocks that share a contact with i.
void BlockCholesky::analyse() {
    constexpr int none = -1;
    struct Column {
        int parent = none;
        int seen = none; ///< the last row found to have this column
        int count = 0;
    };
    std::vector<Column> columns(blocks_);
    across_start_.resize(blocks_ + 1);
    std::size_t entries = 0;
    for (std::size_t i = 0; i < blocks_; ++i) {
        const int row = static_cast<int>(i);
        across_start_[i] = static_cast<int>(entries);
        columns[i].seen = row;
        if (column_.size() < entries + blocks_) {
            column_.resize(2 * entries + 8 * blocks_); // cost: memory
        }
        int* const found = column_.data();
        for (int p = row_start_[i]; p < row_start_[i + 1]; ++p) {
            int j = by_row_[static_cast<std::size_t>(p)];
            while (columns[static_cast<std::size_t>(j)].seen != row) {
                Column& column = columns[static_cast<std::size_t>(j)];
                column.seen = row;
                ++column.count;
                found[entries++] = j;
                column.parent = column.parent == none ? row : column.parent;
                j = column.parent;
            }
        }
    }
    across_start_[blocks_] = static_cast<int>(entries);
    start_.resize(blocks_ + 1);
    next_.resize(blocks_);
    start_[0] = 0;
    for (std::size_t j = 0; j < blocks_; ++j) {
        next_[j] = start_[j];
        start_[j + 1] = start_[j] + columns[j].count;
    }
    if (row_.size() < entries) { // the arrays never shrink: their memory serves the next matrix
        row_.resize(entries);
        across_.resize(entries);
        value_.resize(entries);
    }
    int* const next = next_.data();
    int* const row = row_.data();
    int* const across = across_.data();
    const int* const column = column_.data();
    for (std::size_t i = 0; i < blocks_; ++i) { // rows are entered in ascending order
        const auto end = static_cast<std::size_t>(across_start_[i + 1]);
        for (auto a = static_cast<std::size_t>(across_start_[i]); a < end; ++a) {
            const int place = next[column[a]]++;
            row[place] = static_cast<int>(i);
            across[a] = place;
        }
    }
}

/// Arrays of a factorisation, not read through `this` because every store might change `this`.
struct BlockCholesky::Arrays {
    Block* value;
    Block* work; ///< the column that is worked on
    int* place;  ///< of each row in `work`
    const int* start;
    const int* row;
    const int* column;
    const int* across;
};

/// Scatters column j of H H^T - shift I into `work`; returns how many blocks L has below the diagonal.
inline std::size_t BlockCholesky::load_column(const Arrays& at, std::size_t j, double shift) const {
    const auto begin = static_cast<std::size_t>(at.start[j]);
    const auto count = static_cast<std::size_t>(at.start[j + 1]) - begin;
    std::fill_n(at.work, count + 1, Block{});
    at.place[j] = 0;
    for (std::size_t k = 0; k < count; ++k) {
        at.place[static_cast<std::size_t>(at.row[begin + k])] = static_cast<int>(k) + 1;
    }
    at.work[0] = diagonal_[j];
    at.work[0].value[0] -= shift;
    at.work[0].value[3] -= shift;
    for (int p = column_start_[j]; p < column_start_[j + 1]; ++p) {
        const Pair& pair = pairs_[static_cast<std::size_t>(by_column_[static_cast<std::size_t>(p)])];
        std::array<double, 4>& w = at.work[at.place[pair.row.place]].value; // exact: size of a block
        const std::array<double, 2>& own = pair.column.value;
        const std::array<double, 2>& other = pair.row.value;
        w[0] += other[0] * own[0];
        w[1] += other[1] * own[0];
        w[2] += other[0] * own[1];
        w[3] += other[1] * own[1];
    }
    return count;
}

/// work -= m l^T for the columns of row j, in the order of the scalar operations, so that the bits do not depend on the
/// width. Takes two columns at once when one is the parent of the other and has as many rows left: the same rows.
ISOSTAT_WITHIN_WIDE void BlockCholesky::subtract_columns(const Arrays& at, std::size_t begin, std::size_t end) {
    Block* const value = at.value;
    Block* const work = at.work;
    const int* const place = at.place;
    const int* const start = at.start;
    const int* const row = at.row;
    for (std::size_t a = begin; a < end; ++a) {
        const int c = at.column[a];
        const int own = at.across[a];
        const int left = start[c + 1] - own;
        Wide l;
        read(l, value[own].value.data());
        const Wide first = __builtin_shufflevector(l, l, 0, 0, 1, 1);
        const Wide second = __builtin_shufflevector(l, l, 2, 2, 3, 3);
        const bool two =
            a + 1 < end && row[start[c]] == at.column[a + 1] && start[at.column[a + 1] + 1] - at.across[a + 1] == left;
        if (!two) {
            for (int q = 0; q < left; ++q) {
                double* target = work[place[row[own + q]]].value.data();
                Wide m;
                Wide w;
                read(m, value[own + q].value.data());
                read(w, target);
                w = w - __builtin_shufflevector(m, m, 0, 1, 0, 1) * first;
                w = w - __builtin_shufflevector(m, m, 2, 3, 2, 3) * second;
                write(target, w);
            }
            continue;
        }
        const int other = at.across[++a];
        read(l, value[other].value.data());
        const Wide third = __builtin_shufflevector(l, l, 0, 0, 1, 1);
        const Wide fourth = __builtin_shufflevector(l, l, 2, 2, 3, 3);
        for (int q = 0; q < left; ++q) {
            double* target = work[place[row[own + q]]].value.data();
            Wide m;
            Wide k;
            Wide w;
            read(m, value[own + q].value.data());
            read(k, value[other + q].value.data());
            read(w, target);
            w = w - __builtin_shufflevector(m, m, 0, 1, 0, 1) * first;
            w = w - __builtin_shufflevector(m, m, 2, 3, 2, 3) * second;
            w = w - __builtin_shufflevector(k, k, 0, 1, 0, 1) * third;
            w = w - __builtin_shufflevector(k, k, 2, 3, 2, 3) * fourth;
            write(target, w);
        }
    }
}

ISOSTAT_WIDE
bool BlockCholesky::factorise(double shift) {
    place_.resize(blocks_);
    work_.resize(blocks_);
    pivot_.resize(blocks_);
    const Arrays at{value_.data(), work_.data(),   place_.data(), start_.data(),
                    row_.data(),   column_.data(), across_.data()};
    for (std::size_t j = 0; j < blocks_; ++j) {
        const std::size_t count = load_column(at, j, shift);
        subtract_columns(at, static_cast<std::size_t>(across_start_[j]),
                         static_cast<std::size_t>(across_start_[j + 1]));
        const std::array<double, 4>& diagonal = at.work[0].value; // 4: exact: size of a block
        const double d0 = diagonal[0];
        if (!(d0 > 0)) {
            return false;
        }
        const double l00 = std::sqrt(d0);
        const double l10 = diagonal[1] / l00;
        const double d1 = diagonal[3] - l10 * l10;
        if (!(d1 > 0)) {
            return false;
        }
        const double l11 = std::sqrt(d1);
        pivot_[j] = {l00, l10, l11};
        const double by00 = 1 / l00;
        const double by11 = 1 / l11;
        for (std::size_t k = 0; k < count; ++k) {
            const std::array<double, 4>& w = at.work[k + 1].value;
            std::array<double, 4>& l = at.value[static_cast<std::size_t>(at.start[j]) + k].value;
            l[0] = w[0] * by00;
            l[1] = w[1] * by00;
            l[2] = (w[2] - l[0] * l10) * by11;
            l[3] = (w[3] - l[1] * l10) * by11;
        }
    }
    return true;
}

double BlockCholesky::error_bound(double shift) const {
    const auto n = static_cast<std::size_t>(h_->rows);
    std::vector<int> entries(n, 0);
    std::vector<double> diagonal(n, 0.0);
    for (std::size_t e = 0; e < h_->row.size(); ++e) {
        const auto row = static_cast<std::size_t>(h_->row[e]);
        ++entries[row];
        diagonal[row] += h_->value[e] * h_->value[e];
    }
    std::vector<double> relative(n); // gamma_{t_k}
    double trace = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto block = static_cast<std::size_t>(position_[i] / 2);
        const int row_of_l = 2 * (across_start_[block + 1] - across_start_[block] + 1); // with the zeros in blocks
        relative[i] = gamma(entries[i] + row_of_l + 4.0);                               // bounds.md V1 (t_k)
        trace += relative[i] * (2 * diagonal[i] + shift);
    }
    constexpr double good_enough = 0.01; // of the shift; cost: when the row bound is taken (bounds.md V1)
    // cost: when the row bound is refined (bounds.md V1)
    constexpr double of_use = 0.5; // of the shift: above it the caller may give up
    constexpr int most_passes = 5; // cost: passes
    double sum = trace;
    std::vector<double> x(n);
    std::transform(relative.begin(), relative.end(), x.begin(), [](double g) { return 1 / std::sqrt(g); });
    for (int pass = 0; pass < most_passes && !(sum < (pass == 0 ? good_enough : of_use) * shift); ++pass) {
        const double ratio = largest_ratio(relative, shift, x);
        sum = std::min(sum, ratio);
        if (std::isinf(ratio)) {
            break;
        }
    }
    // bounds.md V1
    return sum * 1.01 + 1e-290; // 1.01: second order in gamma and the rounding of this sum; 1e-290: underflow
}

/// Largest (M x)_k / x_k, x > 0, for M = D^1/2 (|B||B|^T + s + |L||L|^T) D^1/2, D = diag(gamma_{t_k}): above |M|, and
/// below its trace by about the number of rows. Leaves M x, scaled, in x, so that the next ratio is nearer |M|.
double BlockCholesky::largest_ratio(const std::vector<double>& relative, double shift, std::vector<double>& x) const {
    const sparse::Matrix<double>& h = *h_;
    std::vector<double> y(x.size()); // D^1/2 x
    std::transform(x.begin(), x.end(), relative.begin(), y.begin(),
                   [](double c, double g) { return c * std::sqrt(g); });
    std::vector<double> of_b(relative.size(), 0.0);
    for (std::size_t l = 0; l < static_cast<std::size_t>(h.cols); ++l) {
        double sum = 0;
        for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
            sum += std::abs(h.value[e]) * y[static_cast<std::size_t>(h.row[e])];
        }
        for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
            of_b[static_cast<std::size_t>(h.row[e])] += std::abs(h.value[e]) * sum;
        }
    }
    // y by blocks, with 0 for the row that only fills up the last block.
    std::vector<std::array<double, 2>> weight(blocks_, {0.0, 0.0});
    for (std::size_t i = 0; i < y.size(); ++i) {
        const auto at = static_cast<std::size_t>(position_[i]);
        weight[at / 2][at % 2] = y[i];
    }
    std::vector<std::array<double, 2>> of_l(blocks_, {0.0, 0.0});
    for (std::size_t j = 0; j < blocks_; ++j) {
        const auto& [l00, l10, l11] = pivot_[j];
        const std::array<double, 2>& own = weight[j];
        double first = l00 * own[0] + std::abs(l10) * own[1]; // sums of the two columns
        double second = l11 * own[1];
        for (auto k = static_cast<std::size_t>(start_[j]); k < static_cast<std::size_t>(start_[j + 1]); ++k) {
            const std::array<double, 4>& l = value_[k].value; // 4: exact: size of a block
            const std::array<double, 2>& w = weight[static_cast<std::size_t>(row_[k])];
            first += std::abs(l[0]) * w[0] + std::abs(l[1]) * w[1];
            second += std::abs(l[2]) * w[0] + std::abs(l[3]) * w[1];
        }
        of_l[j][0] += l00 * first;
        of_l[j][1] += std::abs(l10) * first + l11 * second;
        for (auto k = static_cast<std::size_t>(start_[j]); k < static_cast<std::size_t>(start_[j + 1]); ++k) {
            const std::array<double, 4>& l = value_[k].value;
            std::array<double, 2>& row = of_l[static_cast<std::size_t>(row_[k])];
            row[0] += std::abs(l[0]) * first + std::abs(l[2]) * second;
            row[1] += std::abs(l[1]) * first + std::abs(l[3]) * second;
        }
    }
    double largest = 0;
    double largest_x = 0;
    for (std::size_t i = 0; i < relative.size(); ++i) {
        const auto at = static_cast<std::size_t>(position_[i]);
        const double l = of_l[at / 2][at % 2];
        const double image = std::sqrt(relative[i]) * (of_b[i] + shift * y[i] + l);
        if (!std::isfinite(image)) { // a maximum overlooks a NaN
            return std::numeric_limits<double>::infinity();
        }
        largest = std::max(largest, image / x[i]);
        x[i] = image;
        largest_x = std::max(largest_x, image);
    }
    for (double& c : x) {
        c = std::max(c / largest_x, 1e-9); // cost: any x > 0 gives a bound (bounds.md V1)
    }
    return largest;
}

} // namespace isostat
