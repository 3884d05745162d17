#pragma once
/// \file
/// Where the contact matrix can have entries: the one pattern by which structural zeros are told
/// (proofs/definition.md).

#include "rigidity/isostatic.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/contact.hpp>

#include <optional>
#include <span>
#include <vector>

namespace isostat {

/// The degrees of freedom on which a contact can act, ascending: by the indices alone, wherever the grains are.
std::vector<int> touched_rows(const DofMap& dofs, const Contact& contact);

/// The pattern of the contact matrix at the true vertex: the entries that the contacts can have by their indices (those
/// of `contact_matrix`, a stored 0 among them), without those that are 0 at every true vertex: components along an axis
/// where walls, holds or being fixed keep both disks at one coordinate. What vanishes by this pattern (T11) vanishes
/// for the true vertex, whatever the stored numbers are. In a cell the disk with the most contacts counts as pinned,
/// whichever is, as long as no disk carries a finite load. Refers to the structure while no entry is left out.
class ContactPattern {
  public:
    /// `perturbed`: the radii are R_i + eps rho_i; then equal ones are not equal, and nothing is left out.
    ContactPattern(const Packing& packing, const IsostaticStructure& structure, bool perturbed = false)
        : ContactPattern(packing, structure.dofs(), structure.contacts(), structure.matrix(), structure.matching(),
                         perturbed) {}
    /// The same from the parts of a structure, which must outlive it.
    ContactPattern(const Packing& packing, const DofMap& dofs, const std::vector<Contact>& contacts,
                   const sparse::Matrix<double>& matrix, const std::vector<int>& matching, bool perturbed = false);

    /// Per contact: 1 when its force can be other than 0 under a load on `rows`; 0: a structural zero. Cost O(N).
    /// `reached`: the answer for a load on some of these rows, none of a disk, where it is known.
    [[nodiscard]] std::vector<unsigned char> carrying(std::span<const int> rows,
                                                      std::vector<unsigned char> reached = {}) const;
    /// The same for what is left of the forces where the force of `opens` has been brought to 0 by a load on `rows`: 0
    /// means that the two vanish together (D3). All 1 when `opens` does not depend on that load.
    [[nodiscard]] std::vector<unsigned char> carrying_without(ContactId opens, std::span<const int> rows,
                                                              std::span<const int> other_rows) const;

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
    int rows_of_disks_ = 0; ///< where another disk is pinned than the structure says; else 0

    struct View {
        std::span<const int> start;
        std::span<const int> row;
        const std::vector<int>& matched;
    };
    /// For a load on these rows.
    [[nodiscard]] View for_load(std::span<const int> rows) const;
};

} // namespace isostat
