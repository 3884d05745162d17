#include "crafted/carrying.hpp"
#include "crafted/rigid_motions.hpp"

#include <isostat/crafted/plateau.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/exact/rank.hpp>
#include <isostat/rigidity/isostatic.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace isostat::crafted {

namespace {

/// Difference of two stored points: rounded, and exact on demand.
struct StoredNormal {
    double x, y;
    std::array<double, 2> from, to;
    [[nodiscard]] Number exact(std::size_t a) const {
        return Number::from_double(to[a]) - Number::from_double(from[a]);
    }
};

/// Sign of s - t for products of two differences each, relative error below 4 * 2^-53 per product away from underflow.
template <class Exact> int filtered_sign(double s, double t, Exact exact) {
    const double value = s + t;
    const double size = std::abs(s) + std::abs(t);
    if (size > 1e-280 && std::isfinite(size) && std::abs(value) > 0x1p-49 * size) {
        return value > 0 ? 1 : -1;
    }
    return exact().sign();
}

int cross_sign(const StoredNormal& a, const StoredNormal& b) {
    return filtered_sign(a.x * b.y, -(a.y * b.x), [&] { return a.exact(0) * b.exact(1) - a.exact(1) * b.exact(0); });
}
int dot_sign(const StoredNormal& a, const StoredNormal& b) {
    return filtered_sign(a.x * b.x, a.y * b.y, [&] { return a.exact(0) * b.exact(0) + a.exact(1) * b.exact(1); });
}

struct Candidate {
    double gap;
    Contact contact;
};

class Counter {
  public:
    Counter(const Packing<2>& packing, double largest) : packing_(packing) {
        find_candidates(largest);
        std::stable_sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
            return a.gap != b.gap ? a.gap < b.gap : a.contact < b.contact;
        });
    }

    [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }

    [[nodiscard]] std::size_t below(double threshold) const {
        return static_cast<std::size_t>(std::upper_bound(candidates_.begin(), candidates_.end(), threshold,
                                                         [](double t, const Candidate& c) { return t < c.gap; }) -
                                        candidates_.begin());
    }

    /// Counts with the first `count` candidates as contacts.
    [[nodiscard]] PlateauStep step(std::size_t count) const {
        const auto n = static_cast<std::size_t>(packing_.disk_count());
        std::vector<Arms<StoredNormal>> arms(n);
        for (std::size_t l = 0; l < count; ++l) {
            add_arms(l, arms);
        }
        std::vector<unsigned char> carrying(count, 1);
        std::vector<DiskHold> hold(n, DiskHold::held);
        for (std::size_t i = 0; i < n; ++i) {
            hold[i] = packing_.is_fixed(DiskId(i)) ? DiskHold::fixed : DiskHold::held;
        }
        exclude_contacts(arms, carrying, hold);
        PlateauStep out;
        out.candidate_count = static_cast<int>(count);
        // A rattler has no degree of freedom left: it is held fixed, and touches nothing.
        Packing<2> rest = packing_;
        rest.fixed.resize(n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            if (hold[i] == DiskHold::rattler) {
                rest.fixed[i] = 1;
                ++out.rattlers;
            }
        }
        std::vector<Contact> contacts;
        for (std::size_t l = 0; l < count; ++l) {
            if (carrying[l] != 0) {
                contacts.push_back(candidates_[l].contact);
            }
        }
        std::sort(contacts.begin(), contacts.end());
        const DofMap<2> dofs(rest);
        out.dof_count = dofs.dof_count();
        out.contact_count = static_cast<int>(contacts.size());
        out.rigid_motions = std::min(
            out.dof_count, rigid_motions(packing_.walls, packing_.fixed, packing_.disk_count() - out.rattlers));
        const int most = std::min(out.contact_count, out.dof_count - out.rigid_motions);
        out.rank = contacts.empty() || out.dof_count == 0 ? 0 : exact::rank(exact_contact_matrix(rest, dofs, contacts));
        out.hyperstaticity = out.contact_count - out.rank;
        out.mechanisms = out.dof_count - out.rank;
        out.rank_exact = out.rank == most ? Verdict::proved : Verdict::undecided;
        if (out.contact_count != out.dof_count - out.rigid_motions) {
            out.isostatic = Verdict::refuted; // N_f + h = N + k: h and the internal mechanisms cannot both be 0
        } else if (out.rank_exact == Verdict::proved && out.contact_count > 0) {
            out.isostatic = Verdict::proved;
        }
        return out;
    }

  private:
    void find_candidates(double largest) {
        const int n = packing_.disk_count();
        const auto keep = [&](const Contact& contact) {
            if (const double g = gap<2>(packing_, contact); g <= largest) {
                candidates_.push_back({g, contact});
            }
        };
        std::vector<int> order(static_cast<std::size_t>(n));
        std::iota(order.begin(), order.end(), 0);
        const auto radius = [&](int i) { return packing_.radius[static_cast<std::size_t>(i)]; };
        const auto left = [&](int i) { return packing_.coordinate(DiskId(i), 0) - radius(i); };
        std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return left(i) < left(j); });
        // Far above the rounding of the sweep's bounds: a wider sweep only looks at more pairs.
        double size = std::abs(largest) + packing_.max_radius();
        for (const double x : packing_.q) {
            size = std::max(size, std::abs(x));
        }
        const double slack = 1e-12 * size;
        for (std::size_t s = 0; s < order.size(); ++s) {
            const int i = order[s];
            const double reach = packing_.coordinate(DiskId(i), 0) + radius(i) + std::max(largest, 0.0) + slack;
            for (std::size_t t = s + 1; t < order.size() && left(order[t]) <= reach; ++t) {
                if (!packing_.is_fixed(DiskId(i)) || !packing_.is_fixed(DiskId(order[t]))) {
                    keep({ContactKind::disk_disk, std::min(i, order[t]), std::max(i, order[t])});
                }
            }
        }
        for (int i = 0; i < n; ++i) {
            for (int a = 0; a < 2; ++a) {
                const auto axis = static_cast<std::size_t>(a);
                const auto moves = [&](WallKind wall) {
                    return wall == WallKind::movable || (wall == WallKind::fixed && !packing_.is_fixed(DiskId(i)));
                };
                if (moves(packing_.walls.lower[axis])) {
                    keep({ContactKind::lower_wall, i, a});
                }
                if (moves(packing_.walls.upper[axis])) {
                    keep({ContactKind::upper_wall, i, a});
                }
            }
        }
    }

    void add_arms(std::size_t l, std::vector<Arms<StoredNormal>>& arms) const {
        const Contact& contact = candidates_[l].contact;
        const auto i = static_cast<std::size_t>(contact.i);
        const auto j = static_cast<std::size_t>(contact.j);
        if (contact.kind == ContactKind::disk_disk) {
            const std::array<double, 2> a{packing_.q[2 * i], packing_.q[2 * i + 1]};
            const std::array<double, 2> b{packing_.q[2 * j], packing_.q[2 * j + 1]};
            arms[i].push_back({l, {b[0] - a[0], b[1] - a[1], a, b}});
            arms[j].push_back({l, {a[0] - b[0], a[1] - b[1], b, a}});
        } else {
            std::array<double, 2> unit{};
            unit[j] = contact.kind == ContactKind::lower_wall ? -1 : 1;
            arms[i].push_back({l, {unit[0], unit[1], {0, 0}, unit}});
        }
    }

    const Packing<2>& packing_;
    std::vector<Candidate> candidates_;
};

} // namespace

Plateau plateau(const Packing<2>& packing, const std::vector<double>& thresholds) {
    assert(std::is_sorted(thresholds.begin(), thresholds.end()));
    Plateau out;
    if (thresholds.empty()) {
        return out;
    }
    const Counter counter(packing, thresholds.back());
    const auto& candidates = counter.candidates();
    out.deepest_overlap = candidates.empty() ? HUGE_VAL : candidates.front().gap;
    std::vector<std::size_t> counts;
    for (const double threshold : thresholds) {
        counts.push_back(counter.below(threshold));
        // The same list again costs nothing.
        out.steps.push_back(counts.size() > 1 && counts.back() == counts[counts.size() - 2]
                                ? out.steps.back()
                                : counter.step(counts.back()));
        out.steps.back().threshold = threshold;
    }
    const auto proved = [&](std::size_t count) { return counter.step(count).isostatic == Verdict::proved; };
    for (std::size_t s = 0; s < out.steps.size(); ++s) {
        if (out.steps[s].isostatic != Verdict::proved || (s > 0 && out.steps[s - 1].isostatic == Verdict::proved)) {
            continue;
        }
        std::size_t e = s;
        while (e + 1 < out.steps.size() && out.steps[e + 1].isostatic == Verdict::proved) {
            ++e;
        }
        // Invariant: `in` contacts are isostatic, `outside` are not.
        std::size_t in = counts[s], outside = s > 0 ? counts[s - 1] : 0;
        while (in - outside > 1) {
            const std::size_t middle = outside + (in - outside) / 2;
            (proved(middle) ? in : outside) = middle;
        }
        PlateauRange range;
        range.first = candidates[in - 1].gap;
        in = counts[e];
        if (e + 1 == out.steps.size()) {
            range.last = thresholds.back();
        } else {
            outside = counts[e + 1];
            while (outside - in > 1) {
                const std::size_t middle = in + (outside - in) / 2;
                (proved(middle) ? in : outside) = middle;
            }
            range.last = candidates[outside - 1].gap;
        }
        out.ranges.push_back(range);
    }
    return out;
}

} // namespace isostat::crafted
