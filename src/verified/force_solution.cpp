#include "verified/extended_norm.hpp"
#include "verified/norm.hpp"

#include <isostat/verified/force_solution.hpp>

#include <qd/dd_real.h>

#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;
/// Relative error that is granted to one double-double operation of libqd (its own bounds are 2^-104 to 2^-102).
constexpr double dd_unit = 0x1p-98;

/// Largest magnitude; NaN when there is one.
double max_abs(const std::vector<double>& x) {
    double largest = 0;
    for (const double c : x) {
        largest = std::isnan(c) ? c : std::max(largest, std::abs(c));
    }
    return largest;
}

/// Upper bound of the 2-norm of an exact residual, and the part of it that is rounding of its evaluation.
struct Residual {
    double bound;
    double rounding;
};

/// A row of the residual: value, sum of the absolute values, and number of roundings.
struct Row {
    double r;
    double size;
    int terms;
};

/// Residual F - H x in double, with a bound of its distance from the exact residual (exact H: entries of fl(H) carry
/// 5u). Returns an upper bound of the 2-norm of the exact residual.
Residual residual_in_double(const sparse::Matrix<double>& h, const std::vector<double>& x,
                            const std::vector<double>& force, std::vector<double>& r) {
    const auto n = static_cast<std::size_t>(h.rows);
    std::vector<Row> rows(n);
    for (std::size_t i = 0; i < n; ++i) {
        rows[i] = {force[i], std::abs(force[i]),
                   7}; // 5u of the entries, the product and the final sum; of the force: its own
    }
    Row* const row = rows.data();
    const double* const value = h.value.data();
    for (std::size_t j = 0; j < static_cast<std::size_t>(h.cols); ++j) {
        const auto end = static_cast<std::size_t>(h.start[j + 1]);
        const double xj = x[j];
        for (auto e = static_cast<std::size_t>(h.start[j]); e < end; ++e) {
            Row& at = row[h.row[e]];
            const double term = value[e] * xj;
            at.r -= term;
            at.size += std::abs(term);
            ++at.terms;
        }
    }
    // Entries and products that underflow err by an absolute amount besides.
    const double lost = underflow_unit * (1 + max_abs(x));
    std::vector<double> unknown(n);
    std::vector<double> bound(n);
    for (std::size_t i = 0; i < n; ++i) {
        r[i] = row[i].r;
        unknown[i] = row[i].terms * (u * 1.001 * row[i].size + lost);
        bound[i] = std::abs(r[i]) + unknown[i];
    }
    return {norm_above(bound), norm_above(unknown)};
}

} // namespace

template <int Dim>
ForceSolution solve_forces(const IsostaticStructure<Dim>& structure, const Factorisation& factorisation,
                           const InverseBound& inverse, const std::vector<double>& force, std::span<const double> guess,
                           double accuracy) {
    const sparse::Matrix<double>& h = structure.matrix();
    const auto n = static_cast<std::size_t>(h.rows);
    ForceSolution solution;
    solution.value = force;
    const bool rough = accuracy > 0 && !factorisation.is_fresh();
    if (!rough && guess.empty()) {
        factorisation.solve_forces(solution.value);
    } else {
        factorisation.solve_forces_from(solution.value, guess, rough ? accuracy : 4 * u);
    }
    std::vector<double> r(n);
    Residual residual = residual_in_double(h, solution.value, force, r);
    // A residual that is mostly the rounding of its own evaluation cannot be improved in double.
    if (!rough && !(residual.bound < 3 * residual.rounding)) {
        factorisation.solve_forces(r);
        for (std::size_t l = 0; l < n; ++l) {
            solution.value[l] += r[l];
        }
        residual = residual_in_double(h, solution.value, force, r);
    }
    solution.residual = max_abs(r);
    solution.bound = inverse.verdict == Verdict::proved ? residual.bound / inverse.sigma_min * (1 + 4 * u)
                                                        : std::numeric_limits<double>::infinity();
    return solution;
}

template <int Dim>
ExtendedMatrix extended_contact_matrix(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                                       const std::vector<double>& correction) {
    const sparse::Matrix<double>& h = structure.matrix();
    ExtendedMatrix matrix{h.value, std::vector<double>(h.value.size(), 0.0)};
    const DofMap<Dim>& dofs = structure.dofs();
    for (std::size_t l = 0; l < structure.contacts().size(); ++l) {
        const Contact& contact = structure.contacts()[l];
        if (contact.kind != ContactKind::disk_disk) {
            continue; // entries +-1 are exact
        }
        std::array<dd_real, Dim> d;
        for (int a = 0; a < Dim; ++a) {
            const auto i = static_cast<std::size_t>(Dim * contact.i + a);
            const auto j = static_cast<std::size_t>(Dim * contact.j + a);
            dd_real& component = d[static_cast<std::size_t>(a)];
            component = dd_real(packing.q[j]) - packing.q[i];
            if (!correction.empty()) { // the large parts cancel first
                component += dd_real(correction[j]) - correction[i];
            }
        }
        normalise(d);
        const dd_real distance = length(d);
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            const int coordinate = dofs.coordinate_of(h.row[s]);
            dd_real value = d[static_cast<std::size_t>(coordinate % Dim)] / distance;
            if (coordinate / Dim == contact.j) {
                value = -value;
            }
            matrix.high[s] = value.x[0];
            matrix.low[s] = value.x[1];
        }
    }
    return matrix;
}

template <int Dim>
void refine_double_double(ForceSolution& solution, const ExtendedMatrix& matrix,
                          const IsostaticStructure<Dim>& structure, const Factorisation& factorisation,
                          const InverseBound& inverse, const std::vector<double>& force,
                          std::span<const ExactProduct> products) {
    if (inverse.verdict != Verdict::proved) {
        return;
    }
    const sparse::Matrix<double>& h = structure.matrix();
    const auto n = static_cast<std::size_t>(h.rows);
    std::vector<dd_real> x(n);
    for (std::size_t l = 0; l < n; ++l) {
        x[l] = dd_real(solution.value[l], solution.low.empty() ? 0.0 : solution.low[l]);
    }
    std::vector<dd_real> r(n);
    std::vector<double> correction(n);
    std::vector<double> size(n);
    std::vector<double> terms(n, 0.0); // entries of each row
    for (const int row : h.row) {
        ++terms[static_cast<std::size_t>(row)];
    }
    double best = std::numeric_limits<double>::infinity();
    constexpr int max_iterations = 8; // each gains the factor cond * u; stagnation ends the loop before
    for (int k = 0; k < max_iterations; ++k) {
        for (std::size_t i = 0; i < n; ++i) {
            r[i] = force[i];
            size[i] = std::abs(force[i]);
        }
        for (const ExactProduct& product : products) {
            r[static_cast<std::size_t>(product.row)] = -dd_real::mul(product.a, product.b);
        }
        for (std::size_t j = 0; j < n; ++j) {
            for (int e = h.start[j]; e < h.start[j + 1]; ++e) {
                const auto s = static_cast<std::size_t>(e);
                const auto i = static_cast<std::size_t>(h.row[s]);
                r[i] -= dd_real(matrix.high[s], matrix.low[s]) * x[j];
                size[i] += std::abs(matrix.high[s] * x[j].x[0]);
            }
        }
        double largest = 0;
        double largest_x = 0;
        for (const dd_real& c : x) {
            largest_x = std::max(largest_x, std::abs(c.x[0])); // a NaN is in the residual as well
        }
        for (std::size_t i = 0; i < n; ++i) {
            correction[i] = r[i].x[0];
            largest = std::max(largest, std::abs(correction[i]));
            // The exact products of libqd lose their low parts below 2^-1022.
            size[i] = std::abs(correction[i]) * (1 + 2 * u) +
                      (terms[i] + 8) * (dd_unit * size[i] + 16 * underflow_unit * (1 + largest_x));
        }
        const double bound = norm_above(size) / inverse.sigma_min * (1 + 4 * u);
        if (!(bound < best / 2)) {
            break; // stagnation at the rounding of double-double; the previous iterate stands
        }
        best = bound;
        solution.bound = bound;
        solution.residual = largest;
        solution.low.resize(n);
        for (std::size_t l = 0; l < n; ++l) {
            solution.value[l] = x[l].x[0];
            solution.low[l] = x[l].x[1];
        }
        factorisation.solve_forces(correction);
        for (std::size_t l = 0; l < n; ++l) {
            x[l] += correction[l];
        }
    }
    solution.rung = Rung::double_double;
    solution.bits = 106;
}

template ExtendedMatrix extended_contact_matrix<2>(const Packing<2>&, const IsostaticStructure<2>&,
                                                   const std::vector<double>&);
template ForceSolution solve_forces<2>(const IsostaticStructure<2>&, const Factorisation&, const InverseBound&,
                                       const std::vector<double>&, std::span<const double>, double);
template void refine_double_double<2>(ForceSolution&, const ExtendedMatrix&, const IsostaticStructure<2>&,
                                      const Factorisation&, const InverseBound&, const std::vector<double>&,
                                      std::span<const ExactProduct>);

} // namespace isostat
