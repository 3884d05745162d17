#pragma once
/// \file
/// The load of a packing: F_ext = F_fixed + sigma_loaded * F_unit, plus infinitesimal loads eps*g.

#include <isostat/packing/packing.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace isostat {

/// How a stress on a movable wall becomes a force.
/// - `nominal` (default): force = stress x *reference* length of the other axis: dead forces, W is a potential;
/// - `true_stress`: force = stress x current length: W is no potential; sum sigma_a ln L_a is one up to a factor, where
/// no disk carries a force of its own (proofs/stability.md, S5).
enum class LoadKind : unsigned char { nominal, true_stress };

/// The force on the movable wall of one axis, on a moving period or on a moving tilt, in the real numbers: minus
/// `stress` times `length` times `other`, stored numbers (proofs/definition.md). `external_force` rounds the product;
/// what decides a sign must not.
struct WallForce {
    int coordinate = 0;           ///< of the wall
    int axis = 0;                 ///< of a tilt: the one that it moves along
    double stress = 0;            ///< and `rest`: what that double lacks
    std::array<double, 2> rest{}; ///< 0 but on a `StressPath`
    double length = 0;            ///< of the other axis: the reference length, or under true stresses the present one
    int length_at = -1;           ///< true stresses: the coordinate that is that length; -1: it does not change
    double other = 1;             ///< in space the length of the third axis: the stress presses on an area
    int other_at = -1;            ///< as `length_at`
    double rate = 0;              ///< of the stress with the loaded one: 1 where it is that one, 0 where it stays
};

/// A number for each axis, then for each tilt.
using StressRates = std::array<double, most_axes + most_tilts>;

/// A path in stress space: the stresses `at` + t `rate`, in the real numbers, t the loaded stress of the programme. A
/// triaxial test at constant mean stress has the rates (-1, -1, 2).
struct StressPath {
    StressRates at{}, rate{};
    double t = 0;
    friend bool operator==(const StressPath&, const StressPath&) = default;
};

/// A stress in the real numbers: `nearest` + rest[0] + rest[1].
struct ExactStress {
    double nearest = 0;
    std::array<double, 2> rest{};
};

/// Load of a packing. Forces in the unit (stress unit x length unit); a compressive stress is positive and pushes the
/// upper wall inwards. Coordinates are indexed as in `Packing::q`.
struct Load {
    int dimension = 2; ///< that of the packing
    LoadKind kind = LoadKind::nominal;
    PerAxis<double> stress{};           ///< sigma_1, sigma_2 (axis 0, axis 1), in space sigma_3
    PerAxis<double> reference_length{}; ///< L_a at which nominal stress and strain are defined
    /// Nominal shear stresses on the tilts of a cell that move: the dead force on A_ab, a < b, is - shear times the
    /// reference lengths of all axes but b.
    PerTilt<double> shear{};
    /// A_ab of the cell at which the strain of a tilt is 0.
    PerTilt<double> reference_tilt{};
    /// The axis whose stress the programme changes (sigma_2). From `dimension` on: the shear stress on that tilt. \pre
    /// it moves.
    int loaded_axis = 1;
    /// Several stresses change together: then `stress` and `shear` are the nearest doubles, the loaded stress is t, and
    /// `loaded_axis` is the last one, the axial one of a triaxial test.
    std::optional<StressPath> path;
    std::vector<double> disk_force;    ///< empty, or d n external forces on the disks
    std::vector<double> infinitesimal; ///< empty, or d n infinitesimal loads g (the eps part)

    [[nodiscard]] bool loads_tilt() const { return loaded_axis >= dimension; }
    /// The stress that the programme changes.
    [[nodiscard]] double loaded_stress() const {
        return path ? path->t : stress_of(static_cast<std::size_t>(loaded_axis));
    }
    void set_loaded_stress(double value);
    /// From now on the programme changes the present stresses at these rates, of the axes and then of the tilts. A
    /// single one of 1 is a `loaded_axis`. \pre some rate is not 0
    void follow(const StressRates& rate);
    /// Of axis or tilt: \p place counts the axes, then the tilts.
    [[nodiscard]] double stress_of(std::size_t place) const {
        const auto axes = static_cast<std::size_t>(dimension);
        return place < axes ? stress[place] : shear[place - axes];
    }
    [[nodiscard]] ExactStress exact_stress(std::size_t place) const;
    /// By how much that stress changes with the loaded one.
    [[nodiscard]] double rate_of(std::size_t place) const {
        return path ? path->rate[place] : place == static_cast<std::size_t>(loaded_axis) ? 1 : 0;
    }
    /// Mean stress p of the axes, and deviator q: that of the last axis less the mean of the others.
    [[nodiscard]] double mean_stress() const;
    [[nodiscard]] double deviator() const;
    /// \pre `loads_tilt()`
    [[nodiscard]] std::size_t loaded_tilt() const { return static_cast<std::size_t>(loaded_axis - dimension); }
    /// The axis whose stress the ratio of a programme is taken over. Of a shear on A_ab that is b: both stresses act
    /// over the same reference area, and their ratio is that of the forces.
    [[nodiscard]] int other_axis() const {
        return loads_tilt() ? Cell::axes_of_tilt(loaded_tilt())[1] : loaded_axis == 0 ? dimension - 1 : 0;
    }
    /// On a path: the mean stress at t = 0.
    [[nodiscard]] double other_stress() const;
    [[nodiscard]] double ratio() const { return loaded_stress() / other_stress(); }
    /// What the programme changes: in the plane "sigma2" or "shear", whichever axis that is; in space by axis,
    /// "sigma3", "shear_xy", and "t" on a path. And the ratio, "sigma2/sigma1", and the strain that belongs to it,
    /// "eps2": for messages and tables.
    [[nodiscard]] std::string stress_name() const;
    [[nodiscard]] std::string ratio_name() const;
    [[nodiscard]] std::string strain_name() const;
    /// Stresses are nominal, and strains count, from where box or cell are now.
    void refer_to(const Packing& packing);
    /// Strain of an axis, or of a tilt (axes from `dimension` on): (`at_rest` - coordinate) / `strain_length`. That of
    /// A_ab is what it fell by over the reference length of b: it grows as a positive shear stress does work.
    [[nodiscard]] double at_rest(int axis) const {
        return axis >= dimension ? reference_tilt[static_cast<std::size_t>(axis - dimension)]
                                 : reference_length[static_cast<std::size_t>(axis)];
    }
    [[nodiscard]] double strain_length(int axis) const {
        return reference_length[static_cast<std::size_t>(
            axis >= dimension ? Cell::axes_of_tilt(static_cast<std::size_t>(axis - dimension))[1] : axis)];
    }

    /// What presses on the walls and on the coordinates of the cell that can move. With `disk_force` this is the load,
    /// exactly. A period takes the force of the wall that would stand there: dead forces, so W is linear in the cell.
    [[nodiscard]] std::vector<WallForce> wall_forces(const Packing& packing) const;
    /// Degrees of freedom that carry a finite load whatever the loaded stress is, ascending; and those that the loaded
    /// stress presses on (none: they cannot move, or it presses on nothing).
    [[nodiscard]] std::vector<int> loaded_rows(const Packing& packing, const DofMap& dofs) const;
    [[nodiscard]] std::vector<int> changing_rows(const Packing& packing, const DofMap& dofs) const;
    /// Calls `visit(coordinate, force)` for every external force under the current stresses, each rounded to the
    /// nearest, coordinates ascending; those that are not visited have none.
    template <class Visit> void for_each_force(const Packing& packing, const Visit& visit) const {
        for (std::size_t k = 0; k < disk_force.size(); ++k) {
            visit(k, disk_force[k]);
        }
        for (const WallForce& wall : wall_forces(packing)) {
            visit(static_cast<std::size_t>(wall.coordinate), -(wall.stress * wall.length * wall.other));
        }
    }
    /// External force on every coordinate (as many as `Packing::q` has): the same, none left out.
    [[nodiscard]] std::vector<double> external_force(const Packing& packing) const;
    /// Its derivative with respect to the loaded stress: entries on the loaded walls.
    [[nodiscard]] std::vector<double> unit_force(const Packing& packing) const;
    /// External force with the loaded stress set to 0.
    [[nodiscard]] std::vector<double> fixed_force(const Packing& packing) const;
};

/// Why stresses of this packing cannot change at these rates, of the axes and then of the tilts, in the words of a
/// user; empty: they can.
std::string fault_of_path(const Packing& packing, std::span<const double> rate);

/// Potential W = -sum F_ext . q of dead loads (nominal): decreases along every arc. Meaningless for `true_stress`.
double potential(const Packing& packing, const Load& load);

/// Generic infinitesimal loads: g_i = R_i^2 (direction + amplitude * noise), noise uniform in [-1,1]^d from `seed`,
/// direction fixed and off the walls' normals. Every disk gets one, so that rattlers rest on d contacts.
std::vector<double> generic_infinitesimal(const std::vector<double>& radius, unsigned long long seed,
                                          int dimension = 2);

/// Such loads for a cell: along periodic axes they must sum to zero, or the pinned grain would bear the rest and its
/// choice would matter. Every g is rounded to a common dyadic grid of 30 bits, and the pinned grain takes minus the sum
/// of the others, so that the sum is exactly 0. Nothing changes in a box.
void balance(std::vector<double>& infinitesimal, const Cell& cell);

/// Forces on coordinates (as above, or on the disks only) as forces on degrees of freedom: what the contacts carry.
std::vector<double> on_dofs(const std::vector<double>& on_coordinates, const DofMap& dofs);

} // namespace isostat
