#pragma once
/// \file
/// The load: F_ext = F_fixed + sigma_loaded * F_unit, plus infinitesimal loads eps*g.

#include <isostat/packing/packing.hpp>

#include <array>
#include <vector>

namespace isostat {

/// How a stress on a movable wall becomes a force.
/// - `nominal` (default): force = stress x *reference* length of the other axis: dead forces, W is a potential;
/// - `true_stress`: force = stress x current length: W is no potential; sum sigma_a ln L_a is one up to a factor, where
/// no disk carries a force of its own (proofs/stability.md, S5).
enum class LoadKind : unsigned char { nominal, true_stress };

/// The force on the movable wall of one axis, on a moving period or on a moving tilt, in the real numbers: minus
/// `stress` times `length`, two stored numbers (proofs/definition.md). `external_force` rounds the product; what
/// decides a sign must not.
struct WallForce {
    int coordinate = 0; ///< of the wall
    int axis = 0;       ///< of a tilt: the one that it moves along
    double stress = 0;
    double length = 0;   ///< of the other axis: the reference length, or under true stresses the present one
    int length_at = -1;  ///< true stresses: the coordinate that is that length; -1: it does not change
    bool loaded = false; ///< its stress is the one that the programme changes
};

/// Load of a packing. Forces in the unit (stress unit x length unit); a compressive stress is positive and pushes the
/// upper wall inwards. Coordinates are indexed as in `Packing::q`.
struct Load {
    int dimension = 2; ///< that of the packing
    LoadKind kind = LoadKind::nominal;
    PerAxis<double> stress{};           ///< sigma_1, sigma_2 (axis 0, axis 1)
    PerAxis<double> reference_length{}; ///< L_a at which nominal stress and strain are defined
    /// Nominal shear stresses on the tilts of a cell that move: the dead force on A_ab is - shear L_a,ref.
    PerTilt<double> shear{};
    /// A_ab of the cell at which the strain of a tilt is 0.
    PerTilt<double> reference_tilt{};
    /// The axis whose stress the programme changes (sigma_2). `dimension`: that is the shear stress on the tilt. \pre
    /// it moves.
    int loaded_axis = 1;
    std::vector<double> disk_force;    ///< empty, or d n external forces on the disks
    std::vector<double> infinitesimal; ///< empty, or d n infinitesimal loads g (the eps part)

    [[nodiscard]] bool loads_tilt() const { return loaded_axis >= dimension; }
    /// The stress that the programme changes.
    [[nodiscard]] double loaded_stress() const {
        return loads_tilt() ? shear[0] : stress[static_cast<std::size_t>(loaded_axis)];
    }
    [[nodiscard]] double& loaded_stress() {
        return loads_tilt() ? shear[0] : stress[static_cast<std::size_t>(loaded_axis)];
    }
    /// The axis whose stress the ratio of a programme is taken over: of a shear, the last one, whose force is F_2:
    /// both act over the same reference length, and their ratio is that of the stresses.
    [[nodiscard]] int other_axis() const { return loads_tilt() || loaded_axis == 0 ? dimension - 1 : 0; }
    [[nodiscard]] double other_stress() const { return stress[static_cast<std::size_t>(other_axis())]; }
    [[nodiscard]] double ratio() const { return loaded_stress() / other_stress(); }
    /// "sigma2/sigma1", "shear/sigma2": for messages and tables.
    [[nodiscard]] const char* ratio_name() const { return loads_tilt() ? "shear/sigma2" : "sigma2/sigma1"; }
    /// "eps2", "shear strain": the strain that belongs to it.
    [[nodiscard]] const char* strain_name() const { return loads_tilt() ? "shear strain" : "eps2"; }
    /// Stresses are nominal, and strains count, from where box or cell are now.
    void refer_to(const Packing& packing);
    /// Strain of an axis, or of the tilt (axis `dimension`): (`at_rest` - coordinate) / `strain_length`. That of the
    /// tilt is what A_xy fell by over the reference height: it grows as a positive shear stress does work.
    [[nodiscard]] double at_rest(int axis) const {
        return axis >= dimension ? reference_tilt[0] : reference_length[static_cast<std::size_t>(axis)];
    }
    [[nodiscard]] double strain_length(int axis) const {
        return reference_length[static_cast<std::size_t>(axis >= dimension ? dimension - 1 : axis)];
    }

    /// What presses on the walls and on the coordinates of the cell that can move. With `disk_force` this is the load,
    /// exactly. A period takes the force of the wall that would stand there: dead forces, so W is linear in the cell.
    [[nodiscard]] std::vector<WallForce> wall_forces(const Packing& packing) const;
    /// Degrees of freedom that carry a finite load other than that of the loaded wall, ascending; and the loaded wall's
    /// (-1: it cannot move, or its stress presses on nothing).
    [[nodiscard]] std::vector<int> loaded_rows(const Packing& packing, const DofMap& dofs) const;
    [[nodiscard]] int loaded_wall_row(const Packing& packing, const DofMap& dofs) const;
    /// Calls `visit(coordinate, force)` for every external force under the current stresses, each rounded to the
    /// nearest, coordinates ascending; those that are not visited have none.
    template <class Visit> void for_each_force(const Packing& packing, const Visit& visit) const {
        for (std::size_t k = 0; k < disk_force.size(); ++k) {
            visit(k, disk_force[k]);
        }
        for (const WallForce& wall : wall_forces(packing)) {
            visit(static_cast<std::size_t>(wall.coordinate), -(wall.stress * wall.length));
        }
    }
    /// External force on every coordinate (as many as `Packing::q` has): the same, none left out.
    [[nodiscard]] std::vector<double> external_force(const Packing& packing) const;
    /// Its derivative with respect to the loaded stress: one non-zero entry, on the loaded wall, not rounded.
    [[nodiscard]] std::vector<double> unit_force(const Packing& packing) const;
    /// External force with the loaded stress set to 0.
    [[nodiscard]] std::vector<double> fixed_force(const Packing& packing) const;
};

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
