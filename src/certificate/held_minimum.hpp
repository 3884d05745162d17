#pragma once
/// \file
/// Whether the potential has a minimum along mechanisms whose coordinates are held (U8 in proofs/clumps.md): private to
/// the room.

#include "trajectory/vertex.hpp"

#include <isostat/certificate/certify.hpp>

#include <optional>
#include <vector>

namespace isostat {

/// Velocities on which one held coordinate moves at the rate 1 and no other row changes.
struct HeldMotion {
    std::vector<double> v; ///< on coordinates
    double size = 0;       ///< 2-norm
    double residual = 0;   ///< 2-norm of G v - e at the stored configuration
};
/// \pre the row `slot` is of a held coordinate. Cost: a solve.
HeldMotion motion_of(const Vertex& vertex, std::size_t slot);

/// Of all motions of these rows together the one along which d2W is least, as far as double tells. Cost: a solve for
/// each, and their products over the contacts.
HeldMotion least_curved(const Vertex& vertex, const std::vector<double>& forces, const std::vector<std::size_t>& slots);

/// A strict local minimum of the potential of dead loads, at which no held coordinate bears a multiplier.
struct HeldMinimum {
    double away = 0;            ///< 2-norm of what the equilibrium is from the stored configuration, at most
    double curvature = 0;       ///< the form d2W on the held coordinates is at least this times |dc|^2, up to there
    std::vector<double> rate{}; ///< dc per unit of the loaded stress
    double rate_bound = 0;      ///< 2-norm of its error
    PerAxis<Enclosure> length_rate{};
};

/// `acting`: rows of the held coordinates that the load reaches, all others being free motions. `nearest`: lower bound
/// of all gaps of other pairs at the true vertex. Nothing: not proved. \pre a box, nominal stresses, no infinitesimal
/// loads. Cost: a solve for each coordinate, and their products over the contacts.
std::optional<HeldMinimum> minimum_near(const Vertex& vertex, double sigma, const std::vector<std::size_t>& acting,
                                        double nearest);

/// The rates of lengths that are proved there, and what comes first by the rates of forces and of the gaps of
/// `candidates`. Cost: a solve.
Yielding yielding_at(const Vertex& vertex, double sigma, const std::vector<std::size_t>& acting,
                     const HeldMinimum& minimum, const std::vector<Contact>& candidates);

} // namespace isostat
