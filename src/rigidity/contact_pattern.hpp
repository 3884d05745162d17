#pragma once
/// \file
/// Where the contact matrix can have entries: the one pattern
/// from which structural zeros follow (proofs/definition.md).

#include "rigidity/isostatic.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/contact.hpp>

#include <optional>
#include <span>
#include <vector>

namespace isostat {

/// The degrees of freedom on which a contact can act, ascending: they follow from indices alone, for any positions.
std::vector<int> touched_rows(const DofMap& dofs, const Contact& contact);

/// The pattern of the contact matrix at the true vertex: the entries that the contacts can have by their indices (those
/// of `contact_matrix`, stored zeros included), without entries that are 0 at every true vertex: components along an
/// axis where walls, holds or fixed grains keep both disks at one coordinate. A force that vanishes by this pattern
/// (T11) vanishes at the true vertex, for any stored numbers. In a cell the disk with the most contacts counts as
/// pinned, as long as no disk carries a finite load. Refers to the structure while no entry is left out.
class ContactPattern {
  public:
    /// `perturbed`: the radii are R_i + eps rho_i; equal radii then differ, and no entry is left out.
    ContactPattern(const Packing& packing, const IsostaticStructure& structure, bool perturbed = false)
        : ContactPattern(packing, structure.dofs(), structure.contacts(), structure.matrix(), structure.matching(),
                         perturbed) {}
    /// Uses the parts of a structure, which must outlive the pattern.
    ContactPattern(const Packing& packing, const DofMap& dofs, const std::vector<Contact>& contacts,
                   const sparse::Matrix<double>& matrix, const std::vector<int>& matching, bool perturbed = false);

    /// Per contact: 1 when its force can differ from 0 under a load on `rows`; 0: a structural zero. Cost O(N).
    /// `reached`: the answer for a load on some of these rows (none of a disk), if known.
    [[nodiscard]] std::vector<unsigned char> carrying(std::span<const int> rows,
                                                      std::vector<unsigned char> reached = {}) const;
    /// `carrying` for the remaining forces after the force of `opens` was brought to 0 by a load on `rows`: 0 means
    /// that both forces vanish together (D3). All 1 when `opens` does not depend on that load.
    [[nodiscard]] std::vector<unsigned char> carrying_without(ContactId opens, std::span<const int> rows,
                                                              std::span<const int> other_rows) const;
    /// `carrying` with one balance more along each axis that `rows` do not load: that of what cannot move, the sum of
    /// all others of the axis (T11 (d)). A row of the axis makes room for this balance: of the contact with the largest
    /// of `sizes`, guesses of the forces. A poor guess shows fewer zeros.
    [[nodiscard]] std::vector<unsigned char> carrying_by_sums(const DofMap& dofs, std::span<const int> rows,
                                                              std::span<const double> sizes) const;

  private:
    struct Parts {
        std::vector<int> start{0};
        std::vector<int> row;
        std::vector<int> matched; ///< the column of each row, in a perfect matching
    };
    std::optional<Parts> own_;
    const std::vector<int>* start_;
    const std::vector<int>* row_;
    const std::vector<int>* matched_;
    int rows_of_disks_ = 0; ///< where this pattern pins another disk than the structure; else 0

    struct View {
        std::span<const int> start;
        std::span<const int> row;
        const std::vector<int>& matched;
    };
    /// The matrix view for a load on these rows.
    [[nodiscard]] View for_load(std::span<const int> rows) const;
};

} // namespace isostat
