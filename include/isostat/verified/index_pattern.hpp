#pragma once
/// \file
/// Which coordinates a contact touches, whatever the values of its normal.

#include <isostat/rigidity/isostatic.hpp>

#include <vector>

namespace isostat {

/// The pattern of the contact matrix for all positions of the grains: a pair of disks has entries for every coordinate
/// of both, also where the stored normal has a component that is exactly 0 and `structure.matrix()` none. Zeros that
/// follow from this pattern hold for the perturbed grains too.
struct IndexPattern {
    std::vector<int> start; ///< per contact, one more at the end
    std::vector<int> row;
    std::vector<int> matched; ///< column of each row (`perfect_matching`)
};
template <int Dim> IndexPattern index_pattern(const IsostaticStructure<Dim>& structure);

/// The degrees of freedom that a pair touches.
template <int Dim> std::vector<int> touched_rows(const DofMap<Dim>& dofs, int disks, const Contact& contact);

extern template IndexPattern index_pattern<2>(const IsostaticStructure<2>&);
extern template std::vector<int> touched_rows<2>(const DofMap<2>&, int, const Contact&);

} // namespace isostat
