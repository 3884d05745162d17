#include "contact/cell_drift.hpp"

#include "core/roundoff.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isostat {

namespace {

using roundoff::infinity;

/// The smallest and the largest of the numbers it is shown.
struct Extent {
    double low = infinity;
    double high = -infinity;
    void show(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
    [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// The strain E with A - A_0 = E A_0; 0 along axes with walls. And a bound of |A_0^-1|.
struct Strain {
    double xx = 0, xy = 0, yy = 0;
    double inverse = 0;

    Strain(const std::vector<double>& reference, const Packing<2>& packing) {
        const std::size_t at = packing.length_at(0);
        const double lx = reference[at];
        const double ly = reference[at + 1];
        const double tilt = reference[at + 2];
        const Cell<2>& cell = packing.cell;
        const double along_x = (packing.q[at] - lx) / lx;
        xx = cell.periodic[0] ? along_x : 0;
        yy = cell.periodic[1] ? (packing.q[at + 1] - ly) / ly : 0;
        xy = cell.all() ? (packing.q[at + 2] - tilt - along_x * tilt) / ly : 0;
        inverse = cell.all() ? std::hypot(lx, tilt, ly) / lx / ly : cell.periodic[0] ? 1 / lx : 1 / ly;
    }
    [[nodiscard]] double norm() const { return std::hypot(xx, xy, yy); }
};

} // namespace

CellDrift cell_drift(const CandidateList<2>& list, const Packing<2>& packing) {
    if (list.reference.size() != packing.q.size()) {
        return {infinity, 1};
    }
    const std::vector<double>& from = list.reference;
    const std::size_t disks = 2 * packing.radius.size();
    const Strain strain(from, packing);
    std::array<Extent, 2> place;
    double largest = 0;
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        if (k < disks) {
            place[k % 2].show(from[k]);
        }
        largest = std::max({largest, std::abs(from[k]), std::abs(packing.q[k])});
    }
    std::array<Extent, 2> range;
    std::vector<double> w(disks);
    double extent = 0; // of the centres, from the middle
    for (std::size_t k = 0; k < disks; k += 2) {
        const double x = from[k] - place[0].middle();
        const double y = from[k + 1] - place[1].middle();
        extent = std::max(extent, std::hypot(x, y));
        w[k] = packing.q[k] - from[k] - (strain.xx * x + strain.xy * y);
        w[k + 1] = packing.q[k + 1] - from[k + 1] - strain.yy * y;
        range[0].show(w[k]);
        range[1].show(w[k + 1]);
    }
    std::array<double, 2> common{};
    double farthest = 0;
    for (std::size_t a = 0; a < 2; ++a) {
        if (packing.cell.periodic[a]) {
            common[a] = range[a].middle();
        } else { // the upper wall is a grain
            farthest = std::max(farthest, std::abs(packing.q[packing.length_at(a)] - from[packing.length_at(a)]));
        }
    }
    for (std::size_t k = 0; k < disks; k += 2) {
        farthest = std::max(farthest, std::hypot(w[k] - common[0], w[k + 1] - common[1]));
    }
    const double stretched = packing.max_radius() + 0.5 * list.reach;
    constexpr double rounding = 0x1p-46; // of a dozen operations on lengths up to `largest`, times strains up to 8
    const double used = (farthest + strain.norm() * stretched) * (1 + 1e-12) + rounding * largest;
    const bool small = strain.norm() < 1; // else the bound of C8 says nothing
    return {small ? used : infinity, (1 + (extent + stretched) * strain.inverse) * (1 + 1e-9)};
}

} // namespace isostat
