#include "checker/newton.hpp"

#include "checker/at_wall.hpp"

#include <cmath>

namespace isostat::checker {

namespace {

/// Factors that reduce a residual by a smaller factor are made anew.
constexpr double slow = 0.25; // cost: when factors are renewed
/// The same where the contacts may be nearly singular: proofs go on with the last factors.
constexpr double quick = 0x1p-10; // cost: when factors are renewed where contacts may be nearly singular

#ifdef __SIZEOF_FLOAT128__
// __extension__ has no form with `using`: NOLINTNEXTLINE(modernize-use-using)
__extension__ typedef __float128 Quadruple;
#else
using Quadruple = long double;
#endif

} // namespace

System::System(const Packing& packing, std::vector<Contact> contacts, std::shared_ptr<const Solver> near,
               std::shared_ptr<const Solver> like)
    : packing_(packing), contacts_(std::move(contacts)), structure_(packing, contacts_),
      weight_(std::ldexp(1.0, structure_.wall_exponent)), solver_(std::move(near)), like_(std::move(like)) {}

double System::held_value(const Contact& c) const {
    return fresh_ && fresh_->first == c ? fresh_->second : packing_.q[static_cast<std::size_t>(c.i)];
}

template <class T> T System::value(const std::vector<T>& q, const Contact& c, const Row& row) const {
    if (c.kind == ContactKind::held) {
        return weight_ * (q[static_cast<std::size_t>(c.i)] - held_value(c));
    }
    const auto [one, other] = closed_at(packing_, c);
    if (c.of_disks()) {
        const T sum = T(one) + other;
        return (row.square(q, packing_.axes()) - sum * sum) / 2;
    }
    return weight_ * (AtWall(c, packing_.layout()).distance_in(q) - one);
}

template double System::value(const std::vector<double>& q, const Contact& c, const Row& row) const;

void System::renew(const std::vector<double>& q) {
    const bool quick = !solver_; // else those that were quick to make may not be accurate enough
    solver_ = std::make_shared<Solver>(structure_, q, solver_ ? solver_.get() : like_.get(), quick);
    kernel_.reset();
}

Eigen::VectorXd System::step(const Eigen::VectorXd& residual) const {
    return solver_->solve(residual) * std::ldexp(1.0, -solver_->exponent());
}

const Eigen::VectorXd& System::kernel(std::size_t left_out) {
    if (!kernel_ || kernel_->first != left_out) {
        const auto n = static_cast<Eigen::Index>(contacts_.size());
        kernel_ = {left_out, step(Eigen::VectorXd::Unit(n, static_cast<Eigen::Index>(left_out)))};
    }
    return kernel_->second;
}

/// The step that leaves one coordinate in place, and one F as it comes.
Eigen::VectorXd System::step_along(Eigen::VectorXd residual, const Way& way) {
    residual(static_cast<Eigen::Index>(way.left_out)) = 0;
    Eigen::VectorXd x = step(residual);
    const Eigen::VectorXd& free = kernel(way.left_out);
    x -= x(way.kept) / free(way.kept) * free;
    return x;
}

Eigen::VectorXd System::bend(const Eigen::VectorXd& v, const Way& way) {
    std::vector<double> at(structure_.dof_of.size(), 0.0);
    for (std::size_t d = 0; d < size(); ++d) {
        at[coordinate(d)] = v(static_cast<Eigen::Index>(d));
    }
    Eigen::VectorXd residual(static_cast<Eigen::Index>(contacts_.size()));
    for (std::size_t l = 0; l < contacts_.size(); ++l) {
        const Row& row = structure_.rows[l];
        residual(static_cast<Eigen::Index>(l)) = row.quadratic ? -row.square(at, packing_.axes()) / 2 : 0.0;
    }
    return step_along(std::move(residual), way);
}

/// Newton's step with the present factors.
template <class T> Eigen::VectorXd System::step_at(const std::vector<T>& q, const std::optional<Way>& way) {
    Eigen::VectorXd residual(static_cast<Eigen::Index>(contacts_.size()));
    for (std::size_t l = 0; l < contacts_.size(); ++l) {
        residual(static_cast<Eigen::Index>(l)) = static_cast<double>(-value(q, contacts_[l], structure_.rows[l]));
    }
    return way ? step_along(std::move(residual), *way) : step(residual);
}

Eigen::VectorXd System::product(const std::vector<double>& q, const Eigen::VectorXd& v) const {
    const auto at = [&](int coordinate) {
        const int dof = structure_.dof_of[static_cast<std::size_t>(coordinate)];
        return dof >= 0 ? v(dof) : 0.0;
    };
    Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(contacts_.size()));
    for (std::size_t l = 0; l < contacts_.size(); ++l) {
        const Row& row = structure_.rows[l];
        double sum = 0;
        if (row.quadratic) {
            PerAxis<double> change{};
            for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
                change[row.axis[k]] += row.sign[k] * at(row.coordinate[k]);
            }
            for (std::size_t a = 0; a < packing_.axes(); ++a) {
                double difference = 0;
                row.separate(q, a, difference);
                sum += difference * change[a];
            }
        } else {
            for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
                sum += weight_ * row.sign[k] * at(row.coordinate[k]);
            }
        }
        result(static_cast<Eigen::Index>(l)) = sum;
    }
    return result;
}

bool System::motion(const std::vector<double>& q, std::size_t opened, Eigen::VectorXd& v, int bits) {
    for (const bool last_factors : {false, true}) {
        if (last_factors || !solver_) {
            renew(q);
        }
        if (solver_->usable() && (last_factors || v.size() == 0)) {
            v = kernel(opened);
        }
        double size = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 30 && solver_->usable(); ++k) { // cost: Newton steps of the look
            Eigen::VectorXd residual = -product(q, v);
            residual(static_cast<Eigen::Index>(opened)) += 1;
            const double now = residual.lpNorm<Eigen::Infinity>();
            const double rounding = std::ldexp(1 + std::ldexp(v.lpNorm<Eigen::Infinity>(), solver_->exponent()), -bits);
            if (now <= rounding || (last_factors && now >= slow * size)) {
                return v.allFinite();
            }
            if (!(now < slow * size)) {
                break;
            }
            size = now;
            v += step(residual);
        }
    }
    v.resize(0);
    return false;
}

std::optional<double> System::newton(std::vector<double>& q, const std::optional<Way>& way, double accuracy) {
    const double scale = packing_.max_radius();
    if (!solver_) {
        renew(q);
    }
    double last = std::numeric_limits<double>::infinity();
    int renewals = 0;
    for (int k = 0; k < 100 && solver_->usable(); ++k) { // cost: Newton steps of the look
        const Eigen::VectorXd x = step_at(q, way);
        const double size = x.lpNorm<Eigen::Infinity>();
        if (!std::isfinite(size)) {
            return {};
        }
        // choice: when the look's Newton has converged
        const bool rounded = size <= 0x1p-38 * scale; // rounding: new factors would not help
        const bool smaller = size < (rounded ? 1 : slow) * last;
        const bool ends = size <= accuracy * scale || (!smaller && rounded);
        if (smaller || ends) {
            for (std::size_t d = 0; d < this->size(); ++d) {
                q[coordinate(d)] += x(static_cast<Eigen::Index>(d));
            }
        }
        if (ends) {
            return size / scale;
        }
        if (smaller) {
            last = size;
        } else if (++renewals > 20) { // cost: factors renewed
            return {};
        } else {
            renew(q);
            last = std::numeric_limits<double>::infinity();
        }
    }
    return {};
}

double System::spread() const {
    const double scale = packing_.max_radius();
    Eigen::VectorXd mixed(static_cast<Eigen::Index>(contacts_.size()));
    for (Eigen::Index l = 0; l < mixed.size(); ++l) {
        mixed(l) = (l * l + l / 3) % 7 < 3 ? -scale * scale : scale * scale; // guess: mixed signs
    }
    return step(mixed).lpNorm<Eigen::Infinity>() / scale;
}

bool System::newton_in_quadruple(std::vector<double>& q, const std::optional<Way>& way) {
    constexpr int most = 60; // steps halve the distance to one of two nearby zeros; cost: Newton steps of the look
    const double scale = packing_.max_radius();
    std::vector<Quadruple> at(q.begin(), q.end());
    double last = std::numeric_limits<double>::infinity();
    bool stale = solver_ != nullptr; // the factors are those of another place
    for (int k = 0; k < most;) {
        if (!stale) {
            renew(q);
        }
        if (!solver_->usable()) {
            return false;
        }
        const Eigen::VectorXd x = step_at(at, way);
        const double size = x.lpNorm<Eigen::Infinity>();
        if (stale && !(size < std::min(quick * last, scale))) {
            stale = false;
            continue;
        }
        if (!(size < scale)) {
            return false;
        }
        for (std::size_t d = 0; d < this->size(); ++d) {
            at[coordinate(d)] += x(static_cast<Eigen::Index>(d));
            q[coordinate(d)] = static_cast<double>(at[coordinate(d)]);
        }
        // choice: when the look's Newton has converged
        if (size <= (stale ? 0x1p-46 : 0x1p-38) * scale) { // the next step would be its square, or rounding
            return true;
        }
        stale = true;
        last = size;
        ++k;
    }
    return false;
}

} // namespace isostat::checker
