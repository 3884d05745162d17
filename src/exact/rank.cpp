#include <isostat/exact/independent_columns.hpp>
#include <isostat/exact/rank.hpp>

#include <cassert>
#include <cmath>
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

std::uint64_t square_repeatedly(std::uint64_t a, int times) {
    for (int k = 0; k < times; ++k) {
        a = fold_once(product(a, a));
    }
    return a;
}

/// Arithmetic of the elimination mod 2^61 - 1. `Work` holds a number congruent to the value, below 2^61 + 8.
struct Field61 {
    using Value = std::uint64_t;
    using Work = std::uint64_t;
    static Work add_product(Work x, Value a, Value b) {
        return fold_once(x + product(a, b));
    } // < 2^61 + 8 + 2^62 + 16: no overflow
    static Value reduce(Work x) { return canonical(x); }
    static Value negative_inverse(Value a) { return mersenne61 - inverse(a); }
    static Value scaled(Work x, Value a) { return canonical(product(fold_once(x), a)); }
};

/// The same mod 2^31 - 1, half the memory and no 128-bit products. `Work` is below 2^63.
struct Field31 {
    using Value = std::uint32_t;
    using Work = std::uint64_t;
    static constexpr std::uint64_t p = mersenne31;
    static Work add_product(Work x, Value a, Value b) {
        return (x & p) + (x >> 31) + static_cast<std::uint64_t>(a) * b; // < 2^31 + 2^32 + 2^62
    }
    static Value reduce(Work x) {
        x = (x & p) + (x >> 31);
        x = (x & p) + (x >> 31);
        return static_cast<Value>(x >= p ? x - p : x);
    }
    static Value times(Value a, Value b) { return reduce(static_cast<std::uint64_t>(a) * b); }
    static Value squared(Value a, int times_) {
        for (int k = 0; k < times_; ++k) {
            a = times(a, a);
        }
        return a;
    }
    static Value negative_inverse(Value a) {
        // Fermat: a^(2^31 - 3), 2^31 - 3 = 4 (2^29 - 1) + 1; x_n = a^(2^n - 1).
        const Value x2 = times(squared(a, 1), a);
        const Value x3 = times(squared(x2, 1), a);
        const Value x6 = times(squared(x3, 3), x3);
        const Value x7 = times(squared(x6, 1), a);
        const Value x14 = times(squared(x7, 7), x7);
        const Value x28 = times(squared(x14, 14), x14);
        const Value x29 = times(squared(x28, 1), a);
        return static_cast<Value>(p - times(squared(x29, 2), a));
    }
    static Value scaled(Work x, Value a) { return times(reduce(x), a); }
};

/// Left-looking (Gilbert-Peierls) elimination of one diagonal block: symbolic reach by depth-first search with
/// symmetric pruning. The matched diagonal is preferred as pivot, for the sake of fill; any other row with a non-zero
/// value serves when it vanishes. Rows carry the label of their position in the block; pivot j is the j-th pivot found.
template <class Field> class BlockElimination {
    using Value = typename Field::Value;

  public:
    explicit BlockElimination(std::size_t largest)
        : value_(largest, 0), mark_(largest), pivot_of_(largest), row_of_(largest), stack_(largest), resume_(largest),
          order_(largest) {
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
        column(k, [&](int i, Value a) {
            if (mark_[static_cast<std::size_t>(i)] != k) {
                visit(i, k);
            }
            value_[static_cast<std::size_t>(i)] = a;
        });
        for (std::size_t t = static_cast<std::size_t>(top_); t < order_.size(); ++t) {
            const auto j = static_cast<std::size_t>(order_[t]);
            const auto pivot_row = static_cast<std::size_t>(row_of_[j]);
            const Value factor = Field::reduce(value_[pivot_row]);
            value_[pivot_row] = 0;
            for (int e = lower_start_[j]; e < lower_end_[j]; ++e) {
                const auto s = static_cast<std::size_t>(e);
                auto& x = value_[static_cast<std::size_t>(lower_row_[s])];
                x = Field::add_product(x, lower_value_[s], factor);
            }
        }
        const auto diagonal = static_cast<std::size_t>(k);
        int chosen = -1;
        if (mark_[diagonal] == k && pivot_of_[diagonal] < 0 && Field::reduce(value_[diagonal]) != 0) {
            chosen = k;
        }
        for (std::size_t b = 0; b < below_.size() && chosen < 0; ++b) {
            if (Field::reduce(value_[static_cast<std::size_t>(below_[b])]) != 0) {
                chosen = below_[b];
            }
        }
        if (chosen >= 0) {
            const auto pivot_row = static_cast<std::size_t>(chosen);
            const int begin = static_cast<int>(lower_row_.size());
            if (below_.size() > 1) {
                // The multipliers are stored negated, so that elimination adds.
                const Value scale = Field::negative_inverse(Field::reduce(value_[pivot_row]));
                for (const int i : below_) {
                    if (i != chosen) { // zeros stay too: pruning relies on the structural pattern
                        lower_row_.push_back(i);
                        lower_value_.push_back(Field::scaled(value_[static_cast<std::size_t>(i)], scale));
                    }
                }
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

    std::vector<typename Field::Work> value_; ///< the column in work, 0 elsewhere
    std::vector<int> mark_, pivot_of_, row_of_, stack_, resume_, order_, below_;
    std::vector<int> lower_start_, lower_end_, pruned_end_, lower_row_;
    std::vector<Value> lower_value_;
    int top_ = 0;
    int pivots_ = 0;
};

template <class Field>
int rank_in_blocks(const sparse::Matrix<typename Field::Value>& matrix, const sparse::Ordering& ordering) {
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
    BlockElimination<Field> elimination(static_cast<std::size_t>(largest));
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

} // namespace

std::uint64_t multiply(std::uint64_t a, std::uint64_t b) {
    return canonical(product(a, b));
}

std::uint64_t subtract(std::uint64_t a, std::uint64_t b) {
    return a >= b ? a - b : a + mersenne61 - b;
}

std::uint64_t inverse(std::uint64_t a) {
    assert(a != 0);
    // Fermat: a^(2^61 - 3). x_n = a^(2^n - 1), and 2^61 - 3 = 4 (2^59 - 1) + 1.
    const std::uint64_t x1 = a;
    const std::uint64_t x2 = fold_once(product(square_repeatedly(x1, 1), x1));
    const std::uint64_t x3 = fold_once(product(square_repeatedly(x2, 1), x1));
    const std::uint64_t x6 = fold_once(product(square_repeatedly(x3, 3), x3));
    const std::uint64_t x7 = fold_once(product(square_repeatedly(x6, 1), x1));
    const std::uint64_t x14 = fold_once(product(square_repeatedly(x7, 7), x7));
    const std::uint64_t x28 = fold_once(product(square_repeatedly(x14, 14), x14));
    const std::uint64_t x29 = fold_once(product(square_repeatedly(x28, 1), x1));
    const std::uint64_t x58 = fold_once(product(square_repeatedly(x29, 29), x29));
    const std::uint64_t x59 = fold_once(product(square_repeatedly(x58, 1), x1));
    return canonical(product(square_repeatedly(x59, 2), x1));
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

std::uint32_t residue31(double value) {
    assert(std::isfinite(value));
    if (value == 0) {
        return 0;
    }
    int exponent = 0;
    const double mantissa = std::frexp(std::abs(value), &exponent);
    const auto integer = static_cast<std::uint64_t>(std::ldexp(mantissa, 53));
    const int shift = ((exponent - 53) % 31 + 31) % 31;
    const auto r = Field31::reduce(static_cast<std::uint64_t>(Field31::reduce(integer)) << shift);
    return value < 0 && r != 0 ? mersenne31 - r : r;
}

int rank(const sparse::Matrix<std::uint64_t>& matrix, const sparse::Ordering& ordering) {
    return rank_in_blocks<Field61>(matrix, ordering);
}

int rank(const sparse::Matrix<std::uint32_t>& matrix, const sparse::Ordering& ordering) {
    return rank_in_blocks<Field31>(matrix, ordering);
}

int rank(const sparse::Matrix<std::uint64_t>& matrix) {
    return static_cast<int>(independent_columns(matrix).size());
}

} // namespace isostat::exact
