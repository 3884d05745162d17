#pragma once
// Large sparse systems to the digits of any number type: Eigen's LU factors in double, residuals in the type.

#include "oracle/geometry.hpp"

#include <Eigen/SparseLU>
#include <mpfr.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace isostat::oracle {

template <class T> double as_double(const T& x) {
    if constexpr (requires { x.x[0]; }) { // libqd
        return x.x[0];
    } else {
        return static_cast<double>(x);
    }
}

/// NaN where an entry is.
template <class T> T largest_of(const std::vector<T>& x) {
    T largest(0.0);
    for (const T& c : x) {
        const T size(abs(c));
        if (size != size) {
            return size;
        }
        largest = size > largest ? size : largest;
    }
    return largest;
}

/// Power of 2 above x.
template <class T> int exponent_of(const T& x) {
    int exponent = 0;
    if constexpr (requires { x.x[0]; }) {
        (void)std::frexp(x.x[0], &exponent);
    } else {
        using std::frexp;
        (void)T(frexp(x, &exponent));
    }
    return exponent;
}

/// A matrix A with its factors, where it is square. Rows are contacts, columns coordinates or degrees of freedom.
template <class T> class RefinedMatrix {
  public:
    using Sparse = Eigen::SparseMatrix<double>;

    /// `fill(put)` calls put(row, column, value).
    template <class Fill> RefinedMatrix(std::size_t rows, std::size_t columns, Fill fill) {
        std::vector<Eigen::Triplet<double>> triplets;
        fill([&](std::size_t row, std::size_t column, const T& value) {
            entries_.push_back({row, column, value});
            triplets.emplace_back(static_cast<int>(row), static_cast<int>(column), as_double(value));
        });
        rounded.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
        rounded.setFromTriplets(triplets.begin(), triplets.end());
        if (rows == columns) {
            lu_ = std::make_unique<Eigen::SparseLU<Sparse>>(rounded);
            usable = lu_->info() == Eigen::Success;
        }
    }
    Sparse rounded;      ///< by columns
    bool usable = false; ///< a hint only

    struct Solution {
        std::vector<T> x;
        T residual = T(0.0); ///< its largest entry, as computed
    };
    enum class Of { matrix, transposed };
    /// x with A x = b, or A^T x = b, after so many corrections, or fewer where the residual is `enough` before.
    [[nodiscard]] Solution solve(const std::vector<T>& b, Of side, int corrections, const T& enough = T(0.0)) const {
        Solution solution{std::vector<T>(b.size(), T(0.0)), T(0.0)};
        for (int k = 0;; ++k) {
            std::vector<T> rest = b;
            for (const Entry& e : entries_) {
                if (side == Of::matrix) {
                    rest[e.row] -= e.value * solution.x[e.column];
                } else {
                    rest[e.column] -= e.value * solution.x[e.row];
                }
            }
            solution.residual = largest_of(rest);
            if (k == corrections || solution.residual <= enough) {
                return solution;
            }
            // Scaled, so that the smallest residuals stay in the range of double.
            const T scale = ldexp(T(1.0), -exponent_of(solution.residual));
            Eigen::VectorXd right(static_cast<Eigen::Index>(b.size()));
            for (std::size_t c = 0; c < b.size(); ++c) {
                right[static_cast<Eigen::Index>(c)] = as_double(T(rest[c] * scale));
            }
            const Eigen::VectorXd step = side == Of::matrix ? Eigen::VectorXd(lu_->solve(right))
                                                            : Eigen::VectorXd(lu_->transpose().solve(right));
            for (std::size_t c = 0; c < b.size(); ++c) {
                solution.x[c] += T(step[static_cast<Eigen::Index>(c)]) / scale;
            }
        }
    }

  private:
    struct Entry {
        std::size_t row, column;
        T value;
    };
    std::vector<Entry> entries_;
    std::unique_ptr<Eigen::SparseLU<Sparse>> lu_;
};

/// Forces of any regular structure, in the order of its degrees of freedom; empty where the residual does not fall
/// below 2^-`bits` of the load (condition numbers near 1e16).
template <class T>
std::vector<T> refined_forces(const Packing& packing, const std::vector<Contact>& contacts,
                              const std::vector<double>& force, int bits) {
    const DofMap dofs(packing);
    const Geometry<T> geometry(packing);
    const RefinedMatrix<T> gradients(contacts.size(), force.size(), [&](auto put) {
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            geometry.gradient(contacts[l], [&](std::size_t coordinate, const T& value) {
                if (const int dof = dofs.dof_of(coordinate); dof >= 0) {
                    put(l, static_cast<std::size_t>(dof), value);
                }
            });
        }
    });
    std::vector<T> minus; // H is minus the transposed matrix of the gradients
    for (const double f : force) {
        minus.push_back(T(-f));
    }
    const T enough = ldexp(largest_of(minus), -bits);
    auto solution = gradients.solve(minus, RefinedMatrix<T>::Of::transposed, bits, enough);
    return solution.residual <= enough ? std::move(solution.x) : std::vector<T>();
}

/// A number of MPFR from hexadecimal digits, as the ladder of forces writes them.
template <class T> T from_hexadecimal(const std::string& digits) {
    T x;
    mpfr_set_str(x.backend().data(), digits.c_str(), 16, MPFR_RNDN);
    return x;
}

} // namespace isostat::oracle
