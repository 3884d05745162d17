#pragma once
// Certificates from what is true in long double. Nothing here is rigorous, and nothing of it is shared with the
// checker: intervals are widened by a relative 1e-11, far more than the errors, so that the claims are true.

#include "oracle/truth.hpp"
#include "support/test.hpp"

#include <isostat/io/state_file.hpp>

namespace maker {

using isostat::Certificate;
using isostat::Interval;
using isostat::State;
using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

inline constexpr double slack = 1e-11;

inline Interval around(Real value, Real width) {
    return {static_cast<double>(value - width), static_cast<double>(value + width)};
}

using Truth = isostat::oracle::TruthIn<Real>;

inline Matrix dense(const isostat::oracle::SquareMatrix<Real>& matrix) {
    const auto n = static_cast<Eigen::Index>(matrix.size());
    return Matrix::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index j) {
        return matrix(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    });
}

inline isostat::LoadEndClaim load_end(const State& state, const Truth::End& end) {
    return end.unbounded
               ? isostat::LoadEndClaim{true, {}, {}}
               : isostat::LoadEndClaim{false, around(end.stress, slack * std::max<Real>(1, std::abs(end.stress))),
                                       state.contacts[static_cast<std::size_t>(end.opens.front())]};
}

/// All claims about a state near an isostatic equilibrium.
inline Certificate certificate(const State& state) {
    const Truth truth(state);
    BOOST_REQUIRE_MESSAGE(truth.known, truth.why);
    Certificate made;
    made.state = state;
    made.input = "state";
    made.input_hash = isostat::sha256("state");
    made.program = "approximations";
    auto& claims = made.claims;

    const int count = truth.dof_count();
    claims.counting =
        isostat::CountingClaim{count, static_cast<int>(state.contacts.size()), count, 0, 0, isostat::Rung::exact};
    // Of the gradients: the largest sum of a row is that of a column of the contact matrix.
    const Matrix inverse = dense(truth.contact_matrix()).inverse();
    const Real norm = inverse.cwiseAbs().colwise().sum().maxCoeff();
    const Real smallest_distance = (state.packing.cell.any() ? 0.5L : 2) * state.packing.min_radius();
    claims.vertex = isostat::VertexClaim{static_cast<double>(truth.moved) * (1 + 1e-6) + 1e-15,
                                         static_cast<double>(smallest_distance / (10 * norm)), isostat::Rung::exact};

    isostat::ForcesClaim forces;
    for (std::size_t l = 0; l < truth.force.size(); ++l) {
        const Real f = truth.force[l];
        const bool zero = isostat::oracle::sign_of(f, truth.force_scale) == 0;
        forces.finite.push_back(zero ? Interval{0, 0} : around(f, slack * f));
        if (zero) {
            const Real g = truth.infinitesimal[l];
            forces.structural_zeros.push_back(static_cast<int>(l));
            forces.infinitesimal.push_back(around(g, slack * std::abs(g)));
        }
    }
    claims.forces = forces;
    claims.load_interval =
        isostat::LoadIntervalClaim{load_end(state, truth.low), load_end(state, truth.high), isostat::Rung::exact};

    claims.gaps = isostat::GapsClaim{std::numeric_limits<double>::infinity(), {}, isostat::Rung::exact};
    if (const auto* nearest = truth.nearest()) {
        claims.gaps->smallest = static_cast<double>(nearest->gap * (1 - 1e-9L));
        claims.gaps->where = nearest->pair;
    }
    claims.stable = true;
    return made;
}

} // namespace maker
