#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>

namespace isostat {

namespace {

/// At most sqrt(n) disks are larger than this: one large disk among small ones would make the cells of a grid large.
double common_radius(std::vector<double> radius) {
    constexpr double comparable = 4; // cost: larger disks are not in cells
    const std::size_t n = radius.size();
    const auto place = [&radius](std::size_t k) { return radius.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(radius.begin(), place(n / 2), radius.end());
    const double largest = *std::max_element(place(n / 2), radius.end());
    if (largest <= comparable * radius[n / 2]) {
        return largest;
    }
    const std::size_t rank = n - 1 - static_cast<std::size_t>(std::sqrt(static_cast<double>(n - 1)));
    std::nth_element(radius.begin(), place(rank), radius.end());
    return radius[rank];
}

/// Cells of a bounding box, disks sorted by cell; disks larger than `common` are kept apart. A disk is found from its
/// own cell number, so rounding cannot lose it; pairs within one cell width are in adjacent cells up to rounding, which
/// the margin in the width covers.
class Grid {
  public:
    Grid(int dimension, const std::vector<double>& x, const std::vector<double>& radius, double reach)
        : axes_(static_cast<std::size_t>(dimension)), cell_of_(radius.size(), apart) {
        const double common = common_radius(radius);
        const double width = (2 * common + reach) * (1 + 1e-9); // contact_candidates.md find_pairs
        const PerAxis<double> lowest = divide(x, width);
        for (std::size_t i = 0; i < radius.size(); ++i) {
            if (radius[i] > common) {
                large_.push_back(static_cast<int>(i));
                continue;
            }
            int cell = 0;
            for (std::size_t a = 0; a < axes_; ++a) {
                const double place = count_[a] == 1 ? 0 : (x[axes_ * i + a] - lowest[a]) / step_[a];
                cell = cell * count_[a] + std::clamp(static_cast<int>(place), 0, count_[a] - 1);
            }
            cell_of_[i] = cell;
            ++start_[static_cast<std::size_t>(cell) + 1];
        }
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        std::vector<int> next(start_.begin(), start_.end() - 1);
        member_.resize(radius.size() - large_.size());
        for (std::size_t i = 0; i < radius.size(); ++i) {
            if (cell_of_[i] != apart) {
                member_[static_cast<std::size_t>(next[static_cast<std::size_t>(cell_of_[i])]++)] = static_cast<int>(i);
            }
        }
    }

    /// Calls `visit(j)` for the disks that may be near i: those of its cell and of the cells around it, and the large
    /// ones; for a large i all disks.
    template <class Visit> void around(std::size_t i, const Visit& visit) const {
        std::ranges::for_each(large_, visit);
        if (cell_of_[i] == apart) {
            std::ranges::for_each(member_, visit);
            return;
        }
        PerAxis<int> centre{};
        int cell = cell_of_[i];
        for (std::size_t a = axes_; a-- > 0;) {
            centre[a] = cell % count_[a];
            cell /= count_[a];
        }
        walk(0, 0, centre, visit);
    }

  private:
    static constexpr int apart = -1;

    /// Sets counts and steps; returns the lowest coordinates.
    PerAxis<double> divide(const std::vector<double>& x, double width) {
        const std::size_t n = cell_of_.size();
        // More cells than disks cost memory without benefit.
        const double most = std::ceil(std::pow(static_cast<double>(n), 1.0 / static_cast<double>(axes_))) + 1;
        PerAxis<double> lowest{};
        std::size_t cells = 1;
        for (std::size_t a = 0; a < axes_; ++a) {
            double highest = lowest[a] = x[a];
            for (std::size_t i = 1; i < n; ++i) {
                lowest[a] = std::min(lowest[a], x[axes_ * i + a]);
                highest = std::max(highest, x[axes_ * i + a]);
            }
            const double extent = highest - lowest[a];
            count_[a] = std::isfinite(extent) ? static_cast<int>(std::clamp(std::floor(extent / width), 1.0, most)) : 1;
            step_[a] = extent / count_[a];
            cells *= static_cast<std::size_t>(count_[a]);
        }
        start_.assign(cells + 1, 0);
        return lowest;
    }
    template <class Visit>
    void walk(std::size_t axis, int prefix, const PerAxis<int>& centre, const Visit& visit) const {
        if (axis >= std::min(axes_, centre.size())) {
            const auto cell = static_cast<std::size_t>(prefix);
            for (int k = start_[cell]; k < start_[cell + 1]; ++k) {
                visit(member_[static_cast<std::size_t>(k)]);
            }
            return;
        }
        for (int c = std::max(0, centre[axis] - 1); c <= std::min(count_[axis] - 1, centre[axis] + 1); ++c) {
            walk(axis + 1, prefix * count_[axis] + c, centre, visit);
        }
    }

    std::size_t axes_;
    PerAxis<int> count_{};
    PerAxis<double> step_{};
    std::vector<int> start_, member_, cell_of_, large_;
};

/// Whether the gap of two disks is below the reach, or above it only by rounding.
class Near {
  public:
    Near(int dimension, const std::vector<double>& x, const std::vector<double>& radius, double reach)
        : layout_{dimension, static_cast<int>(radius.size())}, x_(x), radius_(radius), reach_(reach),
          plain_(lengths_are_plain(x, radius)) {}

    bool operator()(int i, int j) const {
        constexpr double up = 1 + 0x1p-46; // covers any rounding of the gap; contact_candidates.md find_pairs
        const Contact pair{ContactKind::disk_disk, i, j};
        const double range = (touching_distance(radius_, pair) + reach_) * up;
        const Separation separation(pair, layout_);
        double square = 0, distance = 0;
        for (const double d : separation.of_disks([&](std::size_t k) { return x_[k]; }, std::minus<>())) {
            square += d * d;
            distance = plain_ ? 0 : std::hypot(distance, d); // slow
        }
        return plain_ ? square < range * range : distance < range;
    }

  private:
    Layout layout_;
    const std::vector<double>& x_;
    const std::vector<double>& radius_;
    double reach_;
    bool plain_;
};

} // namespace

bool lengths_are_plain(const std::vector<double>& x, const std::vector<double>& radius) {
    constexpr double largest = 1e100;   // squares neither overflow; contact_candidates.md lengths_are_plain
    constexpr double smallest = 1e-100; // nor underflow; contact_candidates.md lengths_are_plain
    return std::ranges::all_of(radius, [](double r) { return r >= smallest && r <= largest; }) &&
           std::ranges::all_of(x, [](double c) { return std::abs(c) <= largest; }); // also false for a NaN
}

void find_pairs(int dimension, const std::vector<double>& x, const std::vector<double>& radius, double reach,
                PairList& pairs, int most) {
    const std::size_t n = radius.size();
    pairs.start.assign(1, 0);
    pairs.partner.clear();
    if (n == 0) {
        return;
    }
    const Grid grid(dimension, x, radius, reach);
    const Near near(dimension, x, radius, reach);
    for (std::size_t i = 0; i < n; ++i) {
        const auto first = static_cast<std::ptrdiff_t>(pairs.partner.size());
        grid.around(i, [&](int j) {
            if (static_cast<std::size_t>(j) > i && near(static_cast<int>(i), j)) {
                pairs.partner.push_back(j);
            }
        });
        if (pairs.partner.size() > static_cast<std::size_t>(most)) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{} disks have more than {} pairs at gaps below {}: expected fewer (disks that lie "
                                    "on each other, or too large a threshold)",
                                    n, most, reach));
        }
        std::sort(pairs.partner.begin() + first, pairs.partner.end());
        pairs.start.push_back(static_cast<int>(pairs.partner.size()));
    }
}

} // namespace isostat
