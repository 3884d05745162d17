#pragma once
// The regular triangulation of the disks of a packing, made by CGAL and carried along with disks that move.

#include <isostat/packing/packing.hpp>

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

// exact: all other numbers of this file: corners of a face

namespace isostat {

class RegularTriangulation;

/// Faces of a regular triangulation of n disks with weights fl(R^2) and of four more disks, as
/// small as the smallest, at the corners of a rectangle far around them, which is then the hull
/// for any packing (proofs/contact_candidates.md, section "Four disks far outside"). No disk is
/// hidden. Never changed after its construction, so that threads and lists can share it.
class RegularTriangulation {
  public:
    using Shared = std::shared_ptr<const RegularTriangulation>;

    /// Built by CGAL from disks in spatial order: O(n log n). Null when a disk is hidden or equal to another. \pre
    /// squares of lengths neither over- nor underflow, n > 0.
    static Shared build(const Packing& packing);

    /// A regular triangulation of the disks of `packing`, wherever they are: `from` with a few edges flipped (or `from`
    /// itself), proved regular edge by edge with exact predicates. Null when flips cannot give one: a face has turned
    /// over, or an edge that is not regular cannot be flipped. O(n). \pre as `build`.
    static Shared carry(const Shared& from, const Packing& packing);

    /// Calls visit(i, j), i < j, for every edge between two disks of the packing.
    template <class Visit> void for_each_edge(Visit visit) const {
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                const int i = faces_[f].vertex[(k + 1) % 3];
                const int j = faces_[f].vertex[(k + 2) % 3];
                if (faces_[f].neighbour[k] > static_cast<int>(f) && i < disks_ && j < disks_) {
                    visit(i < j ? i : j, i < j ? j : i);
                }
            }
        }
    }

    [[nodiscard]] int disk_count() const { return disks_; }

  private:
    /// Counter-clockwise; neighbour[k] is the face on the other side of the edge opposite to vertex[k], -1 at the hull.
    struct Face {
        std::array<int, 3> vertex;
        std::array<int, 3> neighbour;
    };
    class Mover;

    int disks_ = 0; ///< vertices from here on are the four outer disks
    std::vector<Face> faces_;
};

/// The edges (i, j), i < j, of a regular triangulation of the centres with weights fl(R^2), by exact predicates:
/// statements T5 and T6 say which pairs are edges. Empty where a sphere is hidden or equal to another. Centres in one
/// plane, or on one line, are triangulated in it. Cost: O(n log n) for packings. \pre `packing.dimension` is 3; squares
/// of lengths neither over- nor underflow
std::optional<std::vector<std::pair<int, int>>> regular_edges_in_space(const Packing& packing);

} // namespace isostat
