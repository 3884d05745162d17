#pragma once
/// \file
/// What is asked of a state, the same for every rung: load and structural zeros.

#include "rigidity/contact_pattern.hpp"

#include <isostat/contact/state.hpp>

#include <vector>

namespace isostat {

/// \pre of the structure: of the contacts of the state; it outlives the subject.
class Subject {
  public:
    Subject(const State& state, const IsostaticStructure& structure);

    const State& state;
    const DofMap& dofs;
    ContactPattern pattern;
    std::vector<int> loaded_rows;    ///< that carry a finite load whatever the loaded stress is
    std::vector<int> changing_rows;  ///< that the loaded stress presses on
    std::vector<unsigned char> zero; ///< per contact: the finite force is a structural zero

    [[nodiscard]] int size() const { return static_cast<int>(state.contacts.size()); }
    /// Contacts whose finite force vanishes at the same load as that of `opens`, for structural reasons (D3). `opens`
    /// itself and the contacts in `zero` are not listed.
    [[nodiscard]] std::vector<int> vanish_with(int opens) const;
};

} // namespace isostat
