#include "exact/independent_columns.hpp"

#include <isostat/exact/rank.hpp>

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace isostat::exact {

std::vector<int> independent_columns(const sparse::Matrix<std::uint64_t>& matrix) {
    const auto rows = static_cast<std::size_t>(matrix.rows);
    std::vector<std::vector<std::pair<int, std::uint64_t>>> lower; // multipliers of each pivot column
    std::vector<int> pivot_of_row(rows, -1);
    std::vector<int> row_weight(rows, 0);
    for (const int r : matrix.row) {
        ++row_weight[static_cast<std::size_t>(r)];
    }
    std::vector<std::uint64_t> x(rows, 0);
    std::vector<unsigned char> seen(rows, 0);
    std::vector<int> touched;
    std::vector<int> independent;
    std::vector<int> row_of_pivot;
    for (int column = 0; column < matrix.cols && independent.size() < rows; ++column) {
        std::priority_queue<int, std::vector<int>, std::greater<>> pending; // pivots to apply, in order
        const auto touch = [&](int r) {
            const auto i = static_cast<std::size_t>(r);
            if (seen[i] == 0) {
                seen[i] = 1;
                touched.push_back(r);
                if (pivot_of_row[i] >= 0) {
                    pending.push(pivot_of_row[i]);
                }
            }
        };
        for (int e = matrix.start[static_cast<std::size_t>(column)];
             e < matrix.start[static_cast<std::size_t>(column) + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            x[static_cast<std::size_t>(matrix.row[s])] = matrix.value[s];
            touch(matrix.row[s]);
        }
        while (!pending.empty()) {
            const auto pivot = static_cast<std::size_t>(pending.top());
            pending.pop();
            const std::uint64_t factor = x[static_cast<std::size_t>(row_of_pivot[pivot])];
            if (factor == 0) {
                continue;
            }
            for (const auto& [r, multiplier] : lower[pivot]) {
                touch(r);
                auto& value = x[static_cast<std::size_t>(r)];
                value = subtract(value, multiply(multiplier, factor));
            }
        }
        int chosen = -1;
        for (const int r : touched) {
            const auto i = static_cast<std::size_t>(r);
            if (pivot_of_row[i] < 0 && x[i] != 0 &&
                (chosen < 0 || row_weight[i] < row_weight[static_cast<std::size_t>(chosen)] ||
                 (row_weight[i] == row_weight[static_cast<std::size_t>(chosen)] && r < chosen))) {
                chosen = r;
            }
        }
        if (chosen >= 0) {
            const auto c = static_cast<std::size_t>(chosen);
            pivot_of_row[c] = static_cast<int>(independent.size());
            row_of_pivot.push_back(chosen);
            independent.push_back(column);
            const std::uint64_t reciprocal = inverse(x[c]);
            lower.emplace_back();
            for (const int r : touched) {
                const auto i = static_cast<std::size_t>(r);
                if (x[i] != 0 && pivot_of_row[i] < 0) {
                    lower.back().emplace_back(r, multiply(x[i], reciprocal));
                }
            }
        }
        for (const int r : touched) {
            x[static_cast<std::size_t>(r)] = 0;
            seen[static_cast<std::size_t>(r)] = 0;
        }
        touched.clear();
    }
    return independent;
}

} // namespace isostat::exact
