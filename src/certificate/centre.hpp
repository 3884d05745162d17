#pragma once
/// \file
/// A configuration in doubles around which the true vertex is enclosed, with what is proved there once for all rungs.

#include <isostat/core/result.hpp>
#include <isostat/verified/inverse_bound.hpp>

#include <memory>
#include <vector>

namespace isostat {

/// The length D_l of a contact: sum of the radii, or the radius at a wall.
template <int Dim> double contact_length(const Packing<Dim>& packing, const Contact& contact);

/// Contacts of disks with disks and walls only (nothing held). Not movable: its parts may refer to each other.
template <int Dim> class Centre {
  public:
    /// Proves the rank, factorises, bounds the inverse. Failure: `not_isostatic`.
    static Result<std::unique_ptr<Centre>> make(Packing<Dim> packing, std::vector<Contact> contacts);
    /// Where Newton's iteration for "all gaps are 0" ends that starts at `start`; null when it leaves the
    /// neighbourhood, does not converge or meets a matrix that is not proved regular. Proves nothing about the end.
    static std::unique_ptr<Centre> downhill(const Centre& start);
    Centre(const Centre&) = delete;
    Centre& operator=(const Centre&) = delete;

    Packing<Dim> packing;
    IsostaticStructure<Dim> structure;
    Factorisation factorisation;
    InverseBound inverse;
    double largest_gap = 0;  ///< bound of |gap| of a contact
    double relative_gap = 0; ///< largest |gap| / D of a contact, as computed
    double lipschitz = 0;    ///< K of V4 (a), for the derivative of the gap functions F_l
    double inverse_norm = 0; ///< bound of |DF^-1| here, V4 (b); infinity when nothing is known

  private:
    Centre(Packing<Dim> p, IsostaticStructure<Dim> s);
};

extern template double contact_length<2>(const Packing<2>&, const Contact&);
extern template class Centre<2>;

} // namespace isostat
