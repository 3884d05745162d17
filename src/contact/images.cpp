#include "contact/images.hpp"

#include "core/dot.hpp"
#include "packing/cell_wrap.hpp"
#include "packing/words.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace isostat {

namespace {

/// A_aa, or 1 along an axis with walls, whose tilts are 0.
double period_of(const Packing& packing, std::size_t a) {
    return packing.cell.periodic[a] ? packing.lattice(a, a) : 1;
}

/// A_ab, or 0 where an axis has walls or is not there.
double tilt_of(const Packing& packing, std::size_t a, std::size_t b) {
    return b < packing.axes() && packing.cell.periodic[a] && packing.cell.periodic[b] ? packing.lattice(a, b) : 0;
}

/// Fractional coordinates of a disk along the periodic axes, rounded; 0 along the others.
PerAxis<double> fractional(const Packing& packing, int disk) {
    PerAxis<double> s{};
    for (std::size_t a = packing.axes(); a-- > 0;) {
        double rest = packing.cell.periodic[a] ? packing.coordinate(DiskId(disk), static_cast<int>(a)) : 0;
        for (std::size_t b = a + 1; b < packing.axes(); ++b) {
            rest -= s[b] * tilt_of(packing, a, b);
        }
        s[a] = rest / period_of(packing, a);
    }
    return s;
}

/// Distance of the two sides of the cell along each periodic axis: 1 / |row of A^-1|.
PerAxis<double> heights(const Packing& packing) {
    const double y = tilt_of(packing, 0, 1) / period_of(packing, 1);
    PerAxis<double> lean{std::hypot(1, y), 1, 1};
    if (packing.dimension > plane) {
        const double height = period_of(packing, 2);
        lean[0] = std::hypot(1, y, (y * tilt_of(packing, 1, 2) - tilt_of(packing, 0, 2)) / height);
        lean[1] = std::hypot(1, tilt_of(packing, 1, 2) / height);
    }
    PerAxis<double> h{};
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        h[a] = packing.cell.periodic[a] ? packing.lattice(a, a) / lean[a] : 0;
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

/// Largest distance, in periods, of disks with a gap below `reach`. The rounding of s and of the heights moves an image
/// by far less than a hundredth of this margin.
PerAxis<double> margin_of(const Packing& packing, double reach) {
    const double near = 1.01 * (2 * packing.max_radius() + reach); // cells.md C3, a hundredth wider
    const PerAxis<double> height = heights(packing);
    PerAxis<double> margin{};
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        // cells.md C3, rounding of fractional coordinates
        margin[a] = packing.cell.periodic[a] ? near / height[a] + 1e-9 : 0;
    }
    return margin;
}

} // namespace

std::optional<std::string> disk_beyond(const Packing& packing, double reach, double most) {
    const PerAxis<double> margin = margin_of(packing, reach);
    for (int i = 0; i < packing.disk_count(); ++i) {
        const PerAxis<double> s = fractional(packing, i);
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            if (packing.cell.periodic[a] && !(std::abs(s[a]) < most && margin[a] < most - 1)) {
                return fmt::format("{} {} is {:.3g} periods from the origin and pairs up to {:.3g} periods apart may "
                                   "touch: expected less than {} (put it into the cell, or take a basis of short "
                                   "periods)",
                                   grain_word(packing.dimension), i, s[a], margin[a], most);
            }
        }
    }
    return std::nullopt;
}

void Images::add(const Packing& of, int i, const std::array<int, most_axes>& m) {
    packing.radius.push_back(of.radius[static_cast<std::size_t>(i)]);
    disk.push_back(i);
    Image& here = offset.emplace_back();
    PerAxis<double> shift{};
    add_periods(shift, of, m);
    for (std::size_t a = 0; a < of.axes(); ++a) {
        packing.q.push_back(of.coordinate(DiskId(i), static_cast<int>(a)) + shift[a]);
        here.m[a] = static_cast<std::int8_t>(m[a]);
    }
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
    constexpr double most = 1e8; // cost: then the cell is refused
    Images images;
    images.packing.dimension = packing.dimension;
    images.packing.walls = Walls::none();
    const PerAxis<double> margin = margin_of(packing, reach);
    if (const auto beyond = disk_beyond(packing, reach, farthest_disk)) {
        throw Error(ErrorKind::bad_input, *beyond);
    }
    if (!((1 + 2 * margin[0]) * (1 + 2 * margin[1]) * (1 + 2 * margin[2]) * packing.disk_count() < most)) {
        std::string heights_text;
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            heights_text += fmt::format("{}{:.3g}", a == 0 ? "" : ", ", heights(packing)[a]);
        }
        throw Error(ErrorKind::bad_input,
                    fmt::format("the cell has heights {}, {}s up to {:.3g}: more than {:.0g} images are near it; "
                                "expected a basis of short periods",
                                heights_text, grain_word(packing.dimension), packing.max_radius(), most));
    }
    for (int i = 0; i < packing.disk_count(); ++i) {
        const PerAxis<double> s = fractional(packing, i);
        PerAxis<Range> range{};
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            range[a] = packing.cell.periodic[a] ? range_of(s[a], margin[a]) : Range{};
        }
        for (int x = range[0].first; x <= range[0].last; ++x) {
            for (int y = range[1].first; y <= range[1].last; ++y) {
                for (int z = range[2].first; z <= range[2].last; ++z) {
                    images.add(packing, i, {x, y, z});
                }
            }
        }
    }
    // cells.md C3, rounding of centres
    images.rounding = 0x1p-40 * std::max(largest(packing.q), largest(images.packing.q));
    images.packing.q.insert(images.packing.q.end(), packing.axes(), 0);
    return images;
}

} // namespace isostat
