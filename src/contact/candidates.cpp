#include "contact/candidates.hpp"

#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"
#include "core/work.hpp"
#include "packing/arc_bodies.hpp"

#include <isostat/core/machine.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace isostat {

namespace {

/// Calls visit(contact) for every disk and every wall that is there; of arcs for those nearest to it.
template <class Visit> void for_each_wall_contact(const Packing& packing, Visit visit) {
    const ArcBodies arcs(packing);
    for (int i = 0; i < packing.disk_count(); ++i) {
        packing.walls.for_each(packing.dimension, i, [&](const Contact& contact) {
            if (arcs.is_nearest(contact)) {
                visit(contact);
            }
        });
    }
}

/// Whether A m can change.
bool moves_with_cell(const Packing& packing, const Image& image) {
    const Cell& cell = packing.cell;
    bool moves = false;
    for (std::size_t b = 0; b < packing.axes(); ++b) {
        moves = moves || (image.m[b] != 0 && cell.period_moves[b]);
        for (std::size_t a = 0; a < b; ++a) {
            moves = moves || (image.m[b] != 0 && cell.tilt_moves[cell.tilt(a, b)]);
        }
    }
    return moves;
}

/// Bound on the rounding of a wall gap, from the lengths that enter.
double wall_rounding(const Packing& packing, const Contact& contact) {
    double lengths = 0;
    Separation(contact, packing.layout()).for_each_coordinate([&](std::size_t k, std::size_t, int) {
        lengths += std::abs(packing.q[k]);
    });
    // contact_candidates.md wall_rounding
    return 0x1p-51 * (lengths + packing.radius[static_cast<std::size_t>(contact.i)]);
}

} // namespace

bool can_move(const Packing& packing, const Contact& pair) {
    if (packing.cell.any() && pair.of_disks()) { // no disk is fixed there
        return pair.i != pair.j || moves_with_cell(packing, pair.image);
    }
    if (!packing.is_fixed(DiskId(pair.i))) {
        return true;
    }
    return pair.of_disks() ? !packing.is_fixed(DiskId(pair.j))
                           : pair.is_wall() && packing.walls.of(pair) == WallKind::movable;
}

std::optional<Contact> fixed_overlap(const Packing& packing) {
    std::optional<Contact> found;
    const auto look = [&](const Contact& pair) {
        if (!found && !can_move(packing, pair) && gap_sign(packing, pair, 0) < 0) {
            found = pair;
        }
    };
    if (packing.cell.any() || std::ranges::find(packing.fixed, 1) != packing.fixed.end()) {
        for (const Contact& pair :
             // contact_candidates.md Displacements (any reach finds overlaps)
             near_pairs(packing, 0.5 * packing.min_radius()).pairs) {
            look(pair);
        }
        for_each_wall_contact(packing, look);
    }
    return found;
}

bool CandidateList::covers(const Packing& packing, double radius) const {
    if (reference.size() != packing.q.size()) {
        return false;
    }
    if (packing.cell.any()) {
        const CellDrift drift = cell_drift(*this, packing);
        // 0.5: contact_candidates.md Displacements (half of the reach); 1e-14: contact_candidates.md
        // covers
        return drift.used + drift.rate * radius < 0.5 * reach * (1 - 1e-14);
    }
    // 1e-14 covers the rounding of the differences and of the norm.
    return reach * moved_in_box(packing) + radius < 0.5 * reach * (1 - 1e-14) &&
           std::ranges::none_of(packing.q, [](double x) { return std::isnan(x); });
}

double CandidateList::moved_in_box(const Packing& packing) const {
    const double unit = 1 / reach; // squares then neither under- nor overflow in any unit
    double most = 0;
    for (std::size_t k = 0; k + packing.axes() <= reference.size(); k += packing.axes()) {
        double square = 0;
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            const double d = unit * (packing.q[k + a] - reference[k + a]);
            square += d * d;
        }
        most = std::max(most, square);
    }
    return std::sqrt(most);
}

CandidateList find_candidates(const Packing& packing, double fraction,
                              const std::shared_ptr<const RegularTriangulation>& from) {
    assert(fraction > 0 && fraction <= largest_candidate_fraction);
    count_work(Work::candidate_searches);
    CandidateList list;
    list.reach = fraction * packing.min_radius();
    list.reference = packing.q;
    NearPairs near = near_pairs(packing, list.reach, from);
    list.contacts = std::move(near.pairs);
    list.triangulation = std::move(near.triangulation);
    if (!packing.fixed.empty() || packing.cell.any()) {
        std::erase_if(list.contacts, [&](const Contact& contact) { return !can_move(packing, contact); });
    }
    const std::size_t pairs = list.contacts.size();
    for_each_wall_contact(packing, [&](const Contact& contact) {
        if (gap(packing, contact) - wall_rounding(packing, contact) < list.reach && can_move(packing, contact)) {
            list.contacts.push_back(contact);
        }
    });
    const auto walls = list.contacts.begin() + static_cast<std::ptrdiff_t>(pairs);
    std::sort(walls, list.contacts.end());
    std::inplace_merge(list.contacts.begin(), walls, list.contacts.end());
    return list;
}

Admissibility certify_admissible(const Packing& packing, double allowance, const CandidateList* known) {
    require_floating_point();
    assert(allowance >= 0);
    count_work(Work::overlap_proofs);
    Admissibility result;
    result.worst_gap = std::numeric_limits<double>::infinity();
    result.verdict = Verdict::proved;
    const auto look = [&](const Contact& contact) {
        const double h = gap(packing, contact);
        // A pair that overlaps takes precedence over one that merely looks worse in double.
        const bool overlaps = gap_sign(packing, contact, allowance) < 0;
        const bool first_overlap = overlaps && result.verdict == Verdict::proved;
        if (first_overlap || (h < result.worst_gap && (overlaps || result.verdict == Verdict::proved))) {
            result.worst_gap = h;
            result.worst = contact;
        }
        if (overlaps) {
            result.verdict = Verdict::refuted;
        }
    };
    // Any positive reach finds every overlapping pair.
    if (known != nullptr && known->reach > 0 && packing.fixed.empty() && !packing.cell.any() &&
        known->reference == packing.q) {
        for (const Contact& contact : known->contacts) {
            if (contact.of_disks()) {
                look(contact);
            }
        }
    } else {
        const auto from = known != nullptr ? known->triangulation : nullptr;
        // contact_candidates.md Displacements (any reach finds overlaps)
        for (const Contact& contact : near_pairs(packing, 0.5 * packing.min_radius(), from).pairs) {
            look(contact);
        }
    }
    for_each_wall_contact(packing, look);
    return result;
}

} // namespace isostat
