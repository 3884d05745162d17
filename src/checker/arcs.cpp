#include "checker/arcs.hpp"

#include "checker/at_wall.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace isostat::checker {

namespace {

constexpr double slack = 0x1p-36; // checker.md K29, of the sine of an angle to a joint, in doubles
// Of the largest length: beside a joint both arcs have one gap, but for roundings.
constexpr double indistinguishable = 0x1p-48; // checker.md K29, gaps that doubles do not tell apart

struct Direction {
    Integer x, y;
};

Integer cross(const Direction& a, const Direction& b) {
    return a.x * b.y - a.y * b.x;
}

Integer size(const Direction& a) {
    return abs(a.x) + abs(a.y);
}

/// Directions between centres at the true vertex: both components are off by at most `off`.
class Directions {
  public:
    Directions(const Problem& problem, const TrueVertex& vertex)
        : problem_(problem), vertex_(vertex), off_(ceiling_of(2 * vertex.radius, -problem.fine)) {}

    [[nodiscard]] Direction between(int from, int to) const {
        const auto at = [&](int disk, std::size_t a) -> Integer {
            return vertex_.middle[problem_.layout.of_disk(disk) + a];
        };
        return {at(to, 0) - at(from, 0), at(to, 1) - at(from, 1)};
    }
    /// From the centre of the larger circle to that of the smaller one.
    [[nodiscard]] Direction joint(int one, int other) const {
        const bool first =
            problem_.radius[static_cast<std::size_t>(one)] < problem_.radius[static_cast<std::size_t>(other)];
        return first ? between(other, one) : between(one, other);
    }
    /// b is to the left of a for certain: by less than half a turn.
    [[nodiscard]] bool left(const Direction& a, const Direction& b) const {
        return cross(a, b) > off_ * (size(a) + size(b)) + 2 * off_ * off_;
    }
    /// The angle from a to b, \pre b is to the left of a.
    [[nodiscard]] static double angle(const Direction& a, const Direction& b) {
        const Integer along = a.x * b.x + a.y * b.y;
        const Integer across = cross(a, b);
        const long scale = -std::max(bits(along), bits(across));
        return std::atan2(approximate(across, scale), approximate(along, scale));
    }

  private:
    const Problem& problem_;
    const TrueVertex& vertex_;
    Integer off_;
};

double side(const Packing& packing, int one, int other) {
    return std::abs(packing.radius[static_cast<std::size_t>(one)] - packing.radius[static_cast<std::size_t>(other)]);
}

int next_of(const std::vector<int>& ring, std::size_t k) {
    return ring[(k + 1) % ring.size()];
}

/// Neighbours touch from within, without rounding, and the joints go around once.
std::string not_convex(const State& state, const Directions& at, const std::vector<int>& ring) {
    const Packing& packing = state.packing;
    double turn = 0;
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const int one = ring[k];
        const int other = next_of(ring, k);
        const Rational difference = Rational(packing.radius[static_cast<std::size_t>(one)]) -
                                    Rational(packing.radius[static_cast<std::size_t>(other)]);
        const auto bar = std::find_if(packing.bars.begin(), packing.bars.end(), [&](const Bar& b) {
            return b.i == std::min(one, other) && b.j == std::max(one, other);
        });
        if (bar == packing.bars.end() || difference == 0 || Rational(bar->length) != abs(difference)) {
            return fmt::format("the arcs of {} and {} are not tangent", one, other);
        }
        const Direction from = at.joint(one, other);
        const Direction to = at.joint(other, next_of(ring, k + 1));
        if (!at.left(from, to)) {
            return fmt::format("the arc of {} is not known to turn to the left", other);
        }
        turn += Directions::angle(from, to);
    }
    // 4: clumps.md U9, the least number of arcs; 3: checker.md K29, between one and two turns
    return ring.size() >= 4 && turn < 3 * std::numbers::pi ? "" : "arcs that are no closed convex curve";
}

} // namespace

std::string unfit_arcs(const Problem& problem, const State& state, const TrueVertex& vertex) {
    const Packing& packing = state.packing;
    if (packing.arcs.empty()) {
        return {};
    }
    if (packing.dimension != plane || packing.cell.any() ||
        std::find(packing.fixed.begin(), packing.fixed.end(), 1) != packing.fixed.end()) {
        return "bodies bounded by arcs are checked in boxes of the plane, without fixed disks";
    }
    const Directions at(problem, vertex);
    std::vector<std::array<int, 2>> joints(packing.radius.size(), {-1, -1}); // neighbours before and after
    const double thinnest = packing.min_radius();
    double largest = 0;
    for (const double x : vertex.middle.near(problem.fine)) {
        largest = std::max(largest, std::abs(x));
    }
    for (const std::vector<int>& ring : packing.arcs) {
        if (std::string why = not_convex(state, at, ring); !why.empty()) {
            return why;
        }
        double shortest = std::numeric_limits<double>::infinity();
        double around = 0;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            shortest = std::min(shortest, side(packing, ring[k], next_of(ring, k)));
            around += side(packing, ring[k], next_of(ring, k));
            joints[static_cast<std::size_t>(ring[k])][1] = next_of(ring, k);
            joints[static_cast<std::size_t>(next_of(ring, k))][0] = ring[k];
        }
        const double smallest = std::min(shortest, thinnest);
        // 9: checker.md K29, the condition on the radius; 0x1p-13: checker.md K29, lengths that doubles tell directions
        // of
        if (!(vertex.radius < Rational(shortest * (shortest / (9 * around)))) || !(smallest > 0x1p-13 * largest)) {
            return "the vertex is not known well enough, or the box too large, to say which arcs are nearest";
        }
    }
    const auto inside = [&](int member, const Direction& n) {
        const auto [before, after] = joints[static_cast<std::size_t>(member)];
        return before < 0 || (at.left(at.joint(before, member), n) && at.left(n, at.joint(member, after)));
    };
    for (const Contact& c : state.contacts) {
        if (!c.is_unilateral()) {
            continue;
        }
        Direction n = c.of_disks() ? at.between(c.i, c.j) : Direction{c.j == 0 ? 1 : 0, c.j == 0 ? 0 : 1};
        if (!c.of_disks()) { // as long as the box: its direction is known, and `left` takes it as well as others
            const Integer along = shifted_left(1, vertex.middle.most_bits()) * -AtWall(c, problem.layout).sign;
            n = {n.x * along, n.y * along};
        }
        if (!inside(c.i, n) || (c.of_disks() && !inside(c.j, {-n.x, -n.y}))) {
            return fmt::format("the normal of {} is not inside the arcs of its members", to_string(c));
        }
    }
    return {};
}

Rational arc_blur(const Packing& packing) {
    Rational most = 0;
    for (const std::vector<int>& ring : packing.arcs) {
        Rational around = 0;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            around += Rational(side(packing, ring[k], next_of(ring, k)));
        }
        most = std::max(most, around);
    }
    return most * power_of_two(-70); // checker.md K29, what sines in doubles leave of a gap
}

NearestArcs::NearestArcs(const Packing& packing, const std::vector<double>& q, const std::vector<double>& radius)
    : packing_(packing), q_(q), radius_(radius) {
    arc_.resize(packing.arcs.empty() ? 0 : packing.radius.size());
    for (std::size_t b = 0; b < packing.arcs.size(); ++b) {
        const std::vector<int>& ring = packing.arcs[b];
        for (std::size_t k = 0; k < ring.size(); ++k) {
            arc_[static_cast<std::size_t>(ring[k])].body = static_cast<int>(b);
            arc_[static_cast<std::size_t>(ring[k])].after = next_of(ring, k);
            arc_[static_cast<std::size_t>(next_of(ring, k))].before = ring[k];
        }
    }
}

std::vector<int> NearestArcs::members(int of) const {
    const int body = arc_[static_cast<std::size_t>(of)].body;
    return body < 0 ? std::vector<int>{of} : packing_.arcs[static_cast<std::size_t>(body)];
}

bool NearestArcs::may_face(int member, double x, double y) const {
    const Arc& arc = arc_[static_cast<std::size_t>(member)];
    const auto left_of_joint = [&](int one, int other, double way) {
        const bool first = radius_[static_cast<std::size_t>(one)] < radius_[static_cast<std::size_t>(other)];
        const std::size_t to = 2 * static_cast<std::size_t>(first ? one : other);
        const std::size_t from = 2 * static_cast<std::size_t>(first ? other : one);
        const double jx = q_[to] - q_[from];
        const double jy = q_[to + 1] - q_[from + 1];
        return way * (jx * y - jy * x) >= -slack * std::hypot(jx, jy) * std::hypot(x, y);
    };
    return arc.body < 0 || (left_of_joint(arc.before, member, 1) && left_of_joint(member, arc.after, -1));
}

/// -infinity: the members do not face each other.
double NearestArcs::gap_if_facing(int i, int j) const {
    const std::size_t one = 2 * static_cast<std::size_t>(i);
    const std::size_t other = 2 * static_cast<std::size_t>(j);
    const double x = q_[other] - q_[one];
    const double y = q_[other + 1] - q_[one + 1];
    return may_face(i, x, y) && may_face(j, -x, -y)
               ? std::hypot(x, y) - radius_[static_cast<std::size_t>(i)] - radius_[static_cast<std::size_t>(j)]
               : -std::numeric_limits<double>::infinity();
}

double NearestArcs::gap_if_facing(int i, int axis, double sign) const {
    const double at = q_[2 * static_cast<std::size_t>(i) + static_cast<std::size_t>(axis)];
    return may_face(i, axis == 0 ? sign : 0, axis == 0 ? 0 : sign)
               ? -sign * at - radius_[static_cast<std::size_t>(i)] // less where the wall is
               : -std::numeric_limits<double>::infinity();
}

bool NearestArcs::contains(const Contact& pair) const {
    if (arc_.empty() || (arc_[static_cast<std::size_t>(pair.i)].body < 0 &&
                         !(pair.of_disks() && arc_[static_cast<std::size_t>(pair.j)].body >= 0))) {
        return true;
    }
    const double sign = pair.is_wall() ? -AtWall(pair, packing_.layout()).sign : 0;
    const double own = pair.of_disks() ? gap_if_facing(pair.i, pair.j) : gap_if_facing(pair.i, pair.j, sign);
    double largest = -std::numeric_limits<double>::infinity();
    for (const int i : members(pair.i)) {
        for (const int j : pair.of_disks() ? members(pair.j) : std::vector<int>{pair.j}) {
            largest = std::max(largest, pair.of_disks() ? gap_if_facing(i, j) : gap_if_facing(i, j, sign));
        }
    }
    return own >= largest - indistinguishable;
}

} // namespace isostat::checker
