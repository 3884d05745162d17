#include "checker/gaps.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace isostat::checker {

namespace {

bool is_fixed(const Packing<2>& packing, int disk) {
    return !packing.fixed.empty() && packing.fixed[static_cast<std::size_t>(disk)] != 0;
}

bool exists_and_moves(const Packing<2>& packing, const Contact& pair) {
    const auto axis = static_cast<std::size_t>(pair.j);
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
            const double dx = q[2 * i] - q[2 * j];
            const double dy = q[2 * i + 1] - q[2 * j + 1];
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
    const Range blur = Range::around(0, 3 * vertex.radius);
    if (pair.kind == ContactKind::disk_disk) {
        const Integer dx = q[2 * i] - q[2 * j];
        const Integer dy = q[2 * i + 1] - q[2 * j + 1];
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
    Collector(const State<2>& state, const Approximation& at) : state_(state), at_(at) {
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
    [[nodiscard]] std::vector<Contact> nearest() const {
        std::vector<Contact> pairs;
        for (const auto& [gap, pair] : near_) {
            if (gap <= limit()) {
                pairs.push_back(pair);
            }
        }
        return pairs;
    }

  private:
    const State<2>& state_;
    const Approximation& at_;
    std::set<Contact> contacts_;
    std::vector<std::pair<double, Contact>> near_;
    double best_ = std::numeric_limits<double>::infinity();
};

} // namespace

std::optional<Contact> fixed_overlap(const Problem& problem, const State<2>& state) {
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

bool is_free_pair(const State<2>& state, const Contact& pair) {
    return exists_and_moves(state.packing, pair) &&
           std::find(state.contacts.begin(), state.contacts.end(), pair) == state.contacts.end();
}

std::vector<Gap> smallest_gaps(const Problem& problem, const State<2>& state, const TrueVertex& vertex) {
    const Approximation at(problem, vertex);
    Collector collector(state, at);
    for (int i = 0; i < problem.disks; ++i) {
        for (int a = 0; a < 2; ++a) {
            collector.offer({ContactKind::lower_wall, i, a});
            collector.offer({ContactKind::upper_wall, i, a});
        }
    }
    // Sweep along x: a pair whose centres are further apart in x alone cannot be nearer.
    std::vector<int> order(static_cast<std::size_t>(problem.disks));
    std::iota(order.begin(), order.end(), 0);
    const auto x = [&at](int disk) { return at.q[2 * static_cast<std::size_t>(disk)]; };
    std::sort(order.begin(), order.end(), [&x](int i, int j) { return x(i) < x(j) || (x(i) == x(j) && i < j); });
    const double widest = 2 * *std::max_element(at.radius.begin(), at.radius.end());
    for (std::size_t p = 0; p < order.size(); ++p) {
        for (std::size_t k = p + 1; k < order.size(); ++k) {
            if (x(order[k]) - x(order[p]) - widest > collector.limit() + at.error) {
                break;
            }
            collector.offer({ContactKind::disk_disk, std::min(order[p], order[k]), std::max(order[p], order[k])});
        }
    }
    std::vector<Gap> gaps;
    for (const Contact& pair : collector.nearest()) {
        gaps.push_back({pair, exact_gap(problem, vertex, pair)});
    }
    return gaps;
}

} // namespace isostat::checker
