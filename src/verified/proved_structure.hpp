#pragma once
/// \file
/// The configuration from which a vertex is proved: by a run, a certificate, a polished packing, a snapped frame.

#include "linear/factorisation.hpp"
#include "verified/inverse_bound.hpp"

#include <isostat/core/result.hpp>

#include <memory>
#include <vector>

namespace isostat {

/// A packing with a contact list that is proved regular at the stored coordinates, with factors and a bound of the
/// inverse. A true vertex is enclosed around the coordinates. Not movable: whoever asks keeps references to the parts.
class ProvedStructure {
  public:
    /// Proves the rank, factorises, bounds the inverse (which may stay undecided). Failure: `not_isostatic`.
    static Result<std::unique_ptr<ProvedStructure>> make(Packing packing, std::vector<Contact> contacts);
    /// The same proofs, with factors whose passes count for another owner.
    [[nodiscard]] std::unique_ptr<ProvedStructure> shared() const;
    /// The same list where each coordinate is at most `farthest` away. While sigma_min loses less than half by that,
    /// rank and bound follow from those here (V4), and the factors serve; else as `make`.
    [[nodiscard]] Result<std::unique_ptr<ProvedStructure>> moved(Packing there, double farthest) const;
    /// It is of this list at these coordinates, proved as `make` would prove it.
    [[nodiscard]] bool is_of(const Packing& other, const std::vector<Contact>& contacts) const;
    ProvedStructure(const ProvedStructure&) = delete;
    ProvedStructure& operator=(const ProvedStructure&) = delete;

    Packing packing;
    IsostaticStructure structure;
    Factorisation factorisation;
    InverseBound inverse;

  protected:
    ProvedStructure(Packing p, IsostaticStructure s, Factorisation factors, const InverseBound& bound);
};

} // namespace isostat
