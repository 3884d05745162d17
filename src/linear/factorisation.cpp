#include "linear/factorisation.hpp"

#include "core/dot.hpp"
#include "core/roundoff.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

namespace isostat {

namespace {

using roundoff::u;
constexpr std::size_t max_passes = 20; ///< more passes cost as much as new factors
constexpr std::size_t kept_directions = 4;
constexpr double cancelled = 1e-12;     ///< of the square of an image: then 1e-10 of the image is rounding
constexpr double residual_left = 1e-12; ///< of the size of the unknowns and the right-hand side

/// A direction and its image under the matrix.
struct Direction {
    std::vector<double> step, image;
    double square = 0; ///< of the image
};
using Directions = std::array<Direction, kept_directions>;

/// Subtracts directions times their factors, all in one sweep.
template <std::size_t count>
void subtract(Direction& from, const std::array<const Direction*, count>& what,
              const std::array<double, count>& factor) {
    const auto sweep = [&](double* to, const std::array<const double*, count>& terms) {
        for (std::size_t i = 0; i < from.step.size(); ++i) {
            double value = to[i];
            for (std::size_t k = 0; k < count; ++k) {
                value -= factor[k] * terms[k][i];
            }
            to[i] = value;
        }
    };
    std::array<const double*, count> steps{};
    std::array<const double*, count> images{};
    for (std::size_t k = 0; k < count; ++k) {
        steps[k] = what[k]->step.data();
        images[k] = what[k]->image.data();
    }
    sweep(from.step.data(), steps);
    sweep(from.image.data(), images);
}

/// Makes the image of a direction orthogonal to the images of the last `count` directions, which are orthogonal to each
/// other. Returns the square of the image taken out.
template <std::size_t count> double orthogonalise(Direction& now, const std::array<const Direction*, count>& earlier) {
    std::array<double, count> factor{};
    double taken_out = 0;
    for (std::size_t k = 0; k < count; ++k) {
        factor[k] = dot(now.image, earlier[k]->image) / earlier[k]->square;
        taken_out += factor[k] * factor[k] * earlier[k]->square;
    }
    subtract<count>(now, earlier, factor);
    return taken_out;
}

} // namespace

struct Factorisation::Implementation {
    std::shared_ptr<const sparse::Matrix<double>> matrix;
    ApproximateInverse inverse;
    bool fresh = true;
    int passes = 0;
    std::vector<double> x, r;
    using Enough = std::function<bool(std::span<const double>, double)>;
    double error = 0; ///< estimated, of the last refinement that `enough` ended

    enum class Side { forces, velocities };

    void pass(Side side, std::span<double> rhs) {
        ++passes;
        if (side == Side::forces) {
            inverse.forces(rhs);
        } else {
            inverse.velocities(rhs);
        }
    }

    /// y = H x, or G x.
    void multiply(Side side, std::span<const double> in, std::vector<double>& y) const {
        const sparse::Matrix<double>& h = *matrix;
        const auto columns = static_cast<std::size_t>(h.cols);
        if (side == Side::forces) {
            std::fill(y.begin(), y.end(), 0.0);
        }
        for (std::size_t j = 0; j < columns; ++j) {
            const auto end = static_cast<std::size_t>(h.start[j + 1]);
            double sum = 0;
            for (auto e = static_cast<std::size_t>(h.start[j]); e < end; ++e) {
                const auto i = static_cast<std::size_t>(h.row[e]);
                if (side == Side::forces) {
                    y[i] += h.value[e] * in[j];
                } else {
                    sum += h.value[e] * in[i];
                }
            }
            if (side == Side::velocities) {
                y[j] = sum;
            }
        }
    }

    /// Direction k of the iteration: from the residual, with the image made orthogonal to the last images.
    const Direction& next_direction(Side side, std::size_t k, Directions& directions) {
        Direction& now = directions[k % kept_directions];
        now.step = r;
        pass(side, now.step);
        now.image.resize(r.size());
        multiply(side, now.step, now.image);
        const auto back = [&](std::size_t steps) { return &directions[(k - steps) % kept_directions]; };
        const double taken_out = k == 0   ? 0.0
                                 : k == 1 ? orthogonalise<1>(now, {back(1)})
                                 : k == 2 ? orthogonalise<2>(now, {back(1), back(2)})
                                          : orthogonalise<3>(now, {back(1), back(2), back(3)});
        now.square = dot(now.image, now.image);
        if (now.square < cancelled * taken_out) { // mostly rounding is left, so the image is computed again
            multiply(side, now.step, now.image);
            now.square = dot(now.image, now.image);
        }
        return now;
    }

    /// Estimate of the changes still to come: change^2 / previous where the changes fall fast, and otherwise infinity.
    /// A direction across the residual also makes a small step, so the residual must be as small.
    [[nodiscard]] double error_left(double change, double previous, double size, double size_of_rhs) const {
        const double next = change * change / previous;
        return change < 0.1 * previous && largest(r) * std::max(size, size_of_rhs) <= 100 * next * size_of_rhs
                   ? next
                   : std::numeric_limits<double>::infinity();
    }

    /// Sets x and r for the start of a refinement, times `up`. Returns the largest component of the right-hand side.
    double start_from(Side side, std::span<const double> rhs, std::span<const double> guess, double up) {
        const auto scaled = [up](double c) { return c * up; };
        error = 0;
        x.assign(rhs.size(), 0.0);
        r.resize(rhs.size());
        std::transform(rhs.begin(), rhs.end(), r.begin(), scaled);
        const double size_of_rhs = largest(r);
        if (!guess.empty()) {
            std::transform(guess.begin(), guess.end(), x.begin(), scaled);
            std::vector<double> carried(rhs.size());
            multiply(side, x, carried);
            std::transform(r.begin(), r.end(), carried.begin(), r.begin(), std::minus<>());
        }
        return size_of_rhs;
    }

    /// Iterates to rounding; false when the iteration does not converge. Each pass makes a direction. The residual is
    /// minimised over the last few directions (generalised conjugate residuals, truncated), which needs fewer passes
    /// than plain refinement and converges in cases where plain refinement does not.
    bool refined(Side side, std::span<double> rhs, std::span<const double> guess = {}, double accuracy = 4 * u,
                 const Enough& enough = {}) {
        const std::size_t n = rhs.size();
        // Scales by a power of two, which changes no bit, so that squares neither under- nor overflow in any units.
        int exponent = 0;
        std::frexp(largest(rhs), &exponent);
        exponent = std::clamp(exponent, -1000, 1000);
        const double up = std::ldexp(1.0, -exponent);
        const double down = std::ldexp(1.0, exponent);
        const double size_of_rhs = start_from(side, rhs, guess, up);
        const auto deliver = [&] {
            std::transform(x.begin(), x.end(), rhs.begin(), [down](double c) { return c * down; });
            return true;
        };
        Directions directions;
        double previous = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < max_passes; ++k) {
            const Direction& now = next_direction(side, k, directions);
            if (now.square == 0 && largest(r) == 0) {
                return deliver(); // the residual is exactly 0
            }
            const double length = dot(now.image, r) / now.square;
            if (!std::isfinite(now.square) || !std::isfinite(length)) { // the maxima below overlook a NaN
                return false;
            }
            for (std::size_t i = 0; i < n; ++i) {
                x[i] += length * now.step[i];
                r[i] -= length * now.image[i];
            }
            const double change = std::abs(length) * largest(now.step);
            const double size = largest(x);
            if (!(change < std::numeric_limits<double>::infinity())) {
                return false;
            }
            // Linear convergence: the next change would be change^2 / previous.
            if (change <= accuracy * size || (k > 0 && change * change <= accuracy * size * previous)) {
                // A useless operator makes small steps too, so the residual has to be small as well.
                if (!(largest(r) <= std::max(residual_left, 100 * accuracy) * (size + size_of_rhs))) {
                    return false;
                }
                return deliver();
            }
            if (enough) {
                const double left =
                    k > 0 ? error_left(change, previous, size, size_of_rhs) : std::numeric_limits<double>::infinity();
                deliver();
                if (enough(rhs, left * down)) {
                    error = left * down;
                    return true;
                }
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

Factorisation::Factorisation(const IsostaticStructure& structure)
    : implementation_(new Implementation{structure.shared_matrix(),
                                         ApproximateInverse(structure.matrix(), structure.ordering().symbolic()),
                                         true,
                                         0,
                                         {},
                                         {}}) {}

Factorisation::Factorisation(const IsostaticStructure& structure, ApproximateInverse inverse)
    : implementation_(new Implementation{structure.shared_matrix(), std::move(inverse), false, 0, {}, {}}) {}

std::vector<unsigned char> Factorisation::moving(const IsostaticStructure& structure, int slot) {
    // The pattern of G where only contact `slot` has a velocity: the unknown velocities that are not structural zeros.
    const sparse::Matrix<double>& h = structure.matrix();
    const auto n = static_cast<std::size_t>(h.rows);
    std::vector<int> start(n + 1, 0);
    for (const int row : h.row) {
        ++start[static_cast<std::size_t>(row) + 1];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<int> contact(h.row.size());
    std::vector<int> next(start.begin(), start.end() - 1);
    for (std::size_t l = 0; l < n; ++l) {
        for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
            contact[static_cast<std::size_t>(next[static_cast<std::size_t>(h.row[e])]++)] = static_cast<int>(l);
        }
    }
    std::vector<int> matched(n); // the degree of freedom matched to each contact
    for (std::size_t mu = 0; mu < n; ++mu) {
        matched[static_cast<std::size_t>(structure.matching()[mu])] = static_cast<int>(mu);
    }
    return sparse::structural_nonzeros(start, contact, matched, {&slot, 1});
}

std::optional<Factorisation> Factorisation::of_moving_block(const IsostaticStructure& structure, int slot) {
    const sparse::Matrix<double>& h = structure.matrix();
    const auto n = static_cast<std::size_t>(h.rows);
    const std::vector<unsigned char> moves = moving(structure, slot);
    std::vector<int> rows;
    std::vector<int> columns;
    for (std::size_t mu = 0; mu < n; ++mu) {
        if (moves[mu] != 0) {
            rows.push_back(static_cast<int>(mu));
            columns.push_back(structure.matching()[mu]);
        }
    }
    if (rows.size() > n / 4) {
        return std::nullopt;
    }
    Factorisation block;
    // NOLINTNEXTLINE(modernize-make-unique): an aggregate
    block.implementation_.reset(new Implementation{structure.shared_matrix(),
                                                   ApproximateInverse::of_block(h, std::move(rows), std::move(columns)),
                                                   true,
                                                   0,
                                                   {},
                                                   {}});
    return block;
}

Factorisation Factorisation::of(const IsostaticStructure& structure, ApproximateInverse factors) {
    assert(factors.exchanges() == 0);
    Factorisation fresh(structure, std::move(factors));
    fresh.implementation_->fresh = true;
    return fresh;
}

Factorisation Factorisation::shared() const {
    Factorisation copy;
    copy.implementation_ = std::make_unique<Implementation>(*implementation_);
    return copy;
}

Factorisation::~Factorisation() = default;
Factorisation::Factorisation(Factorisation&&) noexcept = default;
Factorisation& Factorisation::operator=(Factorisation&&) noexcept = default;

void Factorisation::solve_forces(std::span<double> rhs, int count) const {
    implementation_->solve(Implementation::Side::forces, rhs, count);
}

void Factorisation::solve_forces_from(std::span<double> rhs, std::span<const double> guess, double accuracy) const {
    Implementation& self = *implementation_;
    if (self.fresh || !self.refined(Implementation::Side::forces, rhs, guess, accuracy)) {
        self.solve(Implementation::Side::forces, rhs, 1);
    }
}

double Factorisation::solve_forces_until(std::span<double> rhs, std::span<const double> guess,
                                         const std::function<bool(std::span<const double>, double)>& enough) const {
    Implementation& self = *implementation_;
    const std::vector<double> load(rhs.begin(), rhs.end());
    if (!self.fresh && self.refined(Implementation::Side::forces, rhs, guess, 4 * u, enough)) {
        return self.error;
    }
    std::copy(load.begin(), load.end(), rhs.begin());
    self.solve(Implementation::Side::forces, rhs, 1);
    return 0;
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

} // namespace isostat
