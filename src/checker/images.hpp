#pragma once
/// \file
/// The disks of a cell and their images near it, for the sweep over all pairs (proofs/checker.md, K9).

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <array>
#include <optional>
#include <vector>

namespace isostat::checker {

/// A disk, or an image of it.
struct Placed {
    int disk = 0;
    Image image{};       ///< from where the disk is stored
    bool central = true; ///< the one in the cell itself: of every pair one is, but for a common period
    double x = 0;
    double y = 0;
};

/// The pair that two of them are.
Contact pair_between(const Placed& one, const Placed& two);

/// The cell that the sweep sees, in doubles.
class CellImages {
  public:
    /// `q`: coordinates near the true vertex, of the packing's kind.
    CellImages(const Packing& packing, const std::vector<double>& q);
    /// False: a disk is too far from the cell for its images to have names.
    [[nodiscard]] bool usable() const { return usable_; }
    /// Bound of the sum of |m_a| over all pairs that places within a range make.
    [[nodiscard]] int periods(const std::array<int, 2>& range) const;
    /// Every disk, moved into the cell by periods, and its images up to `range` periods away; 0 along axes with walls.
    [[nodiscard]] std::vector<Placed> places(const std::array<int, 2>& range) const;
    /// Those of them that are within `distance` of a disk in the cell along x and along y, and some more.
    [[nodiscard]] std::vector<Placed> near_cell(const std::array<int, 2>& range, double distance) const;
    /// So many periods suffice: a disk in the cell has no image within `distance` of a central one beyond them.
    /// Nothing: too many for a sweep.
    [[nodiscard]] std::optional<std::array<int, 2>> range(double distance) const;
    /// The larger height.
    [[nodiscard]] double longest() const;

  private:
    const Packing& packing_;
    const std::vector<double>& q_;
    std::vector<std::array<int, 2>> wraps_; ///< periods that a disk is away from the cell
    std::array<int, 2> farthest_{};         ///< largest |wrap|
    std::array<double, 2> height_{};        ///< of the cell
    bool usable_ = true;

    [[nodiscard]] double lattice(std::size_t a, std::size_t b) const {
        return q_[a == b ? packing_.length_at(a) : packing_.tilt_at(a, b)];
    }
};

} // namespace isostat::checker
