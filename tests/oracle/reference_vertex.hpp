#pragma once
// The true vertex of a contact list in the paper's box, polished in any arithmetic and certified, apart from the
// library: Newton on |x_i - x_j| = R_i + R_j with Eigen's LU in double, residuals in the arithmetic wanted, and the
// theorem of Newton and Kantorovich in the maximum norm with an approximate inverse. Only data structures are shared.

#include <isostat/contact/state.hpp>

#include <boost/multiprecision/mpfr.hpp>
#include <eigen3/Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace isostat::oracle {

/// 97 decimal digits: at least 320 bits.
using Reference =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<97, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;

template <class T> double as_double(const T& x) {
    if constexpr (requires { x.x[0]; }) { // libqd
        return x.x[0];
    } else {
        return static_cast<double>(x);
    }
}

/// Gap functions and their derivative for all contacts at once; unknowns are all 2n + 2 coordinates.
template <class T> class ContactEquations {
  public:
    ContactEquations(const std::vector<double>& radius, const std::vector<Contact>& contacts)
        : radius_(&radius), contacts_(&contacts) {}
    [[nodiscard]] std::size_t unknowns() const { return 2 * radius_->size() + 2; }

    /// D_l: sum of the radii, or 1 at a wall (where the gap is linear).
    [[nodiscard]] T length(const Contact& c) const {
        return c.kind == ContactKind::disk_disk ? T(r(c.i)) + T(r(c.j)) : T(1.0);
    }
    /// (|x_i - x_j|^2 - D^2) / (2 D), or the gap at a wall.
    [[nodiscard]] T value(const std::vector<T>& q, const Contact& c) const {
        if (c.kind == ContactKind::disk_disk) {
            const T dx = q[index(c.j, 0)] - q[index(c.i, 0)];
            const T dy = q[index(c.j, 1)] - q[index(c.i, 1)];
            const T d = length(c);
            return (dx * dx + dy * dy - d * d) / (T(2.0) * d);
        }
        const T x = q[index(c.i, c.j)];
        return c.kind == ContactKind::lower_wall ? x - T(r(c.i)) : q[wall(c.j)] - x - T(r(c.i));
    }
    /// visit(coordinate, derivative of `value`).
    template <class Visit> void derivative(const std::vector<T>& q, const Contact& c, Visit visit) const {
        if (c.kind == ContactKind::disk_disk) {
            for (int a = 0; a < 2; ++a) {
                const T n = (q[index(c.j, a)] - q[index(c.i, a)]) / length(c);
                visit(index(c.i, a), -n);
                visit(index(c.j, a), n);
            }
        } else if (c.kind == ContactKind::lower_wall) {
            visit(index(c.i, c.j), T(1.0));
        } else {
            visit(index(c.i, c.j), T(-1.0));
            visit(wall(c.j), T(1.0));
        }
    }
    [[nodiscard]] const std::vector<Contact>& contacts() const { return *contacts_; }
    [[nodiscard]] double smallest_length() const {
        double d = std::numeric_limits<double>::infinity();
        for (const Contact& c : *contacts_) {
            d = c.kind == ContactKind::disk_disk ? std::min(d, r(c.i) + r(c.j)) : d;
        }
        return d;
    }

  private:
    [[nodiscard]] double r(int i) const { return (*radius_)[static_cast<std::size_t>(i)]; }
    [[nodiscard]] std::size_t index(int i, int axis) const { return static_cast<std::size_t>(2 * i + axis); }
    [[nodiscard]] std::size_t wall(int axis) const { return 2 * radius_->size() + static_cast<std::size_t>(axis); }
    const std::vector<double>* radius_;
    const std::vector<Contact>* contacts_;
};

/// The derivative A (rows: contacts) in double, and its factors.
class DoubleJacobian {
  public:
    template <class T> DoubleJacobian(const ContactEquations<T>& equations, const std::vector<T>& q) {
        const auto n = static_cast<Eigen::Index>(equations.unknowns());
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t l = 0; l < equations.contacts().size(); ++l) {
            equations.derivative(q, equations.contacts()[l], [&](std::size_t c, const T& value) {
                entries.emplace_back(static_cast<int>(l), static_cast<int>(c), as_double(value));
            });
        }
        matrix.resize(static_cast<Eigen::Index>(equations.contacts().size()), n);
        matrix.setFromTriplets(entries.begin(), entries.end());
        if (matrix.rows() == matrix.cols()) {
            lu = std::make_unique<Eigen::SparseLU<Eigen::SparseMatrix<double>>>(matrix);
            usable = lu->info() == Eigen::Success;
        }
    }
    Eigen::SparseMatrix<double> matrix; ///< by columns: one per coordinate
    std::unique_ptr<Eigen::SparseLU<Eigen::SparseMatrix<double>>> lu;
    bool usable = false; ///< a hint only
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
Polished<T> polish(const std::vector<double>& radius, std::vector<T> q, const std::vector<Contact>& contacts,
                   double tolerance, int max_iterations = 60, int fresh = 4) {
    const ContactEquations<T> equations(radius, contacts);
    const double unit = *std::min_element(radius.begin(), radius.end());
    Polished<T> result;
    std::unique_ptr<DoubleJacobian> jacobian;
    Eigen::VectorXd right(static_cast<Eigen::Index>(contacts.size()));
    for (;; ++result.iterations) {
        double worst = 0;
        std::vector<T> f(contacts.size());
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            f[l] = equations.value(q, contacts[l]);
            worst = std::max(worst, std::abs(as_double(f[l])));
        }
        result.residual = worst / unit;
        result.converged = result.residual <= tolerance;
        if (result.converged || result.iterations == max_iterations || !(result.residual < 1e3)) {
            break;
        }
        if (result.iterations < fresh) {
            jacobian = std::make_unique<DoubleJacobian>(equations, q);
        }
        if (!jacobian->usable) {
            break;
        }
        int exponent = 0; // scaled, so that the smallest residuals stay in the range of double
        (void)std::frexp(worst, &exponent);
        const T scale = ldexp(T(1.0), -exponent);
        for (std::size_t l = 0; l < f.size(); ++l) {
            right[static_cast<Eigen::Index>(l)] = -as_double(T(f[l] * scale));
        }
        const Eigen::VectorXd step = jacobian->lu->solve(right);
        for (std::size_t c = 0; c < q.size(); ++c) {
            q[c] += T(step[static_cast<Eigen::Index>(c)]) / scale;
        }
    }
    result.q = std::move(q);
    return result;
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
inline VertexCertificate certify_vertex(const std::vector<double>& radius, const std::vector<Reference>& q,
                                        const std::vector<Contact>& contacts) {
    VertexCertificate certificate;
    const ContactEquations<Reference> equations(radius, contacts);
    const DoubleJacobian jacobian(equations, q);
    if (!jacobian.usable) {
        return certificate;
    }
    constexpr double u = 0x1p-53;
    const auto& a = jacobian.matrix;
    const Eigen::Index n = a.rows();
    double rows_r = 0;
    double rows_e = 0;
    Eigen::VectorXd columns_r = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd columns_e = Eigen::VectorXd::Zero(n);
    const Eigen::SparseMatrix<double> transposed = a.transpose();
    const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(transposed);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::VectorXd r = lu.solve(Eigen::VectorXd::Unit(n, i)); // row i of R
        double row_r = 0;
        double row_e = 0;
        for (Eigen::Index c = 0; c < n; ++c) {
            double sum = 0;
            double size = 0;
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
    Reference largest = 0;
    for (const Contact& c : contacts) {
        largest = std::max(largest, Reference(abs(equations.value(q, c))));
    }
    Reference extent = 0;
    for (const Reference& x : q) {
        extent = std::max(extent, Reference(abs(x)));
    }
    const double d = equations.smallest_length();
    const double size = static_cast<double>(extent);
    const double rounding = std::ldexp(size + size * size / d, -310); // ten operations in at least 320 bits
    const double eta = certificate.inverse_rows * (static_cast<double>(largest) * (1 + 1e-12) + rounding);
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

/// `refinements` with residuals in T; `right_hand_sides` of the two are solved with one factorisation.
template <class T>
AffineForces<T> affine_forces(const std::vector<double>& radius, const std::vector<T>& q,
                              const std::vector<Contact>& contacts, const std::vector<double>& fixed_load,
                              const std::vector<double>& unit_load, int refinements) {
    const ContactEquations<T> equations(radius, contacts);
    const DoubleJacobian jacobian(equations, q);
    AffineForces<T> forces;
    if (!jacobian.usable) {
        return forces;
    }
    const auto solve = [&](const std::vector<double>& load, std::vector<T>& f, double& worst) {
        f.assign(contacts.size(), T(0.0));
        for (int k = 0;; ++k) {
            std::vector<T> r; // load - H f = load + A^T f
            for (const double c : load) {
                r.push_back(T(c));
            }
            for (std::size_t l = 0; l < contacts.size(); ++l) {
                equations.derivative(q, contacts[l], [&](std::size_t c, const T& value) { r[c] += value * f[l]; });
            }
            worst = 0;
            for (const T& c : r) {
                worst = std::max(worst, std::abs(as_double(c)));
            }
            if (k > refinements || worst == 0) {
                return;
            }
            int exponent = 0;
            (void)std::frexp(worst, &exponent);
            const T scale = ldexp(T(1.0), -exponent);
            Eigen::VectorXd right(static_cast<Eigen::Index>(r.size()));
            for (std::size_t c = 0; c < r.size(); ++c) {
                right[static_cast<Eigen::Index>(c)] = -as_double(T(r[c] * scale));
            }
            const Eigen::VectorXd step = jacobian.lu->transpose().solve(right);
            for (std::size_t l = 0; l < f.size(); ++l) {
                f[l] += T(step[static_cast<Eigen::Index>(l)]) / scale;
            }
        }
    };
    solve(fixed_load, forces.fixed, forces.fixed_residual);
    solve(unit_load, forces.unit, forces.unit_residual);
    return forces;
}

/// sigma at which the force of contact l vanishes, with a bound of its error (infinite: nothing is known).
struct LimitReference {
    Reference stress = 0;
    double bound = std::numeric_limits<double>::infinity();
    double lowest = 0; ///< smallest force of all contacts there / largest: not below 0 but for roundings
};

inline LimitReference certified_limit(const std::vector<double>& radius, const std::vector<Reference>& q,
                                      const VertexCertificate& certificate, const std::vector<Contact>& contacts,
                                      const std::vector<double>& fixed_load, const std::vector<double>& unit_load,
                                      std::size_t l) {
    LimitReference limit;
    if (!certificate.proved()) {
        return limit;
    }
    const auto f = affine_forces(radius, q, contacts, fixed_load, unit_load, 40);
    if (f.fixed.empty()) {
        return limit;
    }
    const double d = ContactEquations<Reference>(radius, contacts).smallest_length();
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
    Reference lowest = 0;
    Reference largest = 0;
    for (std::size_t k = 0; k < f.fixed.size(); ++k) {
        const Reference force = f.fixed[k] + limit.stress * f.unit[k];
        lowest = std::min(lowest, force);
        largest = std::max(largest, force);
    }
    limit.lowest = static_cast<double>(Reference(lowest / largest));
    return limit;
}

} // namespace isostat::oracle
