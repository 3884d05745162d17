#pragma once
/// \file
/// The dimension that templates are made for.

namespace isostat {

/// True, or the program does not compile: everything that is a template on Dim asks it.
template <int Dim> constexpr bool has_dimension() {
    static_assert(Dim == 2, "Isostat has disks only, Dim = 2: spheres are not written yet");
    return true;
}

} // namespace isostat
