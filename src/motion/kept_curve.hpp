#pragma once
// The equations of one arc: private to the room (statements A1 to A4, proofs/arcs.md).

#include <isostat/contact/state.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace isostat {

/// The parts of the moving coordinates on which the separation over a kept contact depends: its disks, and the cell as
/// a block behind them. A change of norm x in a block changes r by at most weight x: 1 for a disk, |m| for the cell.
struct Blocks {
    std::array<std::size_t, 3> at{}; // 3: exact: blocks that a contact touches
    std::array<double, 3> weight{};
    std::size_t count = 0;

    void add(std::size_t block, double w) {
        at[count] = block;
        weight[count++] = w;
    }
};

/// The equations of one arc: contacts[l] keeps gap 0 for every l except `slot`, whose row is free. Only moving grains
/// take part; the others stay at their true place, which is within `rest_radius` (2-norm) of that in `start`.
struct KeptCurve {
    KeptCurve(const Packing& start, std::vector<Contact> contacts, std::size_t slot, double rest_radius);
    /// The equation of two disks in contact is not linear; all other equations are.
    [[nodiscard]] bool bends(std::size_t l) const { return l != slot && contacts[l].of_disks(); }
    /// Upper bound of the 2-norm of the matrix whose row l has blocks of norm e_l times their weight.
    [[nodiscard]] double norm_of(const std::vector<double>& e) const;

    const Packing* start; ///< `fixed` and `walls` tell which grains move; held coordinates keep this value
    std::vector<Contact> contacts;
    std::size_t slot;
    DofMap dofs;
    std::vector<double> target; ///< sum of the radii, radius (walls), 0 (held), rounded
    std::vector<Blocks> blocks; ///< per contact; empty unless two disks keep contact
    double spread = 2;          ///< sum_l |D_l x|^2 <= spread |x|^2 over the kept contacts of two disks
    double smallest = 0;        ///< smallest sum of radii of a kept disk contact (infinity: there is none)
    double lipschitz = 0;       ///< of the derivative of F over the moving coordinates (V4)
    double rest_radius = 0;
    double rest_residual = 0;   ///< bound of the change of F by the true places of the grains at rest
    double rest_derivative = 0; ///< the same for the derivative of F

  private:
    void find_blocks();
    void bound_in_cell();
    void bound_rest(double heaviest, double row);
};

} // namespace isostat
