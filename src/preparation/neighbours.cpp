#include "preparation/neighbours.hpp"

#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>

namespace isostat::preparation {

namespace {

/// Cells of a bounding box, disks sorted by cell. A disk is found again from its own cell number, so rounding cannot
/// lose it; pairs within one cell width are in adjacent cells up to rounding, which the margin in the width covers.
class Grid {
  public:
    Grid(int dimension, const std::vector<double>& x, std::size_t n, double width)
        : axes_(static_cast<std::size_t>(dimension)), cell_of_(n) {
        PerAxis<double> lowest{};
        PerAxis<double> highest{};
        for (std::size_t a = 0; a < axes_; ++a) {
            lowest[a] = highest[a] = x[a];
            for (std::size_t i = 1; i < n; ++i) {
                lowest[a] = std::min(lowest[a], x[axes_ * i + a]);
                highest[a] = std::max(highest[a], x[axes_ * i + a]);
            }
        }
        // More cells than disks cost memory and find nothing.
        const double most = std::ceil(std::pow(static_cast<double>(n), 1.0 / static_cast<double>(axes_))) + 1;
        PerAxis<double> step{};
        int cells = 1;
        for (std::size_t a = 0; a < axes_; ++a) {
            const double extent = highest[a] - lowest[a];
            count_[a] = static_cast<int>(std::clamp(std::floor(extent / width), 1.0, most));
            step[a] = extent > 0 ? extent / count_[a] : 1.0;
            cells *= count_[a];
        }
        start_.assign(static_cast<std::size_t>(cells) + 1, 0);
        for (std::size_t i = 0; i < n; ++i) {
            int cell = 0;
            for (std::size_t a = 0; a < axes_; ++a) {
                const int c = static_cast<int>((x[axes_ * i + a] - lowest[a]) / step[a]);
                cell = cell * count_[a] + std::clamp(c, 0, count_[a] - 1);
            }
            cell_of_[i] = cell;
            ++start_[static_cast<std::size_t>(cell) + 1];
        }
        for (std::size_t c = 0; c < static_cast<std::size_t>(cells); ++c) {
            start_[c + 1] += start_[c];
        }
        std::vector<int> next(start_.begin(), start_.end() - 1);
        member_.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            member_[static_cast<std::size_t>(next[static_cast<std::size_t>(cell_of_[i])]++)] = static_cast<int>(i);
        }
    }

    /// Calls `visit(j)` for the disks of the cell of i and of the cells around it.
    template <class Visit> void around(std::size_t i, const Visit& visit) const {
        PerAxis<int> centre{};
        int cell = cell_of_[i];
        for (std::size_t a = axes_; a-- > 0;) {
            centre[a] = cell % count_[a];
            cell /= count_[a];
        }
        walk(0, 0, centre, visit);
    }

  private:
    template <class Visit>
    void walk(std::size_t axis, int prefix, const PerAxis<int>& centre, const Visit& visit) const {
        if (axis == axes_) {
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
    std::vector<int> start_, member_, cell_of_;
};

} // namespace

void find_pairs(int dimension, const std::vector<double>& x, const std::vector<double>& radius, double reach,
                PairList& pairs, int most) {
    const std::size_t n = radius.size();
    pairs.start.assign(1, 0);
    pairs.partner.clear();
    if (n == 0) {
        return;
    }
    const double largest = *std::max_element(radius.begin(), radius.end());
    const Grid grid(dimension, x, n, (2 * largest + reach) * (1 + 1e-9));
    for (std::size_t i = 0; i < n; ++i) {
        const auto first = static_cast<std::ptrdiff_t>(pairs.partner.size());
        grid.around(i, [&](int partner) {
            const auto j = static_cast<std::size_t>(partner);
            if (j <= i) {
                return;
            }
            const Separation separation({ContactKind::disk_disk, static_cast<int>(i), partner},
                                        Layout{dimension, static_cast<int>(n)});
            double square = 0;
            for (const double d : separation.of_disks([&](std::size_t k) { return x[k]; }, std::minus<>())) {
                square += d * d;
            }
            const double range = radius[i] + radius[j] + reach;
            if (square < range * range) {
                pairs.partner.push_back(partner);
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

namespace {

std::vector<Contact> near_disks(const Packing& packing, double reach, double upper_reach) {
    if (packing.cell.any()) {
        std::vector<Contact> all = near_pairs(packing, reach + upper_reach).pairs;
        std::erase_if(all, [&](const Contact& c) { return c.image.is_here() && !(gap(packing, c) < reach); });
        return all;
    }
    PairList pairs;
    find_pairs(packing.dimension, packing.q, packing.radius, reach, pairs);
    std::vector<Contact> near;
    const int n = packing.disk_count();
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        for (int p = pairs.start[k]; p < pairs.start[k + 1]; ++p) {
            near.push_back({ContactKind::disk_disk, i, pairs.partner[static_cast<std::size_t>(p)]});
        }
    }
    return near;
}

} // namespace

std::vector<Contact> near_contacts(const Packing& packing, double reach, double upper_reach) {
    std::vector<Contact> near = near_disks(packing, reach, upper_reach);
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (int i = 0; i < packing.disk_count(); ++i) {
            for (int a = 0; a < packing.dimension; ++a) {
                const Contact wall{kind, i, a};
                if (packing.cell.periodic[static_cast<std::size_t>(a)]) {
                    continue;
                }
                if (gap(packing, wall) < (kind == ContactKind::upper_wall ? upper_reach : reach)) {
                    near.push_back(wall);
                }
            }
        }
    }
    return near;
}

} // namespace isostat::preparation
