#include "contact/cell_drift.hpp"

#include "core/dot.hpp"
#include "core/roundoff.hpp"

#include <algorithm>
#include <array>
#include <cassert>
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

/// The strain E = dA A_0^-1 of a change dA of the cell; 0 along axes with walls. And a bound of |A_0^-1|.
struct Strain {
    double xx = 0, xy = 0, yy = 0;
    double inverse = 0;

    /// `change`: dA as `Packing::q` has it.
    Strain(const std::vector<double>& reference, const Packing& packing, const std::array<double, 3>& change) {
        const std::size_t at = packing.length_at(0);
        const double lx = reference[at];
        const double ly = reference[at + 1];
        const double tilt = reference[at + 2];
        const Cell& cell = packing.cell;
        const double along_x = change[0] / lx;
        xx = cell.periodic[0] ? along_x : 0;
        yy = cell.periodic[1] ? change[1] / ly : 0;
        xy = cell.all() ? (change[2] - along_x * tilt) / ly : 0;
        inverse = cell.all() ? std::hypot(lx, tilt, ly) / lx / ly : cell.periodic[0] ? 1 / lx : 1 / ly;
    }
    [[nodiscard]] double norm() const { return std::hypot(xx, xy, yy); }
};

constexpr double rounding = 0x1p-46; // of a dozen operations on lengths, times strains up to 8

/// The left-hand side of C8 for a displacement, without its roundings: moved(k) of coordinate k.
struct Used {
    double used = 0;
    double rate = 1;
    double strain = 0;

    template <class Moved> Used(const CandidateList& list, const Packing& packing, Moved moved) {
        assert(packing.dimension == plane); // lists of spheres are not carried along
        const std::vector<double>& from = list.reference;
        const std::size_t disks = 2 * packing.radius.size();
        const Strain affine(from, packing, {moved(disks), moved(disks + 1), moved(disks + 2)});
        std::array<Extent, 2> place;
        for (std::size_t k = 0; k < disks; ++k) {
            place[k % 2].show(from[k]);
        }
        std::array<Extent, 2> range;
        std::vector<double> w(disks);
        double extent = 0; // of the centres, from the middle
        for (std::size_t k = 0; k < disks; k += 2) {
            const double x = from[k] - place[0].middle();
            const double y = from[k + 1] - place[1].middle();
            extent = std::max(extent, std::hypot(x, y));
            w[k] = moved(k) - (affine.xx * x + affine.xy * y);
            w[k + 1] = moved(k + 1) - affine.yy * y;
            range[0].show(w[k]);
            range[1].show(w[k + 1]);
        }
        std::array<double, 2> common{};
        double farthest = 0;
        for (std::size_t a = 0; a < 2; ++a) {
            if (packing.cell.periodic[a]) {
                common[a] = range[a].middle();
            } else { // the upper wall is a grain
                farthest = std::max(farthest, std::abs(moved(packing.length_at(a))));
            }
        }
        for (std::size_t k = 0; k < disks; k += 2) {
            farthest = std::max(farthest, std::hypot(w[k] - common[0], w[k + 1] - common[1]));
        }
        const double stretched = packing.max_radius() + 0.5 * list.reach;
        strain = affine.norm();
        used = (farthest + strain * stretched) * (1 + 1e-12);
        rate = (1 + (extent + stretched) * affine.inverse) * (1 + 1e-9);
    }
};

} // namespace

CellDrift cell_drift(const CandidateList& list, const Packing& packing) {
    if (list.reference.size() != packing.q.size()) {
        return {infinity, 1};
    }
    const Used left(list, packing, [&](std::size_t k) { return packing.q[k] - list.reference[k]; });
    const double size = std::max(largest(list.reference), largest(packing.q));
    const bool small = left.strain < 1; // else the bound of C8 says nothing
    return {small ? left.used + rounding * size : infinity, left.rate};
}

double drift_along(const CandidateList& list, const Packing& packing, const std::vector<double>& displacement) {
    const Used left(list, packing, [&](std::size_t k) { return displacement[k]; });
    return left.used + rounding * largest(displacement) * left.rate;
}

} // namespace isostat
