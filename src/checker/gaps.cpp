#include "checker/gaps.hpp"

#include "checker/images.hpp"

#include <algorithm>
#include <set>

namespace isostat::checker {

namespace {

bool is_fixed(const Packing& packing, int disk) {
    return !packing.fixed.empty() && packing.fixed[static_cast<std::size_t>(disk)] != 0;
}

/// The periods between a disk and its own image move.
bool own_image_moves(const Packing& packing, const Contact& pair) {
    const Cell& cell = packing.cell;
    const auto& m = pair.image.m;
    return (m[0] != 0 && cell.period_moves[0]) || (m[1] != 0 && (cell.period_moves[1] || cell.tilt_moves[0]));
}

bool exists_and_moves(const Packing& packing, const Contact& pair) {
    const auto axis = static_cast<std::size_t>(pair.j);
    if (pair.kind == ContactKind::disk_disk && packing.cell.any()) { // no disk is fixed there
        return pair.i != pair.j || own_image_moves(packing, pair);
    }
    switch (pair.kind) {
    case ContactKind::disk_disk: return !is_fixed(packing, pair.i) || !is_fixed(packing, pair.j);
    case ContactKind::lower_wall: return packing.walls.lower[axis] != WallKind::absent && !is_fixed(packing, pair.i);
    case ContactKind::upper_wall:
        return packing.walls.upper[axis] == WallKind::movable ||
               (packing.walls.upper[axis] == WallKind::fixed && !is_fixed(packing, pair.i));
    case ContactKind::held: return false;
    }
    return false;
}

/// The middle of the enclosure of the true vertex in doubles, in units of a power of two above all lengths (so that no
/// square overflows), with one bound for the error of any gap computed from it.
struct Approximation {
    std::vector<double> q;
    std::vector<double> radius;
    double error = 0;

    Approximation(const Problem& problem, const TrueVertex& vertex) {
        long largest = 1;
        for (const Integer& x : vertex.middle) {
            largest = std::max(largest, bits(x));
        }
        for (const Integer& r : problem.radius) {
            largest = std::max(largest, bits(r));
        }
        for (const Integer& x : vertex.middle) {
            q.push_back(approximate(x, -largest));
        }
        for (const Integer& r : problem.radius) {
            radius.push_back(approximate(r, -largest));
        }
        // K9: 64 roundings of numbers up to 1, and three radii of the enclosure.
        error = 0x1p-47 + 4 * rounded_up(vertex.radius * power_of_two(-largest - problem.fine));
    }
    [[nodiscard]] double gap(const Contact& pair, std::size_t disks) const {
        const auto i = static_cast<std::size_t>(pair.i);
        const auto j = static_cast<std::size_t>(pair.j);
        if (pair.kind == ContactKind::disk_disk) {
            double dx = q[2 * i] - q[2 * j];
            double dy = q[2 * i + 1] - q[2 * j + 1];
            if (!pair.image.is_here()) {
                dx -= pair.image.m[0] * q[2 * disks] + pair.image.m[1] * q[2 * disks + 2];
                dy -= pair.image.m[1] * q[2 * disks + 1];
            }
            return std::sqrt(dx * dx + dy * dy) - (radius[i] + radius[j]);
        }
        const double x = q[2 * i + j];
        return (pair.kind == ContactKind::lower_wall ? x : q[2 * disks + j] - x) - radius[i];
    }
};

/// The gap at the true vertex, exact up to the radius of its enclosure: the root is taken of an integer.
Range exact_gap(const Problem& problem, const TrueVertex& vertex, const Contact& pair) {
    const auto i = static_cast<std::size_t>(pair.i);
    const auto j = static_cast<std::size_t>(pair.j);
    const std::vector<Integer>& q = vertex.middle;
    const Row row(pair, problem.disks);
    const Range blur = Range::around(0, (3 * std::max(2, row.spread()) + 1) / 2 * vertex.radius);
    if (pair.kind == ContactKind::disk_disk) {
        Integer dx;
        Integer dy;
        row.separate(q, 0, dx);
        row.separate(q, 1, dy);
        const Integer root = sqrt(Integer(dx * dx + dy * dy));
        const Integer distance = problem.radius[i] + problem.radius[j];
        return Range(problem.length(root - distance), problem.length(root + 1 - distance)) + blur;
    }
    const Integer& x = q[2 * i + j];
    const Integer wall =
        pair.kind == ContactKind::lower_wall ? Integer(0) : q[2 * static_cast<std::size_t>(problem.disks) + j];
    const Integer gap = (pair.kind == ContactKind::lower_wall ? x : Integer(wall - x)) - problem.radius[i];
    return Range(problem.length(gap)) + blur;
}

/// Collects the pairs whose approximate gap is nearly the smallest one so far.
class Collector {
  public:
    Collector(const State& state, const Approximation& at) : state_(state), at_(at) {
        contacts_.insert(state.contacts.begin(), state.contacts.end());
    }
    /// Pairs with an approximate gap above this are certainly not the nearest.
    [[nodiscard]] double limit() const { return best_ + 4 * at_.error; }
    void offer(const Contact& pair) {
        const double gap = at_.gap(pair, state_.packing.radius.size());
        if (gap > limit() || !exists_and_moves(state_.packing, pair) || contacts_.contains(pair)) {
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
    const Approximation& at_;
    std::set<Contact> contacts_;
    std::vector<std::pair<double, Contact>> near_;
    double best_ = std::numeric_limits<double>::infinity();
};

} // namespace

namespace {

/// An own image that cannot move, nearer than a diameter: the largest disk has one if any has.
std::optional<Contact> overlapping_image(const Problem& problem, const State& state) {
    const auto widest = std::max_element(problem.radius.begin(), problem.radius.end());
    const auto disk = static_cast<int>(widest - problem.radius.begin());
    std::vector<double> q;
    for (const Integer& x : problem.stored) {
        q.push_back(approximate(x, problem.fine));
    }
    const CellImages images(state.packing, q);
    const auto range = images.range(2.5 * approximate(*widest, problem.fine));
    if (!images.usable() || !range) {
        return Contact{ContactKind::disk_disk, -1, -1};
    }
    for (int m = -(*range)[0]; m <= (*range)[0]; ++m) {
        for (int p = 0; p <= (*range)[1]; ++p) {
            const Contact pair = pair_of(disk, disk, {{static_cast<std::int8_t>(m), static_cast<std::int8_t>(p), 0}});
            if (pair.image.is_here() || own_image_moves(state.packing, pair)) {
                continue;
            }
            const Row row(pair, problem.disks);
            Integer dx;
            Integer dy;
            row.separate(problem.stored, 0, dx);
            row.separate(problem.stored, 1, dy);
            if (dx * dx + dy * dy < 4 * *widest * *widest) {
                return pair;
            }
        }
    }
    return {};
}

} // namespace

std::optional<Contact> fixed_overlap(const Problem& problem, const State& state) {
    if (state.packing.cell.any()) {
        return overlapping_image(problem, state);
    }
    std::vector<int> fixed;
    for (int i = 0; i < problem.disks; ++i) {
        if (is_fixed(state.packing, i)) {
            fixed.push_back(i);
        }
    }
    const std::vector<Integer>& q = problem.stored;
    const auto coordinate = [&q](int i, std::size_t a) { return q[2 * static_cast<std::size_t>(i) + a]; };
    const auto radius = [&problem](int i) { return problem.radius[static_cast<std::size_t>(i)]; };
    std::sort(fixed.begin(), fixed.end(), [&](int i, int j) { return coordinate(i, 0) < coordinate(j, 0); });
    Integer widest = 0;
    for (const int i : fixed) {
        widest = std::max(widest, radius(i));
    }
    for (std::size_t k = 0; k < fixed.size(); ++k) {
        const int i = fixed[k];
        for (int a = 0; a < 2; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            const Integer wall = q[2 * state.packing.radius.size() + axis];
            if (state.packing.walls.lower[axis] != WallKind::absent && coordinate(i, axis) < radius(i)) {
                return Contact{ContactKind::lower_wall, i, a};
            }
            if (state.packing.walls.upper[axis] == WallKind::fixed && wall - coordinate(i, axis) < radius(i)) {
                return Contact{ContactKind::upper_wall, i, a};
            }
        }
        for (std::size_t m = k + 1; m < fixed.size(); ++m) {
            const int j = fixed[m];
            const Integer dx = coordinate(j, 0) - coordinate(i, 0);
            if (dx >= radius(i) + widest) {
                break;
            }
            const Integer dy = coordinate(j, 1) - coordinate(i, 1);
            const Integer sum = radius(i) + radius(j);
            if (dx * dx + dy * dy < sum * sum) {
                return Contact{ContactKind::disk_disk, std::min(i, j), std::max(i, j)};
            }
        }
    }
    return {};
}

bool is_free_pair(const State& state, const Contact& pair) {
    return exists_and_moves(state.packing, pair) &&
           std::find(state.contacts.begin(), state.contacts.end(), pair) == state.contacts.end();
}

namespace {

/// All pairs, one of each being in the cell itself. Sweep along x: a pair whose centres are further apart in x, or in
/// y, alone cannot be nearer.
void sweep(std::vector<Placed> places, const Approximation& at, double widest, Collector& collector) {
    std::sort(places.begin(), places.end(), [](const Placed& a, const Placed& b) {
        return a.x < b.x || (a.x == b.x && (a.disk < b.disk || (a.disk == b.disk && a.image < b.image)));
    });
    for (std::size_t p = 0; p < places.size(); ++p) {
        const Placed& one = places[p];
        for (std::size_t k = p + 1; k < places.size(); ++k) {
            const Placed& two = places[k];
            const double farthest = widest + collector.limit() + at.error;
            if (two.x - one.x > farthest) {
                break;
            }
            if ((one.central || two.central) && std::abs(two.y - one.y) <= farthest) {
                collector.offer(pair_between(one, two));
            }
        }
    }
}

void sweep_walls(const Problem& problem, Collector& collector) {
    for (int i = 0; i < problem.disks; ++i) {
        for (int a = 0; a < 2; ++a) {
            collector.offer({ContactKind::lower_wall, i, a});
            collector.offer({ContactKind::upper_wall, i, a});
        }
    }
}

/// The pairs that come nearest; nothing: there are too many images to tell.
std::optional<std::vector<Contact>> nearest_pairs(const Problem& problem, const State& state, Approximation at) {
    const double widest = 2 * *std::max_element(at.radius.begin(), at.radius.end());
    if (!state.packing.cell.any()) {
        std::vector<Placed> places;
        for (int i = 0; i < problem.disks; ++i) {
            const auto at_x = 2 * static_cast<std::size_t>(i);
            places.push_back({i, {}, true, at.q[at_x], at.q[at_x + 1]});
        }
        Collector collector(state, at);
        sweep_walls(problem, collector);
        sweep(std::move(places), at, widest, collector);
        return collector.nearest();
    }
    const CellImages images(state.packing, at.q);
    const double error = at.error;
    double reach = 1.25 * widest; // of what is swept: the smallest gap is far below a quarter of that
    std::optional<std::array<int, 2>> range = images.range(reach);
    while (range && images.usable()) {
        at.error = error * (1 + images.periods(*range)); // K9 with images
        Collector collector(state, at);
        sweep_walls(problem, collector);
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
        return {{Contact{ContactKind::disk_disk, -1, -1}, Range::around(0, power_of_two(2000))}};
    }
    std::vector<Gap> gaps;
    for (const Contact& pair : *nearest) {
        gaps.push_back({pair, exact_gap(problem, vertex, pair)});
    }
    return gaps;
}

} // namespace isostat::checker
