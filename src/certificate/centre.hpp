#pragma once
/// \file
/// A configuration in doubles around which the true vertex is enclosed, with what is proved there once for all rungs.

#include "verified/enclosed_vertex.hpp"

#include <isostat/core/result.hpp>

#include <memory>
#include <vector>

namespace isostat {

/// Contacts of disks with disks and walls only (nothing held). Not movable: its parts may refer to each other.
class Centre {
  public:
    /// Proves the rank, factorises, bounds the inverse. Failure: `not_isostatic`.
    static Result<std::unique_ptr<Centre>> make(Packing packing, std::vector<Contact> contacts);
    /// Where Newton's iteration for "all gaps are 0" ends that starts at `start`; null when it leaves the
    /// neighbourhood, does not converge or meets a matrix that is not proved regular. Proves nothing about the end.
    static std::unique_ptr<Centre> downhill(const Centre& start);
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
