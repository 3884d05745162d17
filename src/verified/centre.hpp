#pragma once
/// \file
/// A configuration in doubles with proofs that several users share.

#include "verified/enclosed_vertex.hpp"

#include <isostat/core/result.hpp>

#include <memory>
#include <vector>

namespace isostat {

/// What was proved of the structure of a packing: regular by elimination, with fresh factors and a bound of the
/// inverse.
struct ProvedStructure {
    const Packing& packing;
    const IsostaticStructure& structure;
    const Factorisation& factorisation;
    const InverseBound& inverse;

    /// It is of this list at these coordinates, proved as `Centre::make` would prove it.
    [[nodiscard]] bool is_of(const Packing& other, const std::vector<Contact>& contacts) const;
};

/// The place around which a true vertex is enclosed. Not movable because its parts may refer to each other.
class Centre {
  public:
    /// Proves the rank, factorises, bounds the inverse (which may stay undecided). Failure: `not_isostatic`.
    static Result<std::unique_ptr<Centre>> make(Packing packing, std::vector<Contact> contacts);
    /// The same from these proofs.
    static std::unique_ptr<Centre> of(const ProvedStructure& proved);
    /// The same list where each coordinate is at most `farthest` away. While sigma_min loses less than half by that,
    /// rank and bound follow from those here (V4), and the factors serve; else as `make`.
    [[nodiscard]] Result<std::unique_ptr<Centre>> moved(Packing there, double farthest) const;
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
    Centre(Packing p, IsostaticStructure s, Factorisation factors, const InverseBound& bound);
};

} // namespace isostat
