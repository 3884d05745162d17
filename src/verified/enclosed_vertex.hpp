#pragma once
// The true vertex in one number type (statement V5, proofs/true_vertex.md): private to the room and to the certificate.

#include "core/roundoff.hpp"
#include "verified/corrected_configuration.hpp"
#include "verified/inverse_bound.hpp"

#include <limits>
#include <utility>

namespace isostat {

/// Bounds at the stored coordinates q that hold for all number types (V4).
struct Neighbourhood {
    double lipschitz = 0;    ///< K of V4 (a), for the derivative of the gap functions F_l
    double inverse_norm = 0; ///< bound of |DF^-1| at q, V4 (b); infinity if unknown

    static Neighbourhood of(const Packing& packing, const std::vector<Contact>& contacts, const InverseBound& inverse) {
        using roundoff::u;
        const double relative_gap = worst_gap_ratio(packing, contacts);
        // true_vertex.md V5 (test of the gaps)
        const bool known = inverse.verdict == Verdict::proved && relative_gap < 1e-3; // false for a NaN
        return {isostat::lipschitz(packing, contacts),
                // 16: bounds.md V4 (b), 8u granted there; 4: precision.md B1 (last operations)
                known ? (1 + 2 * relative_gap + 16 * u) / inverse.sigma_min * (1 + 4 * u)
                      : std::numeric_limits<double>::infinity()};
    }
};

/// Newton's method from q + p with gaps in T and steps from the factors in double, until an iteration does not halve
/// the radius; then Newton-Kantorovich, including the rounding of the gaps. Cost per iteration: N gaps and a solve.
template <class T> class EnclosedVertex {
  public:
    using A = Arithmetic<T>;
    using Bound = typename A::Bound;

    /// `start`: p at the start of the iteration, or empty.
    EnclosedVertex(const A& arithmetic, const Packing& packing, const IsostaticStructure& structure,
                   const Factorisation& factorisation, const Neighbourhood& at_q, const std::vector<T>& start = {})
        : at_(arithmetic, packing), at_q_(at_q) {
        for (std::size_t c = 0; c < start.size(); ++c) {
            at_.correction(static_cast<int>(c)) += start[c];
        }
        if (at_q.inverse_norm < std::numeric_limits<double>::infinity()) {
            enclose(structure, factorisation);
        }
    }
    /// A true vertex exists within `radius` of `at`, alone within 1.7 / (derivative K). \pre of all members below
    [[nodiscard]] bool exists() const { return exists_; }
    [[nodiscard]] const CorrectedConfiguration<T>& at() const { return at_; }
    [[nodiscard]] const Bound& radius() const { return radius_; }   ///< 2-norm
    [[nodiscard]] const Bound& shift() const { return shift_; }     ///< bound of |p|
    [[nodiscard]] double derivative() const { return derivative_; } ///< beta: bound of |DF^-1| at q + p
    [[nodiscard]] double lipschitz() const { return at_q_.lipschitz; }
    /// Lower bound of the smallest singular value of the contact matrix at the true vertex.
    [[nodiscard]] double sigma() const { return sigma_; }
    /// Bound of |q* - q|.
    // precision.md B1 (last operations)
    [[nodiscard]] Bound distance() const { return (shift_ + radius_) * (1 + 4 * u); }

  private:
    static constexpr double u = roundoff::u;

    /// Bound of |F(c)|; `f` becomes the computed F.
    Bound residual(const std::vector<Contact>& contacts, std::vector<T>& f) const {
        const A& a = at_.arithmetic();
        std::vector<Bound> bound;
        f.clear();
        for (const Contact& contact : contacts) {
            f.push_back(at_.gap_function(contact));
            // true_vertex.md V5 (8e D)
            bound.push_back(a.size(f.back()) + 8 * a.unit() * target(at_.packing(), contact));
        }
        return norm_of_bounds(bound);
    }
    /// Accepts the present place when its radius is less than half the best; false also where nothing is known.
    bool accept(const Bound& residual);
    void enclose(const IsostaticStructure& structure, const Factorisation& factorisation);

    CorrectedConfiguration<T> at_;
    Neighbourhood at_q_;
    bool exists_ = false;
    Bound radius_ = std::numeric_limits<double>::infinity();
    Bound shift_ = 0;
    double derivative_ = 0;
    double sigma_ = 0;
    bool lost_ = false; ///< too far from q
};

template <class T> bool EnclosedVertex<T>::accept(const Bound& residual) {
    const double k = at_q_.lipschitz;
    std::vector<Bound> moved;
    for (const T& c : at_.correction()) {
        moved.push_back(at_.arithmetic().size(c));
    }
    const Bound largest = *std::max_element(moved.begin(), moved.end());
    const Bound shift = norm_of_bounds(moved);
    // 4: precision.md B1 (last operations)
    const double lost = above(at_q_.inverse_norm * k * shift * (1 + 4 * u));
    // 0x1p-10: true_vertex.md V5 (size of p); 0.5: cost: lost below 1/2, and when iterations stop
    lost_ = !(largest <= 0x1p-10 * at_.packing().min_radius() && lost < 0.5);
    if (lost_) {
        return false;
    }
    const double beta = at_q_.inverse_norm / (1 - lost) * (1 + 4 * u);
    const Bound eta = beta * residual * (1 + 2 * u);
    const Bound product = beta * k * eta * (1 + 4 * u);
    // true_vertex.md V5 (by bounds.md T9)
    const Bound radius = 1.18 * eta;                    // (1 - sqrt(1 - 2h)) / h <= 1.172 for h <= 1/4
    if (!(product <= 0.25 && radius < 0.5 * radius_)) { // true_vertex.md V5 (h <= 1/4)
        return false;
    }
    exists_ = true;
    shift_ = shift;
    radius_ = radius;
    derivative_ = beta;
    return true;
}

template <class T>
void EnclosedVertex<T>::enclose(const IsostaticStructure& structure, const Factorisation& factorisation) {
    const A& a = at_.arithmetic();
    std::vector<T> accepted;
    std::vector<T> f;
    std::vector<double> step(structure.contacts().size());
    for (int iteration = 0; iteration <= a.corrections; ++iteration) {
        const Bound bound = residual(structure.contacts(), f);
        if (accept(bound)) {
            accepted = at_.correction();
        } else if (lost_ || exists_) {
            break; // at the rounding of this type, or too far away
        }
        if (iteration < a.corrections) {
            const long exponent = a.exponent_of(f);
            std::transform(f.begin(), f.end(), step.begin(), [&](const T& c) { return a.scaled(c, exponent); });
            factorisation.solve_velocities(step); // approach velocities equal to the gaps close them
            for (std::size_t mu = 0; mu < step.size(); ++mu) {
                at_.correction(structure.dofs().coordinate_of(static_cast<int>(mu))) += a.number(step[mu], exponent);
            }
        }
    }
    if (exists_) {
        at_.correct(std::move(accepted));
        // precision.md B1 (last operations)
        sigma_ = (1 / derivative_ - above(at_q_.lipschitz * radius_)) * (1 - 8 * u);
    }
}

} // namespace isostat
