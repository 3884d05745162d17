#include "trajectory/ties/ties.hpp"

#include "contact/words.hpp"
#include "core/roundoff.hpp"
#include "core/splitmix.hpp"
#include "statics/proved_minimum.hpp"
#include "verified/precise_first_order.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

using roundoff::u;
constexpr Contact nobody{ContactKind::disk_disk, -1, -1};

/// Step length c / |rate| of a pair that closes.
Enclosure length_of_way(const Enclosure& gap, const Enclosure& rate) {
    const double value = gap.value / std::abs(rate.value);
    const double smallest = std::abs(rate.value) - rate.radius;
    return {value, (gap.radius + std::abs(value) * rate.radius) / smallest * (1 + 16 * u) + 4 * u * std::abs(value)};
}

} // namespace

std::vector<double> tie_direction(const std::vector<double>& radius, std::uint64_t seed) {
    const double smallest = *std::min_element(radius.begin(), radius.end());
    int exponent = 0;
    std::frexp(smallest, &exponent); // smallest = x 2^exponent, x in [1/2, 1)
    std::vector<double> rho;
    rho.reserve(radius.size());
    for (std::size_t i = 0; i < radius.size(); ++i) {
        rho.push_back(std::ldexp(static_cast<double>(splitmix(seed, i + 1) >> 48) - 32768, exponent - 1 - 16));
    }
    return rho;
}

namespace {

/// Whether the rate is 0 to within `tie_bits`.
bool vanishes(const Enclosure& rate) {
    return std::abs(rate.value) + rate.radius <= std::ldexp(1.0, -tie_bits);
}

/// First-order terms of a vertex: in double, then with more bits where double does not decide.
class Terms {
  public:
    explicit Terms(const Vertex& vertex)
        : first_(vertex.perturbed->first), rho_(*vertex.perturbed->rho),
          precise_(vertex.packing, vertex.structure, vertex.factorisation, vertex.inverse, vertex.ladder) {}

    /// Exactly 0, radius 0, when it is 0 for a structural reason.
    Enclosure rate(ContactId opened, int direction, const Contact& pair) {
        const Enclosure rate = first_.rate(opened, direction, pair);
        return rate.decided() || rate.radius == 0 ? rate : precise_.rate(opened, direction, pair);
    }
    /// Second derivative of a gap whose rate vanishes to within `tie_bits`; otherwise unknown.
    Enclosure bend(const Enclosure& rate, ContactId opened, int direction, const Contact& pair) {
        return vanishes(rate) ? precise_.bend(opened, direction, pair)
                              : Enclosure{0, std::numeric_limits<double>::infinity()};
    }
    Enclosure gap(const Contact& pair) {
        const Enclosure c = first_.gap(pair);
        return c.decided() ? c : precise_.gap(rho_, pair);
    }
    /// Step length of a pair that closes, from its first-order gap. With nearly singular contacts step lengths in
    /// double cannot be told apart.
    Enclosure way(const Enclosure& gap, const Enclosure& rate, ContactId opened, int direction, const Contact& pair) {
        constexpr double enough = 1e-9;
        const Enclosure way = length_of_way(gap, rate);
        if (way.radius <= enough * std::abs(way.value)) {
            return way;
        }
        const Enclosure closer = precise_.rate(opened, direction, pair);
        return closer.negative() ? length_of_way(precise_.gap(rho_, pair), closer) : way;
    }

  private:
    const FirstOrder& first_;
    const std::vector<double>& rho_;
    PreciseFirstOrder precise_;
};

struct Closing {
    Contact contact;
    Enclosure way;
};

/// The pair that is proved to close first of those that close at once; where ties are chosen, the first by name of the
/// pairs before which no other is proved to close.
Result<Contact> first_of(const std::vector<Closing>& closing, bool choose, std::vector<TieDecision>& settled) {
    const auto before = [](const Closing& a, const Closing& b) { return (b.way - a.way).positive(); };
    auto first = std::min_element(closing.begin(), closing.end(),
                                  [](const Closing& a, const Closing& b) { return a.way.value < b.way.value; });
    if (choose) {
        const auto unbeaten = [&](const Closing& a) {
            return std::none_of(closing.begin(), closing.end(), [&](const Closing& b) { return before(b, a); });
        };
        for (auto other = closing.begin(); other != closing.end(); ++other) {
            first = unbeaten(*other) && (!unbeaten(*first) || other->contact < first->contact) ? other : first;
        }
    }
    for (const Closing& other : closing) {
        if (&other == &*first) {
            continue;
        }
        TieDecision step{"step", first->contact, first->way, other.contact, other.way, 0, 0};
        if (!before(*first, other)) {
            if (!choose) {
                return failed(FailureKind::undecided,
                              "tied at first order too: {} and {} touch, and close again after ways of eps "
                              "({}) and eps ({})",
                              named(first->contact), named(other.contact), shown(first->way), shown(other.way));
            }
            step.choice = TieChoice::names;
        }
        settled.push_back(std::move(step));
    }
    if (closing.size() == 1) {
        settled.push_back({"step", first->contact, first->way, nobody, {}, 0, 0});
    }
    return first->contact;
}

} // namespace

Result<Departure> depart(const Vertex& from, ContactId opened, int direction) {
    Departure departure;
    std::vector<Closing> closing;
    std::vector<TieDecision> assumed;
    const bool chooses = from.perturbed->statics.chooses();
    const bool held = from.structure.contacts()[opened.index()].kind == ContactKind::held;
    Terms terms(from);
    for (const auto& [contact, c] : from.perturbed->touching) {
        const Enclosure rate = terms.rate(opened, direction, contact);
        if (rate.value == 0 && rate.radius == 0) {
            departure.kept_touching.push_back(contact);
            continue;
        }
        const bool asks = chooses && !rate.decided();
        const Enclosure bend = asks ? terms.bend(rate, opened, direction, contact) : Enclosure{0, 0};
        if (rate.positive() || bend.positive()) {
            departure.leaving.push_back(contact);
        } else if (rate.negative()) {
            closing.push_back({contact, terms.way(c, rate, opened, direction, contact)});
        } else if (bend.negative() && !held) {
            if (!departure.overlaps || contact < departure.overlaps->pair) {
                departure.overlaps = BentPair{contact, rate, bend};
            }
        } else if (chooses && from.perturbed->first.moves_as_linkage(opened, contact)) {
            departure.kept_touching.push_back(contact);
        } else if (asks && !bend.negative() && vanishes(rate)) {
            departure.assumed_touching.push_back(contact);
            assumed.push_back(
                {"rest", contact, bend, from.structure.contacts()[opened.index()], rate, 0, 0, TieChoice::zero});
        } else {
            return failed(FailureKind::undecided,
                          "{} touch without being a contact, and the rate of their gap when {} opens is "
                          "not told from 0: {}; pairs that move alike are not followed at first order{}",
                          named(contact), named(from.structure.contacts()[opened.index()]), shown(rate),
                          asks ? words(" (second derivative {})", shown(bend)) : Words());
        }
    }
    if (closing.empty()) {
        departure.settled = std::move(assumed);
        return departure;
    }
    const auto first = first_of(closing, from.perturbed->statics.chooses(), departure.settled);
    if (!first.ok()) {
        return first.failure();
    }
    departure.closes = first.value();
    departure.overlaps.reset();
    return departure;
}

namespace {

/// The recorded choice for a pair that touches and stays watched.
TieChoice watched(const Enclosure& gap) {
    return gap.positive() ? TieChoice::none : gap.negative() ? TieChoice::watched : TieChoice::zero;
}

/// A pair that touches where an arc ends.
struct TouchingPair {
    Enclosure gap;  ///< at first order
    bool touched;   ///< touched at the start too
    Enclosure back; ///< rate of its gap backwards from the end, where it did not
};

Result<TouchingPair> touching_pair(Terms& terms, bool chooses, const Contact& closed, const Contact& contact,
                                   const Way& way) {
    const Enclosure c = terms.gap(contact);
    if (!c.decided() && !chooses) {
        return failed(FailureKind::undecided,
                      "{} touch where {} closes, and their first-order gap is not told from 0: {}", named(contact),
                      named(closed), shown(c));
    }
    if (way.stays || std::find(way.touching.begin(), way.touching.end(), contact) != way.touching.end()) {
        return TouchingPair{c, true, {}};
    }
    // Simple roots (P3): backwards from the end both open.
    const Enclosure back = terms.rate(way.slot, +1, contact);
    const Enclosure bend = terms.bend(back, way.slot, +1, contact);
    const bool grazes = chooses && vanishes(back) && !bend.negative(); // as far as the end decides (C1 f)
    if (!grazes && (closed.kind == ContactKind::held || !back.positive())) {
        return failed(FailureKind::undecided,
                      "{} touch where {} closes, but are not proved to close there: the rate of their gap is {} times "
                      "that of the other{}; grazing is not followed at first order",
                      named(contact), named(closed), shown(back),
                      vanishes(back) ? words(", the second derivative {}", shown(bend)) : Words());
    }
    return TouchingPair{c, grazes, back};
}

} // namespace

Result<Arrival> arrive(Vertex& to, const ZeroGaps& zero, const Way& way) {
    Arrival arrival;
    FirstOrderVertex& side = *to.perturbed;
    const bool chooses = side.statics.chooses();
    side.touching.clear();
    side.zero = zero;
    const Contact& closed = to.structure.contacts()[way.slot.index()];
    Terms terms(to);
    double first = 0;                // where, in eps, the first of the pairs closed that closed before
    std::optional<Failure> doubtful; // this end is doubtful, because another pair may close first
    for (const auto& [contact, order] : zero) {
        const auto pair = touching_pair(terms, chooses, closed, contact, way);
        if (!pair.ok()) {
            doubtful = doubtful ? doubtful : pair.failure();
            continue;
        }
        const auto& [c, touched, back] = pair.value();
        const bool may_overlap = chooses && (way.stays ? way.overlapped : touched);
        if (c.negative() && !may_overlap) {
            if (touched && !way.stays) {
                doubtful =
                    failed(FailureKind::undecided, "{} at rest overlap at first order: {}", named(contact), shown(c));
                continue;
            }
            const double where = touched ? c.value : c.value / back.value; // P3
            if (where < first) {
                first = where;
                arrival.earlier = contact;
            }
            continue;
        }
        side.touching.emplace_back(contact, c);
        arrival.settled.push_back({"gap", closed, {0, 0}, contact, c, order.exponent, order.bits, watched(c)});
    }
    if (doubtful && !arrival.earlier) {
        return *doubtful;
    }
    return arrival;
}

std::optional<Failure> settle_touching(Vertex& vertex, const ZeroGaps& zero) {
    FirstOrderVertex& side = *vertex.perturbed;
    side.touching.clear();
    side.zero = zero;
    Words names;
    Terms terms(vertex);
    for (const auto& [contact, order] : zero) {
        const Enclosure c = terms.gap(contact);
        if (!c.decided() && !side.statics.chooses()) {
            return failed(FailureKind::undecided, "{} touch, and their first-order gap is not told from 0: {}",
                          named(contact), shown(c));
        }
        if (c.negative() && !side.statics.chooses()) {
            names += words("{}{}", names.empty() ? "" : ", ", named(contact));
        }
        side.touching.emplace_back(contact, c);
    }
    if (!names.empty()) {
        return failed(FailureKind::overlap, "pairs that touch overlap at first order: {}", names);
    }
    return std::nullopt;
}

} // namespace isostat
