#include "checker/arcs.hpp"
#include "checker/at_wall.hpp"
#include "checker/images.hpp"
#include "checker/vertex.hpp"

#include <algorithm>
#include <numeric>

namespace isostat::checker {

namespace {

bool is_fixed(const Packing& packing, int disk) {
    return !packing.fixed.empty() && packing.fixed[static_cast<std::size_t>(disk)] != 0;
}

/// The periods between a disk and its own image move.
bool own_image_moves(const Packing& packing, const Contact& pair) {
    const Cell& cell = packing.cell;
    bool moves = false;
    for (std::size_t b = 0; b < packing.axes(); ++b) {
        bool column = cell.period_moves[b];
        for (std::size_t a = 0; a < b; ++a) {
            column = column || cell.tilt_moves[Cell::tilt(a, b)];
        }
        moves = moves || (pair.image.m[b] != 0 && column);
    }
    return moves;
}

bool exists_and_moves(const Packing& packing, const Contact& pair) {
    if (pair.of_disks() && packing.cell.any()) { // no disk is fixed there
        return pair.i != pair.j || own_image_moves(packing, pair);
    }
    if (pair.of_disks()) {
        return !is_fixed(packing, pair.i) || !is_fixed(packing, pair.j);
    }
    const WallKind wall = pair.is_wall() ? wall_of(packing, pair) : WallKind::absent;
    return wall == WallKind::movable || (wall == WallKind::fixed && !is_fixed(packing, pair.i));
}

/// The middle of the enclosure of the true vertex in doubles, in units of a power of two above all lengths (so that no
/// square overflows), with one bound for the error of any gap computed from it.
struct Approximation {
    std::vector<double> q;
    std::vector<double> radius;
    double error = 0;

    Approximation(const Problem& problem, const TrueVertex& vertex) {
        const long largest = std::max({1L, vertex.middle.most_bits(), problem.radius.most_bits()});
        q = vertex.middle.near(-largest);
        radius = problem.radius.near(-largest);
        // K9: 64 roundings of numbers up to 1, and four radii of the enclosure.
        // 0x1p-47: checker.md K9; 4: checker.md K9 (2 sqrt d r, four times the error)
        error = 0x1p-47 + 4 * rounded_up(vertex.radius * power_of_two(-largest - problem.fine));
    }
    [[nodiscard]] double gap(const Contact& pair, const Layout& layout) const {
        const auto i = static_cast<std::size_t>(pair.i);
        const auto j = static_cast<std::size_t>(pair.j);
        const std::size_t of_i = layout.of_disk(pair.i);
        if (!pair.of_disks()) {
            return AtWall(pair, layout).distance_in(q) - radius[i];
        }
        double square = 0;
        for (std::size_t a = 0; a < layout.axes(); ++a) {
            double d = q[of_i + a] - q[layout.of_disk(pair.j) + a];
            for (std::size_t b = a; b < layout.axes() && !pair.image.is_here(); ++b) {
                d -= pair.image.m[b] * q[a == b ? layout.of_length(a) : layout.of_tilt(a, b)];
            }
            square += d * d;
        }
        return std::sqrt(square) - (radius[i] + radius[j]);
    }
};

/// The gap at the true vertex, exact up to the radius of its enclosure and what is `open` of arcs: the root is taken of
/// an integer.
Range exact_gap(const Problem& problem, const TrueVertex& vertex, const Contact& pair, const Rational& open) {
    const auto i = static_cast<std::size_t>(pair.i);
    const auto j = static_cast<std::size_t>(pair.j);
    const Lengths& q = vertex.middle;
    const Row row(pair, problem.layout);
    const Range blur = Range::around(0, 2 * std::max(2, row.spread()) * vertex.radius + open);
    if (pair.of_disks()) {
        const Integer root = sqrt(row.square(q, problem.layout.axes()));
        const Integer distance = problem.radius[i] + problem.radius[j];
        return Range(problem.length(root - distance), problem.length(root + 1 - distance)) + blur;
    }
    const Integer gap = AtWall(pair, problem.layout).distance_in(q) - problem.radius[i];
    return Range(problem.length(gap)) + blur;
}

/// Collects the pairs whose approximate gap is nearly the smallest one so far.
class Collector {
  public:
    Collector(const State& state, const Approximation& at)
        : state_(state), layout_(state.packing.layout()), at_(at), body_(bodies_of(state.packing)),
          arcs_(state.packing, at.q, at.radius), contacts_(state.contacts) {
        std::sort(contacts_.begin(), contacts_.end());
    }
    /// Pairs with an approximate gap above this are certainly not the nearest.
    // checker.md K9 (2 sqrt d r, four times the error)
    [[nodiscard]] double limit() const { return best_ + 4 * at_.error; }
    void offer(const Contact& pair) {
        const double gap = at_.gap(pair, layout_);
        if (gap > limit() || !exists_and_moves(state_.packing, pair) ||
            std::binary_search(contacts_.begin(), contacts_.end(), pair) || are_members(body_, pair) ||
            !arcs_.contains(pair)) {
            return;
        }
        best_ = std::min(best_, gap);
        near_.emplace_back(gap, pair);
    }
    /// Each once: a pair across a side of the cell is met there and at the opposite side.
    [[nodiscard]] std::vector<Contact> nearest() const {
        std::vector<Contact> pairs;
        for (const auto& [gap, pair] : near_) {
            if (gap <= limit() && std::find(pairs.begin(), pairs.end(), pair) == pairs.end()) {
                pairs.push_back(pair);
            }
        }
        return pairs;
    }

  private:
    const State& state_;
    Layout layout_;
    const Approximation& at_;
    std::vector<int> body_;
    NearestArcs arcs_;
    std::vector<Contact> contacts_; ///< sorted
    std::vector<std::pair<double, Contact>> near_;
    double best_ = std::numeric_limits<double>::infinity();
};

} // namespace

namespace {

/// An own image that cannot move, nearer than a diameter: the largest disk has one if any has.
std::optional<Contact> overlapping_image(const Problem& problem, const State& state) {
    const std::vector<double>& r = state.packing.radius;
    const auto disk = static_cast<int>(std::max_element(r.begin(), r.end()) - r.begin());
    const Integer widest = problem.radius[static_cast<std::size_t>(disk)];
    const CellImages images(state.packing, state.packing.q);
    // cost: images that are looked at, more than two radii
    const auto range = images.range(2.5 * approximate(widest, problem.fine));
    if (!images.usable() || !range) {
        return Contact{ContactKind::disk_disk, -1, -1};
    }
    std::optional<Contact> overlap;
    for_each_image(*range, [&](const Periods& m) {
        const auto times = [&m](std::size_t a) { return static_cast<std::int8_t>(m[a]); };
        const Contact pair = pair_of(disk, disk, {{times(0), times(1), times(2)}});
        if (!pair.image.is_here() && !own_image_moves(state.packing, pair) &&
            // exact: the square of a diameter
            Row(pair, problem.layout).square(problem.stored, problem.layout.axes()) < 4 * widest * widest) {
            overlap = pair;
        }
    });
    return overlap;
}

} // namespace

std::optional<Contact> fixed_overlap(const Problem& problem, const State& state) {
    if (state.packing.cell.any()) {
        return overlapping_image(problem, state);
    }
    std::vector<int> fixed;
    for (int i = 0; i < problem.layout.disks; ++i) {
        if (is_fixed(state.packing, i)) {
            fixed.push_back(i);
        }
    }
    const Lengths& q = problem.stored;
    const Layout& layout = problem.layout;
    const auto coordinate = [&](int i, std::size_t a) { return q[layout.of_disk(i) + a]; };
    const auto radius = [&problem](int i) { return problem.radius[static_cast<std::size_t>(i)]; };
    const std::vector<int> body = bodies_of(state.packing);
    std::sort(fixed.begin(), fixed.end(), [&](int i, int j) { return coordinate(i, 0) < coordinate(j, 0); });
    Integer widest = 0;
    for (const int i : fixed) {
        widest = std::max(widest, radius(i));
    }
    for (std::size_t k = 0; k < fixed.size(); ++k) {
        const int i = fixed[k];
        std::optional<Contact> overlap;
        for_each_wall(state.packing, i, [&](const Contact& wall) {
            if (!overlap && wall_of(state.packing, wall) == WallKind::fixed &&
                AtWall(wall, layout).distance_in(q) < radius(i)) {
                overlap = wall;
            }
        });
        if (overlap) {
            return overlap;
        }
        for (std::size_t m = k + 1; m < fixed.size(); ++m) {
            const int j = fixed[m];
            if (coordinate(j, 0) - coordinate(i, 0) >= radius(i) + widest) {
                break;
            }
            const Contact pair = pair_of(std::min(i, j), std::max(i, j));
            const Integer sum = radius(i) + radius(j);
            if (!are_members(body, pair) && Row(pair, layout).square(q, layout.axes()) < sum * sum) {
                return pair;
            }
        }
    }
    return {};
}

bool is_free_pair(const State& state, const Contact& pair) {
    const bool members = !state.packing.bars.empty() && are_members(bodies_of(state.packing), pair);
    return !members && exists_and_moves(state.packing, pair) &&
           std::find(state.contacts.begin(), state.contacts.end(), pair) == state.contacts.end();
}

namespace {

/// All pairs, one of each being in the cell itself. A pair whose centres are further apart along one axis alone cannot
/// be nearer.
void sweep(const std::vector<Placed>& places, const Approximation& at, double widest, Collector& collector) {
    const auto reach = [&] { return widest + collector.limit() + at.error; };
    double height = 0;
    // cost: reach of the first sweep over images, more diameters than the smallest gap leaves
    for (double needed = std::min(1.25 * widest, reach()); height < needed; needed = reach()) {
        height = needed; // again when a pair farther away could be as near as the nearest found
        for_each_near(places, height, reach, [&](const Placed& one, const Placed& two) {
            if ((one.central || two.central) && std::abs(two.at[2] - one.at[2]) <= reach()) {
                collector.offer(pair_between(one, two));
            }
        });
    }
}

void sweep_walls(const Packing& packing, Collector& collector) {
    for (int i = 0; i < packing.disk_count(); ++i) {
        for_each_wall(packing, i, [&collector](const Contact& wall) { collector.offer(wall); });
    }
}

/// The pairs that come nearest; nothing: there are too many images to tell.
std::optional<std::vector<Contact>> nearest_pairs(const Problem& problem, const State& state, Approximation at) {
    const double widest = 2 * *std::max_element(at.radius.begin(), at.radius.end());
    if (!state.packing.cell.any()) {
        std::vector<Placed> places;
        for (int i = 0; i < problem.layout.disks; ++i) {
            const auto first = at.q.begin() + static_cast<std::ptrdiff_t>(problem.layout.of_disk(i));
            std::copy_n(first, problem.layout.dimension, places.emplace_back(Placed{i}).at.begin());
        }
        Collector collector(state, at);
        sweep_walls(state.packing, collector);
        sweep(places, at, widest, collector);
        return collector.nearest();
    }
    const CellImages images(state.packing, at.q);
    const double error = at.error;
    // cost: reach of the first sweep over images, more diameters than the smallest gap leaves
    double reach = 1.25 * widest; // of what is swept: the smallest gap is far below a quarter of that
    std::optional<Periods> range = images.range(reach);
    while (range && images.usable()) {
        at.error = error * (1 + images.periods(*range)); // K9 with images
        Collector collector(state, at);
        sweep_walls(state.packing, collector);
        sweep(images.near_cell(*range, reach), at, widest, collector);
        // Another sweep when a pair farther away could be as near as the nearest found.
        const double needed =
            std::isfinite(collector.limit()) ? widest + collector.limit() + at.error : 2 * (widest + images.longest());
        if (needed <= reach) {
            return collector.nearest();
        }
        reach = needed;
        range = images.range(reach);
    }
    return std::nullopt;
}

} // namespace

std::vector<Gap> smallest_gaps(const Problem& problem, const State& state, const TrueVertex& vertex) {
    const auto nearest = nearest_pairs(problem, state, Approximation(problem, vertex));
    if (!nearest) {
        // choice: any gap at all, where nothing is known
        return {{Contact{ContactKind::disk_disk, -1, -1}, Range::around(0, power_of_two(2000))}};
    }
    const Rational open = arc_blur(state.packing);
    std::vector<Gap> gaps;
    for (const Contact& pair : *nearest) {
        gaps.push_back({pair, exact_gap(problem, vertex, pair, open)});
    }
    return gaps;
}

} // namespace isostat::checker
