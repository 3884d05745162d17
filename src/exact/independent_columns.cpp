#include "exact/elimination.hpp"
#include "exact/rank.hpp"

namespace isostat::exact {

std::vector<int> independent_columns(const sparse::Matrix<std::uint64_t>& matrix) {
    std::vector<int> weight(static_cast<std::size_t>(matrix.rows), 0);
    for (const int row : matrix.row) {
        ++weight[static_cast<std::size_t>(row)];
    }
    Elimination<Field<61>> elimination;
    elimination.start(weight.size());
    std::vector<int> independent;
    for (int column = 0; column < matrix.cols && elimination.rank() < matrix.rows; ++column) {
        const auto begin = static_cast<std::size_t>(matrix.start[static_cast<std::size_t>(column)]);
        const auto count = static_cast<std::size_t>(matrix.start[static_cast<std::size_t>(column) + 1]) - begin;
        if (elimination.append({matrix.row.data() + begin, count}, {matrix.value.data() + begin, count}, -1, weight)) {
            independent.push_back(column);
        }
    }
    return independent;
}

} // namespace isostat::exact
