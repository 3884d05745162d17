#pragma once
// Packings to start from.

#include "support/test.hpp"

#include <isostat/preparation/preparation.hpp>

inline isostat::State prepared(const isostat::PreparationOptions& options) {
    isostat::PreparationReport report;
    return required(isostat::prepare(options, report));
}

/// Nothing where no packing comes out.
inline std::optional<isostat::State> prepared_or_none(const isostat::PreparationOptions& options) {
    isostat::PreparationReport report;
    const auto made = isostat::prepare(options, report);
    return made.ok() ? std::optional(made.value()) : std::nullopt;
}

/// The first equilibrium of random disks, diameters 1 to 2.
inline isostat::State prepared(int disks, std::uint64_t seed) {
    return prepared({.disks = disks, .seed = seed});
}

inline isostat::State vertex_near(const isostat::Packing& start, const isostat::PreparationOptions& options = {}) {
    isostat::PreparationReport report;
    return required(isostat::find_vertex(start, options, report));
}
