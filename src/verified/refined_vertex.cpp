#include "verified/refined_vertex.hpp"

#include "verified/norm.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

constexpr mpfr_prec_t bound_bits = 64;
constexpr double u = 0x1p-53;

const Real& at(const std::vector<Real>& coordinate, int k) {
    return coordinate[static_cast<std::size_t>(k)];
}

} // namespace

std::vector<Real> exact_coordinates(const std::vector<double>& q, const std::vector<double>& correction) {
    constexpr mpfr_prec_t any_two_doubles = 2200;
    std::vector<Real> result;
    result.reserve(q.size());
    for (std::size_t k = 0; k < q.size(); ++k) {
        if (correction.empty()) {
            result.emplace_back(q[k], 53);
        } else {
            Real sum(any_two_doubles);
            mpfr_set_d(sum.get(), q[k], MPFR_RNDN);
            mpfr_add_d(sum.get(), sum.get(), correction[k], MPFR_RNDN);
            result.push_back(std::move(sum));
        }
    }
    return result;
}

template <int Dim>
Real precise_gap(const Packing<Dim>& packing, const std::vector<Real>& coordinate, const Contact& contact,
                 mpfr_prec_t bits) {
    Real result(bits);
    const double ri = contact.kind == ContactKind::held ? 0 : packing.radius[static_cast<std::size_t>(contact.i)];
    switch (contact.kind) {
    case ContactKind::disk_disk: {
        Real d(bits);
        for (int a = 0; a < Dim; ++a) {
            mpfr_sub(d.get(), at(coordinate, Dim * contact.j + a).get(), at(coordinate, Dim * contact.i + a).get(),
                     MPFR_RNDN);
            mpfr_fma(result.get(), d.get(), d.get(), result.get(), MPFR_RNDN);
        }
        mpfr_sqrt(result.get(), result.get(), MPFR_RNDN);
        mpfr_set_d(d.get(), ri, MPFR_RNDN);
        mpfr_add_d(d.get(), d.get(), packing.radius[static_cast<std::size_t>(contact.j)], MPFR_RNDN);
        mpfr_sub(result.get(), result.get(), d.get(), MPFR_RNDN);
        break;
    }
    case ContactKind::lower_wall:
        mpfr_sub_d(result.get(), at(coordinate, Dim * contact.i + contact.j).get(), ri, MPFR_RNDN);
        break;
    case ContactKind::upper_wall:
        mpfr_sub(result.get(), at(coordinate, Dim * packing.disk_count() + contact.j).get(),
                 at(coordinate, Dim * contact.i + contact.j).get(), MPFR_RNDN);
        mpfr_sub_d(result.get(), result.get(), ri, MPFR_RNDN);
        break;
    case ContactKind::held: break; // 0, wherever it is
    }
    return result;
}

template <int Dim>
RefinedVertex refine_vertex(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                            const Factorisation& factorisation, const InverseBound& inverse,
                            const std::vector<Real>& start, mpfr_prec_t bits) {
    RefinedVertex best;
    mpfr_set_inf(best.radius.get(), 1);
    const double worst = worst_gap_ratio(packing, structure.contacts());
    if (inverse.verdict != Verdict::proved || !(worst < 1e-3)) {
        return best;
    }
    const double k = lipschitz(packing, structure.contacts());
    const double at_q = 1 / inverse.sigma_min * (1 + 2 * worst + 8 * u);
    const DofMap<Dim>& dofs = structure.dofs();
    const std::size_t n = structure.contacts().size();
    std::vector<Real> x;
    for (const Real& s : start) {
        Real copy(bits);
        mpfr_set(copy.get(), s.get(), MPFR_RNDN);
        x.push_back(std::move(copy));
    }
    std::vector<Real> f(n, Real(bits));
    std::vector<double> step(n);
    std::vector<double> moved(x.size());
    Real scratch(bits);
    Real sum(bound_bits);
    Real bound(bound_bits);
    Real eta(bound_bits);
    for (long iteration = 0; iteration < 2 * bits; ++iteration) {
        mpfr_set_zero(sum.get(), 1);
        mpfr_exp_t exponent = mpfr_get_emin();
        for (std::size_t l = 0; l < n; ++l) {
            const Contact& contact = structure.contacts()[l];
            double size = 0; // of what was rounded
            if (contact.kind == ContactKind::held) {
                const auto c = static_cast<std::size_t>(contact.i);
                mpfr_sub_d(f[l].get(), x[c].get(), packing.q[c], MPFR_RNDN); // a held coordinate stays
            } else {
                f[l] = precise_gap(packing, x, contact, bits);
                const double d = target(packing, contact);
                size = 32 * d;
                if (contact.kind == ContactKind::disk_disk) { // F = g (1 + g / (2 D))
                    mpfr_div_d(scratch.get(), f[l].get(), 2 * d, MPFR_RNDN);
                    mpfr_add_ui(scratch.get(), scratch.get(), 1, MPFR_RNDN);
                    mpfr_mul(f[l].get(), f[l].get(), scratch.get(), MPFR_RNDN);
                }
            }
            mpfr_abs(bound.get(), f[l].get(), MPFR_RNDU);
            mpfr_mul_d(bound.get(), bound.get(), 1 + 0x1p-40, MPFR_RNDU); // rounding of F, and 2 D is off by an ulp
            mpfr_set_d(eta.get(), size, MPFR_RNDU);
            mpfr_mul_2si(eta.get(), eta.get(), -bits, MPFR_RNDU);
            mpfr_add(bound.get(), bound.get(), eta.get(), MPFR_RNDU);
            mpfr_sqr(bound.get(), bound.get(), MPFR_RNDU);
            mpfr_add(sum.get(), sum.get(), bound.get(), MPFR_RNDU);
            if (mpfr_regular_p(f[l].get()) != 0) {
                exponent = std::max(exponent, mpfr_get_exp(f[l].get()));
            }
        }
        mpfr_sqrt(sum.get(), sum.get(), MPFR_RNDU);
        for (std::size_t c = 0; c < x.size(); ++c) {
            mpfr_sub_d(scratch.get(), x[c].get(), packing.q[c], MPFR_RNDA);
            moved[c] = std::abs(mpfr_get_d(scratch.get(), MPFR_RNDA));
        }
        const double shift = norm_above(moved);
        const double lost = at_q * k * shift * (1 + 8 * u);
        if (!(lost < 0.5)) {
            break;
        }
        // Kantorovich: h = |DF^-1| K eta <= 1/4, radius 2 eta.
        const double inverse_norm = at_q / (1 - lost) * (1 + 8 * u);
        mpfr_mul_d(eta.get(), sum.get(), inverse_norm, MPFR_RNDU);
        mpfr_mul_d(bound.get(), eta.get(), inverse_norm * k * (1 + 8 * u), MPFR_RNDU);
        const bool exists = mpfr_cmp_d(bound.get(), 0.25) <= 0 && mpfr_nan_p(bound.get()) == 0;
        mpfr_mul_2ui(eta.get(), eta.get(), 1, MPFR_RNDU);
        mpfr_mul_2ui(bound.get(), eta.get(), 1, MPFR_RNDU);
        const bool better = exists && mpfr_less_p(bound.get(), best.radius.get()) != 0;
        if (better) {
            best.verdict = Verdict::proved;
            best.radius = eta;
            best.coordinate = x;
            best.shift = shift;
        } else if (iteration > 2) {
            break;
        }
        if (exponent == mpfr_get_emin()) {
            break; // every gap is 0
        }
        for (std::size_t l = 0; l < n; ++l) {
            mpfr_mul_2si(scratch.get(), f[l].get(), -exponent, MPFR_RNDN);
            step[l] = scratch.nearest();
        }
        factorisation.solve_velocities(step); // approach velocities equal to the gaps close them
        for (std::size_t mu = 0; mu < n; ++mu) {
            const auto c = static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)));
            mpfr_set_d(scratch.get(), step[mu], MPFR_RNDN);
            mpfr_mul_2si(scratch.get(), scratch.get(), exponent, MPFR_RNDN);
            mpfr_add(x[c].get(), x[c].get(), scratch.get(), MPFR_RNDN);
        }
    }
    return best;
}

template RefinedVertex refine_vertex<2>(const Packing<2>&, const IsostaticStructure<2>&, const Factorisation&,
                                        const InverseBound&, const std::vector<Real>&, mpfr_prec_t);
template Real precise_gap<2>(const Packing<2>&, const std::vector<Real>&, const Contact&, mpfr_prec_t);

} // namespace isostat
