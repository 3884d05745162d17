#pragma once
/// \file
/// What a file stores of a sample: packing, load and the contacts that define it.

#include <isostat/contact/contact.hpp>
#include <isostat/core/verdict.hpp>
#include <isostat/packing/load.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// What a run under `ties = "choose"` adds to a state: it speaks of the grains with radii R_i + eps rho_i, eps > 0
/// smaller than every positive number (proofs/perturbation.md).
struct RadiusPerturbation {
    unsigned long long seed = 0;
    std::vector<double> rho; ///< one per disk; short dyadic numbers
    /// i >= 0: the stress is not the stored one but that near it at which the force of this contact vanishes, and
    /// `stress_rate` is its first-order term.
    Contact load_zero{ContactKind::disk_disk, -1, -1};
    Enclosure stress_rate{0, 0};
    /// Results, not input: pairs that touch in the base and are open at first order, with their first-order gaps, and
    /// contacts whose force vanishes in the base, with their first-order forces.
    std::vector<std::pair<Contact, Enclosure>> open;
    std::vector<std::pair<Contact, Enclosure>> zero;
};

/// A vertex: a packing together with N_f contacts (held coordinates included, normally none) whose gaps are 0 to
/// rounding. The contact list is part of the state: it is never found again from a gap threshold.
struct State {
    Packing packing;
    Load load;
    std::vector<Contact> contacts;
    int equilibrium = 0;                            ///< its number in the run that made it
    std::optional<RadiusPerturbation> perturbation; ///< none: the state speaks of its own radii
    std::string provenance; ///< JSON text: version, command line, seeds, `rounding` of a file; no proof looks at it
};

} // namespace isostat
