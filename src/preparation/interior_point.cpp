#include "preparation/interior_point.hpp"

#include "core/dot.hpp"
#include "preparation/clique_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace isostat::preparation {

namespace {

constexpr int most_iterations = 120;
/// Share of the distance to the nearest bound.
constexpr double step_share = 0.9995;
/// Corrections of a direction: largest number, extra length that each tries, factor of products near the centre, and
/// the gain for which one more is worth its solve.
constexpr int most_corrections = 4;
constexpr double reach_farther = 0.3;
constexpr double near_centre = 10;
constexpr double worth_it = 0.03;
/// Descent: the aimed products are never below this share of the current products; a step below the next share of a
/// full step counts as blocked, and the next one aims at so many times the current products.
constexpr double least_centre = 0.1;
constexpr double blocked_below = 0.2;
constexpr double blocked_centre = 3;

/// Constraints in one list: the rows, then x_k >= -bound, then x_k <= bound. Slack s >= 0, multiplier z >= 0.
class Iteration {
  public:
    explicit Iteration(const BoxedProgramme& programme)
        : p_(programme), rows_(programme.lower.size()), columns_(programme.cost.size()), x_(columns_, 0.0),
          s_(rows_ + 2 * columns_), z_(s_.size()), ds_(s_.size()), dz_(s_.size()), target_(s_.size()),
          infeasible_(s_.size(), 0.0), dual_(columns_) {
        // The multipliers begin at order 1 in the scale of the cost, the slacks inside the bounds.
        const double start_slack = 0.02 * largest(p_.bound);
        const double start_force = largest(p_.cost) / std::sqrt(static_cast<double>(columns_));
        for (std::size_t l = 0; l < rows_; ++l) {
            s_[l] = std::max(-p_.lower[l], start_slack);
            z_[l] = start_force * start_slack / s_[l];
        }
        for (std::size_t k = 0; k < columns_; ++k) {
            s_[rows_ + k] = s_[rows_ + columns_ + k] = p_.bound[k];
            z_[rows_ + k] = z_[rows_ + columns_ + k] = start_force * start_slack / p_.bound[k];
        }
    }

    /// Starts at x = 0 with given slacks and multipliers of the rows, and those of the bounds at the mean product.
    void start_from(const InteriorPoint& point) {
        std::ranges::copy(point.slack, s_.begin());
        std::ranges::copy(point.force, z_.begin());
        const double centre = mean_row_product();
        for (std::size_t k = 0; k < columns_; ++k) {
            z_[rows_ + k] = z_[rows_ + columns_ + k] = centre / p_.bound[k];
        }
    }
    void read(InteriorPoint& point) const {
        std::copy_n(s_.begin(), rows_, point.slack.begin());
        std::copy_n(z_.begin(), rows_, point.force.begin());
    }
    [[nodiscard]] double mean_row_product() const { return mean_product(rows_); }
    [[nodiscard]] double mean_product() const { return mean_product(s_.size()); }

    /// Computes the residuals of the constraints and of the balance; returns the largest residual of the constraints.
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

    bool factorise(CliqueMatrix& matrix) {
        std::vector<double> weight(rows_);
        for (std::size_t l = 0; l < rows_; ++l) {
            weight[l] = z_[l] / s_[l];
        }
        std::vector<double> diagonal(columns_);
        for (std::size_t k = 0; k < columns_; ++k) {
            diagonal[k] = z_[rows_ + k] / s_[rows_ + k] + z_[rows_ + columns_ + k] / s_[rows_ + columns_ + k];
        }
        return matrix.factorise(
            [&](std::size_t l, std::size_t p, std::size_t r) { return weight[l] * p_.value[p] * p_.value[r]; },
            diagonal);
    }

    /// Computes the direction towards products s z = centre (minus the product of the affine steps when `correct`).
    void direction(CliqueMatrix& matrix, double centre, bool correct) {
        for (std::size_t l = 0; l < s_.size(); ++l) {
            target_[l] = centre - s_[l] * z_[l] - (correct ? ds_[l] * dz_[l] : 0.0);
        }
        towards_target(matrix);
    }

    /// Computes Mehrotra's direction, centred again where that makes longer steps.
    void predict_and_correct(CliqueMatrix& matrix, double product, double least) {
        direction(matrix, 0, false);
        const double share = product_after(slack_step(), force_step()) / product;
        aim(matrix, std::max(share * share * share, least) * product, true);
    }

    /// Computes the direction towards `centre`, centred again where that makes longer steps.
    void aim(CliqueMatrix& matrix, double centre, bool correct) {
        direction(matrix, centre, correct);
        for (int k = 0; k < most_corrections && centre_more(matrix, centre); ++k) {
        }
    }

    /// Tries a direction with longer steps than the current one, in which products that a longer step would leave far
    /// from the centre are aimed back at it (J. Gondzio, Comput. Optim. Appl. 6, 137 (1996)). It costs a solve and no
    /// factorisation. False when the current direction stays.
    bool centre_more(CliqueMatrix& matrix, double centre) {
        const double slack_before = slack_step();
        const double force_before = force_step();
        if (slack_before > 0.95 && force_before > 0.95) {
            return false;
        }
        const double slack = std::min(1.0, slack_before + reach_farther);
        const double force = std::min(1.0, force_before + reach_farther);
        const std::vector<double> dx = dx_;
        const std::vector<double> ds = ds_;
        const std::vector<double> dz = dz_;
        for (std::size_t l = 0; l < s_.size(); ++l) {
            const double product = (s_[l] + slack * ds_[l]) * (z_[l] + force * dz_[l]);
            const double wanted = std::clamp(product, centre / near_centre, centre * near_centre);
            target_[l] += std::max(wanted - product, -near_centre * centre);
        }
        towards_target(matrix);
        if (slack_step() + force_step() >= slack_before + force_before + worth_it) {
            return true;
        }
        dx_ = dx;
        ds_ = ds;
        dz_ = dz;
        return false;
    }

    void towards_target(CliqueMatrix& matrix) {
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
        matrix.solve(dx_);
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
        // At the end of the quadratic phase each product fixes a multiplier by its slack or a slack by its multiplier:
        // the one that moves by the larger share of itself in the last step vanishes.
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
    /// Of the first constraints.
    [[nodiscard]] double mean_product(std::size_t count) const {
        const auto end = s_.begin() + static_cast<std::ptrdiff_t>(count);
        return std::inner_product(s_.begin(), end, z_.begin(), 0.0) / static_cast<double>(count);
    }

    const BoxedProgramme& p_;
    std::size_t rows_, columns_;
    std::vector<double> x_, s_, z_, dx_, ds_, dz_, target_, infeasible_, dual_;
};

} // namespace

ActiveSet interior_point(const BoxedProgramme& programme, double tolerance, const std::atomic<bool>* stop) {
    ActiveSet result;
    CliqueMatrix matrix(programme.cost.size(), programme.start, programme.column); // A^T D A + diagonal
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
        if (!iteration.factorise(matrix)) {
            break;
        }
        iteration.predict_and_correct(matrix, product, 0);
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

InteriorDescent::InteriorDescent(const BoxedProgramme& pattern)
    : matrix_(std::make_unique<CliqueMatrix>(pattern.cost.size(), pattern.start, pattern.column)) {}

InteriorDescent::~InteriorDescent() = default;

InteriorStep InteriorDescent::step(const BoxedProgramme& programme, InteriorPoint& point) {
    InteriorStep result;
    CliqueMatrix& matrix = *matrix_;
    Iteration iteration(programme);
    iteration.start_from(point);
    result.product = iteration.mean_row_product();
    const double product = iteration.mean_product();
    result.violation = iteration.residuals();
    if (!iteration.factorise(matrix)) {
        return result;
    }
    iteration.predict_and_correct(matrix, product, least_centre);
    if (std::min(iteration.slack_step(), iteration.force_step()) < blocked_below) {
        iteration.aim(matrix, blocked_centre * product, false);
    }
    iteration.advance(iteration.slack_step(), iteration.force_step());
    if (!iteration.finite()) {
        return result;
    }
    iteration.read(point);
    iteration.read(result.active);
    result.done = true;
    return result;
}

} // namespace isostat::preparation
