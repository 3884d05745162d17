#include "contact/near_pairs.hpp"
#include "core/refuse.hpp"
#include "crafted/able.hpp"
#include "crafted/gap_order.hpp"
#include "crafted/hyperstaticity.hpp"
#include "crafted/inspection_parts.hpp"
#include "exact/rank.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/bodies.hpp"
#include "rigidity/isostatic.hpp"
#include "rigidity/strained_matrix.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/crafted/plateau.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <set>

namespace isostat::crafted {

namespace {

constexpr double largest_length = 1e100;   // the squares do not overflow
constexpr double smallest_length = 1e-100; // the squares do not underflow

class Sequence {
  public:
    Sequence(const Packing& packing, double largest, Strain strain)
        : packing_(at_rest(packing)), bodies_(Bodies(packing_).members(1)), strain_(strain), order_(packing_),
          largest_(largest) {
        check();
        find_candidates();
        std::ranges::sort(items_, [this](const GapOrder::Item& a, const GapOrder::Item& b) {
            const int sign = order_.compare(a, b);
            return sign != 0 ? sign < 0 : a.contact < b.contact;
        });
        for (const GapOrder::Item& item : items_) {
            contacts_.push_back(item.contact);
        }
        ends_.push_back(0);
        for (std::size_t l = 1; l <= items_.size(); ++l) {
            if (l == items_.size() || order_.compare(items_[l - 1], items_[l]) != 0) {
                ends_.push_back(static_cast<int>(l));
            }
        }
        count_backbones();
        count_all();
        const auto matrix_rank = [strain](const Packing& rest, const std::vector<Contact>& list) {
            const std::vector<Contact> all = with_bars(list, rest);
            const int bars = bar_count(all);
            const DofMap dofs(rest);
            return list.empty() || (dofs.dof_count() == 0 && !rest.cell.all()) ? 0
                   : rest.cell.all() ? exact::rank(exact_strained_matrix(rest, all, strain)) - bars
                                     : exact::rank(exact_contact_matrix(rest, dofs, all)) - bars;
        };
        backbone_stress_ =
            std::make_unique<Hyperstaticity>(carrying_, std::numeric_limits<int>::max(), [this, matrix_rank](int m) {
                return matrix_rank(without_rattlers(m), backbone_contacts(m));
            });
        std::vector<int> counts(static_cast<std::size_t>(size()) + 1);
        std::iota(counts.begin(), counts.end(), 0);
        all_stress_ = std::make_unique<Hyperstaticity>(
            std::move(counts), all_counts(0).dof_count - all_counts(0).rigid_motions, [this, matrix_rank](int m) {
                std::vector<Contact> list(contacts_.begin(), contacts_.begin() + m);
                std::ranges::sort(list);
                return matrix_rank(packing_, list);
            });
    }

    [[nodiscard]] int size() const { return static_cast<int>(items_.size()); }
    /// Numbers of candidates at which a list ends, because the next gap is larger; 0 first.
    [[nodiscard]] const std::vector<int>& ends() const { return ends_; }

    /// Number of candidates with gap <= threshold, always one of `ends`.
    [[nodiscard]] int below(double threshold) const {
        const auto end = std::ranges::partition_point(
            items_, [&](const GapOrder::Item& item) { return order_.compare(item, threshold) <= 0; });
        return static_cast<int>(end - items_.begin());
    }

    /// The smallest double at which the first m >= 1 candidates are contacts.
    [[nodiscard]] double threshold_of(int m) const {
        return order_.threshold_of(items_[static_cast<std::size_t>(m) - 1]);
    }
    /// The smallest double at which the next candidate is a contact too.
    [[nodiscard]] double threshold_after(int m) const {
        return order_.threshold_of(items_[static_cast<std::size_t>(m)]);
    }

    [[nodiscard]] std::vector<Contact> backbone_contacts(int m) const {
        std::vector<Contact> out;
        for (std::size_t l = 0; l < static_cast<std::size_t>(m); ++l) {
            if (peeling_.contact_from[l] <= m) {
                out.push_back(contacts_[l]);
            }
        }
        std::ranges::sort(out);
        return out;
    }

    /// One step per list; `thresholds` has one threshold per list.
    [[nodiscard]] std::vector<PlateauStep> steps(const std::vector<int>& lists, const std::vector<double>& thresholds) {
        backbone_stress_->at_all(lists);
        all_stress_->at_all(lists);
        std::vector<PlateauStep> out;
        for (std::size_t k = 0; k < lists.size(); ++k) {
            const int m = lists[k];
            PlateauStep& step = out.emplace_back();
            step.threshold = thresholds[k];
            step.candidate_count = m;
            step.rattlers = rattlers_[static_cast<std::size_t>(m)];
            step.backbone = backbone_counts(m);
            settle(step.backbone, backbone_stress_->at(m));
            step.all = all_counts(m);
            settle(step.all, all_stress_->at(m));
        }
        return out;
    }

    /// Finds the ranges of thresholds from \p first on, or of all thresholds when it is empty.
    void find_ranges(Plateau& out, std::optional<double> first) {
        out.rounding = rounding_ = std::max(out.rounding, 0x1p-52 * packing_.max_radius());
        lowest_ = first;
        if (first) {
            start_ = static_cast<std::size_t>(std::ranges::lower_bound(ends_, below(*first)) - ends_.begin());
        }
        // h >= N - N_f + rigid motions, and h does not decrease.
        const auto most = [&](auto counts) {
            const auto more = std::ranges::find_if(ends_, [&](int m) { return excess(counts(m)) > 0; });
            return more == ends_.end() ? size() : *more - 1;
        };
        const auto backbone = [this](int m) { return backbone_counts(m); };
        const int unstressed = backbone_stress_->last_without(ends_, most(backbone));
        out.no_self_stress_open = unstressed == size();
        out.no_self_stress_below = out.no_self_stress_open ? largest_ : threshold_after(unstressed);
        find_widest(out);
        const auto balanced = [&](int m) {
            return carrying_[static_cast<std::size_t>(m)] > 0 && excess(backbone(m)) == 0;
        };
        add_ranges(out.ranges, [&](int m) { return m <= unstressed && balanced(m); });
        add_ranges(out.special, [&](int m) { return m > unstressed && balanced(m); });
        // For all grains N is the number of candidates: of single ones only one list can be isostatic.
        add_ranges(out.ranges_all, [&](int m) { return excess(all_counts(m)) == 0 && all_stress_->at(m) == 0; });
    }

    [[nodiscard]] int ranks_computed() const { return backbone_stress_->computed() + all_stress_->computed(); }

  private:
    /// Where every axis is periodic, the strain replaces the moving coordinates of the cell.
    static Packing at_rest(Packing packing) {
        if (packing.cell.all()) {
            packing.cell.keeps_shape = false;
            packing.cell.move(false, false);
        }
        return packing;
    }
    void check() const {
        require_no_arcs(packing_, "plateau", "a count against the gap threshold");
        for (const Bar& bar : packing_.bars) {
            if (packing_.is_fixed(DiskId(bar.i)) || packing_.is_fixed(DiskId(bar.j))) {
                refuse("plateau", "bar {}-{}: expected members that are not fixed", bar.i, bar.j);
            }
        }
        count_contacts(packing_, with_bars({}, packing_)); // refuses dependent bars
        const auto sensible = [](double x) { return std::abs(x) <= largest_length; };
        for (const double x : packing_.q) {
            if (!sensible(x)) {
                refuse("plateau", "coordinate {}: expected lengths within 1e+-100", x);
            }
        }
        for (const double r : packing_.radius) {
            if (!sensible(r) || r < smallest_length) {
                refuse("plateau", "radius {}: expected lengths within 1e+-100", r);
            }
        }
        if (!sensible(largest_)) {
            refuse("plateau", "threshold {}: expected lengths within 1e+-100", largest_);
        }
    }

    void keep(const Contact& contact) {
        const GapOrder::Item item = order_.item(contact);
        if (order_.compare(item, largest_) <= 0) {
            items_.push_back(item);
        }
    }

    void find_candidates() {
        // The reach exceeds the rounding of the search.
        const double reach = std::max(largest_, 0.0) + 1e-9 * (2 * packing_.max_radius() + std::max(largest_, 0.0));
        for (const Contact& pair : pairs_within(packing_, reach, most_pairs_per_disk)) {
            if (!packing_.is_fixed(DiskId(pair.i)) || !packing_.is_fixed(DiskId(pair.j))) {
                keep(pair);
            }
        }
        for (int i = 0; i < packing_.disk_count(); ++i) {
            packing_.walls.for_each(packing_.dimension, i, [&](const Contact& wall) {
                if (packing_.walls.of(wall) == WallKind::movable || !packing_.is_fixed(DiskId(i))) {
                    keep(wall);
                }
            });
        }
    }

    void count_backbones() {
        peeling_ = peel(packing_, contacts_);
        const auto count = static_cast<std::size_t>(size()) + 1;
        carrying_.assign(count, 0);
        rattlers_.assign(count, 0);
        free_.assign(count, 0);
        for (const int from : peeling_.contact_from) {
            if (from <= size()) {
                ++carrying_[static_cast<std::size_t>(from)];
            }
        }
        freedoms_ = free_;
        int free = 0; // bodies that are not fixed
        for (const std::vector<int>& body : bodies_) {
            const auto from = static_cast<std::size_t>(peeling_.disk_from[static_cast<std::size_t>(body.front())]);
            const bool fixed = packing_.is_fixed(DiskId(static_cast<std::size_t>(body.front())));
            free += fixed ? 0 : 1;
            if (!fixed && from < count) {
                ++free_[from];
                freedoms_[from] += freedoms_of(body.size());
            }
        }
        for (std::vector<int>* sums : {&carrying_, &free_, &freedoms_}) {
            std::partial_sum(sums->begin(), sums->end(), sums->begin());
        }
        for (std::size_t m = 0; m < count; ++m) {
            rattlers_[m] = free - free_[m];
        }
        turns_ = turns(peeling_.contact_from);
        std::vector<int> as_listed(contacts_.size());
        std::iota(as_listed.begin(), as_listed.end(), 1);
        all_turns_ = turns(as_listed);
    }

    [[nodiscard]] int freedoms_of(std::size_t members) const {
        return body_freedoms(static_cast<int>(members), packing_.dimension);
    }

    /// For every m: the motions of touched bodies that move no member with a contact. \p from: as `contact_from`.
    [[nodiscard]] std::vector<int> turns(const std::vector<int>& from) const {
        std::vector<int> first(packing_.radius.size(),
                               size() + 1); // of a member: with how many contacts one is its own
        for (std::size_t l = 0; l < from.size(); ++l) {
            for (const int member : {contacts_[l].i, contacts_[l].of_disks() ? contacts_[l].j : contacts_[l].i}) {
                int& at = first[static_cast<std::size_t>(member)];
                at = std::min(at, from[l]);
            }
        }
        std::vector<int> out(static_cast<std::size_t>(size()) + 2, 0);
        for (std::vector<int> body : bodies_) {
            for (int& member : body) {
                member = first[static_cast<std::size_t>(member)];
            }
            std::ranges::sort(body);
            for (std::size_t s = 1; freedoms_of(s) < freedoms_of(body.size()); ++s) {
                const int left = freedoms_of(body.size()) - freedoms_of(s);
                out[static_cast<std::size_t>(body[s - 1])] += left;
                out[static_cast<std::size_t>(body[s])] -= left;
            }
        }
        std::partial_sum(out.begin(), out.end(), out.begin());
        return out;
    }

    void count_all() {
        for (const WallKind wall : packing_.walls.upper) {
            moving_ += wall == WallKind::movable ? 1 : 0;
        }
        for (const bool moves : packing_.cell.period_moves) {
            moving_ += moves ? 1 : 0;
        }
        all_dofs_ = DofMap(packing_).dof_count() + cell_coordinates() - static_cast<int>(packing_.bars.size());
    }
    /// Number of degrees of freedom that the strains of the cell add to those of the disks.
    [[nodiscard]] int cell_coordinates() const {
        return packing_.cell.all() ? strain_count(strain_, packing_.cell.dimension) : 0;
    }

    [[nodiscard]] PlateauCounts backbone_counts(int m) const {
        const auto k = static_cast<std::size_t>(m);
        PlateauCounts out;
        const auto pinned = static_cast<int>(packing_.cell.periodic_axes());
        out.dof_count = freedoms_[k] + moving_ + cell_coordinates() - (free_[k] > 0 ? pinned : 0);
        out.contact_count = carrying_[k];
        out.turns = turns_[k];
        out.rigid_motions =
            std::min(out.dof_count,
                     turning_or_sliding([&](int i) { return peeling_.disk_from[static_cast<std::size_t>(i)] <= m; }));
        return out;
    }

    [[nodiscard]] PlateauCounts all_counts(int m) const {
        PlateauCounts out;
        out.dof_count = all_dofs_;
        out.contact_count = m;
        out.turns = all_turns_[static_cast<std::size_t>(m)];
        out.rigid_motions = std::min(out.dof_count, turning_or_sliding([](int) { return true; }));
        return out;
    }

    [[nodiscard]] int turning_or_sliding(const std::function<bool(int)>& takes_part) const {
        return rigid_motions(packing_, takes_part,
                             [this](std::size_t k) { return exact::Number::from_double(packing_.q[k]); });
    }

    /// N - (N_f - rigid motions - turns).
    static int excess(const PlateauCounts& c) { return c.contact_count - (c.dof_count - c.rigid_motions - c.turns); }

    void find_widest(Plateau& out) {
        double widest = -1;
        for (std::size_t e = start_; e < ends_.size(); ++e) {
            const std::size_t begin = e;
            const auto kind = [&](std::size_t k) {
                const PlateauCounts counts = backbone_counts(ends_[k]);
                return std::pair(counts.contact_count > 0, excess(counts));
            };
            while (e + 1 < ends_.size() && kind(e + 1) == kind(begin)) {
                ++e;
            }
            const PlateauRange range = range_of(begin, e);
            if (const double width = out.width(range); range.contacts > 0 && width > widest) {
                widest = width;
                out.widest = {range, backbone_counts(ends_[e])};
                last_of_widest_ = ends_[e];
            }
        }
        if (out.widest) {
            settle(out.widest->counts, backbone_stress_->at(last_of_widest_));
        }
    }

    static void settle(PlateauCounts& counts, int h) {
        counts.hyperstaticity = h;
        counts.rank = counts.contact_count - h;
        counts.mechanisms = counts.dof_count - counts.rank;
        const int most = std::min(counts.contact_count, counts.dof_count - counts.rigid_motions - counts.turns);
        counts.rank_exact = counts.rank == most ? Verdict::proved : Verdict::undecided;
        if (excess(counts) != 0 || counts.contact_count == 0) {
            counts.isostatic = Verdict::refuted; // N_f + h = N + k: h and the internal mechanisms cannot both be 0
        } else if (counts.rank_exact == Verdict::proved) {
            counts.isostatic = Verdict::proved;
        }
    }

    /// The packing whose rattlers are fixed and so have no degree of freedom.
    [[nodiscard]] Packing without_rattlers(int m) const {
        Packing rest = packing_;
        rest.fixed.resize(rest.radius.size(), 0);
        for (std::size_t i = 0; i < rest.fixed.size(); ++i) {
            if (peeling_.disk_from[i] > m) {
                rest.fixed[i] = 1;
            }
        }
        return rest;
    }

    /// Adds the maximal runs of ends for which `holds` is true.
    template <class Holds> void add_ranges(std::vector<PlateauRange>& out, Holds holds) const {
        for (std::size_t e = start_; e < ends_.size(); ++e) {
            if (!holds(ends_[e]) || ends_[e] == 0) {
                continue;
            }
            const std::size_t begin = e;
            while (e + 1 < ends_.size() && holds(ends_[e + 1])) {
                ++e;
            }
            out.push_back(range_of(begin, e));
        }
    }
    /// The range of thresholds from one of the ends to another.
    [[nodiscard]] PlateauRange range_of(std::size_t begin, std::size_t end) const {
        const int m = ends_[begin];
        PlateauRange range;
        const double low = m == 0 ? -largest_length : threshold_of(m);
        range.first = std::max(low, lowest_.value_or(low));
        range.open = ends_[end] == size();
        range.last = range.open ? largest_ : threshold_after(ends_[end]);
        range.contacts = carrying_[static_cast<std::size_t>(m)];
        range.rattlers = rattlers_[static_cast<std::size_t>(m)];
        range.candidates = m;
        range.told = low + 2 * rounding_ < range.last &&
                     std::max(range.first, low + rounding_) <= range.last - (range.open ? 0 : rounding_);
        return range;
    }

    Packing packing_;
    std::vector<std::vector<int>> bodies_; ///< single grains too
    Strain strain_;
    GapOrder order_;
    double largest_;
    std::vector<GapOrder::Item> items_; ///< by increasing gap
    std::vector<Contact> contacts_;
    std::vector<int> ends_;
    Peeling peeling_;
    std::vector<int> carrying_, rattlers_, free_, freedoms_; ///< with the first m candidates
    std::vector<int> turns_, all_turns_;                     ///< the same
    int moving_ = 0;                                         ///< walls, and the period of a channel
    int all_dofs_ = 0;
    double rounding_ = 0;          ///< of gaps
    std::optional<double> lowest_; ///< threshold; empty: ranges begin at a gap
    std::size_t start_ = 0;        ///< index in `ends_` of the first list
    int last_of_widest_ = 0;
    std::unique_ptr<Hyperstaticity> backbone_stress_, all_stress_;
};

/// Chooses about `rows` of the `ends` in [begin, end), see `plateau`.
std::set<int> thinned(const Sequence& sequence, int begin, int end, int rows, const Plateau& found) {
    std::vector<int> inside;
    std::ranges::copy_if(sequence.ends(), std::back_inserter(inside),
                         [=](int m) { return m >= begin && m <= end && m > 0; });
    if (rows <= 0 || inside.size() <= static_cast<std::size_t>(rows)) {
        return {inside.begin(), inside.end()};
    }
    std::set<int> out{inside.front(), inside.back()};
    const int half = std::max(rows / 2, 1);
    const auto positive = std::ranges::find_if(inside, [&](int m) { return sequence.threshold_of(m) > 0; });
    // All overlaps count as one list, because the contacts of a soft packing are its overlaps.
    const auto start = positive == inside.begin() || positive == inside.end() ? inside.begin() : positive - 1;
    const auto last = inside.end() - 1 - start;
    for (int k = 0; k < half; ++k) {
        out.insert(*(start + last * k / half));
    }
    if (positive != inside.end()) {
        const double low = std::log(sequence.threshold_of(*positive)),
                     high = std::log(sequence.threshold_of(inside.back()));
        for (int k = 1; k < half; ++k) {
            const int m = sequence.below(std::exp(low + (high - low) * k / half));
            if (m >= inside.front() && m > 0) {
                out.insert(m);
            }
        }
    }
    for (const auto* ranges : {&found.ranges, &found.special, &found.ranges_all}) {
        for (const PlateauRange& range : *ranges) {
            if (ranges->size() > static_cast<std::size_t>(half)) {
                break;
            }
            for (const double t : {range.first, range.last}) {
                const int m = sequence.below(t);
                const auto at = std::ranges::lower_bound(inside, m);
                if (at != inside.end() && *at == m) {
                    out.insert(m);
                    out.insert(at == inside.begin() ? m : *(at - 1));
                }
            }
        }
    }
    return out;
}

Plateau begin(Sequence& sequence, std::optional<double> first = {}, double rounding = 0) {
    Plateau out;
    out.rounding = rounding;
    out.candidates = sequence.size();
    out.changes = static_cast<int>(sequence.ends().size()) - 1;
    out.deepest_overlap = sequence.size() == 0 ? std::numeric_limits<double>::infinity() : sequence.threshold_of(1);
    sequence.find_ranges(out, first);
    return out;
}

} // namespace

double Plateau::width(const PlateauRange& range) const {
    return std::asinh(range.last / rounding) - std::asinh(range.first / rounding);
}

Plateau plateau(const Packing& packing, const std::vector<double>& thresholds, Strain strain) {
    require_floating_point();
    assert(std::ranges::is_sorted(thresholds));
    if (thresholds.empty()) {
        return {};
    }
    Sequence sequence(packing, thresholds.back(), strain);
    Plateau out = begin(sequence);
    std::vector<int> lists;
    for (const double threshold : thresholds) {
        lists.push_back(sequence.below(threshold));
    }
    out.steps = sequence.steps(lists, thresholds);
    out.ranks_computed = sequence.ranks_computed();
    return out;
}

Plateau plateau(const Packing& packing, double first, double last, int rows, Strain strain, double rounding) {
    require_floating_point();
    assert(first <= last);
    Sequence sequence(packing, last, strain);
    Plateau out = begin(sequence, first, rounding);
    std::vector<int> lists{sequence.below(first)};
    std::vector<double> thresholds{first};
    for (const int m : thinned(sequence, lists.front() + 1, sequence.size(), rows, out)) {
        lists.push_back(m);
        thresholds.push_back(sequence.threshold_of(m));
    }
    if (thresholds.back() < last) {
        lists.push_back(sequence.size());
        thresholds.push_back(last);
    }
    out.steps = sequence.steps(lists, thresholds);
    out.ranks_computed = sequence.ranks_computed();
    return out;
}

std::vector<Contact> backbone_at(const Packing& packing, double threshold) {
    const Sequence sequence(packing, threshold, Strain::isotropic);
    return sequence.backbone_contacts(sequence.below(threshold));
}

} // namespace isostat::crafted
