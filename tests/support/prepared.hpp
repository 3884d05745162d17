#pragma once
// A packing to start from.

#include "support/test.hpp"

#include <isostat/preparation/preparation.hpp>

/// The first equilibrium of random disks, diameters 1 to 2.
inline isostat::State prepared(int disks, std::uint64_t seed) {
    isostat::PreparationOptions options;
    options.disks = disks;
    options.seed = seed;
    isostat::PreparationReport report;
    auto result = isostat::prepare(options, report);
    BOOST_REQUIRE_MESSAGE(result.ok(), (result.ok() ? std::string() : result.failure().message()));
    return result.value();
}
