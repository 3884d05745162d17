#pragma once
// A structure with its factors: private to the room.

#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"

#include <utility>

namespace isostat {

/// Not movable because the factors refer to the structure.
struct FactorisedStructure {
    explicit FactorisedStructure(IsostaticStructure s) : structure(std::move(s)), factorisation(structure) {}
    FactorisedStructure(const FactorisedStructure&) = delete;
    FactorisedStructure& operator=(const FactorisedStructure&) = delete;
    IsostaticStructure structure;
    Factorisation factorisation;
};

} // namespace isostat
