#include "checker/gaps.hpp"

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

/// The middle of the enclosure of the true vertex in doubles, with one bound for the error of any gap computed from it.
struct Approximation {
    std::vector<double> q;
    std::vector<double> radius;
    double error = 0;

    Approximation(const Problem& problem, const TrueVertex& vertex) {
        double largest = 0;
        for (const Integer& x : vertex.middle) {
            q.push_back(approximate(x, problem.fine));
            largest = std::max(largest, std::abs(q.back()));
        }
        for (const Integer& r : problem.radius) {
            radius.push_back(approximate(r, problem.fine));
            largest = std::max(largest, radius.back());
        }
        // K9: 60 units in the last place of the largest length, and three radii of the enclosure.
        error = 0x1p-47 * largest + 4 * rounded_up(vertex.radius);
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
