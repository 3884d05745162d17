#include "exact/sparse_lu.hpp"
#include "verified/corrected_configuration.hpp"
#include "verified/inverse_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr mpfr_prec_t bound_bits = 64; ///< of sums of magnitudes, rounded upwards; exact: bits of a bound

/// MPFR numbers of one precision, for SparseLu.
struct RealArithmetic {
    using Value = Real;
    mpfr_prec_t bits;
    [[nodiscard]] Real zero() const { return Real(bits); }
    [[nodiscard]] static bool is_zero(const Real& x) { return mpfr_zero_p(x.get()) != 0; }
    void subtract_product(Real& x, const Real& a, const Real& b) const {
        Real product(bits);
        mpfr_mul(product.get(), a.get(), b.get(), MPFR_RNDN);
        mpfr_sub(x.get(), x.get(), product.get(), MPFR_RNDN);
    }
    static void multiply(Real& x, const Real& a) { mpfr_mul(x.get(), x.get(), a.get(), MPFR_RNDN); }
    [[nodiscard]] Real reciprocal(const Real& x) const {
        Real result(bits);
        mpfr_ui_div(result.get(), 1, x.get(), MPFR_RNDN);
        return result;
    }
    [[nodiscard]] static double weight(const Real& x) {
        return is_zero(x) ? 0 : std::max(std::abs(x.nearest()), std::numeric_limits<double>::denorm_min());
    }
};

void add_magnitude(Real& sum, const Real& x, Real& scratch) {
    mpfr_abs(scratch.get(), x.get(), MPFR_RNDU);
    mpfr_add(sum.get(), sum.get(), scratch.get(), MPFR_RNDU);
}

const Real& largest(const std::vector<Real>& x) {
    return *std::max_element(x.begin(), x.end(),
                             [](const Real& a, const Real& b) { return mpfr_less_p(a.get(), b.get()) != 0; });
}

/// The argument of V2 with `bits` bits; 0 when it does not apply.
double sigma_by_rows(const sparse::Matrix<Real>& h, const sparse::Ordering& ordering, mpfr_prec_t bits) {
    const exact::SparseLu<RealArithmetic> lu(RealArithmetic{bits}, h, ordering);
    if (!lu.regular()) {
        return 0;
    }
    const auto n = static_cast<std::size_t>(h.rows);
    std::vector<Real> column_sum_r(n, Real(bound_bits));
    std::vector<Real> column_sum_e(n, Real(bound_bits));
    Real row_sum_r(bound_bits);
    Real row_sum_e(bound_bits);
    Real scratch(bound_bits);
    Real product(bits);
    Real dot(bits);
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<Real> r(n, Real(bits)); // row i of R ~ H^-1 solves H^T r = e_i
        mpfr_set_ui(r[i].get(), 1, MPFR_RNDN);
        lu.solve_transposed(r);
        Real sum_r(bound_bits);
        Real sum_e(bound_bits);
        for (std::size_t k = 0; k < n; ++k) {
            add_magnitude(sum_r, r[k], scratch);
            add_magnitude(column_sum_r[k], r[k], scratch);
        }
        for (std::size_t j = 0; j < n; ++j) {
            mpfr_set_si(dot.get(), i == j ? -1 : 0, MPFR_RNDN);
            Real size(bound_bits);
            add_magnitude(size, dot, scratch);
            for (auto e = static_cast<std::size_t>(h.start[j]); e < static_cast<std::size_t>(h.start[j + 1]); ++e) {
                mpfr_mul(product.get(), r[static_cast<std::size_t>(h.row[e])].get(), h.value[e].get(), MPFR_RNDN);
                mpfr_add(dot.get(), dot.get(), product.get(), MPFR_RNDN);
                add_magnitude(size, product, scratch);
            }
            // 5 units of the entries, the product, the sums, and second order.
            const double units = 1.01 * (h.start[j + 1] - h.start[j] + 8); // precision.md B5
            mpfr_mul_d(size.get(), size.get(), units, MPFR_RNDU);
            mpfr_mul_2si(size.get(), size.get(), -bits, MPFR_RNDU);
            add_magnitude(size, dot, scratch);
            mpfr_add(sum_e.get(), sum_e.get(), size.get(), MPFR_RNDU);
            mpfr_add(column_sum_e[j].get(), column_sum_e[j].get(), size.get(), MPFR_RNDU);
        }
        mpfr_max(row_sum_r.get(), row_sum_r.get(), sum_r.get(), MPFR_RNDU);
        mpfr_max(row_sum_e.get(), row_sum_e.get(), sum_e.get(), MPFR_RNDU);
        if (!(sum_e.above() < 0.5)) { // 0.5: precision.md B5
            return 0;                 // NaN included
        }
    }
    const double column_e = largest(column_sum_e).above();
    if (!(column_e < 0.5)) {
        return 0;
    }
    // |H^-1|_2^2 <= |R|_1 / (1 - |E|_1) * |R|_inf / (1 - |E|_inf).
    Real bound(bound_bits);
    mpfr_mul(bound.get(), row_sum_r.get(), largest(column_sum_r).get(), MPFR_RNDU);
    mpfr_div_d(bound.get(), bound.get(), (1 - column_e) * (1 - 0x1p-52), MPFR_RNDU); // 0x1p-52: precision.md B5
    mpfr_div_d(bound.get(), bound.get(), (1 - row_sum_e.above()) * (1 - 0x1p-52), MPFR_RNDU);
    mpfr_sqrt(bound.get(), bound.get(), MPFR_RNDU);
    mpfr_ui_div(bound.get(), 1, bound.get(), MPFR_RNDD);
    return bound.below();
}

} // namespace

InverseBound bound_inverse_multiprecision(const Packing& packing, const IsostaticStructure& structure, int size_limit,
                                          int max_bits) {
    if (structure.size() > size_limit) {
        return {};
    }
    for (int bits = 128; bits <= max_bits; bits *= 2) { // cost: first bits
        using Place = CorrectedConfiguration<Real>;
        const sparse::Matrix<Real> h =
            Place(Arithmetic<Real>(bits), packing).contact_matrix(structure, Place::Divided::by_distances);
        const double sigma = sigma_by_rows(h, structure.ordering(), bits);
        if (sigma > 0) {
            return {Verdict::proved, sigma, InverseBound::Route::multiprecision};
        }
    }
    return {};
}

} // namespace isostat
