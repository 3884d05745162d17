#include "contact/near_pairs.hpp"

#include "contact/candidates.hpp"
#include "contact/contact_set.hpp"
#include "contact/images.hpp"
#include "contact/separation.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace isostat {

namespace {

// Constants of proofs/contact_candidates.md, section "Rounded weights". Disks shrunk
// by the common shift 0.002 R_min^2 of their weights have exactly the power diagram
// of the rounded weights; an edge may overlap by half of what this shift allows.
constexpr double edge_overlap = 0.0005; // times R_min^2 (1/R_i + 1/R_j); contact_candidates.md Rounded weights
// contact_candidates.md Rounded weights: 0.82 R_min, and the rest for the rounding of images
constexpr double largest_reach = 0.825;
// contact_candidates.md 1e5
constexpr double largest_ratio = 1e5; // beyond it the rounding of R_max^2 is not small compared with the shift

/// Gaps with a bound of their rounding: 8 u times the lengths that enter, for any coordinates.
class Gaps {
  public:
    struct Gap {
        double value;
        double error;
        [[nodiscard]] bool may_be_below(double reach) const { return value - error < reach; }
    };
    explicit Gaps(const Packing& packing) : packing_(packing), plain_(lengths_are_plain(packing.q, packing.radius)) {}

    [[nodiscard]] Gap of(const Contact& pair) const {
        const auto [dx, dy, dz] = separation(packing_.layout(), packing_.q, pair);
        const double distance =
            plain_ ? std::sqrt(dx * dx + dy * dy + dz * dz) : std::hypot(dx, dy, dz); // slow; error below 1 ulp
        const double radii = touching_distance(packing_.radius, pair);
        // contact_candidates.md Filters (8u)
        return {distance - radii, 0x1p-50 * (distance + radii + lengths_of_image(packing_, pair))};
    }

  private:
    const Packing& packing_;
    bool plain_;
};

/// `for_each_edge(visit)`: visit(i, j), i < j, of a regular triangulation.
template <class Edges>
std::optional<std::vector<Contact>> near_among(const Packing& packing, double reach, Edges for_each_edge) {
    const Gaps gaps(packing);
    const double smallest = packing.min_radius();
    const auto share = [&](std::size_t i) { return smallest / packing.radius[i]; };
    std::vector<Contact> pairs;
    pairs.reserve(3 * packing.radius.size()); // cost: memory reserved
    bool applies = true;
    for_each_edge([&](int first, int second) {
        const auto i = static_cast<std::size_t>(first);
        const auto j = static_cast<std::size_t>(second);
        const Contact pair{ContactKind::disk_disk, first, second};
        const auto gap = gaps.of(pair);
        applies = applies && (gap.value >= 0 || gap.value >= -edge_overlap * smallest * (share(i) + share(j)));
        if (gap.may_be_below(reach)) {
            pairs.push_back(pair);
        }
    });
    if (!applies) {
        return std::nullopt;
    }
    return ContactSet(pairs, packing.disk_count()).take_sorted();
}

} // namespace

std::optional<std::vector<Contact>> near_edges(const Packing& packing, double reach,
                                               const RegularTriangulation& triangulation) {
    return near_among(packing, reach, [&](auto visit) { triangulation.for_each_edge(visit); });
}

std::optional<std::vector<Contact>> near_edges_in_space(const Packing& packing, double reach) {
    const auto edges = regular_edges_in_space(packing);
    return !edges ? std::nullopt : near_among(packing, reach, [&](auto visit) {
        for (const auto& [i, j] : *edges) {
            visit(i, j);
        }
    });
}

std::vector<Contact> pairs_within(const Packing& packing, double reach, int most_per_disk) {
    const bool repeats = packing.cell.any();
    const Images images = repeats ? images_near_cell(packing, reach) : Images();
    const Packing& among = repeats ? images.packing : packing;
    const int most = most_per_disk * std::min(among.disk_count(), std::numeric_limits<int>::max() / most_per_disk);
    PairList list;
    find_pairs(packing.dimension, among.q, among.radius, reach + images.rounding, list, most);
    const Gaps gaps(packing);
    std::vector<Contact> pairs;
    for (int i = 0; i < among.disk_count(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        for (int p = list.start[k]; p < list.start[k + 1]; ++p) {
            const int j = list.partner[static_cast<std::size_t>(p)];
            const Contact pair = repeats ? images.contact(i, j) : pair_of(i, j);
            if (gaps.of(pair).may_be_below(reach)) {
                pairs.push_back(pair);
            }
        }
    }
    if (repeats) { // a pair and its copy moved by a period
        std::ranges::sort(pairs);
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    }
    without_hidden_pairs(pairs, packing);
    return pairs;
}

namespace {

NearPairs near_disks(const Packing& packing, double reach, const std::shared_ptr<const RegularTriangulation>& from) {
    using Triangulation = RegularTriangulation;
    const bool applies = !packing.cell.any() && reach <= largest_reach * packing.min_radius();
    if (applies && packing.disk_count() > 0 && lengths_are_plain(packing.q, packing.radius) &&
        packing.max_radius() <= largest_ratio * packing.min_radius()) {
        if (packing.dimension > plane) {
            auto pairs = near_edges_in_space(packing, reach);
            return {pairs ? std::move(*pairs) : pairs_within(packing, reach), nullptr};
        }
        auto triangulation =
            from && from->disk_count() == packing.disk_count() ? Triangulation::carry(from, packing) : nullptr;
        if (!triangulation) {
            triangulation = Triangulation::build(packing);
        }
        if (triangulation) {
            if (auto pairs = near_edges(packing, reach, *triangulation)) {
                return {std::move(*pairs), std::move(triangulation)};
            }
        }
    }
    return {pairs_within(packing, reach), nullptr};
}

} // namespace

void without_hidden_pairs(std::vector<Contact>& pairs, const Packing& packing) {
    if (packing.bars.empty()) {
        return;
    }
    const Bodies bodies(packing);
    const ArcBodies arcs(packing);
    std::erase_if(pairs, [&](const Contact& pair) {
        const bool own = pair.of_disks() && pair.image.is_here() && bodies.of(pair.i) == bodies.of(pair.j);
        return own || !arcs.is_nearest(pair);
    });
}

NearPairs near_pairs(const Packing& packing, double reach, const std::shared_ptr<const RegularTriangulation>& from) {
    NearPairs near = near_disks(packing, reach, from);
    without_hidden_pairs(near.pairs, packing);
    return near;
}

std::vector<Contact> near_contacts(const Packing& packing, double reach, double upper_reach) {
    const bool repeats = packing.cell.any();
    std::vector<Contact> near = pairs_within(packing, repeats ? reach + upper_reach : reach);
    if (repeats) {
        std::erase_if(near, [&](const Contact& c) { return c.image.is_here() && !(gap(packing, c) < reach); });
    }
    for (const WallFacts& facts : wall_facts) {
        for (int i = 0; i < packing.disk_count(); ++i) {
            for (int a = 0; a < packing.dimension; ++a) {
                const Contact wall{facts.kind, i, a};
                if (packing.walls.of(wall) != WallKind::absent &&
                    gap(packing, wall) < (facts.at_length ? upper_reach : reach)) {
                    near.push_back(wall);
                }
            }
        }
    }
    return near;
}

} // namespace isostat
