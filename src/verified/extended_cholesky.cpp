#include "verified/block_cholesky.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <qd/dd_real.h>

#include <cmath>
#include <vector>

template <> struct Eigen::NumTraits<dd_real> : Eigen::GenericNumTraits<dd_real> {
    using Real = dd_real;
    using NonInteger = dd_real;
    using Nested = dd_real;
    enum { // NOLINTBEGIN(readability-identifier-naming): as Eigen names them
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 1,
        ReadCost = 2,
        AddCost = 20, // exact: cost that Eigen is told
        MulCost = 30  // exact: cost that Eigen is told
    };                // NOLINTEND(readability-identifier-naming)
};

namespace isostat {

double shifted_cholesky_double_double(const sparse::Matrix<double>& h, double shift) {
    using Sparse = Eigen::SparseMatrix<dd_real>;
    std::vector<Eigen::Triplet<dd_real>> entries;
    entries.reserve(10 * static_cast<std::size_t>(h.cols)); // cost: memory reserved
    std::vector<double> diagonal(static_cast<std::size_t>(h.rows), 0.0);
    std::vector<double> terms(static_cast<std::size_t>(h.rows), 4.0); // bounds.md V1 (t_k)
    for (std::size_t j = 0; j < static_cast<std::size_t>(h.cols); ++j) {
        for (int a = h.start[j]; a < h.start[j + 1]; ++a) {
            const auto s = static_cast<std::size_t>(a);
            const auto row = static_cast<std::size_t>(h.row[s]);
            diagonal[row] += h.value[s] * h.value[s];
            terms[row] += 1;
            for (int b = h.start[j]; b <= a; ++b) { // rows are sorted: the lower triangle
                const auto t = static_cast<std::size_t>(b);
                entries.emplace_back(h.row[s], h.row[t], dd_real(h.value[s]) * h.value[t]);
            }
        }
    }
    Sparse product(h.rows, h.rows);
    product.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::AMDOrdering<int>> cholesky;
    cholesky.setShift(dd_real(-shift));
    cholesky.compute(product);
    if (cholesky.info() != Eigen::Success) {
        return 0;
    }
    const Sparse& lower = cholesky.matrixL().nestedExpression();
    std::vector<double> in_factor(terms.size(), 0.0);
    for (int j = 0; j < lower.outerSize(); ++j) {
        for (Sparse::InnerIterator entry(lower, j); entry; ++entry) {
            if (!std::isfinite(entry.value().x[0])) {
                return 0; // a pivot that is not a number passes Eigen's test
            }
            in_factor[static_cast<std::size_t>(entry.row())] += 1;
        }
    }
    // 2^-96 per term: an addition of libqd errs by at most 2^-103 of the sum of magnitudes, a product by less; 2^7
    // covers the accumulation.
    double sum = 0;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const auto row = static_cast<std::size_t>(cholesky.permutationPinv().indices()[static_cast<Eigen::Index>(i)]);
        const double m = terms[row] + in_factor[i];
        sum += m * 0x1p-96 * (2 * diagonal[row] + shift); // bounds.md V1 (second rung)
    }
    const double bound = shift - sum * 1.01 - 1e-290; // bounds.md V1
    return bound > 0 ? bound * (1 - 0x1p-50) : 0;     // precision.md B1 (last operations)
}

} // namespace isostat
