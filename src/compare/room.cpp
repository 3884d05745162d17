#include "compare/room.hpp"

#include "contact/candidates.hpp"
#include "contact/separation.hpp"
#include "core/roundoff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::compare {

namespace {

/// Pairs with at least one rattler that are near.
class RattlerPairs {
  public:
    explicit RattlerPairs(const std::vector<unsigned char>& rattles) : rattles_(rattles) {}

    /// All that can overlap there: those found before while they are complete.
    const std::vector<Contact>& at(const Packing<2>& packing) {
        return !list_.reference.empty() && list_.covers(packing) ? pairs_ : found_at(packing);
    }
    /// Found anew: others are farther apart than half the smallest radius.
    const std::vector<Contact>& found_at(const Packing<2>& packing) {
        constexpr double reach = 0.5; // of the smallest radius; T6 allows up to 0.82
        list_ = find_candidates(packing, reach);
        pairs_.clear();
        for (const Contact& c : list_.contacts) {
            const bool second = c.kind == ContactKind::disk_disk && rattles_[static_cast<std::size_t>(c.j)] != 0;
            if (rattles_[static_cast<std::size_t>(c.i)] != 0 || second) {
                pairs_.push_back(c);
            }
        }
        return pairs_;
    }

  private:
    const std::vector<unsigned char>& rattles_;
    CandidateList<2> list_;
    std::vector<Contact> pairs_;
};

/// One sweep of projections: each pair that is nearer than `wanted` is parted by moving its rattlers.
void part(Packing<2>& packing, const std::vector<Contact>& pairs, const std::vector<unsigned char>& rattles,
          double wanted) {
    const std::size_t disks = 2 * packing.radius.size();
    for (const Contact& pair : pairs) {
        const double missing = wanted - gap(packing, pair);
        if (!(missing > 0)) {
            continue;
        }
        const GapGradient<2> gradient = gap_gradient(packing, pair);
        const auto moves = [&](int k) {
            const auto at = static_cast<std::size_t>(gradient.coordinate[static_cast<std::size_t>(k)]);
            return at < disks && rattles[at / 2] != 0;
        };
        double square = 0;
        for (int k = 0; k < gradient.count; ++k) {
            const double g = gradient.value[static_cast<std::size_t>(k)];
            square += moves(k) ? g * g : 0;
        }
        for (int k = 0; k < gradient.count; ++k) {
            if (moves(k)) {
                packing.q[static_cast<std::size_t>(gradient.coordinate[static_cast<std::size_t>(k)])] +=
                    missing / square * gradient.value[static_cast<std::size_t>(k)];
            }
        }
    }
}

/// Lower bound of the gap when every coordinate may be off by `radius`: rounding as in the centre of a certificate.
double lower_gap(const Packing<2>& packing, const Contact& pair, double radius) {
    using roundoff::u;
    const double h = gap(packing, pair);
    double length = std::abs(h) + touching_distance(packing.radius, pair);
    double off = pair.kind == ContactKind::disk_disk ? 1.4143 * 2 * radius : 2 * radius;
    if (!pair.image.is_here()) { // sums on the way to the separation, and the periods as many times as they enter
        const int periods = std::abs(pair.image.m[0]) + std::abs(pair.image.m[1]);
        off = 1.4143 * (2 + 2 * periods) * radius;
        const auto [low, high] = std::minmax_element(packing.q.begin(), packing.q.end());
        length += (2 + 2 * periods) * std::max(std::abs(*low), std::abs(*high));
    }
    return h - (off + 16 * u * length) * (1 + 0x1p-49);
}

/// The least of these bounds, and where.
struct Least {
    double gap = std::numeric_limits<double>::infinity();
    Contact pair;
};
Least least_gap(const Packing<2>& packing, const std::vector<Contact>& pairs, double radius) {
    Least out;
    for (const Contact& pair : pairs) {
        const double h = lower_gap(packing, pair, radius);
        out = h < out.gap ? Least{h, pair} : out;
    }
    return out;
}

} // namespace

std::string make_room(Snap& snap) {
    if (snap.rattlers.empty()) {
        return "";
    }
    std::vector<unsigned char> rattles(snap.packing.radius.size(), 0);
    for (const int i : snap.rattlers) {
        rattles[static_cast<std::size_t>(i)] = 1;
    }
    constexpr int rounds = 20, sweeps = 25; // whether the list of pairs is complete is asked in each round
    const double radius = snap.truth.claims.vertex->radius;
    RattlerPairs pairs(rattles);
    Packing<2> placed;
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
            least = least_gap(placed, pairs.found_at(placed), radius); // the proof asks for all pairs there
            if (least.gap > 0) {
                snap.packing = std::move(placed);
                snap.cage = least.gap;
                return "";
            }
        }
    }
    return fmt::format("a rattler found no room at the vertex of the list: {} stay {:.3g} apart",
                       to_string<2>(least.pair), gap(placed, least.pair));
}

} // namespace isostat::compare
