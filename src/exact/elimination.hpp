#pragma once
// Left-looking sparse elimination mod p with supernodes. Only what the rank needs is kept: the columns of L, not U.

#include "exact/field.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace isostat::exact {

/// Gilbert-Peierls elimination: columns one after the other, each by a depth-first search for the columns of L that act
/// on it (with symmetric pruning) and by those actions. Successive columns of L with the same rows form a supernode:
/// one search step, one row list, and four of them act at once with a single reduction. Rows are labelled 0 ... rows -
/// 1. The object is a workspace for repeated use.
template <class Field> class Elimination {
  public:
    using Value = typename Field::Value;
    using Word = typename Field::Word;

    /// Clears the workspace for columns with rows below `rows`.
    void start(std::size_t rows);

    /// Eliminates the next column, whose entries `rows[e]`, `values[e]` (residues, no row twice) are given. Returns
    /// whether it is independent of the columns before. The pivot is row `preferred` when its value is not zero,
    /// otherwise the candidate with the smallest `weight` (the first candidate when `weight` is empty). \pre preferred
    /// >= 0 or weight given, sizes fit `start`.
    bool append(std::span<const int> rows, std::span<const Value> values, int preferred,
                std::span<const int> weight = {});

    /// Number of independent columns so far, and the row of the last pivot.
    [[nodiscard]] int rank() const { return pivots_; }
    [[nodiscard]] int pivot_row() const { return row_of_.back(); }

  private:
    /// Pivots [first, first + width) whose columns share the rows [begin, end) of `rows_`: the first width - 1 are the
    /// pivot rows of the second, third ... column, the rest are below all. Column c of the node holds no value for the
    /// rows before its own pivot.
    struct Node {
        int first, width;
        int begin, end;
        int search_end; ///< the depth-first search reads rows [begin + width - 1, search_end)
        bool pruned;
    };
    struct Frame {
        int node, next;
    };

    void reach(int row);
    bool enter(int pivot);
    void act(const Node& node, int first_column);
    template <std::size_t Columns> void act_together(const Node& node, int column);
    [[nodiscard]] int choose_pivot(int preferred, std::span<const int> weight) const;
    void store(int pivot_row);
    void join(Node& node, int pivot_row);
    void prune(int pivot_row);
    void exchange_rows(const Node& node, int a, int b);
    void invert_pending();

    [[nodiscard]] Value* column_values(int pivot) {
        return values_.data() + value_begin_[static_cast<std::size_t>(pivot)];
    }

    std::vector<Word> work_; ///< by row: the column in work, with the bound of `Field::add_products`; 0 elsewhere
    std::vector<int> state_; ///< by row: its pivot, or -2 - (last column that reached it), or -1
    std::vector<int> row_of_, node_of_;       ///< by pivot
    std::vector<Value> reciprocal_;           ///< by pivot: 1 / pivot; 0 while pending
    std::vector<std::ptrdiff_t> value_begin_; ///< by pivot: where the value of the node's row q is, minus (q - begin)
    std::vector<Node> nodes_;
    std::vector<int> node_mark_, low_; ///< by node: last column that reached it, and from which of its columns on
    std::vector<int> rows_;
    std::vector<Value> values_;        ///< not divided by the pivot
    std::vector<int> below_, reached_; ///< rows without pivot; nodes in the order in which their search ended
    std::vector<Frame> stack_;
    std::vector<std::pair<std::size_t, Value>> pending_; ///< pivots not inverted yet
    int column_ = 0;
    int pivots_ = 0;
};

extern template class Elimination<Field<61>>;
extern template class Elimination<Field<31>>;

} // namespace isostat::exact
