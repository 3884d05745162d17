#pragma once
/// \file
/// The part of a state that a run under `ties = "choose"` adds.

#include "io/json.hpp"

#include <isostat/contact/state.hpp>

namespace isostat::json {

/// {"seed", "rho": [...], "load_zero": contact, "stress_rate": [value, bound], "open": [[contact, value, bound], ...],
/// "zero": the same}; the last four only when they say something.
template <int Dim> Json perturbation_to_json(const RadiusPerturbation& perturbation);

/// Throws `Error(bad_input)`.
template <int Dim> RadiusPerturbation perturbation_from_json(const Field& field, const Packing<Dim>& packing);

/// log2 of a bound: null when the quantity is exactly 0.
Json exponent_json(double exponent);

} // namespace isostat::json
