#pragma once
/// \file
/// Self-stresses and mechanisms of packings that are too large for exact bases.

#include <isostat/core/verdict.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <string>
#include <vector>

namespace isostat::crafted {

/// One exact vector, known to a bound in every component.
struct EnclosedVector {
    int free = 0;              ///< the contact (degree of freedom) in which it is 1; it is 0 in the other free ones
    std::vector<double> value; ///< one force per contact (one velocity per degree of freedom), unit normals
    double radius = 0;         ///< |component - value| <= radius, for the exact coordinates
};

struct EnclosedBases {
    /// `proved`: there is exactly one self-stress (motion) with the free components stated, it lies within the bound,
    /// and the h (k) of them are a basis. `undecided`: the rank is not proved, or double precision gives no bound; the
    /// vectors are then empty.
    Verdict verdict = Verdict::undecided;
    std::vector<int> free_contacts;            ///< h of them
    std::vector<int> free_dofs;                ///< k of them
    std::vector<EnclosedVector> self_stresses; ///< those of the first `count` free contacts
    std::vector<EnclosedVector> motions;       ///< those of the first `count` free degrees of freedom
};

/// Independent contacts and degrees of freedom are chosen by elimination mod p in the field; with the others held, the
/// matrix of the nearest doubles is proved regular, with a bound of its inverse (V1, V2), and |x' - x| <= |H'^-1|
/// (|residual| + |H' - H| |x|) carries the solution over to the exact coordinates. \pre `inspection` is that of the
/// packing. Cost: an elimination, a factorisation, one solve per vector.
EnclosedBases enclose_bases(const ExactPacking& packing, const Inspection& inspection, int count);

/// Lines for a terminal: the first 3 of each basis, components beyond the bound. The same as one JSON object: 10.
std::string enclosed_text(const ExactPacking& packing, const Inspection& inspection);
std::string enclosed_json(const ExactPacking& packing, const Inspection& inspection);

} // namespace isostat::crafted
