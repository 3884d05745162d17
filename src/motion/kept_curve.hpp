#pragma once
// The equations of one arc: private to the room (statements A1 to A4, proofs/arcs.md).

#include <isostat/contact/contact.hpp>

#include <cstddef>
#include <vector>

namespace isostat {

/// The equations of one arc: contacts[l] keeps gap 0 for every l but `slot`, whose row is free. Only grains that move
/// take part; the others stay at their true place, which is within `rest_radius` (2-norm) of the one in `start`.
template <int Dim> struct KeptCurve {
    KeptCurve(const Packing<Dim>& start, std::vector<Contact> contacts, std::size_t slot, double rest_radius);
    /// Two disks that keep contact: the equations of all others are linear.
    [[nodiscard]] bool bends(std::size_t l) const { return l != slot && contacts[l].kind == ContactKind::disk_disk; }
    /// Upper bound of the 2-norm of the matrix whose row l is e_l on one disk and -e_l on the other (moving ones).
    [[nodiscard]] double norm_of(const std::vector<double>& e) const;

    const Packing<Dim>* start; ///< `fixed` and `walls` tell which grains move; held coordinates keep their value here
    std::vector<Contact> contacts;
    std::size_t slot;
    DofMap<Dim> dofs;
    std::vector<double> target; ///< sum of the radii, radius (walls), 0 (held), rounded
    double degree = 0;          ///< largest number of kept disk contacts of one moving disk
    double smallest = 0;        ///< smallest sum of radii of a kept disk contact (infinity: there is none)
    double lipschitz = 0;       ///< of the derivative of F over the moving coordinates (V4)
    double rest_radius = 0;
    double rest_residual = 0;   ///< bound of the change of F by the true places of the grains at rest
    double rest_derivative = 0; ///< the same for the derivative of F
};

extern template struct KeptCurve<2>;

} // namespace isostat
