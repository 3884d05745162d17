#include "preparation/interior_point.hpp"

#include <cholmod.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace isostat::preparation {

namespace {

constexpr int most_iterations = 120;
/// Share of the way to the nearest bound.
constexpr double step_share = 0.9995;

/// A^T D A + diagonal: pattern and fill-in order once, numbers and factor every iteration.
class NormalMatrix {
  public:
    explicit NormalMatrix(const BoxedProgramme& programme) : programme_(programme) {
        cholmod_start(&common_);
        common_.supernodal = CHOLMOD_SIMPLICIAL;
        common_.final_ll = 1;
        common_.print = 0;
        common_.quick_return_if_not_posdef = 1;
        common_.nmethods = 1;
        common_.method[0].ordering = CHOLMOD_AMD;
        build_pattern();
        factor_ = cholmod_analyze(&matrix_, &common_);
    }
    NormalMatrix(const NormalMatrix&) = delete;
    NormalMatrix& operator=(const NormalMatrix&) = delete;
    ~NormalMatrix() {
        cholmod_free_dense(&solution_, &common_);
        cholmod_free_dense(&work_y_, &common_);
        cholmod_free_dense(&work_e_, &common_);
        cholmod_free_factor(&factor_, &common_);
        cholmod_finish(&common_);
    }

    /// False when the matrix is numerically singular.
    bool factorise(const std::vector<double>& row_weight, const std::vector<double>& diagonal) {
        std::fill(value_.begin(), value_.end(), 0.0);
        std::size_t next = 0;
        for (std::size_t l = 0; l < row_weight.size(); ++l) {
            const auto begin = static_cast<std::size_t>(programme_.start[l]);
            const auto end = static_cast<std::size_t>(programme_.start[l + 1]);
            for (std::size_t p = begin; p < end; ++p) {
                for (std::size_t r = begin; r <= p; ++r) {
                    value_[static_cast<std::size_t>(place_[next++])] +=
                        row_weight[l] * programme_.value[p] * programme_.value[r];
                }
            }
        }
        for (std::size_t k = 0; k < diagonal.size(); ++k) {
            value_[static_cast<std::size_t>(start_[k])] += diagonal[k]; // the first entry of a column
        }
        return factor_ != nullptr && cholmod_factorize(&matrix_, factor_, &common_) != 0 &&
               common_.status == CHOLMOD_OK && factor_->minor == factor_->n;
    }

    bool solve(std::vector<double>& b) {
        cholmod_dense right{};
        right.nrow = right.nzmax = right.d = b.size();
        right.ncol = 1;
        right.x = b.data();
        right.xtype = CHOLMOD_REAL;
        right.dtype = CHOLMOD_DOUBLE;
        if (cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &solution_, nullptr, &work_y_, &work_e_, &common_) ==
            0) {
            return false;
        }
        const auto* const x = static_cast<const double*>(solution_->x);
        std::copy_n(x, b.size(), b.begin());
        return true;
    }

  private:
    /// Lower triangle by columns, diagonal first.
    void build_pattern() {
        const std::size_t columns = programme_.cost.size();
        std::vector<std::pair<int, int>> entries;
        for (std::size_t k = 0; k < columns; ++k) {
            entries.emplace_back(static_cast<int>(k), static_cast<int>(k));
        }
        const auto each = [&](const auto& visit) {
            for (std::size_t l = 0; l + 1 < programme_.start.size(); ++l) {
                for (int p = programme_.start[l]; p < programme_.start[l + 1]; ++p) {
                    for (int r = programme_.start[l]; r <= p; ++r) {
                        const int a = programme_.column[static_cast<std::size_t>(p)];
                        const int b = programme_.column[static_cast<std::size_t>(r)];
                        visit(std::min(a, b), std::max(a, b));
                    }
                }
            }
        };
        each([&](int column, int row) { entries.emplace_back(column, row); });
        std::sort(entries.begin(), entries.end());
        entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
        start_.assign(columns + 1, 0);
        row_.reserve(entries.size());
        for (const auto& [column, row] : entries) {
            ++start_[static_cast<std::size_t>(column) + 1];
            row_.push_back(row);
        }
        for (std::size_t k = 0; k < columns; ++k) {
            start_[k + 1] += start_[k];
        }
        value_.assign(entries.size(), 0.0);
        entries = {};
        each([&](int column, int row) {
            const auto from = row_.begin() + start_[static_cast<std::size_t>(column)];
            const auto to = row_.begin() + start_[static_cast<std::size_t>(column) + 1];
            place_.push_back(static_cast<int>(std::lower_bound(from, to, row) - row_.begin()));
        });
        matrix_.nrow = matrix_.ncol = columns;
        matrix_.nzmax = value_.size();
        matrix_.p = start_.data();
        matrix_.i = row_.data();
        matrix_.x = value_.data();
        matrix_.stype = -1;
        matrix_.itype = CHOLMOD_INT;
        matrix_.xtype = CHOLMOD_REAL;
        matrix_.dtype = CHOLMOD_DOUBLE;
        matrix_.sorted = 1;
        matrix_.packed = 1;
    }

    const BoxedProgramme& programme_;
    cholmod_common common_{};
    cholmod_sparse matrix_{};
    cholmod_factor* factor_ = nullptr;
    cholmod_dense* solution_ = nullptr;
    cholmod_dense* work_y_ = nullptr;
    cholmod_dense* work_e_ = nullptr;
    std::vector<int> start_, row_, place_;
    std::vector<double> value_;
};

/// Constraints in one list: the rows, then x_k >= -bound, then x_k <= bound. Slack s >= 0, multiplier z >= 0.
class Iteration {
  public:
    explicit Iteration(const BoxedProgramme& programme)
        : p_(programme), rows_(programme.lower.size()), columns_(programme.cost.size()), x_(columns_, 0.0),
          s_(rows_ + 2 * columns_), z_(s_.size()), ds_(s_.size()), dz_(s_.size()), target_(s_.size()),
          infeasible_(s_.size(), 0.0), dual_(columns_) {
        // Multipliers of order 1 in the scale of the cost; slacks inside.
        double force = 0;
        for (const double c : p_.cost) {
            force = std::max(force, std::abs(c));
        }
        double length = 0;
        for (const double b : p_.bound) {
            length = std::max(length, b);
        }
        const double start_slack = 0.02 * length;
        const double start_force = force / std::sqrt(static_cast<double>(columns_));
        for (std::size_t l = 0; l < rows_; ++l) {
            s_[l] = std::max(-p_.lower[l], start_slack);
            z_[l] = start_force * start_slack / s_[l];
        }
        for (std::size_t k = 0; k < columns_; ++k) {
            s_[rows_ + k] = s_[rows_ + columns_ + k] = p_.bound[k];
            z_[rows_ + k] = z_[rows_ + columns_ + k] = start_force * start_slack / p_.bound[k];
        }
    }

    [[nodiscard]] double mean_product() const {
        double sum = 0;
        for (std::size_t l = 0; l < s_.size(); ++l) {
            sum += s_[l] * z_[l];
        }
        return sum / static_cast<double>(s_.size());
    }

    /// Residuals of the constraints and of the balance; the largest of the former.
    double residuals() {
        double worst = 0;
        dual_ = p_.cost;
        for (std::size_t l = 0; l < rows_; ++l) {
            double a = -p_.lower[l] - s_[l];
            for (auto e = static_cast<std::size_t>(p_.start[l]); e < static_cast<std::size_t>(p_.start[l + 1]); ++e) {
                const auto k = static_cast<std::size_t>(p_.column[e]);
                a += p_.value[e] * x_[k];
                dual_[k] -= p_.value[e] * z_[l];
            }
            infeasible_[l] = a;
            worst = std::max(worst, std::abs(a));
        }
        for (std::size_t k = 0; k < columns_; ++k) {
            dual_[k] += z_[rows_ + columns_ + k] - z_[rows_ + k];
            infeasible_[rows_ + k] = p_.bound[k] + x_[k] - s_[rows_ + k];
            infeasible_[rows_ + columns_ + k] = p_.bound[k] - x_[k] - s_[rows_ + columns_ + k];
        }
        return worst;
    }
    [[nodiscard]] double balance() const {
        double worst = 0;
        for (const double d : dual_) {
            worst = std::max(worst, std::abs(d));
        }
        return worst;
    }

    bool factorise(NormalMatrix& matrix) {
        std::vector<double> weight(rows_);
        for (std::size_t l = 0; l < rows_; ++l) {
            weight[l] = z_[l] / s_[l];
        }
        std::vector<double> diagonal(columns_);
        for (std::size_t k = 0; k < columns_; ++k) {
            diagonal[k] = z_[rows_ + k] / s_[rows_ + k] + z_[rows_ + columns_ + k] / s_[rows_ + columns_ + k];
        }
        return matrix.factorise(weight, diagonal);
    }

    /// Direction towards products s z = centre (minus the product of the affine steps when `correct`).
    bool direction(NormalMatrix& matrix, double centre, bool correct) {
        for (std::size_t l = 0; l < s_.size(); ++l) {
            target_[l] = centre - s_[l] * z_[l] - (correct ? ds_[l] * dz_[l] : 0.0);
        }
        dx_.resize(columns_);
        for (std::size_t k = 0; k < columns_; ++k) {
            const auto term = [&](std::size_t l) { return (target_[l] - z_[l] * infeasible_[l]) / s_[l]; };
            dx_[k] = term(rows_ + k) - term(rows_ + columns_ + k) - dual_[k];
        }
        for (std::size_t l = 0; l < rows_; ++l) {
            const double t = (target_[l] - z_[l] * infeasible_[l]) / s_[l];
            for (auto e = static_cast<std::size_t>(p_.start[l]); e < static_cast<std::size_t>(p_.start[l + 1]); ++e) {
                dx_[static_cast<std::size_t>(p_.column[e])] += p_.value[e] * t;
            }
        }
        if (!matrix.solve(dx_)) {
            return false;
        }
        for (std::size_t l = 0; l < rows_; ++l) {
            double a = infeasible_[l];
            for (auto e = static_cast<std::size_t>(p_.start[l]); e < static_cast<std::size_t>(p_.start[l + 1]); ++e) {
                a += p_.value[e] * dx_[static_cast<std::size_t>(p_.column[e])];
            }
            ds_[l] = a;
        }
        for (std::size_t k = 0; k < columns_; ++k) {
            ds_[rows_ + k] = infeasible_[rows_ + k] + dx_[k];
            ds_[rows_ + columns_ + k] = infeasible_[rows_ + columns_ + k] - dx_[k];
        }
        for (std::size_t l = 0; l < s_.size(); ++l) {
            dz_[l] = (target_[l] - z_[l] * ds_[l]) / s_[l];
        }
        return true;
    }

    static double longest(const std::vector<double>& y, const std::vector<double>& dy) {
        double step = 1 / step_share;
        for (std::size_t l = 0; l < y.size(); ++l) {
            if (dy[l] < 0) {
                step = std::min(step, -y[l] / dy[l]);
            }
        }
        return std::min(1.0, step_share * step);
    }
    [[nodiscard]] double slack_step() const { return longest(s_, ds_); }
    [[nodiscard]] double force_step() const { return longest(z_, dz_); }

    [[nodiscard]] double product_after(double slack_step, double force_step) const {
        double sum = 0;
        for (std::size_t l = 0; l < s_.size(); ++l) {
            sum += (s_[l] + slack_step * ds_[l]) * (z_[l] + force_step * dz_[l]);
        }
        return sum / static_cast<double>(s_.size());
    }

    void advance(double slack_step, double force_step) {
        for (std::size_t k = 0; k < columns_; ++k) {
            x_[k] += slack_step * dx_[k];
        }
        for (std::size_t l = 0; l < s_.size(); ++l) {
            s_[l] += slack_step * ds_[l];
            z_[l] += force_step * dz_[l];
        }
    }

    [[nodiscard]] bool finite() const { return std::isfinite(mean_product()); }

    void read(ActiveSet& set) const {
        // At the end of the quadratic phase a multiplier or a slack is the product divided by the other: whichever
        // moves by a larger share of itself in the last step vanishes.
        set.row.resize(rows_);
        set.column.assign(columns_, 0);
        const auto active = [&](std::size_t l) { return std::abs(ds_[l]) * z_[l] > std::abs(dz_[l]) * s_[l]; };
        for (std::size_t l = 0; l < rows_; ++l) {
            set.row[l] = active(l) ? 1 : 0;
        }
        for (std::size_t k = 0; k < columns_; ++k) {
            if (active(rows_ + k)) {
                set.column[k] = -1;
            } else if (active(rows_ + columns_ + k)) {
                set.column[k] = 1;
            }
        }
        set.x = x_;
    }

  private:
    const BoxedProgramme& p_;
    std::size_t rows_, columns_;
    std::vector<double> x_, s_, z_, dx_, ds_, dz_, target_, infeasible_, dual_;
};

} // namespace

ActiveSet interior_point(const BoxedProgramme& programme, double tolerance, const std::atomic<bool>* stop) {
    ActiveSet result;
    NormalMatrix matrix(programme);
    Iteration iteration(programme);
    for (; result.iterations < most_iterations; ++result.iterations) {
        if (stop != nullptr && stop->load(std::memory_order_relaxed)) {
            return result;
        }
        const double product = iteration.mean_product();
        const double violation = iteration.residuals();
        if (product < tolerance && violation < 1e-9) {
            result.converged = true;
            break;
        }
        if (!iteration.factorise(matrix) || !iteration.direction(matrix, 0, false)) {
            break;
        }
        const double affine = iteration.product_after(iteration.slack_step(), iteration.force_step());
        const double share = affine / product;
        if (!iteration.direction(matrix, share * share * share * product, true)) {
            break;
        }
        iteration.advance(iteration.slack_step(), iteration.force_step());
        if (!iteration.finite()) {
            break;
        }
    }
    if (result.converged) {
        iteration.read(result);
    }
    return result;
}

} // namespace isostat::preparation
