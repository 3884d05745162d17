#include "verified/full_rank.hpp"

#include "verified/block_cholesky.hpp"
#include "verified/row_scales.hpp"
#include "verified/singular_value.hpp"

#include <algorithm>

namespace isostat {

double smallest_row_singular_value(const sparse::Matrix<double>& h, int dimension) {
    sparse::Matrix<double> scaled = h;
    const std::vector<double> scale = row_scales(h);
    for (std::size_t e = 0; e < h.row.size(); ++e) {
        scaled.value[e] *= scale[static_cast<std::size_t>(h.row[e])];
    }
    BlockCholesky cholesky;
    FillOrder order;
    cholesky.set(scaled, order);
    for (double shift = 1; shift > 1e-12; shift /= 4) {
        if (cholesky.factorise(shift)) {
            const double square = shift - cholesky.error_bound(shift);
            return std::max(0.0, smallest_singular_value(square, rounding_of_entries(h, dimension)));
        }
    }
    return 0;
}

} // namespace isostat
