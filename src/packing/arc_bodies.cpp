#include "packing/arc_bodies.hpp"

#include "core/refuse.hpp"
#include "packing/bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace isostat {

namespace {

constexpr double slack = 0x1p-36; // of sines: far above the roundings of directions
constexpr double roundings = 0x1p-46;
constexpr double least_share = 0x1p-20;   // of the shortest bar of a ring in the sum of all
constexpr double never_turning = 0x1p400; // length of the normal of a wall: beside it every displacement is 0
constexpr double least_sine = 0x1p-16;    // of a sector: a narrower one, or one as wide, is no arc

double cross(double ax, double ay, double bx, double by) {
    return ax * by - ay * bx;
}

} // namespace

ArcBodies::ArcBodies(const Packing& packing) : packing_(packing) {
    if (packing.arcs.empty()) {
        return;
    }
    neighbours_.resize(packing.radius.size());
    farthest_ = known_to_ = std::numeric_limits<double>::infinity();
    const double thinnest = packing.min_radius();
    for (std::size_t b = 0; b < packing.arcs.size(); ++b) {
        const std::vector<int>& ring = packing.arcs[b];
        double shortest = std::numeric_limits<double>::infinity();
        double around = 0;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            const int before = ring[(k + ring.size() - 1) % ring.size()];
            neighbours_[static_cast<std::size_t>(ring[k])] = {before, ring[(k + 1) % ring.size()], b};
            const double side = std::abs(packing.radius[static_cast<std::size_t>(ring[k])] -
                                         packing.radius[static_cast<std::size_t>(before)]);
            shortest = std::min(shortest, side);
            around += side;
        }
        farthest_ = std::min(farthest_, shortest * shortest / (9 * around));
        const bool fit = shortest > least_share * around && turn(ring).is_once();
        const double known = fit ? slack / 16 * std::min(shortest, thinnest) : 0;
        known_to_ = std::min({known_to_, farthest_, known});
        blur_ = std::max(blur_, 2 * around * slack * slack);
    }
}

double ArcBodies::below(double gap) const {
    return any() && std::isfinite(gap) ? std::nextafter(gap - blur_, -std::numeric_limits<double>::infinity()) : gap;
}

ArcBodies::Vector ArcBodies::between(int from, int to) const {
    return {packing_.coordinate(DiskId(to), 0) - packing_.coordinate(DiskId(from), 0),
            packing_.coordinate(DiskId(to), 1) - packing_.coordinate(DiskId(from), 1)};
}

ArcBodies::Vector ArcBodies::joint(int one, int other) const {
    const auto radius = [&](int i) { return packing_.radius[static_cast<std::size_t>(i)]; };
    return radius(one) < radius(other) ? between(other, one) : between(one, other);
}

ArcBodies::Vector ArcBodies::normal(const Contact& contact) const {
    if (contact.of_disks()) {
        return between(contact.i, contact.j);
    }
    const double along = contact.wall().side * never_turning;
    return contact.j == 0 ? Vector{along, 0} : Vector{0, along};
}

/// The smaller one of the sines of the angles from the joints to a direction n, less what a displacement of the centres
/// by `moved` can change: infinity of a full circle. Sectors are narrower than pi.
double ArcBodies::inside(int member, Vector n, double moved) const {
    const Neighbours& at = neighbours_[static_cast<std::size_t>(member)];
    if (at.before < 0) {
        return std::numeric_limits<double>::infinity();
    }
    const Vector from = joint(at.before, member);
    const Vector to = joint(member, at.after);
    const double size = std::hypot(n.x, n.y);
    const auto sine = [&](double times, const Vector& at_joint) {
        const double length = std::hypot(at_joint.x, at_joint.y);
        // A vector of two centres turns by an angle whose sine is at most 2 moved over its length.
        return times / (length * size) - 2.2 * moved * (1 / length + 1 / size);
    };
    return std::min(sine(cross(from.x, from.y, n.x, n.y), from), sine(cross(n.x, n.y, to.x, to.y), to));
}

double ArcBodies::inside(const Contact& contact, double moved) const {
    const Vector n = normal(contact);
    const double first = inside(contact.i, n, moved);
    return contact.of_disks() ? std::min(first, inside(contact.j, {-n.x, -n.y}, moved)) : first;
}

bool ArcBodies::faces(const Contact& contact, double moved) const {
    return !any() || !contact.is_unilateral() || (moved < farthest_ && inside(contact, moved) > roundings);
}

std::vector<int> ArcBodies::shape(int member) const {
    const Neighbours& at = neighbours_[static_cast<std::size_t>(member)];
    return at.before < 0 ? std::vector<int>{member} : packing_.arcs[at.body];
}

double ArcBodies::gap(const Contact& pair) const {
    const auto radius = [&](int i) { return packing_.radius[static_cast<std::size_t>(i)]; };
    if (pair.of_disks()) {
        const Vector n = between(pair.i, pair.j);
        return std::hypot(n.x, n.y) - (radius(pair.i) + radius(pair.j));
    }
    const double x = packing_.coordinate(DiskId(pair.i), pair.j);
    const auto wall = wall_coordinate(pair, packing_.layout());
    return pair.wall().side * ((wall ? packing_.q[*wall] : 0) - x) - radius(pair.i);
}

bool ArcBodies::is_nearest(const Contact& pair) const {
    const auto is_arc = [&](int i) { return neighbours_[static_cast<std::size_t>(i)].before >= 0; };
    if (!any() || (!is_arc(pair.i) && !(pair.of_disks() && is_arc(pair.j)))) {
        return true;
    }
    Contact nearest{ContactKind::disk_disk, -1, -1};
    double largest = -std::numeric_limits<double>::infinity();
    const auto look = [&](const Contact& other) {
        if (inside(other, 0) >= -slack && gap(other) > largest) {
            largest = gap(other);
            nearest = other;
        }
    };
    for (const int i : shape(pair.i)) {
        if (!pair.of_disks()) {
            look({pair.kind, i, pair.j});
            continue;
        }
        for (const int j : shape(pair.j)) {
            look(pair_of(i, j));
        }
    }
    return nearest == pair || nearest.i < 0; // none is known: all of them are asked
}

std::optional<std::array<double, 2>> ArcBodies::angles(int member) const {
    if (!any() || neighbours_[static_cast<std::size_t>(member)].before < 0) {
        return {};
    }
    const Neighbours& at = neighbours_[static_cast<std::size_t>(member)];
    const Vector first = joint(at.before, member);
    const Vector last = joint(member, at.after);
    const double from = std::atan2(first.y, first.x);
    const double to = std::atan2(last.y, last.x);
    return std::array{from, to > from ? to : to + 2 * std::numbers::pi};
}

bool ArcBodies::Turn::is_once() const {
    return convex && std::abs(together - 2 * std::numbers::pi) < 1; // a multiple of 2 pi
}

ArcBodies::Turn ArcBodies::turn(const std::vector<int>& ring) const {
    Turn turn;
    for (const int member : ring) {
        const auto sector = *angles(member);
        turn.together += sector[1] - sector[0];
        turn.convex = turn.convex && std::sin(sector[1] - sector[0]) > least_sine;
    }
    return turn;
}

void validate_arcs(const Packing& packing, const std::string& source) {
    const auto bad = [&](std::size_t b, const std::string& what) { refuse(source, "arcs[{}]: {}", b, what); };
    const Bodies bodies(packing);
    std::vector<unsigned char> used(packing.radius.size());
    for (std::size_t b = 0; b < packing.arcs.size(); ++b) {
        const std::vector<int>& ring = packing.arcs[b];
        if (packing.dimension != plane || packing.cell.any()) {
            bad(b, "a body bounded by arcs: expected a box in the plane");
        }
        if (ring.size() < 4) {
            bad(b, fmt::format("{} arcs: expected at least four", ring.size()));
        }
        for (const int member : ring) {
            if (member < 0 || member >= packing.disk_count() || used[static_cast<std::size_t>(member)]++ != 0 ||
                packing.is_fixed(DiskId(static_cast<std::size_t>(member)))) {
                bad(b, fmt::format("member {}: expected a disk from 0 to {} that is not fixed, each once", member,
                                   packing.disk_count() - 1));
            }
        }
        const auto members =
            std::ranges::count_if(ring, [&](int member) { return bodies.of(member) == bodies.of(ring.front()); });
        std::size_t in_body = 0;
        for (int i = 0; i < packing.disk_count(); ++i) {
            in_body += bodies.of(i) == bodies.of(ring.front()) ? 1 : 0;
        }
        if (members != static_cast<std::ptrdiff_t>(ring.size()) || in_body != ring.size()) {
            bad(b, "expected all members of one body");
        }
        for (std::size_t k = 0; k < ring.size(); ++k) {
            const auto [i, j] = std::minmax(ring[k], ring[(k + 1) % ring.size()]);
            const double large =
                std::max(packing.radius[static_cast<std::size_t>(i)], packing.radius[static_cast<std::size_t>(j)]);
            const double small =
                std::min(packing.radius[static_cast<std::size_t>(i)], packing.radius[static_cast<std::size_t>(j)]);
            const double side = large - small;
            const double rest = side - large;
            const bool exact = (large - (side - rest)) - (small + rest) == 0; // what was rounded away (Knuth)
            const auto bar = std::ranges::lower_bound(packing.bars, Bar{i, j, 0});
            const bool there = bar != packing.bars.end() && bar->i == i && bar->j == j;
            if (!there || !exact || !(side > 0) || bar->length != side) {
                bad(b, fmt::format("members {} and {} of radii {} and {}, {}: expected a bar of exactly the difference "
                                   "of the radii, a double above 0 without rounding",
                                   i, j, packing.radius[static_cast<std::size_t>(i)],
                                   packing.radius[static_cast<std::size_t>(j)],
                                   there ? fmt::format("with a bar of length {}", bar->length) : "without a bar"));
            }
        }
    }
    const ArcBodies arcs(packing);
    for (std::size_t b = 0; b < packing.arcs.size(); ++b) {
        if (const ArcBodies::Turn turn = arcs.turn(packing.arcs[b]); !turn.is_once()) {
            bad(b, fmt::format("the arcs turn by {:.6g}{}: expected a convex curve, counterclockwise, whose arcs turn "
                               "by less than pi each and by 2 pi together",
                               turn.together,
                               turn.convex ? "" : ", one of them by less than 2^-16 or by nearly pi or more"));
        }
    }
}

void require_no_arcs(const Packing& packing, const std::string& source, const std::string& what) {
    if (!packing.arcs.empty()) {
        refuse(source,
               "{} bodies bounded by arcs; {} does not take them: inspect, certify, verify (of certificates) and "
               "report do",
               packing.arcs.size(), what);
    }
}

} // namespace isostat
