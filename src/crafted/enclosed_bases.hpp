#pragma once
/// \file
/// Self-stresses and mechanisms of packings that are too large for exact bases.

#include <isostat/core/result.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <string>
#include <vector>

namespace isostat::crafted {

/// One exact vector, known to a bound in every component.
struct EnclosedVector {
    int free = 0;              ///< its component 1 (a contact or degree of freedom); its other free components are 0
    std::vector<double> value; ///< one force per contact (or one velocity per degree of freedom), unit normals
    double radius = 0;         ///< |component - value| <= radius, for the exact coordinates
};

struct EnclosedBases {
    /// `proved`: exactly one self-stress (motion) has the stated free components, it
    /// lies within the bound, and the h (k) vectors are a basis. `undecided`: the rank
    /// is not proved, or double precision gives no bound; the vectors are then empty.
    Verdict verdict = Verdict::undecided;
    std::vector<int> free_contacts;            ///< all h free contacts
    std::vector<int> free_dofs;                ///< all k free degrees of freedom
    std::vector<EnclosedVector> self_stresses; ///< for the first `count` free contacts
    std::vector<EnclosedVector> motions;       ///< for the first `count` free degrees of freedom
};

/// Independent contacts and degrees of freedom are chosen by elimination mod p in the field; with the others held, the
/// matrix of the nearest doubles is proved regular, with a bound of its inverse (V1, V2), and |x' - x| <= |H'^-1|
/// (|residual| + |H' - H| |x|) carries the solution over to the exact coordinates. \pre `inspection` is that of the
/// packing. Cost: an elimination, a factorisation, one solve per vector.
EnclosedBases enclose_bases(const ExactPacking& packing, const Inspection& inspection, int count);

/// Text for a terminal with the first 3 of each basis, components beyond the bound; and one JSON object with 10.
std::string enclosed_text(const ExactPacking& packing, const Inspection& inspection);
std::string enclosed_json(const ExactPacking& packing, const Inspection& inspection);

} // namespace isostat::crafted
