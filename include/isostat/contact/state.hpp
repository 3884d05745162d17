#pragma once
/// \file
/// What a file stores of a sample: packing, load and the contacts that define it.

#include <isostat/contact/contact.hpp>
#include <isostat/packing/load.hpp>

#include <string>
#include <vector>

namespace isostat {

/// A vertex: a packing together with N_f contacts (held coordinates included, normally none) whose gaps are 0 to
/// rounding. The contact list is part of the state: it is never found again from a gap threshold.
template <int Dim> struct State {
    Packing<Dim> packing;
    Load<Dim> load;
    std::vector<Contact> contacts;
    int equilibrium = 0;    ///< its number in the run that made it
    std::string provenance; ///< JSON text: program version, command line, seeds; kept with the state, never interpreted
};

} // namespace isostat
