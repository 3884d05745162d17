#include "verified/refinement.hpp"

#include "verified/precise_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr mpfr_prec_t bound_bits = 64; ///< of sizes and bounds, rounded upwards

} // namespace

template <int Dim>
RefinedSystem<Dim>::RefinedSystem(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                                  const Factorisation& factorisation, const InverseBound& inverse, mpfr_prec_t bits)
    : pattern_(&structure.matrix()), factorisation_(&factorisation), inverse_(&inverse), bits_(bits),
      entry_(precise_contact_matrix(packing, structure, bits)) {}

template <int Dim>
RefinedVector RefinedSystem<Dim>::solve(const std::vector<Real>& b, const std::vector<Real>& start,
                                        bool transposed) const {
    const sparse::Matrix<double>& h = *pattern_;
    const std::size_t n = b.size();
    std::vector<Real> x;
    x.reserve(n);
    for (const Real& s : start) {
        Real copy(bits_);
        mpfr_set(copy.get(), s.get(), MPFR_RNDN);
        x.push_back(std::move(copy));
    }
    std::vector<Real> r(n, Real(bits_));
    std::vector<Real> size(n, Real(bound_bits));
    std::vector<unsigned long> terms(n);
    std::vector<double> correction(n);
    Real product(bits_);
    Real upper(bound_bits);
    Real sum(bound_bits);
    RefinedVector best;
    mpfr_set_inf(best.bound.get(), 1);
    for (long iteration = 0; iteration < 2 * bits_; ++iteration) {
        for (std::size_t i = 0; i < n; ++i) {
            mpfr_set(r[i].get(), b[i].get(), MPFR_RNDN);
            mpfr_abs(size[i].get(), b[i].get(), MPFR_RNDU);
            terms[i] = 8; // 5 units of the entries, the product, the rounding of b, and one to spare
        }
        for (std::size_t j = 0; j < n; ++j) {
            for (int k = h.start[j]; k < h.start[j + 1]; ++k) {
                const auto e = static_cast<std::size_t>(k);
                const auto row = static_cast<std::size_t>(h.row[e]);
                const std::size_t i = transposed ? j : row;
                mpfr_mul(product.get(), entry_[e].get(), x[transposed ? row : j].get(), MPFR_RNDN);
                mpfr_sub(r[i].get(), r[i].get(), product.get(), MPFR_RNDN);
                mpfr_abs(upper.get(), product.get(), MPFR_RNDU);
                mpfr_add(size[i].get(), size[i].get(), upper.get(), MPFR_RNDU);
                ++terms[i];
            }
        }
        // |exact residual|_2 with an a-priori bound of what rounding hides; 1.01 covers second order.
        mpfr_set_zero(sum.get(), 1);
        double largest = 0;
        mpfr_exp_t exponent = mpfr_get_emin();
        for (std::size_t i = 0; i < n; ++i) {
            mpfr_mul_d(size[i].get(), size[i].get(), 1.01 * static_cast<double>(terms[i]), MPFR_RNDU);
            mpfr_mul_2si(size[i].get(), size[i].get(), -bits_, MPFR_RNDU);
            mpfr_abs(upper.get(), r[i].get(), MPFR_RNDU);
            largest = std::max(largest, upper.above());
            if (mpfr_regular_p(r[i].get()) != 0) {
                exponent = std::max(exponent, mpfr_get_exp(r[i].get()));
            }
            mpfr_add(upper.get(), upper.get(), size[i].get(), MPFR_RNDU);
            mpfr_sqr(upper.get(), upper.get(), MPFR_RNDU);
            mpfr_add(sum.get(), sum.get(), upper.get(), MPFR_RNDU);
        }
        mpfr_sqrt(sum.get(), sum.get(), MPFR_RNDU);
        mpfr_div_d(sum.get(), sum.get(), inverse_->sigma_min, MPFR_RNDU);
        mpfr_mul_2ui(upper.get(), sum.get(), 1, MPFR_RNDU);
        if (mpfr_less_p(upper.get(), best.bound.get()) == 0) {
            break; // NaN included
        }
        best.value = x;
        best.bound = sum;
        best.residual = largest;
        if (mpfr_zero_p(sum.get()) != 0 || exponent == mpfr_get_emin()) {
            break;
        }
        for (std::size_t i = 0; i < n; ++i) {
            mpfr_mul_2si(product.get(), r[i].get(), -exponent, MPFR_RNDN);
            correction[i] = product.nearest();
        }
        if (transposed) {
            factorisation_->solve_velocities(correction);
        } else {
            factorisation_->solve_forces(correction);
        }
        for (std::size_t j = 0; j < n; ++j) {
            mpfr_set_d(product.get(), correction[j], MPFR_RNDN);
            mpfr_mul_2si(product.get(), product.get(), exponent, MPFR_RNDN);
            mpfr_add(x[j].get(), x[j].get(), product.get(), MPFR_RNDN);
        }
    }
    return best;
}

template class RefinedSystem<2>;

} // namespace isostat
