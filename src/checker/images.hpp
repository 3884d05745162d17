#pragma once
/// \file
/// The disks of a cell and their images near it, for the sweep over all pairs (proofs/checker.md, K9).

#include <isostat/contact/state.hpp>

#include <array>
#include <optional>
#include <vector>

namespace isostat::checker {

using Periods = PerAxis<int>;

/// All m with |m_a| <= range_a.
template <class Visit> void for_each_image(const Periods& range, const Visit& visit) {
    for (int x = -range[0]; x <= range[0]; ++x) {
        for (int y = -range[1]; y <= range[1]; ++y) {
            for (int z = -range[2]; z <= range[2]; ++z) {
                visit(Periods{x, y, z});
            }
        }
    }
}

/// A disk, or an image of it.
struct Placed {
    int disk = 0;
    Image image{};       ///< periods from where the disk is stored
    bool central = true; ///< the place in the cell itself: in every pair, up to common periods, one place is central
    PerAxis<double> at{};
};

/// The pair of two places.
Contact pair_between(const Placed& one, const Placed& two);

/// The cell in doubles, as the sweep uses it.
class CellImages {
  public:
    /// `q`: coordinates near the true vertex, with the layout of the packing.
    CellImages(const Packing& packing, const std::vector<double>& q);
    /// False: a disk is too far from the cell for its images to have names.
    [[nodiscard]] bool usable() const { return usable_; }
    /// Bound of the sum of |m_a| over all pairs of places within a range.
    [[nodiscard]] int periods(const Periods& range) const;
    /// Every disk, moved into the cell by periods, and its images up to `range` periods away (0 along axes with walls),
    /// except images that are not within `distance` of a disk in the cell along every axis.
    [[nodiscard]] std::vector<Placed> near_cell(const Periods& range, double distance) const;
    /// Sufficient periods: a disk in the cell has no image within `distance`
    /// of a central place beyond them. Nothing: too many for a sweep.
    [[nodiscard]] std::optional<Periods> range(double distance) const;
    /// The largest height.
    [[nodiscard]] double longest() const;

  private:
    const Packing& packing_;
    const std::vector<double>& q_;
    std::vector<Periods> wraps_; ///< periods between a disk and the cell
    Periods farthest_{};         ///< largest |wrap|
    PerAxis<double> height_{};   ///< heights of the cell; 0 along axes with walls
    bool usable_ = true;

    /// A_ab; along axes with walls, which have no images, 1 and 0.
    [[nodiscard]] double lattice(std::size_t a, std::size_t b) const;
    [[nodiscard]] Placed placed(std::size_t disk, const Periods& m) const;
};

} // namespace isostat::checker
