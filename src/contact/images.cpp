#include "contact/images.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace isostat {

namespace {

/// Fractional coordinates of a point along the periodic axes, rounded; 0 along the others.
std::array<double, 2> fractional(const Packing& packing, double x, double y) {
    std::array<double, 2> s{};
    if (packing.cell.periodic[1]) {
        s[1] = y / packing.lattice(1, 1);
    }
    if (packing.cell.periodic[0]) {
        s[0] = (x - s[1] * packing.lattice(0, 1)) / packing.lattice(0, 0);
    }
    return s;
}

/// Distance of the two sides of the cell along each periodic axis: 1 / |row of A^-1|.
std::array<double, 2> heights(const Packing& packing) {
    const Cell& cell = packing.cell;
    std::array<double, 2> h{};
    if (cell.periodic[1]) {
        h[1] = packing.lattice(1, 1);
    }
    if (cell.periodic[0]) {
        const double tilt = packing.lattice(0, 1);
        const double lean = cell.periodic[1] ? std::hypot(1, tilt / packing.lattice(1, 1)) : 1;
        h[0] = packing.lattice(0, 0) / lean;
    }
    return h;
}

/// Integers k with -margin <= s + k <= 1 + margin.
struct Range {
    int first = 0;
    int last = 0;
};

/// \pre |s| and the margin are below `farthest_disk`
Range range_of(double s, double margin) {
    return {static_cast<int>(std::ceil(-margin - s)), static_cast<int>(std::floor(1 + margin - s))};
}

/// So many periods apart may disks be whose gap is below `reach`. The rounding of s and of the heights moves an image
/// by far less than a hundredth of it.
std::array<double, 2> margin_of(const Packing& packing, double reach) {
    const double near = 1.01 * (2 * packing.max_radius() + reach);
    const std::array<double, 2> height = heights(packing);
    std::array<double, 2> margin{};
    for (std::size_t a = 0; a < 2; ++a) {
        margin[a] = packing.cell.periodic[a] ? near / height[a] + 1e-9 : 0;
    }
    return margin;
}

/// Largest size of a coordinate of the images, and of the cell.
double largest_length(const Packing& packing, const Images& images) {
    double largest = 0;
    for (const auto* q : {&packing.q, &images.packing.q}) {
        for (const double x : *q) {
            largest = std::max(largest, std::abs(x));
        }
    }
    return largest;
}

} // namespace

std::optional<std::string> disk_beyond(const Packing& packing, double reach, double most) {
    const std::array<double, 2> margin = margin_of(packing, reach);
    for (int i = 0; i < packing.disk_count(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const std::array<double, 2> s = fractional(packing, packing.q[2 * k], packing.q[2 * k + 1]);
        for (std::size_t a = 0; a < 2; ++a) {
            if (packing.cell.periodic[a] && !(std::abs(s[a]) < most && margin[a] < most - 1)) {
                return fmt::format("disk {} is {:.3g} periods from the origin and pairs up to {:.3g} periods apart may "
                                   "touch: expected less than {} (put it into the cell, or take a basis of short "
                                   "periods)",
                                   i, s[a], margin[a], most);
            }
        }
    }
    return std::nullopt;
}

Contact Images::contact(int a, int b) const {
    const auto from = static_cast<std::size_t>(a);
    const auto to = static_cast<std::size_t>(b);
    Image image;
    for (std::size_t k = 0; k < image.m.size(); ++k) {
        image.m[k] = static_cast<std::int8_t>(offset[to].m[k] - offset[from].m[k]);
    }
    return pair_of(disk[from], disk[to], image);
}

Images images_near_cell(const Packing& packing, double reach) {
    constexpr double most = 1e8;
    Images images;
    images.packing.walls = Walls::none();
    const std::array<double, 2> height = heights(packing);
    const std::array<double, 2> margin = margin_of(packing, reach);
    if (const auto beyond = disk_beyond(packing, reach, farthest_disk)) {
        throw Error(ErrorKind::bad_input, *beyond);
    }
    if (!((1 + 2 * margin[0]) * (1 + 2 * margin[1]) * packing.disk_count() < most)) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("the cell has heights {:.3g} and {:.3g}, disks up to {:.3g}: more than {:.0g} images "
                                "are near it; expected a basis of short periods",
                                height[0], height[1], packing.max_radius(), most));
    }
    for (int i = 0; i < packing.disk_count(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double x = packing.q[2 * k];
        const double y = packing.q[2 * k + 1];
        const std::array<double, 2> s = fractional(packing, x, y);
        std::array<Range, 2> range;
        for (std::size_t a = 0; a < 2; ++a) {
            range[a] = packing.cell.periodic[a] ? range_of(s[a], margin[a]) : Range{};
        }
        for (int m = range[0].first; m <= range[0].last; ++m) {
            for (int p = range[1].first; p <= range[1].last; ++p) {
                images.packing.radius.push_back(packing.radius[k]);
                images.packing.q.push_back(
                    x + (packing.cell.periodic[0] ? m * packing.lattice(0, 0) + p * packing.lattice(0, 1) : 0));
                images.packing.q.push_back(y + (packing.cell.periodic[1] ? p * packing.lattice(1, 1) : 0));
                images.disk.push_back(i);
                images.offset.push_back({{static_cast<std::int8_t>(m), static_cast<std::int8_t>(p), 0}});
            }
        }
    }
    // Each centre: two products and two sums per component, of numbers below 122 times the largest length.
    images.rounding = 0x1p-42 * largest_length(packing, images);
    images.packing.q.insert(images.packing.q.end(), {0, 0});
    return images;
}

} // namespace isostat
