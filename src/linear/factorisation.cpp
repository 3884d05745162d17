#include <isostat/linear/factorisation.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;
constexpr int max_passes = 24; ///< more than that costs as much as new factors

double largest(std::span<const double> x) {
    double value = 0;
    for (const double c : x) {
        value = std::max(value, std::abs(c));
    }
    return value;
}

} // namespace

struct Factorisation::Implementation {
    const sparse::Matrix<double>* matrix = nullptr;
    ApproximateInverse inverse;
    bool fresh = true;
    int passes = 0;
    std::vector<double> x, r;

    enum class Side { forces, velocities };

    void pass(Side side, std::span<double> rhs) {
        ++passes;
        if (side == Side::forces) {
            inverse.forces(rhs);
        } else {
            inverse.velocities(rhs);
        }
    }

    /// r = b - H x, or b - G x.
    void residual(Side side, std::span<const double> b) {
        const sparse::Matrix<double>& h = *matrix;
        r.assign(b.begin(), b.end());
        const auto columns = static_cast<std::size_t>(h.cols);
        for (std::size_t j = 0; j < columns; ++j) {
            double sum = 0;
            for (auto e = static_cast<std::size_t>(h.start[j]); e < static_cast<std::size_t>(h.start[j + 1]); ++e) {
                const auto i = static_cast<std::size_t>(h.row[e]);
                if (side == Side::forces) {
                    r[i] -= h.value[e] * x[j];
                } else {
                    sum += h.value[e] * x[i];
                }
            }
            if (side == Side::velocities) {
                r[j] -= sum;
            }
        }
    }

    /// Iterates to rounding; false when it does not converge.
    bool refined(Side side, std::span<double> rhs) {
        x.assign(rhs.begin(), rhs.end());
        pass(side, x);
        double previous = largest(x);
        for (int k = 1; k < max_passes; ++k) {
            residual(side, rhs);
            pass(side, r);
            double change = 0;
            double size = 0;
            for (std::size_t i = 0; i < x.size(); ++i) {
                x[i] += r[i];
                change = std::max(change, std::abs(r[i]));
                size = std::max(size, std::abs(x[i]));
            }
            if (!(change < std::numeric_limits<double>::infinity())) {
                return false;
            }
            // Linear convergence: the next change would be change^2 / previous.
            if (change <= 4 * u * size || change * change <= 2 * u * size * previous) {
                std::copy(x.begin(), x.end(), rhs.begin());
                return true;
            }
            if (change > 0.5 * previous) {
                if (change > 1e-11 * size) {
                    return false;
                }
                std::copy(x.begin(), x.end(), rhs.begin()); // the last changes are rounding
                return true;
            }
            previous = change;
        }
        return false;
    }

    void solve(Side side, std::span<double> rhs, int count) {
        const auto n = static_cast<std::size_t>(matrix->rows);
        assert(rhs.size() == n * static_cast<std::size_t>(count));
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
            const auto one = rhs.subspan(k * n, n);
            if (!fresh && !refined(side, one)) {
                inverse = ApproximateInverse(*matrix);
                fresh = true;
            }
            if (fresh) {
                pass(side, one);
            }
        }
    }
};

template <int Dim>
Factorisation::Factorisation(const IsostaticStructure<Dim>& structure)
    : implementation_(new Implementation{&structure.matrix(),
                                         ApproximateInverse(structure.matrix(), structure.ordering().symbolic()),
                                         true,
                                         0,
                                         {},
                                         {}}) {}

template <int Dim>
Factorisation::Factorisation(const IsostaticStructure<Dim>& structure, ApproximateInverse inverse)
    : implementation_(new Implementation{&structure.matrix(), std::move(inverse), false, 0, {}, {}}) {}

Factorisation::~Factorisation() = default;
Factorisation::Factorisation(Factorisation&&) noexcept = default;
Factorisation& Factorisation::operator=(Factorisation&&) noexcept = default;

void Factorisation::solve_forces(std::span<double> rhs, int count) const {
    implementation_->solve(Implementation::Side::forces, rhs, count);
}

void Factorisation::solve_velocities(std::span<double> rhs, int count) const {
    implementation_->solve(Implementation::Side::velocities, rhs, count);
}

const ApproximateInverse& Factorisation::approximate() const {
    return implementation_->inverse;
}

bool Factorisation::is_fresh() const {
    return implementation_->fresh;
}

int Factorisation::passes() const {
    return implementation_->passes;
}

template Factorisation::Factorisation(const IsostaticStructure<2>&);
template Factorisation::Factorisation(const IsostaticStructure<2>&, ApproximateInverse);

} // namespace isostat
