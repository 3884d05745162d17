#include "linear/approximate_inverse.hpp"

#include "core/wide.hpp"
#include "core/work.hpp"
#include "linear/solve_schedule.hpp"
#include "sparse/pattern.hpp"

#include <klu.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <type_traits>

namespace isostat {

namespace {

// KLU's interface is not const-correct; it writes neither to the pattern nor to the values.
int* mutable_data(const std::vector<int>& x) {
    return const_cast<int*>(x.data()); // NOLINT(cppcoreguidelines-pro-type-const-cast)
}
double* mutable_data(const std::vector<double>& x) {
    return const_cast<double*>(x.data()); // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

/// A vector with few entries, by index and value.
struct SparseVector {
    std::vector<int> index;
    std::vector<double> value;
    [[nodiscard]] double dot(std::span<const double> x) const {
        double sum = 0;
        for (std::size_t e = 0; e < index.size(); ++e) {
            sum += value[e] * x[static_cast<std::size_t>(index[e])];
        }
        return sum;
    }
    void add_to(std::span<double> x, double factor) const {
        for (std::size_t e = 0; e < index.size(); ++e) {
            x[static_cast<std::size_t>(index[e])] += factor * value[e];
        }
    }
};

SparseVector column_of(const sparse::Matrix<double>& matrix, int column) {
    const auto c = static_cast<std::size_t>(column);
    return {{matrix.row.begin() + matrix.start[c], matrix.row.begin() + matrix.start[c + 1]},
            {matrix.value.begin() + matrix.start[c], matrix.value.begin() + matrix.start[c + 1]}};
}

/// Replaces x by solve(part of x) on the unknowns of `to`, and by 0 elsewhere.
template <class Solve>
void in_block(std::span<double> x, const std::vector<int>& from, const std::vector<int>& to, Solve solve) {
    std::vector<double> part(from.size());
    std::transform(from.begin(), from.end(), part.begin(), [&](int k) { return x[static_cast<std::size_t>(k)]; });
    solve(part);
    std::fill(x.begin(), x.end(), 0.0);
    for (std::size_t k = 0; k < to.size(); ++k) {
        x[static_cast<std::size_t>(to[k])] = part[k];
    }
}

/// Several long vectors are handled `together` at a time, in one sweep through x.
constexpr std::size_t together = 4;
using Several = std::vector<const double*>;

template <std::size_t count> void add_each(const double* const* v, const double* factor, std::span<double> x) {
    for (std::size_t i = 0; i < x.size(); ++i) {
        double sum = x[i];
        for (std::size_t k = 0; k < count; ++k) {
            sum += factor[k] * v[k][i];
        }
        x[i] = sum;
    }
}

template <std::size_t count> void dot_each(const double* const* v, std::span<const double> x, double* product) {
    // The sums are written in pairs because g++ else permutes the elements of its vectors in every step of the loop.
    std::array<Two, count> low{}; // sums over i = 0, 1 mod 4
    std::array<Two, count> high{};
    std::size_t i = 0;
    for (; i + 4 <= x.size(); i += 4) {
        const Two x_low = two_at(x.data() + i);
        const Two x_high = two_at(x.data() + i + 2);
        for (std::size_t k = 0; k < count; ++k) {
            low[k] += two_at(v[k] + i) * x_low;
            high[k] += two_at(v[k] + i + 2) * x_high;
        }
    }
    for (; i < x.size(); ++i) {
        for (std::size_t k = 0; k < count; ++k) {
            low[k][0] += v[k][i] * x[i];
        }
    }
    for (std::size_t k = 0; k < count; ++k) {
        product[k] = (low[k][0] + low[k][1]) + (high[k][0] + high[k][1]);
    }
}

/// Calls sweep(number, first) for groups of four vectors, then for the remaining group.
template <class Sweep> void in_groups(std::size_t size, Sweep sweep) {
    std::size_t first = 0;
    for (; first + together <= size; first += together) {
        sweep(std::integral_constant<std::size_t, together>(), first);
    }
    switch (size - first) {
    case 3: sweep(std::integral_constant<std::size_t, 3>(), first); break;
    case 2: sweep(std::integral_constant<std::size_t, 2>(), first); break;
    case 1: sweep(std::integral_constant<std::size_t, 1>(), first); break;
    default: break;
    }
}

/// Adds the sum of factor v to x.
void add_all(const Several& v, const std::vector<double>& factor, std::span<double> x) {
    in_groups(v.size(), [&](auto count, std::size_t k) { add_each<count>(v.data() + k, factor.data() + k, x); });
}

/// Computes v . x for each v.
void dot_all(const Several& v, std::span<const double> x, std::vector<double>& product) {
    product.resize(v.size());
    in_groups(v.size(), [&](auto count, std::size_t k) { dot_each<count>(v.data() + k, x, product.data() + k); });
}

} // namespace

struct ApproximateInverse::Base {
    klu_common common{};
    std::shared_ptr<void> analysis; ///< keeps a shared `symbolic` alive
    klu_symbolic* symbolic = nullptr;
    klu_numeric* numeric = nullptr;
    sparse::Matrix<double> matrix;
    std::vector<int> block_rows, block_columns; ///< empty: the whole matrix
    std::vector<int> row_order, column_order;   ///< of the last full analysis, exchanged columns last
    int entries = 0;                            ///< of L and U; 0: there are no factors
    int entries_then = 0;                       ///< of the first factors made with this order
    double operations = 0;                      ///< number of operations that made the factors
    explicit Base(const sparse::Matrix<double>& m) : matrix(m) {
        klu_defaults(&common);
        sparse::choose_order(common, matrix.rows, matrix.entries());
        // Unit columns need no scaling, and without scaling nothing depends on the size of the numbers.
        common.scale = 0;
        // A regular matrix may still underflow to a zero pivot. KLU then goes on: the callers' residual bounds show it.
        common.halt_if_singular = 0;
    }
    void factorise() {
        if (symbolic != nullptr) {
            numeric = klu_factor(mutable_data(matrix.start), mutable_data(matrix.row), mutable_data(matrix.value),
                                 symbolic, &common);
        }
        entries = numeric != nullptr ? numeric->lnz + numeric->unz : 0;
        if (numeric != nullptr && klu_flops(symbolic, numeric, &common) != 0) {
            operations = common.flops;
        }
    }
    Base(const Base&) = delete;
    Base& operator=(const Base&) = delete;
    ~Base() {
        klu_free_numeric(&numeric, &common);
        if (analysis == nullptr) {
            klu_free_symbolic(&symbolic, &common);
        }
    }
};

/// M' = M with row `slot` of G replaced by g: M'^-1 = (I - v (g - a)^T / (g.v)) M^-1, v = M^-1 e_slot, a the old row.
/// The effect of several exchanges on a vector follows from their products with the vector, all computed in one sweep,
/// and from their products with each other.
struct ApproximateInverse::Exchange {
    int slot = 0;
    SparseVector row;                      ///< g
    SparseVector change;                   ///< g - a
    SparseVector few;                      ///< v when only few grains move (rattlers)
    std::vector<double> many;              ///< v otherwise
    double speed = 0;                      ///< g.v
    std::vector<double> row_on, change_on; ///< g . v and (g - a) . v for the v of each earlier exchange

    [[nodiscard]] double along_v(const SparseVector& x) const {
        if (!many.empty()) {
            return x.dot(many);
        }
        double sum = 0;
        for (std::size_t e = 0; e < x.index.size(); ++e) {
            for (std::size_t k = 0; k < few.index.size(); ++k) {
                sum += x.index[e] == few.index[k] ? x.value[e] * few.value[k] : 0.0;
            }
        }
        return sum;
    }
};

ApproximateInverse::ApproximateInverse(const sparse::Matrix<double>& matrix, std::shared_ptr<void> symbolic) {
    count_work(Work::factorisations);
    auto base = std::make_shared<Base>(matrix);
    base->analysis = std::move(symbolic);
    base->symbolic = base->analysis != nullptr ? static_cast<klu_symbolic*>(base->analysis.get())
                                               : klu_analyze(matrix.rows, mutable_data(matrix.start),
                                                             mutable_data(matrix.row), &base->common);
    base->factorise();
    if (base->symbolic != nullptr) {
        base->row_order.assign(base->symbolic->P, base->symbolic->P + matrix.rows);
        base->column_order.assign(base->symbolic->Q, base->symbolic->Q + matrix.rows);
        base->entries_then = base->entries;
    }
    make_schedule(std::move(base));
}

ApproximateInverse ApproximateInverse::renewed(const sparse::Matrix<double>& matrix, Use use) const {
    if (!valid() || base_->column_order.size() != static_cast<std::size_t>(matrix.rows) ||
        base_->entries > base_->entries_then + base_->entries_then / 5) {
        return ApproximateInverse(matrix);
    }
    count_work(Work::factorisations);
    auto base = std::make_shared<Base>(matrix);
    base->row_order = base_->row_order;
    base->column_order = base_->column_order;
    base->entries_then = base_->entries_then;
    // An exchanged column goes to the end of the order, and so does its row: there it fills little, whatever it
    // connects. Its pivot need not be an entry of the matrix.
    std::vector<unsigned char> last(base->column_order.size(), 0);
    for (const auto& exchange : exchanges_) {
        last[static_cast<std::size_t>(exchange->slot)] = 1;
    }
    std::vector<int> position(last.size());
    std::iota(position.begin(), position.end(), 0);
    std::stable_partition(position.begin(), position.end(), [&](int k) {
        return last[static_cast<std::size_t>(base_->column_order[static_cast<std::size_t>(k)])] == 0;
    });
    for (std::size_t k = 0; k < position.size(); ++k) {
        base->row_order[k] = base_->row_order[static_cast<std::size_t>(position[k])];
        base->column_order[k] = base_->column_order[static_cast<std::size_t>(position[k])];
    }
    base->symbolic = klu_analyze_given(matrix.rows, mutable_data(base->matrix.start), mutable_data(base->matrix.row),
                                       base->row_order.data(), base->column_order.data(), &base->common);
    base->factorise();
    if (base->common.numerical_rank < matrix.rows && base->common.numerical_rank >= 0) {
        return ApproximateInverse(matrix); // a block has no pivot
    }
    ApproximateInverse inverse;
    if (use == Use::few_solves) {
        inverse.base_ = std::move(base);
    } else {
        inverse.make_schedule(std::move(base));
    }
    return inverse;
}

void ApproximateInverse::make_schedule(std::shared_ptr<Base> base) {
    if (base->numeric != nullptr) {
        schedule_ = std::make_shared<const SolveSchedule>(*base->symbolic, base->numeric);
    }
    base_ = std::move(base);
}

ApproximateInverse ApproximateInverse::of_block(const sparse::Matrix<double>& matrix, std::vector<int> rows,
                                                std::vector<int> columns) {
    std::vector<int> place(static_cast<std::size_t>(matrix.rows), -1);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        place[static_cast<std::size_t>(rows[k])] = static_cast<int>(k);
    }
    sparse::Matrix<double> block;
    block.rows = block.cols = static_cast<int>(rows.size());
    block.start.push_back(0);
    for (const int column : columns) {
        const SparseVector entries = column_of(matrix, column);
        for (std::size_t e = 0; e < entries.index.size(); ++e) {
            const int row = place[static_cast<std::size_t>(entries.index[e])];
            if (row >= 0) {
                block.row.push_back(row);
                block.value.push_back(entries.value[e]);
            }
        }
        block.start.push_back(static_cast<int>(block.row.size()));
    }
    auto base = std::make_shared<Base>(block);
    base->symbolic =
        klu_analyze(block.rows, mutable_data(base->matrix.start), mutable_data(base->matrix.row), &base->common);
    base->factorise();
    base->matrix.rows = matrix.rows; // the size of right-hand sides
    base->block_rows = std::move(rows);
    base->block_columns = std::move(columns);
    ApproximateInverse inverse;
    inverse.base_ = std::move(base);
    return inverse;
}

bool ApproximateInverse::valid() const {
    return schedule_ != nullptr || base_->numeric != nullptr;
}

double ApproximateInverse::relative_cost() const {
    double work = 0;
    for (const auto& exchange : exchanges_) {
        work += static_cast<double>(exchange->many.size());
    }
    // An entry of a dense vector costs about a sixth of an entry of the factors, which is reached through its index.
    return 1 + work / (6 * std::max(1.0, static_cast<double>(base_->entries)));
}

double ApproximateInverse::renewal_cost() const {
    return base_->operations / std::max(1.0, static_cast<double>(base_->entries));
}

ApproximateInverse ApproximateInverse::exchanged(int slot, const sparse::Matrix<double>& after) const {
    const std::vector<double>& v = mechanism(slot);
    auto exchange = std::make_shared<Exchange>();
    exchange->slot = slot;
    exchange->row = column_of(after, slot);
    exchange->speed = exchange->row.dot(v);
    // The row before is that of the last exchange of this slot, or else the row of the base.
    const auto last = std::find_if(exchanges_.rbegin(), exchanges_.rend(),
                                   [slot](const auto& earlier) { return earlier->slot == slot; });
    const SparseVector before = last != exchanges_.rend() ? (*last)->row : column_of(base_->matrix, slot);
    exchange->change = exchange->row;
    for (std::size_t e = 0; e < before.index.size(); ++e) {
        exchange->change.index.push_back(before.index[e]);
        exchange->change.value.push_back(-before.value[e]);
    }
    const auto moving = v.size() - static_cast<std::size_t>(std::count(v.begin(), v.end(), 0.0));
    if (moving < v.size() / 8) {
        for (std::size_t k = 0; k < v.size(); ++k) {
            if (v[k] != 0) {
                exchange->few.index.push_back(static_cast<int>(k));
                exchange->few.value.push_back(v[k]);
            }
        }
    } else {
        exchange->many = v;
    }
    for (const auto& earlier : exchanges_) {
        exchange->row_on.push_back(earlier->along_v(exchange->row));
        exchange->change_on.push_back(earlier->along_v(exchange->change));
    }
    ApproximateInverse next(*this);
    next.exchanges_.push_back(std::move(exchange));
    next.mechanism_.reset();
    next.mechanism_slot_ = -1;
    return next;
}

void ApproximateInverse::velocities(std::span<double> rhs) const {
    assert(rhs.size() == static_cast<std::size_t>(base_->matrix.rows));
    if (!valid()) {
        std::fill(rhs.begin(), rhs.end(), std::nan("")); // every bound fails, so nothing is decided
        return;
    }
    // Row r of the newest matrix requires rhs[r]. The factors solve for the base with the same right-hand side, and
    // each exchange then corrects its own row.
    klu_common common = base_->common;             // a copy, since threads may share the factors
    std::vector<double> factor(exchanges_.size()); // first the required rates
    for (std::size_t k = 0; k < exchanges_.size(); ++k) {
        factor[k] = rhs[static_cast<std::size_t>(exchanges_[k]->slot)];
    }
    if (schedule_ != nullptr) {
        schedule_->solve_transposed(rhs);
    } else if (base_->block_rows.empty()) {
        klu_tsolve(base_->symbolic, base_->numeric, base_->matrix.rows, 1, rhs.data(), &common);
    } else {
        in_block(rhs, base_->block_columns, base_->block_rows, [&](std::vector<double>& x) {
            klu_tsolve(base_->symbolic, base_->numeric, static_cast<int>(x.size()), 1, x.data(), &common);
        });
    }
    std::vector<double> factor_of_many;
    Several many;
    factor_of_many.reserve(exchanges_.size());
    many.reserve(exchanges_.size());
    for (std::size_t k = 0; k < exchanges_.size(); ++k) {
        const Exchange& exchange = *exchanges_[k];
        double rate = exchange.row.dot(rhs);
        for (std::size_t j = 0; j < k; ++j) {
            rate += factor[j] * exchange.row_on[j];
        }
        factor[k] = (factor[k] - rate) / exchange.speed;
        if (!exchange.many.empty()) {
            many.push_back(exchange.many.data());
            factor_of_many.push_back(factor[k]);
        }
    }
    add_all(many, factor_of_many, rhs);
    for (std::size_t k = 0; k < exchanges_.size(); ++k) {
        exchanges_[k]->few.add_to(rhs, factor[k]);
    }
}

void ApproximateInverse::forces(std::span<double> rhs) const {
    assert(rhs.size() == static_cast<std::size_t>(base_->matrix.rows));
    if (!valid()) {
        std::fill(rhs.begin(), rhs.end(), std::nan(""));
        return;
    }
    Several many;
    many.reserve(exchanges_.size());
    for (const auto& exchange : exchanges_) {
        if (!exchange->many.empty()) {
            many.push_back(exchange->many.data());
        }
    }
    std::vector<double> product;
    dot_all(many, rhs, product);
    std::vector<double> factor(exchanges_.size()); // of each `change`
    std::size_t dense = many.size();
    for (std::size_t k = exchanges_.size(); k-- > 0;) {
        const Exchange& exchange = *exchanges_[k];
        double power = exchange.many.empty() ? exchange.few.dot(rhs) : product[--dense];
        for (std::size_t j = k + 1; j < exchanges_.size(); ++j) {
            power += factor[j] * exchanges_[j]->change_on[k];
        }
        factor[k] = -power / exchange.speed;
    }
    for (std::size_t k = 0; k < exchanges_.size(); ++k) {
        exchanges_[k]->change.add_to(rhs, factor[k]);
    }
    klu_common common = base_->common;
    if (schedule_ != nullptr) {
        schedule_->solve(rhs);
    } else if (base_->block_rows.empty()) {
        klu_solve(base_->symbolic, base_->numeric, base_->matrix.rows, 1, rhs.data(), &common);
    } else {
        in_block(rhs, base_->block_rows, base_->block_columns, [&](std::vector<double>& x) {
            klu_solve(base_->symbolic, base_->numeric, static_cast<int>(x.size()), 1, x.data(), &common);
        });
    }
}

const std::vector<double>& ApproximateInverse::mechanism(int slot) const {
    if (mechanism_slot_ != slot || mechanism_ == nullptr) {
        auto v = std::make_shared<std::vector<double>>(static_cast<std::size_t>(base_->matrix.rows), 0.0);
        (*v)[static_cast<std::size_t>(slot)] = 1;
        velocities(*v);
        mechanism_ = std::move(v);
        mechanism_slot_ = slot;
    }
    return *mechanism_;
}

} // namespace isostat
