#include "contact/candidates.hpp"
#include "contact/separation.hpp"
#include "core/roundoff.hpp"
#include "snap/backbone.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::compare {

namespace {

/// Near pairs with at least one rattler.
class RattlerPairs {
  public:
    explicit RattlerPairs(const std::vector<unsigned char>& rattles) : rattles_(rattles) {}

    /// All pairs that can overlap at this packing: the known list while it is complete, otherwise a new one.
    const std::vector<Contact>& at(const Packing& packing) {
        return !list_.reference.empty() && list_.covers(packing) ? pairs_ : found_at(packing);
    }
    /// Makes a new list; other pairs are farther apart than half the smallest radius.
    const std::vector<Contact>& found_at(const Packing& packing) {
        constexpr double reach = 0.5; // in smallest radii; T6 allows up to 0.82
        list_ = find_candidates(packing, reach);
        pairs_.clear();
        for (const Contact& c : list_.contacts) {
            const bool second = c.of_disks() && rattles_[static_cast<std::size_t>(c.j)] != 0;
            if (rattles_[static_cast<std::size_t>(c.i)] != 0 || second) {
                pairs_.push_back(c);
            }
        }
        return pairs_;
    }

  private:
    const std::vector<unsigned char>& rattles_;
    CandidateList list_;
    std::vector<Contact> pairs_;
};

/// One sweep of projections: each pair that is nearer than `wanted` is parted by moving its rattlers.
void part(Packing& packing, const std::vector<Contact>& pairs, const std::vector<unsigned char>& rattles,
          double wanted) {
    const std::size_t disks = packing.length_at(0);
    for (const Contact& pair : pairs) {
        const double missing = wanted - gap(packing, pair);
        if (!(missing > 0)) {
            continue;
        }
        const GapGradient gradient = gap_gradient(packing, pair);
        const auto moves = [&](std::size_t k) { return k < disks && rattles[k / packing.axes()] != 0; };
        double square = 0;
        gradient.for_each([&](std::size_t k, double g) { square += moves(k) ? g * g : 0; });
        gradient.for_each([&](std::size_t k, double g) {
            if (moves(k)) {
                packing.q[k] += missing / square * g;
            }
        });
    }
}

/// Upper bound of the diagonal of a unit square or cube.
double diagonal(const Packing& packing) {
    return packing.dimension == plane ? 1.4143 : 1.7321;
}

/// Bounds of a gap when every coordinate may be off by `radius`; rounding is bounded as in the centre of a certificate.
struct GapBounds {
    double lower, upper;
};
GapBounds gap_bounds(const Packing& packing, const Contact& pair, double radius) {
    using roundoff::u;
    const double h = gap(packing, pair);
    double length = std::abs(h) + touching_distance(packing.radius, pair);
    double off = pair.of_disks() ? diagonal(packing) * 2 * radius : 2 * radius;
    if (!pair.image.is_here()) { // the separation has sums of coordinates, and each period m times
        const int periods = std::abs(pair.image.m[0]) + std::abs(pair.image.m[1]) + std::abs(pair.image.m[2]);
        off = diagonal(packing) * (2 + 2 * periods) * radius;
        const auto [low, high] = std::ranges::minmax_element(packing.q);
        length += (2 + 2 * periods) * std::max(std::abs(*low), std::abs(*high));
    }
    const double error = (off + 16 * u * length) * (1 + 0x1p-49);
    return {h - error, h + error};
}

/// The smallest lower bound, and its pair.
struct Least {
    double gap = std::numeric_limits<double>::infinity();
    Contact pair;
};
Least least_gap(const Packing& packing, const std::vector<Contact>& pairs, double radius) {
    Least out;
    for (const Contact& pair : pairs) {
        const double h = gap_bounds(packing, pair, radius).lower;
        out = h < out.gap ? Least{h, pair} : out;
    }
    return out;
}

/// Proves that a rattler overlaps a grain of the list at every point of a square or cube. This is divided until each
/// part is within one grain: the gap to a grain changes by at most the displacement of the rattler.
class Covering {
  public:
    /// `pairs`: those of the rattler with grains of the list; `radius`: bound of the error of their coordinates.
    Covering(Packing packing, std::vector<Contact> pairs, std::size_t rattler, double radius)
        : packing_(std::move(packing)), pairs_(std::move(pairs)), rattler_(packing_.axes() * rattler), radius_(radius) {
    }

    /// False when no proof was found.
    bool holds(double half_side) {
        PerAxis<double> centre{};
        std::copy_n(&packing_.q[rattler_], packing_.axes(), centre.begin());
        return covered(centre, half_side);
    }

  private:
    bool covered(const PerAxis<double>& centre, double half) {
        constexpr int most = 100'000; // largest number of parts
        if (++parts_ > most) {
            return false;
        }
        const std::size_t d = packing_.axes();
        std::copy_n(centre.begin(), d, &packing_.q[rattler_]);
        // The distance to a corner; a centre was rounded at most 25 times.
        const double size = std::abs(centre[0]) + std::abs(centre[1]) + std::abs(centre[2]);
        const double way = diagonal(packing_) * half + 64 * roundoff::u * size;
        if (std::ranges::any_of(
                pairs_, [&](const Contact& pair) { return gap_bounds(packing_, pair, radius_).upper + way < 0; })) {
            return true;
        }
        const double next = half / 2;
        if (!(next > 1e-8 * packing_.min_radius())) {
            return false;
        }
        bool all = true;
        for (std::size_t part = 0; all && part < std::size_t{1} << d; ++part) {
            PerAxis<double> corner = centre;
            for (std::size_t a = 0; a < d; ++a) {
                corner[a] += ((part >> a) & 1U) != 0 ? next : -next;
            }
            all = covered(corner, next);
        }
        return all;
    }

    Packing packing_;
    std::vector<Contact> pairs_;
    std::size_t rattler_;
    double radius_;
    int parts_ = 0;
};

std::vector<unsigned char> marked(const Snap& snap) {
    std::vector<unsigned char> rattles(snap.packing.radius.size(), 0);
    for (const int i : snap.rattlers) {
        rattles[static_cast<std::size_t>(i)] = 1;
    }
    return rattles;
}

} // namespace

std::string without_room(const Snap& snap) {
    const std::vector<unsigned char> rattles = marked(snap);
    const std::vector<Contact> near = RattlerPairs(rattles).found_at(snap.packing);
    const double half_side = snap.packing.min_radius() / 4;
    for (const int rattler : snap.rattlers) {
        std::vector<Contact> pairs;
        for (const Contact& pair : near) {
            const bool disks = pair.of_disks();
            const int other = disks ? (pair.i == rattler ? pair.j : pair.i) : -1;
            if ((pair.i == rattler || (disks && pair.j == rattler)) &&
                (!disks || rattles[static_cast<std::size_t>(other)] == 0)) {
                pairs.push_back(pair);
            }
        }
        Covering covering(snap.packing, std::move(pairs), static_cast<std::size_t>(rattler),
                          snap.truth.claims.vertex->radius);
        if (covering.holds(half_side)) {
            return fmt::format(
                "rattler {} has no room at the vertex of the list: it overlaps wherever it is put within "
                "{:.3g} of its place",
                rattler, half_side);
        }
    }
    return "";
}

std::string make_room(Snap& snap) {
    if (snap.rattlers.empty()) {
        return "";
    }
    const std::vector<unsigned char> rattles = marked(snap);
    constexpr int rounds = 20, sweeps = 25; // each round checks whether the list of pairs is complete
    const double radius = snap.truth.claims.vertex->radius;
    RattlerPairs pairs(rattles);
    Packing placed;
    Least least;
    for (const double margin : {1e-2, 1e-4, 1e-6, 1e-9}) { // wanted gap in smallest radii
        placed = snap.packing;
        const double wanted = margin * placed.min_radius();
        for (int k = 0; k < rounds; ++k) {
            const std::vector<Contact>& near = pairs.at(placed);
            for (int sweep = 0; sweep < sweeps; ++sweep) {
                part(placed, near, rattles, wanted);
            }
            least = least_gap(placed, near, radius);
            if (!(least.gap > 0)) {
                continue;
            }
            least = least_gap(placed, pairs.found_at(placed), radius); // the proof requires all pairs of this packing
            if (least.gap > 0) {
                snap.packing = std::move(placed);
                snap.cage = least.gap;
                return "";
            }
        }
    }
    return fmt::format("a rattler found no room at the vertex of the list: {} stay {:.3g} apart",
                       to_string(least.pair, placed.dimension), gap(placed, least.pair));
}

} // namespace isostat::compare
