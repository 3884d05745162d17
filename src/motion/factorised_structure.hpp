#pragma once
// A structure with its factors: private to the room.

#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"

#include <utility>

namespace isostat {

/// Not movable because the factors refer to the structure.
struct FactorisedStructure {
    explicit FactorisedStructure(IsostaticStructure s) : structure(std::move(s)), factorisation(structure) {}
    FactorisedStructure(IsostaticStructure s, ApproximateInverse factors)
        : structure(std::move(s)), factorisation(Factorisation::of(structure, std::move(factors))) {}
    FactorisedStructure(const FactorisedStructure&) = delete;
    FactorisedStructure& operator=(const FactorisedStructure&) = delete;
    IsostaticStructure structure;
    Factorisation factorisation;
};

} // namespace isostat
