#include "verified/ladder_problem.hpp"

#include "core/roundoff.hpp"
#include "verified/norm.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

using roundoff::u;
/// Accuracy of the forces in records, as a fraction of the largest force.
constexpr double recorded_accuracy = 1e-7; // choice: accuracy of records (bounds.md V3)

double largest_of(const std::vector<double>& x) {
    double largest = 0;
    for (const double c : x) {
        largest = std::max(largest, std::abs(c));
    }
    return largest;
}

} // namespace

void round_to_pairs(const std::vector<Real>& x, const Real& error, ForceSolution& solution) {
    const std::size_t n = x.size();
    solution.value.resize(n);
    solution.low.resize(n);
    Real bound(64); // 64: exact: bits of a bound
    Real rest(64);
    for (std::size_t l = 0; l < n; ++l) {
        Real left = x[l];
        solution.value[l] = left.nearest();
        mpfr_sub_d(left.get(), left.get(), solution.value[l], MPFR_RNDN); // exact, because the leading bits cancel
        solution.low[l] = left.nearest();
        mpfr_sub_d(left.get(), left.get(), solution.low[l], MPFR_RNDN);
        if (mpfr_number_p(left.get()) == 0) { // beyond the range of double
            solution.bound = std::numeric_limits<double>::infinity();
            return;
        }
        mpfr_abs(rest.get(), left.get(), MPFR_RNDU);
        mpfr_max(bound.get(), bound.get(), rest.get(), MPFR_RNDU);
    }
    mpfr_add(bound.get(), bound.get(), error.get(), MPFR_RNDU);
    solution.bound = bound.above();
}

double LadderProblem::normal_rate() {
    if (!normal_rate_) {
        normal_rate_ = vertex == nullptr       ? 0
                       : vertex->lipschitz > 0 ? isostat::normal_rate(vertex->lipschitz)
                                               : isostat::normal_rate(packing, structure.contacts());
    }
    return *normal_rate_;
}

auto LadderProblem::stored_distance() -> const Distance& {
    if (!stored_distance_) {
        stored_distance_ = Distance{};
        if (vertex != nullptr) {
            const double away = vertex->verdict == Verdict::proved
                                    // precision.md B1 (last operations)
                                    ? (vertex->radius + norm_above(vertex->correction)) * (1 + 4 * u)
                                    : std::numeric_limits<double>::infinity();
            stored_distance_ = Distance{away, normal_rate() * away};
        }
    }
    return *stored_distance_;
}

void LadderProblem::solve_in_double(RightHandSide& part, double accuracy) const {
    ForceSolution& s = part.solution;
    if (!s.value.empty() && !part.rough) {
        return;
    }
    part.rough = accuracy > 0;
    s = solve_forces(structure, factorisation, inverse, part.force, s.value.empty() ? part.guess : s.value, accuracy);
    part.guess.clear();
    // The accuracy was estimated: a force whose bound does not confirm it is solved again, down to rounding.
    if (part.rough && !(s.bound <= recorded_accuracy * largest_of(s.value))) {
        part.rough = false;
        s = solve_forces(structure, factorisation, inverse, part.force, s.value);
    }
}

void LadderProblem::inflate(RightHandSide& part) {
    if (vertex == nullptr) {
        return;
    }
    ForceSolution& s = part.solution;
    const Distance& here = stored_distance();
    const double sigma = inverse.sigma_min;
    const double left = (sigma - here.uncertainty) * (1 - 8 * u); // precision.md B1 (last operations)
    if (!(left > sigma / 2)) {
        s.bound = std::numeric_limits<double>::infinity();
        return;
    }
    // precision.md B1 (last operations)
    const double turned = std::min(here.uncertainty * norm_above(s.value) * (1 + 4 * u), // bounds |(H* - H) x|
                                   turn_of_forces(packing, structure.contacts(), s.value) * here.away);
    const double residual = s.bound * sigma + turned + part.terms.rate * here.away;
    s.bound = residual / left * (1 + 16 * u); // precision.md B6
}

} // namespace isostat
