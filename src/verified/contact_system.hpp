#pragma once
// Forces and motions with bounds in one number type (statement V6, proofs/true_vertex.md): private to the room and to
// the certificate.

#include "core/roundoff.hpp"
#include "linear/factorisation.hpp"
#include "verified/enclosed_vertex.hpp"

namespace isostat {

/// |x*_l - value_l| <= bound for every l. With a bound that is NaN or infinite nothing is known.
template <class T> struct BoundedVector {
    std::vector<T> value;
    typename Arithmetic<T>::Bound bound = std::numeric_limits<double>::infinity();
    double residual = 0; ///< largest component of load - A value, as computed
};

/// H* f = F and its transpose, H* the contact matrix at the true vertex or place, by refinement with residuals in T and
/// corrections of the factors in double, until an iteration does not halve the bound. Cost per iteration: a product
/// with the matrix and a solve. The arguments must outlive the object.
template <class T> class ContactSystem {
  public:
    using A = Arithmetic<T>;
    using Bound = typename A::Bound;
    using Place = CorrectedConfiguration<T>;

    /// H* is the matrix at the true vertex. \pre the vertex exists.
    ContactSystem(const EnclosedVertex<T>& vertex, const IsostaticStructure& structure,
                  const Factorisation& factorisation)
        : arithmetic_(vertex.at().arithmetic()), packing_(vertex.at().packing()), structure_(structure),
          factorisation_(factorisation), matrix_(vertex.at().contact_matrix(structure, Place::Divided::by_lengths)),
          // precision.md B1 (last operations)
          radius_(vertex.radius()), uncertainty_(vertex.lipschitz() * vertex.radius() * (1 + 4 * u)),
          sigma_(vertex.sigma()) {}
    /// |H* - H| <= uncertainty, H the unit normals at `place`; `sigma` > 0 a lower bound of the smallest singular value
    /// of H*.
    ContactSystem(const Place& place, const IsostaticStructure& structure, const Factorisation& factorisation,
                  double sigma, double uncertainty)
        : arithmetic_(place.arithmetic()), packing_(place.packing()), structure_(structure),
          factorisation_(factorisation), matrix_(place.contact_matrix(structure, Place::Divided::by_distances)),
          radius_(0), uncertainty_(uncertainty), sigma_(sigma) {}

    /// The forces that bear a load, which is known to `load_error` (2-norm); `x`: the start of the iteration.
    [[nodiscard]] BoundedVector<T> forces(const std::vector<T>& load, const Bound& load_error, std::vector<T> x) const {
        for (T& c : x) {
            c = arithmetic_.number(0) + c; // rounded to the bits of this arithmetic
        }
        return refine(load, load_error, std::move(x), false);
    }
    /// The motion with these approach velocities.
    [[nodiscard]] BoundedVector<T> motion(const std::vector<T>& approach) const {
        return refine(approach, 0, std::vector<T>(approach.size(), arithmetic_.number(0)), true);
    }
    [[nodiscard]] const A& arithmetic() const { return arithmetic_; }
    [[nodiscard]] std::size_t size() const { return structure_.contacts().size(); }

  private:
    static constexpr double u = roundoff::u;
    struct Residual {
        std::vector<T> value;
        Bound norm = 0; ///< upper bound of the norm of the exact residual
        double largest = 0;
    };
    [[nodiscard]] Residual residual(const std::vector<T>& load, const std::vector<T>& x, bool transposed) const;
    /// Bound of |(H* - A) x|: the error of forces from the distance to the true vertex.
    [[nodiscard]] Bound turned(const std::vector<T>& x, bool transposed) const;
    [[nodiscard]] BoundedVector<T> refine(const std::vector<T>& load, const Bound& load_error, std::vector<T> x,
                                          bool transposed) const;

    A arithmetic_;
    const Packing& packing_;
    const IsostaticStructure& structure_;
    const Factorisation& factorisation_;
    sparse::Matrix<T> matrix_;
    Bound radius_;
    Bound uncertainty_;
    double sigma_;
    double largest_entry_ = largest_multiple(structure_.contacts()); ///< bound of the entries of a contact matrix
};

template <class T>
auto ContactSystem<T>::residual(const std::vector<T>& load, const std::vector<T>& x, bool transposed) const
    -> Residual {
    const A& a = arithmetic_;
    const std::size_t n = load.size();
    Residual result{load};
    std::vector<Bound> size(n);
    std::vector<int> terms(n, 8); // 5 of the entry, 1 of the product, 2 of the load; true_vertex.md V6 (c + 8)
    for (std::size_t i = 0; i < n; ++i) {
        size[i] = a.about(load[i]);
    }
    std::vector<Bound> magnitude(n);
    std::transform(x.begin(), x.end(), magnitude.begin(), [&](const T& c) { return a.about(c); });
    for (std::size_t l = 0; l < n; ++l) {
        for (auto e = static_cast<std::size_t>(matrix_.start[l]); e < static_cast<std::size_t>(matrix_.start[l + 1]);
             ++e) {
            const auto row = static_cast<std::size_t>(matrix_.row[e]);
            const auto [i, j] = transposed ? std::pair(l, row) : std::pair(row, l);
            result.value[i] -= matrix_.value[e] * x[j];
            size[i] += largest_entry_ * magnitude[j];
            ++terms[i];
        }
    }
    std::vector<Bound> unknown(n); // bound of the error of the residual, row by row
    for (std::size_t i = 0; i < n; ++i) {
        unknown[i] = a.size(result.value[i]) + 1.02 * a.unit() * terms[i] * size[i]; // true_vertex.md V6 (rounding)
        result.largest = std::max(result.largest, std::abs(a.rounded(result.value[i])));
    }
    result.norm = norm_of_bounds(unknown);
    return result;
}

template <class T> auto ContactSystem<T>::turned(const std::vector<T>& x, bool transposed) const -> Bound {
    const A& a = arithmetic_;
    if (transposed || radius_ <= 0) { // |H* - A| |x|
        std::vector<Bound> size(x.size());
        std::transform(x.begin(), x.end(), size.begin(), [&](const T& c) { return a.size(c); });
        // precision.md B1 (last operations)
        return uncertainty_ <= 0 ? Bound(0) : uncertainty_ * norm_of_bounds(size) * (1 + 4 * u);
    }
    if (packing_.cell.any()) {
        HeaviestSum sum(packing_.radius.size());
        for (std::size_t l = 0; l < x.size(); ++l) {
            const Contact& contact = structure_.contacts()[l];
            if (contact.of_disks()) {
                sum.add_turn(contact, above(a.about(x[l])) / target(packing_, contact));
            }
        }
        return Bound(sum.largest()) * radius_ * sum_slack(x.size());
    }
    std::vector<Bound> weight(packing_.radius.size(), Bound(0)); // sum of |f_l| / D_l at each disk
    for (std::size_t l = 0; l < x.size(); ++l) {
        const Contact& contact = structure_.contacts()[l];
        if (contact.of_disks()) {
            const Bound w = a.about(x[l]) / target(packing_, contact);
            weight[static_cast<std::size_t>(contact.i)] += w;
            weight[static_cast<std::size_t>(contact.j)] += w;
        }
    }
    const Bound heaviest = weight.empty() ? Bound(0) : *std::max_element(weight.begin(), weight.end());
    return 2 * heaviest * radius_ * sum_slack(x.size());
}

template <class T>
BoundedVector<T> ContactSystem<T>::refine(const std::vector<T>& load, const Bound& load_error, std::vector<T> x,
                                          bool transposed) const {
    const A& a = arithmetic_;
    BoundedVector<T> best;
    std::vector<double> step(x.size());
    for (int iteration = 0; iteration <= a.refinements + 1; ++iteration) {
        const Residual r = residual(load, x, transposed);
        // precision.md B1 (last operations)
        const Bound bound = (r.norm + load_error + turned(x, transposed)) / sigma_ * (1 + 8 * u);
        const bool enough = !(bound < 0.5 * best.bound); // cost: lost below 1/2, and when iterations stop
        if (bound < best.bound) {
            best = {x, bound, r.largest};
        }
        if (iteration > 0 && enough) {
            break;
        }
        const long exponent = a.exponent_of(r.value);
        std::transform(r.value.begin(), r.value.end(), step.begin(), [&](const T& c) { return a.scaled(c, exponent); });
        if (transposed) {
            factorisation_.solve_velocities(step);
        } else {
            factorisation_.solve_forces(step);
        }
        for (std::size_t l = 0; l < x.size(); ++l) {
            x[l] += a.number(step[l], exponent);
        }
    }
    return best;
}

} // namespace isostat
