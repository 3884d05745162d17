#include "contact/near_pairs.hpp"
#include "contact/pair_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace isostat {

namespace {

constexpr double largest_ratio = 4; // beyond it a cell of the size of the largest disks holds many of the smallest

} // namespace

template <> std::optional<std::vector<Contact>> near_pairs_by_cells<2>(const Packing<2>& packing, double reach) {
    const std::size_t n = packing.radius.size();
    if (n == 0) {
        return std::vector<Contact>();
    }
    const double largest = packing.max_radius();
    std::array<double, 2> low{packing.q[0], packing.q[1]};
    std::array<double, 2> high = low;
    for (std::size_t k = 0; k < 2 * n; ++k) {
        low[k % 2] = std::min(low[k % 2], packing.q[k]);
        high[k % 2] = std::max(high[k % 2], packing.q[k]);
    }
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    if (largest > largest_ratio * packing.min_radius() || !distances_are_plain(packing)) {
        return std::nullopt;
    }
    // Pairs with a gap below the reach are in the same or in neighbouring cells: their positions in units of `cell`
    // differ by less than 1/1.01, and the rounding of positions up to 2^20 is far below the rest. Not many more cells
    // than disks.
    const double most = static_cast<double>(std::min(n, std::size_t{1} << 20)); // along an axis
    const double area_of_one = (high[0] - low[0]) * (high[1] - low[1]) / static_cast<double>(n);
    const double cell = std::max({1.01 * (2 * largest + reach), std::sqrt(area_of_one), extent / most});
    const auto index = [&](double x, std::size_t axis) { return static_cast<std::size_t>((x - low[axis]) / cell); };
    const std::size_t columns = index(high[0], 0) + 1;
    const std::size_t rows = index(high[1], 1) + 1;
    // Disks by cells, row by row, with what is asked of them side by side.
    struct Disk {
        double x, y, radius;
        int number;
    };
    std::vector<std::size_t> cell_of(n);
    std::vector<std::size_t> start(rows * columns + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        cell_of[i] = index(packing.q[2 * i + 1], 1) * columns + index(packing.q[2 * i], 0);
        ++start[cell_of[i] + 1];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<Disk> disks(n);
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    for (std::size_t i = 0; i < n; ++i) {
        disks[next[cell_of[i]]++] = {packing.q[2 * i], packing.q[2 * i + 1], packing.radius[i], static_cast<int>(i)};
    }
    std::vector<Contact> pairs;
    pairs.reserve(4 * n);
    const auto compare = [&](const Disk& a, std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            const Disk& b = disks[k];
            const double dx = b.x - a.x;
            const double dy = b.y - a.y;
            const double square = dx * dx + dy * dy;
            const double limit = a.radius + b.radius + reach;
            if (square > 1.001 * limit * limit) { // farther than any rounding: no root is needed
                continue;
            }
            const Distance d = distance_of(square, a.radius + b.radius);
            if (d.gap - d.error < reach) {
                pairs.push_back({ContactKind::disk_disk, std::min(a.number, b.number), std::max(a.number, b.number)});
            }
        }
    };
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            const std::size_t here = row * columns + column;
            const std::size_t end = start[here + (column + 1 < columns ? 2 : 1)]; // of the next cell in the row
            const std::size_t above = here + columns;
            for (std::size_t k = start[here]; k < start[here + 1]; ++k) {
                compare(disks[k], k + 1, end);
                if (row + 1 < rows) {
                    compare(disks[k], start[above - (column > 0 ? 1 : 0)],
                            start[above + (column + 1 < columns ? 2 : 1)]);
                }
            }
        }
    }
    sort_pairs(pairs, n);
    return pairs;
}

} // namespace isostat
