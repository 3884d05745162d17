#include "contact/candidates.hpp"
#include "core/dot.hpp"
#include "core/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using roundoff::infinity;

/// The smallest and the largest of the numbers added so far.
struct Extent {
    double low = infinity;
    double high = -infinity;
    void show(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
    [[nodiscard]] double middle() const { return 0.5 * (low + high); } // exact: a half (cells.md C8)
};

double length_of(const Packing& packing, const PerAxis<double>& x) {
    return packing.dimension == plane ? std::hypot(x[0], x[1]) : std::hypot(x[0], x[1], x[2]);
}

/// The strain E = dA A_0^-1 of a change dA of the cell, upper triangular; 0 along axes with
/// walls. And a bound of |A_0^-1|.
struct Strain {
    PerAxis<PerAxis<double>> e{};
    double inverse = 0;

    /// `moved(k)`: the change of coordinate k of `Packing::q`.
    template <class Moved> Strain(const std::vector<double>& reference, const Packing& packing, const Moved& moved) {
        const auto& periodic = packing.cell.periodic;
        PerAxis<PerAxis<double>> inverted{};
        for (std::size_t b = 0; b < packing.axes(); ++b) {
            for (std::size_t a = 0; a <= b && periodic[b]; ++a) {
                if (!periodic[a]) {
                    continue;
                }
                double change = moved(place(packing, a, b));
                double unit = a == b ? 1 : 0;
                for (std::size_t c = a; c < b; ++c) {
                    const double above = periodic[c] ? reference[place(packing, c, b)] : 0;
                    change -= e[a][c] * above;
                    unit -= inverted[a][c] * above;
                }
                e[a][b] = change / reference[place(packing, b, b)];
                inverted[a][b] = unit / reference[place(packing, b, b)];
            }
        }
        const std::size_t at = packing.length_at(0);
        inverse =
            packing.dimension == plane && packing.cell.all()
                ? std::hypot(reference[at], reference[at + 2], reference[at + 1]) / reference[at] / reference[at + 1]
                : norm(inverted);
    }
    /// Frobenius norm.
    static double norm(const PerAxis<PerAxis<double>>& m) {
        return std::hypot(std::hypot(m[0][0], m[0][1], m[1][1]), std::hypot(m[0][2], m[1][2], m[2][2]));
    }
    /// Coordinate index of A_ab.
    static std::size_t place(const Packing& packing, std::size_t a, std::size_t b) {
        return a == b ? packing.length_at(a) : packing.tilt_at(a, b);
    }
};

// cells.md C8 (roundings)
constexpr double rounding = 0x1p-46; // for two dozen operations on lengths, times strains below 1

/// The left-hand side of C8 for a displacement, without its roundings: moved(k) of coordinate k.
struct Used {
    double used = 0;
    double rate = 1;
    double strain = 0;

    template <class Moved> Used(const CandidateList& list, const Packing& packing, Moved moved) {
        const std::vector<double>& from = list.reference;
        const std::size_t axes = packing.axes();
        const std::size_t disks = packing.length_at(0);
        const Strain affine(from, packing, moved);
        PerAxis<Extent> place;
        for (std::size_t k = 0; k < disks; ++k) {
            place[k % axes].show(from[k]);
        }
        PerAxis<Extent> range;
        std::vector<double> w(disks);
        double extent = 0; // of the centres, from the middle
        for (std::size_t k = 0; k < disks; k += axes) {
            PerAxis<double> x{};
            for (std::size_t a = 0; a < axes; ++a) {
                x[a] = from[k + a] - place[a].middle();
            }
            extent = std::max(extent, length_of(packing, x));
            for (std::size_t a = 0; a < axes; ++a) {
                double strained = 0;
                for (std::size_t b = a; b < axes; ++b) {
                    strained += affine.e[a][b] * x[b];
                }
                w[k + a] = moved(k + a) - strained;
                range[a].show(w[k + a]);
            }
        }
        PerAxis<double> common{};
        double farthest = 0;
        for (std::size_t a = 0; a < axes; ++a) {
            if (packing.cell.periodic[a]) {
                common[a] = range[a].middle();
            } else { // the upper wall is a grain
                farthest = std::max(farthest, std::abs(moved(packing.length_at(a))));
            }
        }
        for (std::size_t k = 0; k < disks; k += axes) {
            PerAxis<double> off{};
            for (std::size_t a = 0; a < axes; ++a) {
                off[a] = w[k + a] - common[a];
            }
            farthest = std::max(farthest, length_of(packing, off));
        }
        const double stretched = packing.max_radius() + 0.5 * list.reach; // exact: a half (cells.md C8)
        strain = Strain::norm(affine.e);
        used = (farthest + strain * stretched) * (1 + 1e-12);            // cells.md C8 (last operations)
        rate = (1 + (extent + stretched) * affine.inverse) * (1 + 1e-9); // cells.md C8 (last operations)
    }
};

} // namespace

CellDrift cell_drift(const CandidateList& list, const Packing& packing) {
    if (list.reference.size() != packing.q.size()) {
        return {infinity, 1};
    }
    const Used left(list, packing, [&](std::size_t k) { return packing.q[k] - list.reference[k]; });
    const double size = std::max(largest(list.reference), largest(packing.q));
    const bool small = left.strain < 1; // otherwise C8 does not apply
    return {small ? left.used + rounding * size : infinity, left.rate};
}

double drift_along(const CandidateList& list, const Packing& packing, const std::vector<double>& displacement) {
    const Used left(list, packing, [&](std::size_t k) { return displacement[k]; });
    return left.used + rounding * largest(displacement) * left.rate;
}

} // namespace isostat
