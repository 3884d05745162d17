#include <isostat/exact/independent_columns.hpp>
#include <isostat/exact/rank.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace isostat::exact {

namespace {

__extension__ using Wide = unsigned __int128;

/// Brings a sum below 2^64 into [0, 2^61 + 7]: congruent, not canonical.
std::uint64_t fold_once(std::uint64_t x) {
    return (x & mersenne61) + (x >> 61);
}

std::uint64_t canonical(std::uint64_t x) {
    x = fold_once(x);
    return x >= mersenne61 ? x - mersenne61 : x;
}

/// A product of two numbers below 2^62 as a number below 2^63: 2^61 = 1.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    const Wide wide = static_cast<Wide>(a) * b;
    return (static_cast<std::uint64_t>(wide) & mersenne61) + static_cast<std::uint64_t>(wide >> 61);
}

/// x 2^k for x < 2^61, 0 <= k <= 61.
std::uint64_t rotate(std::uint64_t x, int k) {
    return ((x << k) & mersenne61) | (x >> (61 - k));
}

/// Left-looking (Gilbert-Peierls) elimination of one diagonal block: symbolic reach by depth-first search with
/// symmetric pruning. The matched diagonal is preferred as pivot, for the sake of fill; any other row with a non-zero
/// value serves when it vanishes. Rows carry the label of their position in the block; pivot j is the j-th pivot found.
class BlockElimination {
  public:
    explicit BlockElimination(std::size_t largest)
        : value_(largest, 0), mark_(largest), pivot_of_(largest), row_of_(largest), stack_(largest), resume_(largest),
          order_(largest), reciprocal_(largest) {
        lower_start_.reserve(largest);
        lower_end_.reserve(largest);
        pruned_end_.reserve(largest);
    }

    /// Number of independent columns. `column(k, visit)` calls visit(i, a) for the entries of column k, in positions of
    /// the block.
    template <class Column> int rank(int size, Column column) {
        lower_row_.clear();
        lower_value_.clear();
        lower_start_.clear();
        lower_end_.clear();
        pruned_end_.clear();
        for (std::size_t k = 0; k < static_cast<std::size_t>(size); ++k) {
            mark_[k] = -1;
            pivot_of_[k] = -1;
        }
        pivots_ = 0;
        for (int k = 0; k < size; ++k) {
            eliminate(k, column);
        }
        return pivots_;
    }

  private:
    template <class Column> void eliminate(int k, Column column) {
        top_ = static_cast<int>(order_.size());
        below_.clear();
        column(k, [&](int i, std::uint64_t a) {
            if (mark_[static_cast<std::size_t>(i)] != k) {
                visit(i, k);
            }
            value_[static_cast<std::size_t>(i)] = a;
        });
        for (std::size_t t = static_cast<std::size_t>(top_); t < order_.size(); ++t) {
            const auto j = static_cast<std::size_t>(order_[t]);
            const auto pivot_row = static_cast<std::size_t>(row_of_[j]);
            const std::uint64_t entry = value_[pivot_row];
            value_[pivot_row] = 0;
            const int begin = lower_start_[j];
            const int end = lower_end_[j];
            if (begin == end) {
                continue;
            }
            if (reciprocal_[j] == 0) {
                invert_pending();
            }
            // Negated, so that elimination adds; shifted by 3 bits, so that 2^61 = 1 falls on the boundary of the two
            // words of a product.
            const std::uint64_t factor = (mersenne61 - canonical(product(entry, reciprocal_[j]))) << 3;
            for (int e = begin; e < end; ++e) {
                const auto s = static_cast<std::size_t>(e);
                const Wide wide = static_cast<Wide>(lower_value_[s]) * factor;
                auto& x = value_[static_cast<std::size_t>(lower_row_[s])];
                // x < 2^61 + 8, the words of the product < 2^61 + 8 and 2^61: no overflow, and folding brings the sum
                // back below 2^61 + 8.
                x = fold_once(x + static_cast<std::uint64_t>(wide >> 64) + (static_cast<std::uint64_t>(wide) >> 3));
            }
        }
        const auto diagonal = static_cast<std::size_t>(k);
        int chosen = -1;
        if (mark_[diagonal] == k && pivot_of_[diagonal] < 0 && canonical(value_[diagonal]) != 0) {
            chosen = k;
        }
        for (std::size_t b = 0; b < below_.size() && chosen < 0; ++b) {
            if (canonical(value_[static_cast<std::size_t>(below_[b])]) != 0) {
                chosen = below_[b];
            }
        }
        if (chosen >= 0) {
            const auto pivot_row = static_cast<std::size_t>(chosen);
            const int begin = static_cast<int>(lower_row_.size());
            reciprocal_[static_cast<std::size_t>(pivots_)] = 0;
            if (below_.size() > 1) {
                for (const int i : below_) {
                    if (i != chosen) { // zeros stay too: pruning relies on the structural pattern
                        lower_row_.push_back(i);
                        lower_value_.push_back(value_[static_cast<std::size_t>(i)]);
                    }
                }
                pending_.push_back({static_cast<std::size_t>(pivots_), canonical(value_[pivot_row])});
            }
            const int end = static_cast<int>(lower_row_.size());
            lower_start_.push_back(begin);
            lower_end_.push_back(end);
            pruned_end_.push_back(end);
            pivot_of_[pivot_row] = pivots_;
            row_of_[static_cast<std::size_t>(pivots_)] = chosen;
            ++pivots_;
            prune(chosen);
        }
        for (const int i : below_) {
            value_[static_cast<std::size_t>(i)] = 0;
        }
    }

    /// Reciprocals of all pivots found since the last call, with a single inversion: the product of all is inverted and
    /// taken apart.
    void invert_pending() {
        std::uint64_t all = 1;
        for (const auto& [j, pivot] : pending_) {
            reciprocal_[j] = all; // product of the pivots before j, for the way back
            all = fold_once(product(all, pivot));
        }
        all = inverse(canonical(all));
        for (std::size_t b = pending_.size(); b-- > 0;) {
            const auto& [j, pivot] = pending_[b];
            reciprocal_[j] = fold_once(product(reciprocal_[j], all));
            all = fold_once(product(all, pivot));
        }
        pending_.clear();
    }

    /// Depth-first search from row i through the columns of L already made; appends to the topological order or to
    /// `below_`.
    void visit(int i, int k) {
        mark_[static_cast<std::size_t>(i)] = k;
        if (pivot_of_[static_cast<std::size_t>(i)] < 0) {
            below_.push_back(i);
            return;
        }
        int depth = 0;
        stack_[0] = pivot_of_[static_cast<std::size_t>(i)];
        resume_[0] = lower_start_[static_cast<std::size_t>(stack_[0])];
        while (depth >= 0) {
            const auto d = static_cast<std::size_t>(depth);
            const int end = pruned_end_[static_cast<std::size_t>(stack_[d])];
            bool deeper = false;
            for (int e = resume_[d]; e < end; ++e) {
                const auto child = static_cast<std::size_t>(lower_row_[static_cast<std::size_t>(e)]);
                if (mark_[child] == k) {
                    continue;
                }
                mark_[child] = k;
                const int pivot = pivot_of_[child];
                if (pivot < 0) {
                    below_.push_back(static_cast<int>(child));
                    continue;
                }
                resume_[d] = e + 1;
                ++depth;
                stack_[d + 1] = pivot;
                resume_[d + 1] = lower_start_[static_cast<std::size_t>(pivot)];
                deeper = true;
                break;
            }
            if (!deeper) {
                order_[static_cast<std::size_t>(--top_)] = stack_[d];
                --depth;
            }
        }
    }

    /// Symmetric pruning: once U has (pivot of j, k) and L's column j has the new pivot row, later searches from j may
    /// stop at the rows that are pivotal by now: the others are reached through the new pivot.
    void prune(int new_pivot_row) {
        for (std::size_t t = static_cast<std::size_t>(top_); t < order_.size(); ++t) {
            const auto j = static_cast<std::size_t>(order_[t]);
            if (pruned_end_[j] != lower_end_[j]) {
                continue;
            }
            bool symmetric = false;
            for (int e = lower_start_[j]; e < lower_end_[j] && !symmetric; ++e) {
                symmetric = lower_row_[static_cast<std::size_t>(e)] == new_pivot_row;
            }
            if (!symmetric) {
                continue;
            }
            int low = lower_start_[j];
            int high = lower_end_[j];
            while (low < high) {
                const auto s = static_cast<std::size_t>(low);
                if (pivot_of_[static_cast<std::size_t>(lower_row_[s])] >= 0) {
                    ++low;
                } else {
                    --high;
                    std::swap(lower_row_[s], lower_row_[static_cast<std::size_t>(high)]);
                    std::swap(lower_value_[s], lower_value_[static_cast<std::size_t>(high)]);
                }
            }
            pruned_end_[j] = low;
        }
    }

    std::vector<std::uint64_t> value_; ///< the column in work, below 2^61 + 8, 0 elsewhere
    std::vector<int> mark_, pivot_of_, row_of_, stack_, resume_, order_, below_;
    std::vector<int> lower_start_, lower_end_, pruned_end_, lower_row_;
    std::vector<std::uint64_t> lower_value_;                     ///< below 2^61 + 8, not divided by the pivot
    std::vector<std::uint64_t> reciprocal_;                      ///< of pivot j, below 2^61 + 8; 0 while pending
    std::vector<std::pair<std::size_t, std::uint64_t>> pending_; ///< pivots not inverted yet
    int top_ = 0;
    int pivots_ = 0;
};

} // namespace

std::uint64_t multiply(std::uint64_t a, std::uint64_t b) {
    return canonical(product(a, b));
}

std::uint64_t subtract(std::uint64_t a, std::uint64_t b) {
    return a >= b ? a - b : a + mersenne61 - b;
}

std::uint64_t inverse(std::uint64_t a) {
    assert(a != 0);
    // Binary extended Euclid without reductions (Kaliski's almost inverse): a r = -e u 2^k and a s = e v 2^k mod p with
    // e = +-1, u s + v r = p, so that nothing overflows. At u = v = 1 only 2^k is left to divide by, a rotation. No
    // unpredictable branch.
    std::uint64_t u = mersenne61;
    int k = std::countr_zero(a);
    std::uint64_t v = a >> k;
    std::uint64_t r = 0;
    std::uint64_t s = 1;
    std::uint64_t negative = 0;
    for (std::uint64_t d = u - v; d != 0; d = u - v) {
        const std::uint64_t swap = u > v ? ~std::uint64_t{0} : 0; // v is kept when it is the smaller
        const int zeros = std::countr_zero(d);
        const std::uint64_t sum = r + s;
        r = (r ^ ((r ^ s) & swap)) << zeros;
        s = sum;
        u = v + (d & ~swap);
        v = ((d ^ ~swap) - ~swap) >> zeros;
        negative ^= swap;
        k += zeros;
    }
    const std::uint64_t x = rotate(s, 61 - k % 61);
    return negative != 0 ? mersenne61 - x : x;
}

std::uint64_t residue(double value) {
    assert(std::isfinite(value));
    if (value == 0) {
        return 0;
    }
    int exponent = 0;
    const double mantissa = std::frexp(std::abs(value), &exponent);
    const auto integer = static_cast<std::uint64_t>(std::ldexp(mantissa, 53)); // exact: 53 bits, also for denormals
    const int shift = ((exponent - 53) % 61 + 61) % 61;                        // 2^61 = 1: powers of two rotate
    const Wide wide = static_cast<Wide>(integer) << shift;
    const std::uint64_t r =
        canonical((static_cast<std::uint64_t>(wide) & mersenne61) + static_cast<std::uint64_t>(wide >> 61));
    return value < 0 && r != 0 ? mersenne61 - r : r;
}

int rank(const sparse::Matrix<std::uint64_t>& matrix, const sparse::Ordering& ordering) {
    assert(ordering.structurally_regular());
    const std::vector<int>& block_start = ordering.block_start();
    std::vector<int> position(static_cast<std::size_t>(matrix.rows));
    for (std::size_t k = 0; k < position.size(); ++k) {
        position[static_cast<std::size_t>(ordering.row_order()[k])] = static_cast<int>(k);
    }
    int largest = 1;
    for (std::size_t b = 0; b + 1 < block_start.size(); ++b) {
        largest = std::max(largest, block_start[b + 1] - block_start[b]);
    }
    BlockElimination elimination(static_cast<std::size_t>(largest));
    int total = 0;
    for (std::size_t b = 0; b + 1 < block_start.size(); ++b) {
        const int first = block_start[b];
        const int last = block_start[b + 1];
        total += elimination.rank(last - first, [&](int k, auto visit) {
            const auto column = static_cast<std::size_t>(ordering.column_order()[static_cast<std::size_t>(first + k)]);
            for (int e = matrix.start[column]; e < matrix.start[column + 1]; ++e) {
                const auto s = static_cast<std::size_t>(e);
                const int i = position[static_cast<std::size_t>(matrix.row[s])];
                if (i >= first && i < last) {
                    visit(i - first, matrix.value[s]);
                }
            }
        });
    }
    return total;
}

int rank(const sparse::Matrix<std::uint64_t>& matrix) {
    return static_cast<int>(independent_columns(matrix).size());
}

} // namespace isostat::exact
