#pragma once
/// \file
/// The true vertex near a stored configuration (proofs/checker.md, K4 and K5), and all gaps there but those of the
/// contacts (K9).

#include "checker/inverse.hpp"

#include <optional>

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

/// A pair that cannot move (two fixed disks, a fixed disk and a fixed wall, a disk and an image of it that no moving
/// period separates) and overlaps, exactly. Of disk -1: not known, as the cell is too sheared or a disk too far from
/// it.
std::optional<Contact> fixed_overlap(const Problem& problem, const State& state);

/// A pair of grains and its gap at the true vertex.
struct Gap {
    Contact pair;
    Range value;
};

/// Pairs that are no contacts and can move relative to each other: all that may have the smallest gap. Every pair that
/// is not listed has a gap above the smallest one. Empty: there is no such pair at all. In a cell a pair with disk -1
/// and a gap of any size: nothing is known, as it is too sheared or a disk too far from it.
std::vector<Gap> smallest_gaps(const Problem& problem, const State& state, const TrueVertex& vertex);

/// Whether a pair is one of those.
bool is_free_pair(const State& state, const Contact& pair);

} // namespace isostat::checker
