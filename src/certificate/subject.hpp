#pragma once
/// \file
/// What is asked of a state, the same for every rung: load, patterns, structural zeros.

#include <isostat/contact/state.hpp>
#include <isostat/sparse/pattern.hpp>

#include <vector>

namespace isostat {

/// Rows (degrees of freedom) that each contact may act on, with a perfect matching.
struct ContactPattern {
    std::vector<int> start{0};
    std::vector<int> row;
    std::vector<int> matched; ///< empty: none exists
};

/// \pre a structure that was proved regular: the matchings exist.
template <int Dim> class Subject {
  public:
    explicit Subject(const State<Dim>& state);

    const State<Dim>& state;
    DofMap<Dim> dofs;
    /// All rows that a contact touches: contains the pattern of every configuration.
    ContactPattern touched;
    /// The same without entries that vanish at every true vertex: two disks of one radius on one wall have the same
    /// coordinate along its normal.
    ContactPattern exact;
    std::vector<int> loaded_rows;          ///< that carry a finite load other than the loaded wall's
    int wall_row = -1;                     ///< of the loaded wall; -1: it cannot move
    std::vector<unsigned char> zero;       ///< per contact: the finite force is a structural zero of `touched`
    std::vector<unsigned char> zero_slope; ///< per contact: the slope is a structural zero of `exact`

    [[nodiscard]] int size() const { return static_cast<int>(state.contacts.size()); }
    /// Contacts whose finite force vanishes at the same load as that of `opens` for every choice of the entries in
    /// `exact` that gives `opens` a slope: the structural zeros after its column was replaced by that of the loaded
    /// wall (D3). `opens` itself and the contacts in `zero` are not listed.
    [[nodiscard]] std::vector<int> vanish_with(int opens) const;
};

extern template class Subject<2>;

} // namespace isostat
