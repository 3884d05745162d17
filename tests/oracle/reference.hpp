#pragma once
// Reference forces of any regular structure, with as many bits as wanted: LU of UMFPACK, residuals in GMP floats, made
// apart from the library. Links with UMFPACK.

#include <isostat/contact/state.hpp>

#include <gmpxx.h>
#include <umfpack.h>

#include <cmath>
#include <vector>

namespace isostat::oracle {

/// Columns of H in GMP floats of `bits` bits, and rounded.
struct ReferenceMatrix {
    std::vector<int> start{0};
    std::vector<int> row;
    std::vector<double> rounded;
    std::vector<mpf_class> value;
};

inline ReferenceMatrix reference_matrix(const Packing& packing, const std::vector<Contact>& contacts, unsigned bits) {
    const DofMap dofs(packing);
    ReferenceMatrix matrix;
    for (const Contact& c : contacts) {
        std::vector<std::pair<int, mpf_class>> column;
        if (c.kind == ContactKind::disk_disk) {
            const auto i = static_cast<std::size_t>(2 * c.i);
            const auto j = static_cast<std::size_t>(2 * c.j);
            mpf_class x(packing.q[j], bits);
            mpf_class y(packing.q[j + 1], bits);
            x -= packing.q[i];
            y -= packing.q[i + 1];
            const mpf_class square = x * x + y * y;
            const mpf_class length = sqrt(square);
            const mpf_class nx = x / length;
            const mpf_class ny = y / length;
            column = {{2 * c.i, nx}, {2 * c.i + 1, ny}, {2 * c.j, mpf_class(-nx)}, {2 * c.j + 1, mpf_class(-ny)}};
        } else if (c.kind == ContactKind::lower_wall) {
            column = {{2 * c.i + c.j, mpf_class(-1, bits)}};
        } else if (c.kind == ContactKind::upper_wall) {
            column = {{2 * c.i + c.j, mpf_class(1, bits)}, {2 * packing.disk_count() + c.j, mpf_class(-1, bits)}};
        } else {
            column = {{c.i, mpf_class(-1, bits)}};
        }
        for (const auto& [coordinate, value] : column) { // coordinates increase, so do their degrees of freedom
            const int dof = dofs.dof_of(static_cast<std::size_t>(coordinate));
            if (dof >= 0 && value != 0) {
                matrix.row.push_back(dof);
                matrix.value.push_back(value);
                matrix.rounded.push_back(value.get_d());
            }
        }
        matrix.start.push_back(static_cast<int>(matrix.row.size()));
    }
    return matrix;
}

/// Forces to about `bits` - 20 - log2(cond) bits; empty when the refinement does not converge (cond near 1e16).
inline std::vector<mpf_class> refined_forces(const Packing& packing, const std::vector<Contact>& contacts,
                                             const std::vector<double>& force, unsigned bits) {
    const ReferenceMatrix h = reference_matrix(packing, contacts, bits);
    const int n = static_cast<int>(force.size());
    void* analysis = nullptr;
    void* factors = nullptr;
    umfpack_di_symbolic(n, n, h.start.data(), h.row.data(), h.rounded.data(), &analysis, nullptr, nullptr);
    umfpack_di_numeric(h.start.data(), h.row.data(), h.rounded.data(), analysis, &factors, nullptr, nullptr);
    umfpack_di_free_symbolic(&analysis);
    std::vector<mpf_class> f(force.size(), mpf_class(0, bits));
    std::vector<mpf_class> r(force.size(), mpf_class(0, bits));
    std::vector<double> right(force.size());
    std::vector<double> correction(force.size());
    bool converged = false;
    for (unsigned iteration = 0; iteration < bits && !converged; ++iteration) {
        for (std::size_t i = 0; i < force.size(); ++i) {
            r[i] = force[i];
        }
        for (std::size_t j = 0; j < force.size(); ++j) {
            for (auto e = static_cast<std::size_t>(h.start[j]); e < static_cast<std::size_t>(h.start[j + 1]); ++e) {
                r[static_cast<std::size_t>(h.row[e])] -= h.value[e] * f[j];
            }
        }
        long exponent = 0;
        bool any = false;
        for (const mpf_class& c : r) {
            long e = 0;
            if (mpf_get_d_2exp(&e, c.get_mpf_t()) != 0) {
                exponent = any ? std::max(exponent, e) : e;
                any = true;
            }
        }
        converged = !any || exponent < -static_cast<long>(bits) + 64;
        for (std::size_t i = 0; i < right.size(); ++i) {
            long e = 0;
            const double mantissa = mpf_get_d_2exp(&e, r[i].get_mpf_t());
            right[i] = std::ldexp(mantissa, static_cast<int>(std::max(e - exponent, -1100L)));
        }
        umfpack_di_solve(UMFPACK_A, h.start.data(), h.row.data(), h.rounded.data(), correction.data(), right.data(),
                         factors, nullptr, nullptr);
        for (std::size_t l = 0; l < f.size(); ++l) {
            mpf_class c(correction[l], bits);
            if (exponent < 0) {
                mpf_div_2exp(c.get_mpf_t(), c.get_mpf_t(), static_cast<mp_bitcnt_t>(-exponent));
            } else {
                mpf_mul_2exp(c.get_mpf_t(), c.get_mpf_t(), static_cast<mp_bitcnt_t>(exponent));
            }
            f[l] += c;
        }
    }
    umfpack_di_free_numeric(&factors);
    return converged ? f : std::vector<mpf_class>();
}

} // namespace isostat::oracle
