#pragma once
/// \file
/// Periodic axes: which there are, and what of the cell moves.

#include <isostat/core/contact.hpp>
#include <isostat/core/dimension.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace isostat {

/// Axes that have no walls but repeat: whatever is at x is at x + A m too, m integers, 0 along the axes with walls.
/// A is upper triangular: column a is the period vector a, A_aa = L_a the period, A_ab (a < b, both periodic) a tilt.
/// They are coordinates (`Packing::q`), and r = x_j - x_i + A m is linear in all coordinates (proofs/cells.md).
///
/// One grain is pinned along the periodic axes, as a translation of everything changes nothing: N_f = d n + (moving
/// coordinates of cell and walls) - (periodic axes). Which one is a matter of gauge, and so are the representatives.
template <int Dim> struct Cell {
    static_assert(has_dimension<Dim>());
    static constexpr std::size_t tilts = static_cast<std::size_t>(Dim) * (Dim - 1) / 2;

    std::array<bool, Dim> periodic{};
    std::array<bool, Dim> period_moves{}; ///< L_a of a periodic axis is a degree of freedom
    std::array<bool, tilts> tilt_moves{}; ///< in the order xy, xz, yz
    int pin = 0;                          ///< the grain that stays where it is along the periodic axes

    /// False in a box, and where there is nothing at all: then there are no tilts in `Packing::q`.
    [[nodiscard]] bool any() const { return std::find(periodic.begin(), periodic.end(), true) != periodic.end(); }
    /// Every axis repeats.
    [[nodiscard]] bool all() const { return std::find(periodic.begin(), periodic.end(), false) == periodic.end(); }
    [[nodiscard]] std::size_t periodic_axes() const {
        return static_cast<std::size_t>(std::count(periodic.begin(), periodic.end(), true));
    }
    /// Place of the tilt A_ab, a < b, among the tilts.
    static constexpr std::size_t tilt(std::size_t a, std::size_t b) { return a + b * (b - 1) / 2; }
    friend bool operator==(const Cell&, const Cell&) = default;
};

} // namespace isostat
