#include "exact/elimination.hpp"

#include <algorithm>
#include <array>

namespace isostat::exact {

template <class Field> void Elimination<Field>::start(std::size_t rows) {
    work_.assign(rows, 0);
    state_.assign(rows, -1);
    row_of_.clear();
    node_of_.clear();
    reciprocal_.clear();
    value_begin_.clear();
    nodes_.clear();
    node_mark_.clear();
    low_.clear();
    rows_.clear();
    values_.clear();
    pending_.clear();
    column_ = 0;
    pivots_ = 0;
}

template <class Field>
bool Elimination<Field>::append(std::span<const int> rows, std::span<const Value> values, int preferred,
                                std::span<const int> weight) {
    below_.clear();
    reached_.clear();
    for (std::size_t e = 0; e < rows.size(); ++e) {
        reach(rows[e]);
        work_[static_cast<std::size_t>(rows[e])] = values[e];
    }
    for (std::size_t t = reached_.size(); t-- > 0;) { // each node before the nodes that it changes
        const auto s = static_cast<std::size_t>(reached_[t]);
        act(nodes_[s], low_[s]);
    }
    const int pivot_row = choose_pivot(preferred, weight);
    if (pivot_row >= 0) {
        store(pivot_row);
    }
    for (const int row : below_) {
        work_[static_cast<std::size_t>(row)] = 0;
    }
    ++column_;
    return pivot_row >= 0;
}

/// Depth-first search from one row through the nodes: fills `below_`, `reached_` and `low_`.
template <class Field> void Elimination<Field>::reach(int row) {
    const int mark = -2 - column_;
    if (state_[static_cast<std::size_t>(row)] < 0) {
        if (state_[static_cast<std::size_t>(row)] != mark) {
            state_[static_cast<std::size_t>(row)] = mark;
            below_.push_back(row);
        }
        return;
    }
    enter(state_[static_cast<std::size_t>(row)]);
    while (!stack_.empty()) {
        const std::size_t depth = stack_.size();
        const int end = nodes_[static_cast<std::size_t>(stack_.back().node)].search_end;
        for (int next = stack_.back().next; next < end; ++next) {
            const int r = rows_[static_cast<std::size_t>(next)];
            int& state = state_[static_cast<std::size_t>(r)];
            if (state < 0) {
                if (state != mark) {
                    state = mark;
                    below_.push_back(r);
                }
            } else if (enter(state)) {
                stack_[depth - 1].next = next + 1;
                break;
            }
        }
        if (stack_.size() == depth) {
            reached_.push_back(stack_.back().node);
            stack_.pop_back();
        }
    }
}

/// Visits a pivot in the search: whether its node is new to the current column; a new node is put on the stack.
template <class Field> bool Elimination<Field>::enter(int pivot) {
    const int node = node_of_[static_cast<std::size_t>(pivot)];
    const auto s = static_cast<std::size_t>(node);
    const int first_column = pivot - nodes_[s].first;
    if (node_mark_[s] == column_) {
        low_[s] = std::min(low_[s], first_column);
        return false;
    }
    node_mark_[s] = column_;
    low_[s] = first_column;
    stack_.push_back({node, nodes_[s].begin + nodes_[s].width - 1});
    return true;
}

/// Subtracts what makes the pivot rows of `Columns` successive columns of the node vanish in the current column.
template <class Field>
template <std::size_t Columns>
void Elimination<Field>::act_together(const Node& node, int column) {
    std::array<Value, Columns> factor{};
    std::array<const Value*, Columns> l{};
    for (std::size_t k = 0; k < Columns; ++k) {
        const auto pivot = static_cast<std::size_t>(node.first + column) + k;
        l[k] = column_values(static_cast<int>(pivot));
    }
    for (std::size_t k = 0; k < Columns; ++k) {
        const auto pivot = static_cast<std::size_t>(node.first + column) + k;
        // Applies the earlier ones of these columns to the pivot row of column k.
        Word entry = std::exchange(work_[static_cast<std::size_t>(row_of_[pivot])], 0);
        for (std::size_t b = 0; b < k; ++b) {
            entry = Field::template add_products<1>(entry, {l[b]}, {factor[b]}, column + static_cast<int>(k) - 1);
        }
        if (reciprocal_[pivot] == 0) {
            invert_pending();
        }
        factor[k] = Field::negate(Field::multiply(Field::canonical(entry), reciprocal_[pivot])); // elimination adds
    }
    const int* const row = rows_.data() + node.begin;
    Word* const work = work_.data();
    const std::ptrdiff_t end = node.end - node.begin;
    for (std::ptrdiff_t q = column + static_cast<int>(Columns) - 1; q < end; ++q) {
        work[row[q]] = Field::add_products(work[row[q]], l, factor, q);
    }
}

template <class Field> void Elimination<Field>::act(const Node& node, int first_column) {
    int column = first_column;
    for (; node.width - column >= 4; column += 4) {
        act_together<4>(node, column);
    }
    switch (node.width - column) {
    case 3: act_together<3>(node, column); break;
    case 2: act_together<2>(node, column); break;
    case 1: act_together<1>(node, column); break;
    default: break;
    }
}

template <class Field> int Elimination<Field>::choose_pivot(int preferred, std::span<const int> weight) const {
    const auto candidate = [&](int row) { return Field::canonical(work_[static_cast<std::size_t>(row)]) != 0; };
    if (preferred >= 0) {
        const auto r = static_cast<std::size_t>(preferred);
        if (state_[r] == -2 - column_ && candidate(preferred)) {
            return preferred;
        }
    }
    int chosen = -1;
    for (const int row : below_) {
        if (candidate(row) && (chosen < 0 || (!weight.empty() && weight[static_cast<std::size_t>(row)] <
                                                                     weight[static_cast<std::size_t>(chosen)]))) {
            chosen = row;
            if (weight.empty()) {
                break;
            }
        }
    }
    return chosen;
}

/// Makes the current column a column of L: of the last node when the rows agree, otherwise of a new node.
template <class Field> void Elimination<Field>::store(int pivot_row) {
    const auto r = static_cast<std::size_t>(pivot_row);
    state_[r] = pivots_;
    row_of_.push_back(pivot_row);
    reciprocal_.push_back(0);
    if (below_.size() > 1) {
        pending_.emplace_back(static_cast<std::size_t>(pivots_), Field::canonical(work_[r]));
    } else {
        reciprocal_.back() = 1; // this column changes no row
    }
    // A reached node has all its rows in `below_`, so an equal number of rows means equal rows.
    const bool same_rows =
        !nodes_.empty() && node_mark_.back() == column_ &&
        static_cast<int>(below_.size()) == nodes_.back().end - nodes_.back().begin - nodes_.back().width + 1;
    if (same_rows) {
        join(nodes_.back(), pivot_row);
    } else {
        const int begin = static_cast<int>(rows_.size());
        const int end = begin + static_cast<int>(below_.size()) - 1;
        value_begin_.push_back(static_cast<std::ptrdiff_t>(values_.size()));
        rows_.resize(static_cast<std::size_t>(end));
        values_.resize(values_.size() + below_.size() - 1);
        int* next_row = rows_.data() + begin;
        Value* next_value = column_values(pivots_);
        for (const int row : below_) {
            if (row != pivot_row) { // zeros are stored: pruning and supernodes rely on the structural pattern
                *next_row++ = row;
                *next_value++ = Field::canonical(work_[static_cast<std::size_t>(row)]);
            }
        }
        nodes_.push_back({pivots_, 1, begin, end, end, false});
        node_mark_.push_back(-1);
        low_.push_back(0);
    }
    node_of_.push_back(static_cast<int>(nodes_.size()) - 1);
    ++pivots_;
    prune(pivot_row);
}

template <class Field> void Elimination<Field>::join(Node& node, int pivot_row) {
    const int place = node.begin + node.width - 1;
    const auto* found = std::find(rows_.data() + place, rows_.data() + node.end, pivot_row);
    exchange_rows(node, place, static_cast<int>(found - rows_.data()));
    ++node.width;
    value_begin_.push_back(static_cast<std::ptrdiff_t>(values_.size()) - (node.width - 1));
    for (int q = place + 1; q < node.end; ++q) {
        values_.push_back(Field::canonical(work_[static_cast<std::size_t>(rows_[static_cast<std::size_t>(q)])]));
    }
}

/// Symmetric pruning: when a node acted on this column and has the new pivot row, later searches from the node may stop
/// at its rows that are pivotal by now, because its other rows are reached through the new pivot.
template <class Field> void Elimination<Field>::prune(int pivot_row) {
    for (const int reached : reached_) {
        Node& node = nodes_[static_cast<std::size_t>(reached)];
        if (node.pruned || reached == node_of_.back()) {
            continue;
        }
        int low = node.begin + node.width - 1;
        int high = node.end;
        if (std::find(rows_.data() + low, rows_.data() + high, pivot_row) == rows_.data() + high) {
            continue;
        }
        while (low < high) {
            if (state_[static_cast<std::size_t>(rows_[static_cast<std::size_t>(low)])] >= 0) {
                ++low;
            } else {
                exchange_rows(node, low, --high);
            }
        }
        node.search_end = low;
        node.pruned = true;
    }
}

template <class Field> void Elimination<Field>::exchange_rows(const Node& node, int a, int b) {
    if (a == b) {
        return;
    }
    std::swap(rows_[static_cast<std::size_t>(a)], rows_[static_cast<std::size_t>(b)]);
    for (int c = 0; c < node.width; ++c) {
        Value* const values = column_values(node.first + c);
        std::swap(values[a - node.begin], values[b - node.begin]);
    }
}

/// Computes the reciprocals of all pivots found since the last call with a single inversion: that of their product,
/// from which each reciprocal follows.
template <class Field> void Elimination<Field>::invert_pending() {
    Value all = 1;
    for (const auto& [pivot, value] : pending_) {
        reciprocal_[pivot] = all; // product of the earlier pivots, used on the way back
        all = Field::multiply(all, value);
    }
    all = Field::inverse(all);
    for (std::size_t b = pending_.size(); b-- > 0;) {
        const auto& [pivot, value] = pending_[b];
        reciprocal_[pivot] = Field::multiply(reciprocal_[pivot], all);
        all = Field::multiply(all, value);
    }
    pending_.clear();
}

template class Elimination<Field<61>>;
template class Elimination<Field<31>>;

} // namespace isostat::exact
