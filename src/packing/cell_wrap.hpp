#pragma once
/// \file
/// Grains of a periodic packing moved by periods, and put into the cell.

#include <isostat/packing/packing.hpp>

#include <vector>

namespace isostat {

/// What `wrap_into_cell` did.
struct Wrapped {
    std::vector<PerAxis<double>> periods; ///< of each disk: it was moved by minus so many along each axis
    double rounding = 0;                  ///< no coordinate was rounded by more; 0: none was moved
};

/// Moves every grain by whole periods so that its fractional coordinates, as rounded, are in [0, 1); along axes with
/// walls nothing moves. Exact where the coordinates are on the grid of `snap_to_grid`.
/// \pre there are periodic axes
Wrapped wrap_into_cell(Packing& packing);

/// at += A m, m_a periods along each axis. \pre m is 0 along axes without a period
template <class Numbers> void add_periods(PerAxis<double>& at, const Packing& packing, const Numbers& m) {
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        for (std::size_t b = a; b < packing.axes(); ++b) {
            at[a] += m[b] == 0 ? 0 : m[b] * packing.lattice(a, b);
        }
    }
}

} // namespace isostat
