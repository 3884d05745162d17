#include "checker/images.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat::checker {

namespace {

/// Wraps and ranges up to these have differences below 128 (`Image`).
constexpr int farthest_disk = 50; // cost: how far a disk may be from the cell (checker.md K9)
constexpr int most_periods = 16;  // cost: periods swept (checker.md K9)

} // namespace

Contact pair_between(const Placed& one, const Placed& two) {
    Image m;
    for (std::size_t a = 0; a < m.m.size(); ++a) {
        m.m[a] = static_cast<std::int8_t>(two.image.m[a] - one.image.m[a]);
    }
    return pair_of(one.disk, two.disk, m);
}

double CellImages::lattice(std::size_t a, std::size_t b) const {
    const auto& periodic = packing_.cell.periodic;
    return periodic[a] && periodic[b] ? q_[a == b ? packing_.length_at(a) : packing_.tilt_at(a, b)] : a == b ? 1 : 0;
}

CellImages::CellImages(const Packing& packing, const std::vector<double>& q) : packing_(packing), q_(q) {
    const std::size_t axes = packing.axes();
    for (std::size_t a = 0; a < axes; ++a) { // 1 / |row a of A^-1|
        PerAxis<double> row{};
        double square = 0;
        for (std::size_t b = a; b < axes; ++b) {
            double rest = a == b ? 1 : 0;
            for (std::size_t c = a; c < b; ++c) {
                rest -= row[c] * lattice(c, b);
            }
            row[b] = rest / lattice(b, b);
            square += row[b] * row[b];
        }
        height_[a] = packing.cell.periodic[a] ? 1 / std::sqrt(square) : 0;
    }
    for (std::size_t i = 0; i < packing.radius.size() && usable_; ++i) {
        Periods& wrap = wraps_.emplace_back();
        PerAxis<double> fraction{};
        for (std::size_t a = axes; a-- > 0;) {
            double x = packing.cell.periodic[a] ? q[axes * i + a] : 0;
            for (std::size_t b = a + 1; b < axes; ++b) {
                x -= fraction[b] * lattice(a, b);
            }
            fraction[a] = x / lattice(a, a);
            usable_ = usable_ && std::abs(fraction[a]) < farthest_disk;
            if (usable_) {
                wrap[a] = static_cast<int>(std::floor(fraction[a]));
                farthest_[a] = std::max(farthest_[a], std::abs(wrap[a]));
            }
        }
    }
}

int CellImages::periods(const Periods& range) const {
    int sum = 0;
    for (std::size_t a = 0; a < range.size(); ++a) {
        sum += 2 * farthest_[a] + range[a];
    }
    return sum;
}

Placed CellImages::placed(std::size_t disk, const Periods& m) const {
    Placed place{static_cast<int>(disk), {}, m == Periods{}, {}};
    for (std::size_t b = packing_.axes(); b-- > 0;) {
        place.at[b] += q_[packing_.axes() * disk + b];
        const int times = m[b] - wraps_[disk][b];
        place.image.m[b] = static_cast<std::int8_t>(times);
        for (std::size_t a = 0; a <= b && times != 0; ++a) {
            place.at[a] += times * lattice(a, b);
        }
    }
    return place;
}

std::vector<Placed> CellImages::near_cell(const Periods& range, double distance) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    PerAxis<double> from; // of the disks in the cell
    PerAxis<double> to;
    from.fill(infinity);
    to.fill(-infinity);
    for (std::size_t i = 0; i < wraps_.size(); ++i) {
        const Placed central = placed(i, {});
        for (std::size_t a = 0; a < from.size(); ++a) {
            from[a] = std::min(from[a], central.at[a]);
            to[a] = std::max(to[a], central.at[a]);
        }
    }
    std::vector<Placed> near;
    for (std::size_t i = 0; i < wraps_.size(); ++i) {
        for_each_image(range, [&](const Periods& m) {
            const Placed place = placed(i, m);
            bool beyond = false;
            for (std::size_t a = 0; a < from.size(); ++a) {
                beyond = beyond || place.at[a] < from[a] - distance || place.at[a] > to[a] + distance;
            }
            if (!beyond) {
                near.push_back(place);
            }
        });
    }
    return near;
}

double CellImages::longest() const {
    return *std::max_element(height_.begin(), height_.end());
}

std::optional<Periods> CellImages::range(double distance) const {
    Periods found{};
    for (std::size_t a = 0; a < packing_.axes(); ++a) {
        if (!packing_.cell.periodic[a]) {
            continue;
        }
        // checker.md K9 (periods swept, with a hundredth for roundings)
        const double most = distance / height_[a] + 1.01;
        if (!(most < most_periods)) {
            return std::nullopt;
        }
        found[a] = static_cast<int>(most);
    }
    return found;
}

} // namespace isostat::checker
