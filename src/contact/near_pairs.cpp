#include "contact/near_pairs.hpp"

#include "contact/candidates.hpp"
#include "contact/images.hpp"
#include "contact/separation.hpp"
#include "core/roundoff.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace isostat {

namespace {

using roundoff::u;

// Constants of proofs/contact_candidates.md, section "Rounded weights". Disks shrunk by the common shift 0.002 R_min^2
// of their weights have exactly the power diagram of the rounded weights; an edge may overlap by half of what that
// shift allows.
constexpr double edge_overlap = 0.0005;   // times R_min^2 (1/R_i + 1/R_j)
constexpr double largest_reach = 0.825;   // times R_min; T6 allows 0.828: room for the rounding of images
constexpr double largest_ratio = 1e5;     // beyond it the rounding of R_max^2 is not small against the shift
constexpr double largest_scale = 1e100;   // squares neither overflow
constexpr double smallest_scale = 1e-100; // nor underflow

/// Whether no square of a length that matters under- or overflows.
bool lengths_are_plain(const Packing& packing) {
    return packing.min_radius() >= smallest_scale && packing.max_radius() <= largest_scale &&
           std::all_of(packing.q.begin(), packing.q.end(),
                       [](double x) { return std::abs(x) <= largest_scale; }); // also false for a NaN
}

/// Gaps with a bound of their rounding: 8 u times the lengths that enter, for any coordinates.
class Gaps {
  public:
    struct Gap {
        double value;
        double error;
        [[nodiscard]] bool may_be_below(double reach) const { return value - error < reach; }
    };
    explicit Gaps(const Packing& packing) : packing_(packing), plain_(lengths_are_plain(packing)) {}

    [[nodiscard]] Gap of(const Contact& pair) const {
        const auto [dx, dy, none] = separation(packing_.layout(), packing_.q, pair);
        const double distance = plain_ ? std::sqrt(dx * dx + dy * dy) : std::hypot(dx, dy); // slow; error below 1 ulp
        const double radii = touching_distance(packing_.radius, pair);
        return {distance - radii, 0x1p-50 * (distance + radii + lengths_of_image(packing_, pair))};
    }

  private:
    const Packing& packing_;
    bool plain_;
};

/// Pairs of images, by the cell.
std::vector<Contact> near_pairs_in_cell(const Packing& packing, double reach) {
    const Images images = images_near_cell(packing, reach);
    const Gaps gaps(packing);
    std::vector<Contact> pairs;
    const double wide = reach + images.rounding;
    const bool allowed = wide <= largest_reach * images.packing.min_radius();
    for (const Contact& pair :
         allowed ? near_pairs(images.packing, wide).pairs : near_pairs_by_sweep(images.packing, wide)) {
        const Contact contact = images.contact(pair.i, pair.j);
        if (gaps.of(contact).may_be_below(reach)) {
            pairs.push_back(contact);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

// Buckets by the first disk, each a few pairs long.
void sort_pairs(std::vector<Contact>& pairs, std::size_t disk_count) {
    std::vector<std::size_t> end(disk_count + 1, 0);
    for (const Contact& pair : pairs) {
        ++end[static_cast<std::size_t>(pair.i) + 1];
    }
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<Contact> sorted(pairs.size());
    std::vector<std::size_t> next(end.begin(), end.end() - 1);
    for (const Contact& pair : pairs) {
        sorted[next[static_cast<std::size_t>(pair.i)]++] = pair;
    }
    for (std::size_t i = 0; i < disk_count; ++i) {
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(end[i]),
                  sorted.begin() + static_cast<std::ptrdiff_t>(end[i + 1]));
    }
    pairs = std::move(sorted);
}

} // namespace

std::optional<std::vector<Contact>> near_edges(const Packing& packing, double reach,
                                               const RegularTriangulation& triangulation) {
    const Gaps gaps(packing);
    const double smallest = packing.min_radius();
    const auto share = [&](std::size_t i) { return smallest / packing.radius[i]; };
    std::vector<Contact> pairs;
    pairs.reserve(3 * packing.radius.size());
    bool applies = true;
    triangulation.for_each_edge([&](int first, int second) {
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
    sort_pairs(pairs, packing.radius.size());
    return pairs;
}

std::vector<Contact> near_pairs_by_sweep(const Packing& packing, double reach) {
    const std::size_t n = packing.radius.size();
    std::vector<std::pair<double, std::size_t>> left(n);
    double extent = reach;
    for (std::size_t i = 0; i < n; ++i) {
        left[i] = {packing.q[2 * i] - packing.radius[i], i};
        extent = std::max({extent, std::abs(packing.q[2 * i]) + packing.radius[i], std::abs(packing.q[2 * i + 1])});
    }
    std::sort(left.begin(), left.end());
    const double slack = reach + 128 * u * extent;
    const Gaps gaps(packing);
    std::vector<Contact> pairs;
    for (std::size_t a = 0; a < n; ++a) {
        const std::size_t i = left[a].second;
        const double right = packing.q[2 * i] + packing.radius[i] + slack;
        for (std::size_t b = a + 1; b < n && left[b].first <= right; ++b) {
            const std::size_t j = left[b].second;
            const Contact pair{ContactKind::disk_disk, static_cast<int>(std::min(i, j)),
                               static_cast<int>(std::max(i, j))};
            if (std::abs(separation(packing.layout(), packing.q, pair)[1]) >
                touching_distance(packing.radius, pair) + slack) {
                continue; // apart along the other axis already
            }
            if (gaps.of(pair).may_be_below(reach)) {
                pairs.push_back(pair);
            }
        }
    }
    sort_pairs(pairs, n);
    return pairs;
}

NearPairs near_pairs(const Packing& packing, double reach, const std::shared_ptr<const RegularTriangulation>& from) {
    using Triangulation = RegularTriangulation;
    if (packing.cell.any()) {
        return {near_pairs_in_cell(packing, reach), nullptr};
    }
    assert(reach > 0 && reach <= largest_reach * packing.min_radius());
    if (packing.disk_count() > 0 && lengths_are_plain(packing) &&
        packing.max_radius() <= largest_ratio * packing.min_radius()) {
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
    return {near_pairs_by_sweep(packing, reach), nullptr};
}

} // namespace isostat
