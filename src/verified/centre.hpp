#pragma once
/// \file
/// A configuration in doubles with proofs that several users share.

#include "verified/enclosed_vertex.hpp"

#include <isostat/core/result.hpp>

#include <memory>
#include <vector>

namespace isostat {

/// The place around which a true vertex is enclosed. Not movable because its parts may refer to each other.
class Centre {
  public:
    /// Proves the rank, factorises, bounds the inverse (which may stay undecided). Failure: `not_isostatic`.
    static Result<std::unique_ptr<Centre>> make(Packing packing, std::vector<Contact> contacts);
    Centre(const Centre&) = delete;
    Centre& operator=(const Centre&) = delete;

    Packing packing;
    IsostaticStructure structure;
    Factorisation factorisation;
    InverseBound inverse;
    double largest_gap = 0;  ///< bound of |gap| of a contact
    double relative_gap = 0; ///< largest |gap| / D of a contact, as computed
    Neighbourhood neighbourhood;

  private:
    Centre(Packing p, IsostaticStructure s);
};

} // namespace isostat
