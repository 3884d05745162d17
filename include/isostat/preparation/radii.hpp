#pragma once
/// \file
/// Radii of disks to prepare, drawn from a law. The same arguments give the same bits on every machine.

#include <cstdint>
#include <string>
#include <vector>

namespace isostat {

/// Shapes of the law of the diameters d. Shares and densities are by number of disks.
enum class RadiiLaw {
    uniform,    ///< density constant between `smallest` and `largest`
    equal,      ///< d = `diameter`
    bidisperse, ///< the first disks have d = `diameter`, the last floor(`fraction` n + 1/2) have `ratio` x `diameter`
    lognormal,  ///< ln d normal, median `diameter`, standard deviation of ln d `deviation`; cut
    normal,     ///< d normal, mean `diameter`, standard deviation `deviation` x `diameter`; cut
    power       ///< density ~ d^-`exponent` between `smallest` and `largest`
};

/// A law with its parameters, lengths in the user's unit. A law that is cut draws again until `smallest` <= d <=
/// `largest`.
struct DiameterLaw {
    double smallest = 1;
    double largest = 2;
    RadiiLaw kind = RadiiLaw::uniform;
    double diameter = 1;
    double ratio = 1.4;
    double fraction = 0.5;
    double deviation = 0.2;
    double exponent = 3;
};

/// What makes no sense in a law, in words; empty: nothing. A law that is cut must have `diameter` inside and an
/// interval that is at least one deviation wide: at least a third of what is drawn is then kept.
std::string fault_of(const DiameterLaw& law);

/// `count` radii, independent, from a 64-bit Mersenne twister. Logarithms and exponentials are rounded correctly
/// (MPFR), and nothing else is not. Throws `Error(bad_input)` for a law with a fault, or count < 1. Cost: 5 us per disk
/// for laws with logarithms.
std::vector<double> draw_radii(const DiameterLaw& law, int count, std::uint64_t seed);

/// R_i (1 + size rho_i) to the nearest double, rho_i uniform in [-1, 1), independent, from a stream of `seed` that is
/// not that of the radii: the equal radii of a mixture become different ones, and ties of their packings are no more.
/// \pre 0 <= size < 1
std::vector<double> with_jitter(std::vector<double> radius, double size, std::uint64_t seed);

} // namespace isostat
