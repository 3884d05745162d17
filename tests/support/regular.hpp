#pragma once
// A structure that is proved regular, with its factors and the bound of its inverse.

#include "linear/factorisation.hpp"
#include "support/test.hpp"
#include "verified/inverse_bound.hpp"

#include <isostat/contact/state.hpp>

namespace crafted {

/// The parts refer to each other, so it stays where it is made.
struct Regular {
    isostat::State state;
    isostat::IsostaticStructure structure;
    isostat::Factorisation factorisation;
    isostat::InverseBoundCache cache;
    isostat::InverseBound inverse;

    explicit Regular(isostat::State s)
        : state(std::move(s)), structure(proved(state)), factorisation(structure),
          inverse(isostat::bound_inverse(structure, factorisation, cache)) {}
    /// Without a load.
    Regular(const isostat::Packing& packing, const std::vector<isostat::Contact>& contacts)
        : Regular([&] {
              isostat::State s;
              s.packing = packing;
              s.contacts = contacts;
              return s;
          }()) {}
    Regular(const Regular&) = delete;
    Regular& operator=(const Regular&) = delete;

    /// Benchmarks have no test that could end: a failure is an exception.
    static isostat::IsostaticStructure proved(const isostat::State& s) {
        return std::move(isostat::IsostaticStructure::prove(s.packing, s.contacts).value());
    }
};

} // namespace crafted
