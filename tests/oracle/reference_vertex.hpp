#pragma once
// The true vertex of a contact list in the paper's box, polished in any arithmetic and certified, apart from the
// library: Newton on |x_i - x_j| = R_i + R_j with Eigen's LU in double, residuals in the arithmetic wanted, and the
// theorem of Newton and Kantorovich in the maximum norm with an approximate inverse. Only data structures are shared.

#include "oracle/refined.hpp"
#include "oracle/truth.hpp"

namespace isostat::oracle {

/// At least 320 bits.
using Reference = Decimal<97>;

/// Functions that vanish with the gaps, and have constant second derivatives; unknowns are all 2n + 2 coordinates.
template <class T> class ContactEquations {
  public:
    using Matrix = RefinedMatrix<T>;

    ContactEquations(const Packing& packing, const std::vector<Contact>& contacts, std::vector<T> q)
        : contacts_(&contacts), at_(packing, std::move(q)) {}
    /// (|x_i - x_j|^2 - D^2) / (2 D), D the sum of the radii, or the gap at a wall.
    [[nodiscard]] T value(const Contact& c) const {
        if (!Geometry<T>::is_pair(c)) {
            return at_.linear_gap(c);
        }
        const T d = at_.target(c);
        return (Geometry<T>::square(at_.between(c)) - d * d) / (T(2.0) * d);
    }
    [[nodiscard]] std::vector<T> values() const {
        std::vector<T> f;
        std::transform(contacts_->begin(), contacts_->end(), std::back_inserter(f),
                       [this](const Contact& c) { return value(c); });
        return f;
    }
    /// The derivative of `values`.
    [[nodiscard]] Matrix derivative() const {
        return {contacts_->size(), at_.q.size(), [this](auto put) {
                    for (std::size_t l = 0; l < contacts_->size(); ++l) {
                        const Contact& c = (*contacts_)[l];
                        const T length = Geometry<T>::is_pair(c) ? at_.target(c) : T(1.0);
                        at_.gradient(c, length, [&](std::size_t k, const T& value) { put(l, k, value); });
                    }
                }};
    }
    [[nodiscard]] double smallest_length() const {
        double d = std::numeric_limits<double>::infinity();
        for (const Contact& c : *contacts_) {
            d = Geometry<T>::is_pair(c) ? std::min(d, as_double(at_.target(c))) : d;
        }
        return d;
    }
    std::vector<T>& q() { return at_.q; }

  private:
    const std::vector<Contact>* contacts_;
    Geometry<T> at_;
};

template <class T> struct Polished {
    std::vector<T> q;
    bool converged = false;
    int iterations = 0;
    double residual = 0; ///< largest |gap function| / smallest radius at q
};

/// Newton until every gap function is below `tolerance` x smallest radius. The factors are made anew at the first
/// `fresh` iterations (chord iterations follow).
template <class T>
Polished<T> polish(const Packing& packing, std::vector<T> q, const std::vector<Contact>& contacts, double tolerance,
                   int max_iterations = 60, int fresh = 4) {
    ContactEquations<T> equations(packing, contacts, std::move(q));
    Polished<T> result;
    std::unique_ptr<RefinedMatrix<T>> derivative;
    for (;; ++result.iterations) {
        std::vector<T> f = equations.values();
        result.residual = as_double(largest_of(f)) / packing.min_radius();
        result.converged = result.residual <= tolerance;
        if (result.converged || result.iterations == max_iterations || !(result.residual < 1e3)) {
            break;
        }
        if (result.iterations < fresh) {
            derivative = std::make_unique<RefinedMatrix<T>>(equations.derivative());
        }
        if (!derivative->usable) {
            break;
        }
        const auto step = derivative->solve(f, RefinedMatrix<T>::Of::matrix, 1).x;
        for (std::size_t c = 0; c < step.size(); ++c) {
            equations.q()[c] -= step[c];
        }
    }
    result.q = std::move(equations.q());
    return result;
}

/// Velocity at q that opens one contact and keeps the others closed, the fastest coordinate at 1; empty where the
/// factors are unusable.
template <class T>
std::vector<T> opening_velocity(const Packing& packing, const std::vector<T>& q, const std::vector<Contact>& contacts,
                                std::size_t opened, int corrections) {
    const RefinedMatrix<T> derivative = ContactEquations<T>(packing, contacts, q).derivative();
    if (!derivative.usable) {
        return {};
    }
    std::vector<T> opening(q.size(), T(0.0));
    opening[opened] = T(1.0);
    std::vector<T> v = derivative.solve(opening, RefinedMatrix<T>::Of::matrix, corrections).x;
    const T fastest = largest_of(v);
    std::ranges::for_each(v, [&fastest](T& c) { c /= fastest; });
    return v;
}

/// What is proved of a true vertex near q (maximum norm). `radius` infinite: nothing.
struct VertexCertificate {
    double radius = std::numeric_limits<double>::infinity(); ///< a true vertex lies within, and is alone within `alone`
    double alone = 0;
    double inverse_rows = 0;    ///< bound of |A^-1| in the maximum norm
    double inverse_columns = 0; ///< and in the 1-norm
    [[nodiscard]] bool proved() const { return std::isfinite(radius); }
};

/// Newton-Kantorovich: |A^-1| <= |R| / (1 - |I - R A|), R from the LU factors, roundings counted; Lipschitz constant 8
/// / smallest D. Cost: N solves.
inline VertexCertificate certify_vertex(const Packing& packing, const std::vector<Reference>& q,
                                        const std::vector<Contact>& contacts) {
    VertexCertificate certificate;
    const ContactEquations<Reference> equations(packing, contacts, q);
    const RefinedMatrix<Reference> derivative = equations.derivative();
    if (!derivative.usable) {
        return certificate;
    }
    constexpr double u = 0x1p-53;
    const auto& a = derivative.rounded;
    const Eigen::Index n = a.rows();
    double rows_r = 0, rows_e = 0;
    Eigen::VectorXd columns_r = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd columns_e = Eigen::VectorXd::Zero(n);
    const Eigen::SparseMatrix<double> transposed = a.transpose();
    const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(transposed);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::VectorXd r = lu.solve(Eigen::VectorXd::Unit(n, i)); // row i of R
        double row_r = 0, row_e = 0;
        for (Eigen::Index c = 0; c < n; ++c) {
            double sum = 0, size = 0;
            int terms = 4;
            for (Eigen::SparseMatrix<double>::InnerIterator e(a, c); e; ++e) {
                sum += r[e.row()] * e.value();
                size += std::abs(r[e.row()] * e.value());
                ++terms;
            }
            // Sum in double, and the entries of A rounded to double.
            const double error = std::abs((c == i ? 1.0 : 0.0) - sum) + 1.01 * u * (terms + 2) * (size + 1);
            row_e += error;
            columns_e[c] += error;
            row_r += std::abs(r[c]);
            columns_r[c] += std::abs(r[c]);
        }
        rows_r = std::max(rows_r, row_r);
        rows_e = std::max(rows_e, row_e);
    }
    const double sums = 1 + 1e-9;
    const double e_rows = rows_e * sums;
    const double e_columns = columns_e.maxCoeff() * sums;
    if (!(e_rows < 0.5 && e_columns < 0.5)) {
        return certificate;
    }
    certificate.inverse_rows = rows_r * sums / (1 - e_rows);
    certificate.inverse_columns = columns_r.maxCoeff() * sums / (1 - e_columns);
    const double d = equations.smallest_length();
    const double size = as_double(largest_of(q));
    const double rounding = std::ldexp(size + size * size / d, -310); // ten operations in at least 320 bits
    const double eta = certificate.inverse_rows * (as_double(largest_of(equations.values())) * (1 + 1e-12) + rounding);
    const double lipschitz = 8 / d;
    if (certificate.inverse_rows * lipschitz * eta <= 0.25) {
        certificate.radius = 1.18 * eta;
        certificate.alone = 1 / (certificate.inverse_rows * lipschitz);
    }
    return certificate;
}

/// Forces a + sigma b of a polished vertex: `a` under the load without the loaded stress, `b` per unit of it.
template <class T> struct AffineForces {
    std::vector<T> fixed, unit;
    double fixed_residual = 0, unit_residual = 0; ///< largest unbalanced force, as computed
};

/// `refinements` with residuals in T; the two right-hand sides are solved with one factorisation.
template <class T>
AffineForces<T> affine_forces(const Packing& packing, const std::vector<T>& q, const std::vector<Contact>& contacts,
                              const std::vector<double>& fixed_load, const std::vector<double>& unit_load,
                              int refinements) {
    const RefinedMatrix<T> derivative = ContactEquations<T>(packing, contacts, q).derivative();
    if (!derivative.usable) {
        return {};
    }
    const auto solve = [&](const std::vector<double>& load) { // load = H f = -A^T f
        std::vector<T> minus;
        std::ranges::transform(load, std::back_inserter(minus), [](double f) { return T(-f); });
        return derivative.solve(minus, RefinedMatrix<T>::Of::transposed, refinements + 1);
    };
    const auto fixed = solve(fixed_load);
    const auto unit = solve(unit_load);
    return {fixed.x, unit.x, as_double(fixed.residual), as_double(unit.residual)};
}

/// sigma at which the force of contact l vanishes, with a bound of its error (infinite: nothing is known).
struct LimitReference {
    Reference stress = 0;
    double bound = std::numeric_limits<double>::infinity();
    double lowest = 0; ///< smallest force of all contacts there / largest: not below 0 but for roundings
};

inline LimitReference certified_limit(const Packing& packing, const std::vector<Reference>& q,
                                      const VertexCertificate& certificate, const std::vector<Contact>& contacts,
                                      const std::vector<double>& fixed_load, const std::vector<double>& unit_load,
                                      std::size_t l) {
    LimitReference limit;
    if (!certificate.proved()) {
        return limit;
    }
    const auto f = affine_forces(packing, q, contacts, fixed_load, unit_load, 40);
    if (f.fixed.empty()) {
        return limit;
    }
    const double d = ContactEquations<Reference>(packing, contacts, q).smallest_length();
    const auto bound = [&](const std::vector<Reference>& x, double residual) {
        double sum = 0;
        for (const Reference& c : x) {
            sum += std::abs(static_cast<double>(c));
        }
        // Residual, its rounding, and normals at the distance of the true vertex.
        return 1.01 * certificate.inverse_columns *
               (residual + std::ldexp(sum + 1, -310) + 2 * certificate.radius / d * sum);
    };
    const double fixed_bound = bound(f.fixed, f.fixed_residual);
    const double unit_bound = bound(f.unit, f.unit_residual);
    const double slope = std::abs(static_cast<double>(f.unit[l]));
    if (!(slope > 2 * unit_bound)) {
        return limit;
    }
    limit.stress = -f.fixed[l] / f.unit[l];
    const double sigma = std::abs(static_cast<double>(limit.stress));
    limit.bound = 1.01 * (fixed_bound + sigma * unit_bound) / (slope - unit_bound) + std::ldexp(sigma, -310);
    Reference lowest = 0, largest = 0;
    for (std::size_t k = 0; k < f.fixed.size(); ++k) {
        const Reference force = f.fixed[k] + limit.stress * f.unit[k];
        lowest = std::min(lowest, force);
        largest = std::max(largest, force);
    }
    limit.lowest = static_cast<double>(Reference(lowest / largest));
    return limit;
}

} // namespace isostat::oracle
