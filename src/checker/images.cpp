#include "checker/images.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat::checker {

namespace {

/// Wraps and ranges up to these have differences below 128 (`Image`).
constexpr int farthest_disk = 50;
constexpr int most_periods = 16;

} // namespace

Contact pair_between(const Placed& one, const Placed& two) {
    Image m;
    for (std::size_t a = 0; a < 2; ++a) {
        m.m[a] = static_cast<std::int8_t>(two.image.m[a] - one.image.m[a]);
    }
    return pair_of(one.disk, two.disk, m);
}

CellImages::CellImages(const Packing& packing, const std::vector<double>& q) : packing_(packing), q_(q) {
    const auto& periodic = packing.cell.periodic;
    const double tilt = lattice(0, 1);
    const double stretch = packing.cell.all() ? std::hypot(1.0, tilt / lattice(1, 1)) : 1;
    height_ = {lattice(0, 0) / stretch, lattice(1, 1)};
    for (std::size_t i = 0; i < packing.radius.size() && usable_; ++i) {
        std::array<int, 2>& wrap = wraps_.emplace_back();
        double x = q[2 * i];
        for (const std::size_t a : {std::size_t{1}, std::size_t{0}}) {
            if (!periodic[a]) {
                continue;
            }
            const double fraction = (a == 0 ? x : q[2 * i + 1]) / lattice(a, a);
            usable_ = usable_ && std::abs(fraction) < farthest_disk;
            if (usable_) {
                wrap[a] = static_cast<int>(std::floor(fraction));
                farthest_[a] = std::max(farthest_[a], std::abs(wrap[a]));
                x -= a == 1 ? fraction * tilt : 0; // 0 unless both axes repeat
            }
        }
    }
}

int CellImages::periods(const std::array<int, 2>& range) const {
    return 2 * farthest_[0] + range[0] + 2 * farthest_[1] + range[1];
}

std::vector<Placed> CellImages::places(const std::array<int, 2>& range) const {
    std::vector<Placed> all;
    for (std::size_t i = 0; i < wraps_.size(); ++i) {
        for (int m = -range[0]; m <= range[0]; ++m) {
            for (int p = -range[1]; p <= range[1]; ++p) {
                const int along = m - wraps_[i][0];
                const int across = p - wraps_[i][1];
                all.push_back(
                    {static_cast<int>(i),
                     {{static_cast<std::int8_t>(along), static_cast<std::int8_t>(across), 0}},
                     m == 0 && p == 0,
                     q_[2 * i] + along * (packing_.cell.periodic[0] ? lattice(0, 0) : 0) + across * lattice(0, 1),
                     q_[2 * i + 1] + across * (packing_.cell.periodic[1] ? lattice(1, 1) : 0)});
            }
        }
    }
    return all;
}

std::vector<Placed> CellImages::near_cell(const std::array<int, 2>& range, double distance) const {
    std::vector<Placed> all = places(range);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 4> box{infinity, -infinity, infinity, -infinity}; // of the disks in the cell
    for (const Placed& place : all) {
        if (place.central) {
            box = {std::min(box[0], place.x), std::max(box[1], place.x), std::min(box[2], place.y),
                   std::max(box[3], place.y)};
        }
    }
    std::erase_if(all, [&](const Placed& place) {
        return place.x < box[0] - distance || place.x > box[1] + distance || place.y < box[2] - distance ||
               place.y > box[3] + distance;
    });
    return all;
}

double CellImages::longest() const {
    return std::max(packing_.cell.periodic[0] ? height_[0] : 0, packing_.cell.periodic[1] ? height_[1] : 0);
}

std::optional<std::array<int, 2>> CellImages::range(double distance) const {
    std::array<int, 2> found{};
    for (std::size_t a = 0; a < 2; ++a) {
        if (!packing_.cell.periodic[a]) {
            continue;
        }
        const double most = distance / height_[a] + 1.01;
        if (!(most < most_periods)) {
            return std::nullopt;
        }
        found[a] = static_cast<int>(most);
    }
    return found;
}

} // namespace isostat::checker
