#pragma once
/// \file
/// Whether the potential has a minimum along mechanisms whose coordinates are held (U8 in proofs/clumps.md): private to
/// the room.

#include "trajectory/vertex.hpp"

#include <isostat/certificate/certify.hpp>

#include <optional>
#include <vector>

namespace isostat {

/// 2-norm of the forces, at most.
double force_norm(const Vertex& vertex, double sigma);

/// d2W/ds2 at the true vertex along the motion of these rows together, all others kept, along which d2W is least as far
/// as double tells, s its fastest coordinate. Cost: a solve for each row, and their products over the contacts.
Enclosure least_curvature(const Vertex& vertex, const Load& load, const std::vector<std::size_t>& slots);

/// A strict local minimum of the potential of the load (of true stresses: the area times Phi), at which no held
/// coordinate bears a multiplier.
struct HeldMinimum {
    double away = 0;              ///< 2-norm of what the equilibrium is from the stored configuration, at most
    double curvature = 0;         ///< the form d2W on the held coordinates is at least this times |dc|^2, up to there
    std::vector<double> rate{};   ///< dc per unit of the loaded stress
    double rate_bound = 0;        ///< 2-norm of its error
    std::vector<Interval> form{}; ///< d2W where held coordinates have their stored values: rows of the upper triangle
    PerAxis<Enclosure> length_rate{};
    std::vector<Enclosure> second_variation{}; ///< as in `Yielding`
};

/// `acting`: rows of the held coordinates that the load reaches, all others being free motions. `nearest`: lower bound
/// of all gaps of other pairs at the true vertex. `off`: what held coordinates differ from their stored values, at most
/// (2-norm). Nothing: not proved. \pre the load has a potential, no infinitesimal
/// loads; in a cell that does not keep its shape coordinates are on the grid. Cost: a solve for each coordinate, and
/// their products over the contacts.
std::optional<HeldMinimum> minimum_near(const Vertex& vertex, const Load& load, const std::vector<std::size_t>& acting,
                                        double nearest, double off);

/// The rates of lengths that are proved there, and what comes first by the rates of forces and of the gaps of
/// `candidates`. Cost: a solve.
Yielding yielding_at(const Vertex& vertex, const Load& load, const std::vector<std::size_t>& acting,
                     const HeldMinimum& minimum, const std::vector<Contact>& candidates);

} // namespace isostat
