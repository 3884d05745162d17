#pragma once
/// \file
/// Complete lists of contact candidates and the certificate of non-overlap, from CGAL's regular triangulation.

#include <isostat/contact/contact.hpp>
#include <isostat/core/verdict.hpp>

#include <string>
#include <vector>

namespace isostat {

/// Every pair that can come into contact before the displacements exceed the list's reach.
template <int Dim> struct CandidateList {
    std::vector<Contact> contacts; ///< sorted; disk pairs with gap < reach, walls with gap < reach
    double reach = 0; ///< delta: complete as long as twice the largest displacement since `reference` < delta
    std::vector<double> reference; ///< q at which the list was made

    /// True when the list is still complete at `packing`: 2 max_i |x_i - x_i^ref| < reach (walls included).
    /// One-sided: false only means that the list must be rebuilt. Cost O(n).
    [[nodiscard]] bool covers(const Packing<Dim>& packing) const;
};

/// Candidates with gap < fraction * R_min, `fraction` in (0, 0.82], complete by statement T6 (proofs/): edges of the
/// regular triangulation with weights R^2, walls by a scan. \pre The packing is admissible (up to rounding): with
/// overlapping disks the list may be incomplete. Cost O(n log n): about 5 ms at n = 5000.
template <int Dim> CandidateList<Dim> find_candidates(const Packing<Dim>& packing, double fraction);

/// Result of `certify_admissible`.
struct Admissibility {
    Verdict verdict = Verdict::undecided; ///< proved: no two grains overlap by more than `allowance`
    double worst_gap = 0;                 ///< smallest gap met
    Contact worst;                        ///< where
};

/// No pair of grains overlaps by more than `allowance` (a length >= 0): statement T5 (proofs/): no hidden vertex and no
/// overlapping edge of the regular triangulation, walls by a scan. `refuted` names a pair whose gap is below
/// -allowance. With allowance = 0 the signs of gaps are exact (dyadic coordinates); with allowance > 0 the disks are
/// shrunk by allowance / 2 each and the statement is about the shrunk disks. Cost O(n log n).
template <int Dim> Admissibility certify_admissible(const Packing<Dim>& packing, double allowance);

extern template struct CandidateList<2>;
extern template CandidateList<2> find_candidates<2>(const Packing<2>&, double);
extern template Admissibility certify_admissible<2>(const Packing<2>&, double);

} // namespace isostat
