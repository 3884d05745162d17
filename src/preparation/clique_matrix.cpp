#include "preparation/clique_matrix.hpp"

#include "preparation/dense_panel.hpp"

#include <isostat/core/threads.hpp>

#include <cholmod.h>

#include <algorithm>
#include <atomic>
#include <new>
#include <numeric>
#include <utility>

namespace isostat::preparation {

namespace {

/// Subtrees with less than this share of the work are not divided further.
constexpr double small_share = 1.0 / 16;

/// CHOLMOD's analysis.
class Analysis {
  public:
    Analysis(std::vector<int>& start, std::vector<int>& row) {
        cholmod_start(&common_);
        common_.supernodal = CHOLMOD_SUPERNODAL;
        common_.print = 0;
        common_.nmethods = 2; // the one with less fill: nested dissection from some thousand disks on
        common_.method[0].ordering = CHOLMOD_AMD;
        common_.method[1].ordering = CHOLMOD_NESDIS;
        cholmod_sparse matrix{};
        matrix.nrow = matrix.ncol = start.size() - 1;
        matrix.nzmax = row.size();
        matrix.p = start.data();
        matrix.i = row.data();
        matrix.stype = -1;
        matrix.itype = CHOLMOD_INT;
        matrix.xtype = CHOLMOD_PATTERN;
        matrix.dtype = CHOLMOD_DOUBLE;
        matrix.sorted = 1;
        matrix.packed = 1;
        factor_ = cholmod_analyze(&matrix, &common_);
        if (factor_ == nullptr) {
            cholmod_finish(&common_);
            throw std::bad_alloc();
        }
    }
    Analysis(const Analysis&) = delete;
    Analysis& operator=(const Analysis&) = delete;
    ~Analysis() {
        cholmod_free_factor(&factor_, &common_);
        cholmod_finish(&common_);
    }
    const cholmod_factor* operator->() const { return factor_; }

  private:
    cholmod_common common_{};
    cholmod_factor* factor_ = nullptr;
};

} // namespace

CliqueMatrix::CliqueMatrix(std::size_t columns, const std::vector<int>& start, const std::vector<int>& column)
    : block_start_(start) {
    analyse(columns, column);
    share_out();
}

void CliqueMatrix::analyse(std::size_t columns, const std::vector<int>& column) {
    // Lower triangle by columns, diagonal first.
    std::vector<std::pair<int, int>> entries;
    for (std::size_t k = 0; k < columns; ++k) {
        entries.emplace_back(static_cast<int>(k), static_cast<int>(k));
    }
    const auto each = [&](const auto& visit) {
        for (std::size_t l = 0; l + 1 < block_start_.size(); ++l) {
            for (int p = block_start_[l]; p < block_start_[l + 1]; ++p) {
                for (int r = block_start_[l]; r <= p; ++r) {
                    visit(column[static_cast<std::size_t>(p)], column[static_cast<std::size_t>(r)]);
                }
            }
        }
    };
    each([&](int a, int b) { entries.emplace_back(std::min(a, b), std::max(a, b)); });
    std::sort(entries.begin(), entries.end());
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
    std::vector<int> first(columns + 1, 0);
    std::vector<int> rows;
    rows.reserve(entries.size());
    for (const auto& [of, row] : entries) {
        ++first[static_cast<std::size_t>(of) + 1];
        rows.push_back(row);
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    entries = {};

    const Analysis analysis(first, rows);
    const auto* const order = static_cast<const int*>(analysis->Perm);
    const auto* const super = static_cast<const int*>(analysis->super);
    const auto* const row_start = static_cast<const int*>(analysis->pi);
    const auto* const row = static_cast<const int*>(analysis->s);
    order_.assign(order, order + columns);
    position_.resize(columns);
    for (std::size_t k = 0; k < columns; ++k) {
        position_[static_cast<std::size_t>(order_[k])] = static_cast<int>(k);
    }
    fronts_.resize(analysis->nsuper);
    front_of_.resize(columns);
    row_.assign(row, row + row_start[analysis->nsuper]);
    in_parent_.resize(row_.size());
    std::size_t values = 0;
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        Front& front = fronts_[f];
        front.first = static_cast<std::size_t>(super[f]);
        front.columns = static_cast<std::size_t>(super[f + 1]) - front.first;
        front.row = static_cast<std::size_t>(row_start[f]);
        front.rows = static_cast<std::size_t>(row_start[f + 1]) - front.row;
        front.value = values;
        values += front.rows * front.columns;
        std::fill_n(front_of_.begin() + super[f], front.columns, static_cast<int>(f));
    }
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        Front& front = fronts_[f];
        if (front.rows > front.columns) {
            front.parent = front_of_[static_cast<std::size_t>(row_[front.row + front.columns])];
            Front& parent = fronts_[static_cast<std::size_t>(front.parent)];
            parent.children.push_back(static_cast<int>(f));
            for (std::size_t k = front.row + front.columns, p = parent.row; k < front.row + front.rows; ++k) {
                while (row_[p] != row_[k]) { // both ascend, and the parent has them all
                    ++p;
                }
                in_parent_[k] = p - parent.row;
            }
        }
    }
    value_.resize(values);
    update_.resize(fronts_.size());
    const auto place = [&](int a, int b) {
        const auto [low, high] =
            std::minmax(position_[static_cast<std::size_t>(a)], position_[static_cast<std::size_t>(b)]);
        return place_of(static_cast<std::size_t>(high), static_cast<std::size_t>(low));
    };
    each([&](int a, int b) { place_.push_back(place(a, b)); });
    for (std::size_t k = 0; k < columns; ++k) {
        diagonal_place_.push_back(place(static_cast<int>(k), static_cast<int>(k)));
    }
}

std::size_t CliqueMatrix::place_of(std::size_t row, std::size_t column) const {
    const Front& front = fronts_[static_cast<std::size_t>(front_of_[column])];
    const auto begin = row_.begin() + static_cast<std::ptrdiff_t>(front.row);
    const auto end = begin + static_cast<std::ptrdiff_t>(front.rows);
    const auto local = static_cast<std::size_t>(std::lower_bound(begin, end, static_cast<int>(row)) - begin);
    return front.value + local + front.rows * (column - front.first);
}

/// Subtrees that are small enough to be shared out among threads; the fronts above them follow one after the other.
void CliqueMatrix::share_out() {
    std::vector<double> work(fronts_.size());
    std::vector<std::size_t> first(fronts_.size());
    double total = 0;
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        const Front& front = fronts_[f];
        const auto rows = static_cast<double>(front.rows);
        work[f] += rows * rows * static_cast<double>(front.columns);
        total += rows * rows * static_cast<double>(front.columns);
        first[f] = front.children.empty() ? f : first[static_cast<std::size_t>(front.children.front())];
        if (front.parent >= 0) {
            work[static_cast<std::size_t>(front.parent)] += work[f];
        }
    }
    above_.assign(fronts_.size(), 0);
    for (std::size_t f = fronts_.size(); f-- > 0;) {
        const int parent = fronts_[f].parent;
        if (parent >= 0 && above_[static_cast<std::size_t>(parent)] == 0) {
            continue; // within a subtree
        }
        if (work[f] > small_share * total) {
            above_[f] = 1;
        } else {
            subtrees_.push_back({first[f], f + 1});
        }
    }
}

/// One front: what its children leave, its columns, what it leaves itself.
bool CliqueMatrix::eliminate(std::size_t f) {
    const Front& front = fronts_[f];
    const std::size_t below = front.rows - front.columns;
    double* const panel = value_.data() + front.value;
    std::vector<double>& update = update_[f];
    update.assign(below * below, 0.0);
    for (const int c : front.children) {
        const Front& child = fronts_[static_cast<std::size_t>(c)];
        std::vector<double>& left = update_[static_cast<std::size_t>(c)];
        const std::size_t size = child.rows - child.columns;
        const std::size_t* const place = in_parent_.data() + child.row + child.columns;
        for (std::size_t j = 0; j < size; ++j) {
            const std::size_t column = place[j];
            // Rows of a child keep their order: the lower triangle stays one.
            const bool own = column < front.columns;
            double* const to = own ? panel + front.rows * column : update.data() + below * (column - front.columns);
            const std::size_t shift = own ? 0 : front.columns;
            const double* const from = left.data() + size * j;
            for (std::size_t i = j; i < size; ++i) {
                to[place[i] - shift] += from[i];
            }
        }
        left = {};
    }
    if (!factorise_panel(panel, front.rows, front.columns)) {
        return false;
    }
    const double* const lower = panel + front.columns;
    ProductSum{update.data(), below, lower, front.rows, lower, front.rows, below, below, front.columns}
        .subtract_lower();
    return true;
}

bool CliqueMatrix::factorise() {
    std::atomic<bool> good = true;
    parallel_pieces(subtrees_.size(), [&](std::size_t k) {
        for (std::size_t f = subtrees_[k].first; f < subtrees_[k].last && good; ++f) {
            if (!eliminate(f)) {
                good = false;
            }
        }
    });
    for (std::size_t f = 0; f < fronts_.size() && good; ++f) {
        if (above_[f] != 0 && !eliminate(f)) {
            good = false;
        }
    }
    return good;
}

/// Forwards like the factorisation: what a front leaves to its parent waits until that takes it, so that subtrees are
/// independent. Backwards a front reads only what fronts above it have finished.
void CliqueMatrix::solve(std::vector<double>& b) {
    x_.resize(b.size());
    left_.resize(row_.size());
    for (std::size_t k = 0; k < b.size(); ++k) {
        x_[k] = b[static_cast<std::size_t>(order_[k])];
    }
    const auto forwards = [&](std::size_t f) {
        const Front& front = fronts_[f];
        double* const own = left_.data() + front.row;
        std::copy_n(x_.data() + front.first, front.columns, own);
        std::fill(own + front.columns, own + front.rows, 0.0);
        for (const int c : front.children) {
            const Front& child = fronts_[static_cast<std::size_t>(c)];
            for (std::size_t i = child.row + child.columns; i < child.row + child.rows; ++i) {
                own[in_parent_[i]] += left_[i];
            }
        }
        solve_panel(value_.data() + front.value, front.rows, front.columns, own);
    };
    const auto backwards = [&](std::size_t f) {
        const Front& front = fronts_[f];
        double* const own = left_.data() + front.row;
        for (std::size_t k = front.columns; k < front.rows; ++k) {
            own[k] = x_[static_cast<std::size_t>(row_[front.row + k])];
        }
        solve_panel_transposed(value_.data() + front.value, front.rows, front.columns, own);
        std::copy_n(own, front.columns, x_.data() + front.first);
    };
    parallel_pieces(subtrees_.size(), [&](std::size_t k) {
        for (std::size_t f = subtrees_[k].first; f < subtrees_[k].last; ++f) {
            forwards(f);
        }
    });
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        if (above_[f] != 0) {
            forwards(f);
        }
    }
    for (std::size_t f = fronts_.size(); f-- > 0;) {
        if (above_[f] != 0) {
            backwards(f);
        }
    }
    parallel_pieces(subtrees_.size(), [&](std::size_t k) {
        for (std::size_t f = subtrees_[k].last; f-- > subtrees_[k].first;) {
            backwards(f);
        }
    });
    for (std::size_t k = 0; k < b.size(); ++k) {
        b[static_cast<std::size_t>(order_[k])] = x_[k];
    }
}

} // namespace isostat::preparation
