#pragma once
// Families that approach a degeneracy: each asks one question of a packing that is delta away from it, and says what
// the answer was, and on which rung. A positive and a negative delta have opposite answers, 0 has none.
//
// Coordinates and radii are doubles: what differs by delta in a radius of size 1 cannot differ by less than 2^-52,
// however many bits the decision has. Loads and heights above a straight line can, down to 1e-300. For the others the
// same question is put to exact coordinates (rational numbers), which carry every delta.

#include "oracle/structures.hpp"
#include "support/crafted.hpp"
#include "support/loaded.hpp"
#include "verified/inverse_bound.hpp"

#include <isostat/crafted/exact_packing.hpp>

namespace families {

using namespace isostat;
using namespace ::crafted;
using exact::Number;
using isostat::crafted::exact_contacts;
using isostat::crafted::ExactPacking;
using isostat::crafted::inspect;
using isostat::crafted::inspect_contacts;

/// What a decision said.
struct Answer {
    int sign = 0; ///< +1 or -1: which of the two; 0: a tie
    Rung rung = Rung::none;
    int bits = 0;
    double margin = 0;
    std::string why{}; ///< for messages
};

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Unit disks 0 and 1 on the bottom side by side between the side walls, 2 on top of 0 under the top wall: all
/// coordinates are integers, so the stored configuration is the true vertex. Forces in y on the disks.
inline State stack(double up0, double up1, double up2) {
    State state = in_box({{1, 1, 1}, {1, 3, 1}, {1, 1, 3}}, 4, 4, 1, 1,
                         {left(0), bottom(0), left(2), pair(0, 2), pair(0, 1), bottom(1), right(1), top(2)});
    state.load.disk_force = {0, up0, 0, up1, 0, up2};
    return state;
}

inline Answer which_opens(const State& state, const Contact& plus, const Contact& minus) {
    AtVertex s(state);
    const double sigma = state.load.stress[1];
    const auto decision = decide_opening(s.statics, sigma, OpeningRule::most_negative, {}, 0);
    Answer answer{0, s.statics.rung(), s.statics.bits(), 0};
    if (decision.ok() && decision.value().opening) {
        const Contact opened = state.contacts[decision.value().opening->contact.index()];
        answer.sign = opened == plus ? 1 : opened == minus ? -1 : 0;
        answer.margin = decision.value().opening->margin;
    }
    return answer;
}

inline Answer tractions(double delta) {
    return which_opens(stack(2, 1, delta), bottom(0), bottom(1));
}

inline Answer limits(double delta) {
    const State state = stack(delta, -1, 0.5);
    AtVertex s(state);
    const auto limit = find_limit(s.statics, 1, -1);
    Answer answer{0, s.statics.rung(), s.statics.bits(), 0};
    if (limit.ok() && limit.value().tie_class.size() == 1) {
        answer.sign = state.contacts[limit.value().opens.index()] == bottom(0) ? 1 : -1;
        answer.margin = limit.value().margin;
    }
    return answer;
}

/// Radii of the two base disks of a notch differ by delta: which side of the small disk lets go. Below 2^-52 the radii
/// themselves are equal.
inline Answer notch(double delta) {
    const Answer answer = delta >= 0 ? which_opens(three_disks(1, 1 + delta, 0.1, 1, -1), pair(0, 2), pair(1, 2))
                                     : which_opens(three_disks(1 - delta, 1, 0.1, 1, -1), pair(0, 2), pair(1, 2));
    return answer;
}

/// A disk between two fixed ones, delta off collinear: compression on one side, traction on the other. A statement
/// about the stored matrix.
inline Answer strut(double delta) {
    const oracle::Structure s = oracle::needle(1, delta);
    const auto proved = IsostaticStructure::prove(s.packing, s.contacts);
    if (!proved.ok()) {
        return {0, Rung::exact, 0, 0}; // singular, as it should be at 0
    }
    const Factorisation factorisation(proved.value());
    InverseBoundCache cache;
    InverseBound inverse = bound_inverse(proved.value(), factorisation, cache);
    if (inverse.verdict != Verdict::proved) {
        inverse = bound_inverse_multiprecision(s.packing, proved.value());
    }
    ForceLadder ladder(s.packing, proved.value(), factorisation, inverse);
    ForceExpression e{.contact = ContactId(0), .part = ladder.add({0, 1})};
    Order order = ladder.sign(e);
    while (!order.decided && ladder.climb()) {
        order = ladder.sign(e);
    }
    return {order.decided ? order.sign : 0, order.rung, order.bits, order.margin};
}

/// A candidate contact that misses, or overlaps, by about delta at the true vertex.
inline Answer grazing(double delta) {
    State state = square_lattice(2);
    std::erase(state.contacts, pair(2, 3));
    std::erase(state.contacts, pair(1, 3));
    state.packing.radius[3] = 1 - delta;
    state.packing.q[6] = 3 + delta;
    state.packing.q[7] = 3 + delta;
    AtVertex s(state);
    if (s.vertex.verdict != Verdict::proved) {
        s.vertex = enclose_vertex_double_double(state.packing, s.structure, s.factorisation, s.inverse);
    }
    const Enclosure h = gap_at_vertex(state.packing, s.vertex, pair(2, 3));
    if (h.decided()) {
        return {h.positive() ? 1 : -1, Rung::double_bound, 53, h.margin()};
    }
    s.vertex = enclose_vertex_double_double(state.packing, s.structure, s.factorisation, s.inverse);
    const Enclosure closer = gap_at_vertex(state.packing, s.vertex, pair(2, 3));
    if (closer.decided()) {
        return {closer.positive() ? 1 : -1, Rung::double_double, 106, closer.margin()};
    }
    const Order order = gap_signs_at_vertex(state.packing, s.structure, s.factorisation, s.inverse, {pair(2, 3)})[0];
    return {order.decided ? order.sign : 0, order.rung, order.bits, order.margin};
}

// --- whole arcs: a contact opens, the mechanism is followed, and what closes first tells the sign -------------------

/// `plus` or `minus` closed first in the first arc of a run, or a tie was named.
inline Answer which_closes(const State& state, const Contact& plus, const Contact& minus) {
    const Played run = play(state, +1, 1);
    if (run.records.arcs.empty()) {
        const bool tie = run.outcome.failure && run.outcome.failure->kind == FailureKind::tie;
        return {0, tie ? Rung::exact : Rung::none, 0, 0, run.why()};
    }
    const ArcRecord& arc = run.records.arcs.front();
    const int bits = arc.decided_by == Rung::double_bound ? 53 : arc.decided_by == Rung::double_double ? 106 : 256;
    return {arc.closed == plus ? 1 : arc.closed == minus ? -1 : 0, arc.decided_by, bits, arc.margin, run.why()};
}

/// A disk sinks between two that part until the top wall meets one of them: the radii of the two differ by delta.
inline Answer closings(double delta) {
    return which_closes(three_disks(1, 1 + delta, 0.5, 1, 1), top(1), top(0));
}

/// The end of the three disks: the third, of radius 1 + delta, comes down to the bottom, or the top wall to the first.
inline Answer ends(double delta) {
    return which_closes(three_disks(1, 0.9, 1 + delta, 1, 1), bottom(2), top(0));
}

// --- exact coordinates ----------------------------------------------------------------------------------------------

/// delta as a decimal number, 10^-decade with a sign: exactly that, for every decade. 0 for `decade` = 0.
inline Number decimal(int sign, int decade) {
    const Number size = decade == 0 ? Number(0) : Number::parse("1e-" + std::to_string(decade));
    return sign < 0 ? -size : size;
}

inline ExactPacking exact_box(const std::vector<std::array<Number, 3>>& disks, const Number& lx, const Number& ly) {
    ExactPacking packing;
    for (const auto& [x, y, r] : disks) {
        packing.centre.push_back({x, y});
        packing.radius.push_back(r);
    }
    packing.walls = Walls::box();
    packing.length = {lx, ly};
    return packing;
}

/// The place where `first` closes: admissible, hence `first` closes first; not admissible, hence `second` closed
/// before; both closed, a tie.
inline Answer which_is_closed(const ExactPacking& there, const Contact& first, const Contact& second) {
    const auto contacts = exact_contacts(there);
    if (!contacts.ok()) {
        const bool named = contacts.failure().message().find(to_string(second)) != std::string::npos;
        return {named ? -1 : 0, named ? Rung::exact : Rung::none, 0, infinity, contacts.failure().message()};
    }
    const auto has = [&](const Contact& c) { return std::ranges::find(contacts.value(), c) != contacts.value().end(); };
    const bool tie = has(first) && has(second);
    return {has(first) && !tie ? 1 : 0, has(first) ? Rung::exact : Rung::none, 0, infinity, "exact contacts"};
}

/// Two disks in a box: disk 1, of radius (1 + delta)^2, rolls down disk 0, of radius 1, until it meets the bottom, or
/// the top wall meets disk 0. The first of the two ends.
inline Answer exact_ends(int sign, int decade) {
    const Number s = Number(1) + decimal(sign, decade);
    const Number r = s * s;
    const Number x = Number(1) + Number(2) * s; // 2 sqrt(r) apart along x when both stand on the bottom
    // Where the top wall meets disk 0: disk 1 at the height 2 - r, which is above the bottom if r < 1.
    return which_is_closed(exact_box({{1, 1, 1}, {x, Number(2) - r, r}}, x + r, 2), top(0), bottom(1));
}

/// Two disks on the bottom, of radii 1 and (64/25 + s^2) / 4, s = 6/5 + delta, and a third, of radius 9/25, between
/// them under the top wall at the height 2.
inline Answer exact_closings(int sign, int decade) {
    const Number s = Number(6) / Number(5) + decimal(sign, decade);
    const Number r = (Number(64) / Number(25) + s * s) / Number(4);
    const Number small = Number(9) / Number(25);
    const Number x = Number(11) / Number(5); // 2 sqrt(small) from disk 0; disk 1 is s further on
    return which_is_closed(exact_box({{1, 1, 1}, {x + s, r, r}, {x, Number(2) - small, small}}, x + s + r, 2), top(0),
                           top(1));
}

/// The disk in the corner of a lattice of four is smaller by delta than its place: it passes its neighbours, grazes
/// them, or overlaps.
inline Answer exact_grazing(int sign, int decade) {
    const Number d = decimal(sign, decade);
    const Number at = Number(3) + d;
    const auto contacts = exact_contacts(exact_box({{1, 1, 1}, {3, 1, 1}, {1, 3, 1}, {at, at, Number(1) - d}}, 4, 4));
    if (!contacts.ok()) {
        return {-1, Rung::exact, 0, infinity, contacts.failure().message()};
    }
    const bool touches = std::ranges::find(contacts.value(), pair(2, 3)) != contacts.value().end();
    return {touches ? 0 : 1, Rung::exact, 0, infinity, "exact contacts"};
}

/// The lattice of four, its last disk smaller by delta (it lies in its corner, a rattler), or larger (it carries both
/// walls alone). With equal disks h = 2, and the load has no unique forces.
inline Answer exact_lattice(int sign, int decade) {
    ExactPacking packing;
    if (sign >= 0) {
        const Number d = decimal(sign, decade);
        const Number at = Number(3) + (decade == 0 ? Number(0) : d);
        packing = exact_box({{1, 1, 1}, {3, 1, 1}, {1, 3, 1}, {at, at, Number(1) - d}}, 4, 4);
    } else {
        // (2 + e)^2 = 2 t^2 + 2 has the rational points t = 1 + (1 - eta) e, e = 4 eta / (1 - 4 eta + 2 eta^2).
        const Number eta = decimal(1, decade) / Number(4);
        const Number e = Number(4) * eta / (Number(1) - Number(4) * eta + Number(2) * eta * eta);
        const Number at = Number(2) + Number(1) + (Number(1) - eta) * e;
        packing = exact_box({{1, 1, 1}, {3, 1, 1}, {1, 3, 1}, {at, at, Number(1) + e}}, at + Number(1) + e,
                            at + Number(1) + e);
    }
    packing.load.emplace();
    packing.load->wall = {Number(1), Number(2)};
    const auto inspected = inspect(packing);
    if (!inspected.ok()) {
        return {0, Rung::none, 0, 0, inspected.failure().message()};
    }
    const auto& seen = inspected.value();
    if (seen.hyperstaticity != 0 || seen.rank_exact != Verdict::proved) {
        return {0, Rung::exact, 0, 0, "h = " + std::to_string(seen.hyperstaticity)};
    }
    const bool rattler = std::ranges::find(seen.without_force, 3) != seen.without_force.end();
    return {rattler ? 1 : -1, Rung::exact, 0, infinity, rattler ? "disk 3 is a rattler" : "disk 3 carries the walls"};
}

/// The notch of three disks, the base of radii 1 and (1 + delta)^2: which of the two upper contacts pulls more.
inline Answer exact_notch(int sign, int decade) {
    const Number s = Number(1) + decimal(sign, decade);
    const Number r = s * s;
    // The triangle of the centres has the sides 1 + r, 1 + t, r + t; its area s k is rational when t (1 + r + t) = k^2.
    const Number t = Number(1) / Number(16) / (r + Number(1) / Number(2));
    const Number k = t + Number(1) / Number(4);
    const Number d = Number(1) + r;
    const Number along = ((Number(1) + t) * (Number(1) + t) - (r + t) * (r + t) + d * d) / (Number(2) * d);
    const Number across = Number(2) * s * k / d;
    const Number bx = Number(2) * s; // from centre to centre of the base
    const Number by = r - Number(1);
    const Number x = Number(1) + (along * bx - across * by) / d;
    const Number y = Number(1) + (along * by + across * bx) / d;
    ExactPacking packing = exact_box({{1, 1, 1}, {Number(1) + bx, r, r}, {x, y, t}}, Number(1) + bx + r, y + t);
    packing.load.emplace();
    packing.load->wall = {Number(1), Number(-1)};
    const std::vector<Contact> contacts{left(0),    bottom(0), pair(0, 1), pair(0, 2),
                                        pair(1, 2), right(1),  bottom(1),  top(2)};
    const auto seen = inspect_contacts(packing, contacts); // the wall reaches into the notch: no gap is asked for
    if (!seen.forces_unique || seen.forces.size() != contacts.size()) {
        return {0, Rung::none, 0, 0, "the forces are not unique"};
    }
    return {(seen.forces[4] - seen.forces[3]).sign(), Rung::exact, 0, infinity, "exact forces"};
}

} // namespace families
