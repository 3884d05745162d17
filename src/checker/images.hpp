#pragma once
/// \file
/// The disks of a cell and their images near it, for the sweep over all pairs (proofs/checker.md, K9).

#include <isostat/contact/state.hpp>

#include <algorithm>
#include <array>
#include <cmath>
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

/// All pairs of places that are within `reach` of each other along the first two axes, by strips across the second and
/// a sweep along the first. `reach` is asked again and again, and may fall. \pre in the end it is at most `height`.
template <class Reach, class Visit>
void for_each_near(const std::vector<Placed>& places, double height, const Reach& reach, const Visit& visit) {
    if (places.empty()) {
        return;
    }
    const auto [lowest, highest] = std::ranges::minmax(places, {}, [](const Placed& place) { return place.at[1]; });
    const double extent = highest.at[1] - lowest.at[1];
    height = std::max(height, extent / static_cast<double>(places.size()));
    // checker.md K9 (height of strips)
    height *= 1 + 0x1p-20; // for the rounding of quotients, which are at most the number of places
    std::vector<std::vector<Placed>> strips(static_cast<std::size_t>(extent / height) + 2);
    for (const Placed& place : places) {
        strips[static_cast<std::size_t>((place.at[1] - lowest.at[1]) / height)].push_back(place);
    }
    for (std::vector<Placed>& strip : strips) {
        std::ranges::sort(strip, {}, [](const Placed& place) { return place.at[0]; });
    }
    for (std::size_t s = 0; s + 1 < strips.size(); ++s) {
        std::size_t first = 0; // in the next strip
        for (std::size_t p = 0; p < strips[s].size(); ++p) {
            const Placed& one = strips[s][p];
            const auto pass = [&](const std::vector<Placed>& strip, std::size_t k) {
                for (; k < strip.size() && strip[k].at[0] - one.at[0] <= reach(); ++k) {
                    if (std::abs(strip[k].at[1] - one.at[1]) <= reach()) {
                        visit(one, strip[k]);
                    }
                }
            };
            pass(strips[s], p + 1);
            while (first < strips[s + 1].size() && one.at[0] - strips[s + 1][first].at[0] > reach()) {
                ++first;
            }
            pass(strips[s + 1], first);
        }
    }
}

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
