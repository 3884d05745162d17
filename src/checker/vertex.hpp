#pragma once
/// \file
/// The true vertex near a stored configuration (proofs/checker.md, K4 and K5).

#include "checker/inverse.hpp"

namespace isostat::checker {

/// A true vertex within `radius` of `middle` (every coordinate), the only one within `unique_within(...)` of the stored
/// configuration. Lengths are real.
struct TrueVertex {
    bool found = false;
    Lengths middle; ///< in units of the problem
    Rational radius;
    Rational moved_least; ///< bounds of the largest |q*_k - stored q_k|
    Rational moved_most;
    Rational row_residual;    ///< bound of |I - R A(q*)|_inf, below 1
    Rational column_residual; ///< bound of |I - R A(q*)|_1, below 1
};

/// `around`: the zeros of all systems whose held coordinates have other values are within `radius` of `middle`, one of
/// each, where the solution v of A(q*) v = b, b the change of F by these values, is no larger than that (K28).
TrueVertex find_vertex(const Problem& problem, const Solver& solver, const InverseBound& inverse,
                       const Rational& around = 0);

/// Coordinate k of the true vertex.
Range coordinate_at(const Problem& problem, const TrueVertex& vertex, std::size_t k);

/// The true vertex is the only zero within `distance` of the stored configuration (every coordinate).
bool unique_within(const InverseBound& inverse, const TrueVertex& vertex, const Rational& distance);

/// A distance for `unique_within`, nearly the largest; infinity when there are no contacts of two disks.
double largest_unique_distance(const InverseBound& inverse, const TrueVertex& vertex);

} // namespace isostat::checker
