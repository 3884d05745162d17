#pragma once
/// \file
/// The approximation of small displacements: gaps linear along an arc, or along a whole trajectory. A shortcut to be
/// measured against the exact path; nothing in the program relies on it.

#include "contact/candidates.hpp"
#include "linear/factorisation.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <vector>

namespace isostat {

/// Where constant velocities and linear gaps put the next event.
struct LinearEvent {
    Contact closed;
    double length = 0;                ///< displacement of the fastest coordinate
    std::vector<double> displacement; ///< of every coordinate of q, at the event
    std::vector<double> velocity;     ///< the fastest coordinate has |v| = 1
};

/// Opens `opened` at the geometry of `packing`, keeps the other contacts of `structure`, moves every grain with the
/// velocity of the start and closes the first gap h + s dh/ds = 0, s > 0. `gaps` replaces the gaps h of `pairs` (empty:
/// those of `packing`); pairs of the structure are skipped. Failure: `unbounded` when no listed gap falls.
/// Cost: one triangular solve and O(pairs).
Result<LinearEvent> find_linear_event(const Packing& packing, const IsostaticStructure& structure,
                                      const Factorisation& factorisation, ContactId opened, int direction,
                                      const std::vector<Contact>& pairs, const std::vector<double>& gaps = {});

/// What is kept when an arc ends.
enum class LinearGeometry : unsigned char {
    frozen, ///< normals and matrix of the start for the whole trajectory, gaps linear in the displacement: the method
            ///< is then the simplex method of a linear programme (T10)
    moved   ///< the grains are moved by the linear displacement, never corrected: normals and gaps are those of where
            ///< they are, the gaps of the contacts drift
};

/// One arc of such a trajectory.
struct LinearArc {
    int equilibrium = 0; ///< number of the equilibrium it started from (0: the start)
    double stress = 0;
    Contact opened, closed;
    double drift = 0; ///< largest |true gap| of a contact at its end / smallest radius
};

/// One equilibrium of such a trajectory.
struct LinearEquilibrium {
    double stress = 0;      ///< at which it was reached
    double stress_high = 0; ///< limit of the interval of loads
    double strain = 0;      ///< of the loaded axis since the start
    int arcs = 0;
};

/// A trajectory in the approximation, with the counters of its cost.
struct LinearTrajectory {
    std::vector<LinearArc> arcs;
    std::vector<LinearEquilibrium> equilibria;
    std::vector<std::vector<double>> coordinates; ///< q at the end of each arc
    std::string stopped;                          ///< why, when before the wanted number of equilibria
    double seconds = 0; ///< CPU, factorisation, solves and gaps; without the proofs of rank and bounds
};

/// Loads `start` (an equilibrium) upwards over `equilibria` rearrangements with the rules of `run_segment` (limits,
/// most negative force, ties by the infinitesimal loads) at the approximate geometry. Pairs are those with gap below
/// 0.8 of the smallest radius at the start (`frozen`) or where the grains are (`moved`). At most `max_arcs` arcs in
/// all. The decisions have the bounds of `Statics` for the approximate matrix, which say nothing about the true one.
LinearTrajectory load_with_linear_gaps(const State& start, LinearGeometry geometry, int equilibria, long max_arcs);

} // namespace isostat
