#include "checker/problem.hpp"

#include "checker/at_wall.hpp"

#include <isostat/contact/state.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <optional>

namespace isostat::checker {

namespace {

/// The largest e such that a finite double is a multiple of 2^e; `if_zero` for 0.
long granularity(double value, long if_zero) {
    if (value == 0) {
        return if_zero;
    }
    int exponent = 0;
    // 53: exact: bits of a double
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(std::abs(value), &exponent), 53));
    return exponent - 53 + std::countr_zero(static_cast<std::uint64_t>(mantissa));
}

/// A double as an integer multiple of 2^unit. \pre it is one, and fits.
template <class Number> Number in_units(double value, long unit) {
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    Number result(static_cast<long>(std::ldexp(fraction, 53))); // 53: exact: bits of a double
    const long shift = value == 0 ? 0 : exponent - 53 - unit;
    if (shift >= 0) {
        result <<= static_cast<unsigned long>(shift);
    } else {
        result >>= static_cast<unsigned long>(-shift); // of zeros
    }
    return result;
}

/// Where a coordinate is at every true vertex, counted from the origin or from the coordinate of a wall.
struct Known {
    bool known = false;
    std::optional<std::size_t> from;
    Integer value;
};

/// Disks on walls, held and fixed coordinates. Of clumps what is held may move freely, and is at no known place (U2).
std::vector<Known> known_coordinates(const State& state, const Lengths& stored, const Lengths& radius) {
    std::vector<Known> known(stored.size());
    const auto at = [](int index) { return static_cast<std::size_t>(index); };
    const Layout layout = state.packing.layout();
    for (std::size_t k = 0; k < layout.of_length(0); ++k) {
        if (!state.packing.fixed.empty() && state.packing.fixed[k / layout.axes()] != 0) {
            known[k] = {true, {}, stored[k]};
        }
    }
    for (const Contact& contact : state.contacts) {
        if (contact.is_wall()) {
            const AtWall place(contact, layout);
            known[place.disk] = {true, place.wall, place.sign * radius[at(contact.i)]};
        } else if (contact.kind == ContactKind::held && state.packing.bars.empty()) {
            known[at(contact.i)] = {true, {}, stored[at(contact.i)]};
        }
    }
    return known;
}

/// Whether a coordinate is a degree of freedom (proofs/definition.md).
bool moves(const Packing& packing, std::size_t k) {
    const std::size_t disk = k / packing.axes();
    const Cell& cell = packing.cell;
    if (disk < packing.radius.size()) {
        const bool pinned = disk == static_cast<std::size_t>(cell.pin) && cell.periodic[k % packing.axes()];
        return !pinned && (packing.fixed.empty() || packing.fixed[disk] == 0);
    }
    const std::size_t behind = k - packing.length_at(0);
    if (behind >= packing.axes()) {
        return cell.tilt_moves[behind - packing.axes()];
    }
    return cell.periodic[behind] ? cell.period_moves[behind] : packing.walls.upper[behind] == WallKind::movable;
}

/// Why the checker does not handle a cell; empty: it does.
std::string unsupported_cell(const State& state) {
    const Packing& packing = state.packing;
    const auto& tilts = packing.cell.tilt_moves;
    if (state.load.kind != LoadKind::nominal && std::find(tilts.begin(), tilts.end(), true) != tilts.end()) {
        return "true stresses in a periodic cell whose tilt moves: not checked";
    }
    for (const std::vector<double>* load : {&state.load.disk_force, &state.load.infinitesimal}) {
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            Rational sum = 0;
            for (std::size_t k = a; k < load->size() && packing.cell.periodic[a]; k += packing.axes()) {
                sum += Rational((*load)[k]);
            }
            if (sum != 0) {
                return "loads on the grains do not sum to 0 along a periodic axis: not checked";
            }
        }
    }
    return "";
}

} // namespace

Row::Row(const Contact& contact, const Layout& layout) {
    const auto add = [this](std::size_t at, int times, std::size_t along) {
        const auto k = static_cast<std::size_t>(count++);
        coordinate[k] = static_cast<int>(at);
        sign[k] = times;
        axis[k] = static_cast<std::uint8_t>(along);
    };
    const auto normal = static_cast<std::size_t>(contact.j);
    if (contact.kind == ContactKind::held) {
        add(static_cast<std::size_t>(contact.i), 1, 0);
        return;
    }
    if (contact.is_wall()) {
        const AtWall place(contact, layout);
        add(place.disk, place.sign, normal);
        if (place.wall) {
            add(*place.wall, -place.sign, normal);
        }
        return;
    }
    quadratic = true;
    apart = static_cast<std::uint8_t>(contact.i != contact.j ? layout.axes() : 0);
    for (const int grain : {contact.i, contact.j}) {
        for (std::size_t a = 0; a < layout.axes() && contact.i != contact.j; ++a) {
            add(layout.of_disk(grain) + a, grain == contact.i ? 1 : -1, a);
        }
    }
    for (std::size_t b = 0; b < layout.axes(); ++b) {
        if (const std::int8_t m = contact.image.m[b]; m != 0) {
            add(layout.of_length(b), -m, b);
            for (std::size_t a = 0; a < b; ++a) { // the tilts move the images along an axis sideways
                add(layout.of_tilt(a, b), -m, a);
            }
        }
    }
}

Lists::Lists(std::size_t lists, const std::vector<std::pair<int, int>>& entries)
    : start_(lists + 2, 0), numbers_(entries.size()) {
    for (const auto& [list, number] : entries) {
        ++start_[static_cast<std::size_t>(list) + 2];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    for (const auto& [list, number] : entries) {
        numbers_[start_[static_cast<std::size_t>(list) + 1]++] = number;
    }
    start_.pop_back();
}

std::pair<std::size_t, std::size_t> Lists::lengths() const {
    std::pair<std::size_t, std::size_t> found{numbers_.size(), 0};
    for (std::size_t k = 0; k < size(); ++k) {
        found = {std::min(found.first, (*this)[k].size()), std::max(found.second, (*this)[k].size())};
    }
    return found;
}

Structure::Structure(const Packing& packing, const std::vector<Contact>& contacts) : layout(packing.layout()) {
    dof_of.assign(packing.q.size(), -1);
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        if (moves(packing, k)) {
            dof_of[k] = static_cast<int>(coordinate_of.size());
            coordinate_of.push_back(static_cast<int>(k));
        }
    }
    for (const Contact& contact : contacts) {
        rows.emplace_back(contact, layout);
    }
    double mean = 0;
    for (const double r : packing.radius) {
        mean += 2 * r / static_cast<double>(packing.disk_count());
    }
    std::frexp(mean, &wall_exponent);
}

namespace {

/// Of a bar; nothing: there is none of these disks.
std::optional<double> length_of(const Packing& packing, const Contact& contact) {
    const auto bar = std::lower_bound(packing.bars.begin(), packing.bars.end(), Bar{contact.i, contact.j, 0});
    const bool found = bar != packing.bars.end() && bar->i == contact.i && bar->j == contact.j;
    return found ? std::optional(bar->length) : std::nullopt;
}

} // namespace

std::array<double, 2> closed_at(const Packing& packing, const Contact& contact) {
    const auto radius = [&packing](int disk) { return packing.radius[static_cast<std::size_t>(disk)]; };
    if (contact.kind == ContactKind::bar) {
        return {*length_of(packing, contact), 0};
    }
    if (contact.kind == ContactKind::held) {
        return {};
    }
    return {radius(contact.i), contact.of_disks() ? radius(contact.j) : 0};
}

std::vector<int> bodies_of(const Packing& packing) {
    std::vector<int> body(packing.radius.size());
    std::iota(body.begin(), body.end(), 0);
    for (bool changed = !packing.bars.empty(); changed;) {
        changed = false;
        for (const Bar& bar : packing.bars) {
            int& one = body[static_cast<std::size_t>(bar.i)];
            int& other = body[static_cast<std::size_t>(bar.j)];
            changed = changed || one != other;
            one = other = std::min(one, other);
        }
    }
    return body;
}

bool are_members(const std::vector<int>& body, const Contact& pair) {
    return pair.of_disks() && pair.image.is_here() &&
           body[static_cast<std::size_t>(pair.i)] == body[static_cast<std::size_t>(pair.j)];
}

namespace {

/// Why a contact is not one of the packing, or is none; empty: nothing.
std::string unsupported_contact(const Packing& packing, const Contact& contact) {
    const auto name = [&] { return to_string(contact, packing.dimension); };
    for (std::size_t a = 0; a < contact.image.m.size(); ++a) {
        if (contact.image.m[a] != 0 && !packing.cell.periodic[a]) {
            return "the contact " + name() + " is with an image along an axis with walls";
        }
    }
    if (contact.kind == ContactKind::bar) {
        return length_of(packing, contact) ? "" : "there is no bar for " + name();
    }
    if (contact.kind == ContactKind::held) {
        return "the state has a " + name() + ", which is no contact: not checked";
    }
    if (contact.is_wall() && wall_of(packing, contact) == WallKind::absent) {
        return "there is no wall for the contact " + name();
    }
    return {};
}

} // namespace

Problem::Problem(const State& state, bool held_allowed, int asked)
    : Structure(state.packing, state.contacts), digits(asked) {
    const Packing& packing = state.packing;
    if (packing.cell.any()) {
        unsupported = unsupported_cell(state);
        if (!unsupported.empty()) {
            return;
        }
    }
    for (const Contact& contact : state.contacts) {
        if (contact.kind == ContactKind::held && held_allowed) {
            continue;
        }
        unsupported = unsupported_contact(packing, contact);
        if (!unsupported.empty()) {
            return;
        }
    }

    double longest = 0;
    const auto add = [&longest](long& unit, double length) {
        unit = std::min(unit, granularity(length, unit));
        longest = std::max(longest, std::abs(length));
    };
    long coordinate_unit = wall_exponent;
    for (const double x : packing.q) {
        add(coordinate_unit, x);
    }
    long unit = coordinate_unit;
    for (const double r : packing.radius) {
        add(unit, r);
    }
    for (const Bar& bar : packing.bars) {
        add(unit, bar.length);
    }
    fine = unit - digits;
    spare = coordinate_unit - fine;
    weight_bits = wall_exponent - fine;
    int exponent = 0;
    std::frexp(longest, &exponent);
    length_bits = exponent - fine;
    int spread = 2;
    for (const Row& row : rows) {
        spread = std::max(spread, row.spread());
    }
    // A separation is the sum of so many lengths, each of which may double on the way to the vertex (K26).
    const long largest = length_bits + 1 + std::bit_width(static_cast<unsigned>(spread));
    // checker.md K26 (separations, weights)
    largest <= 125 && weight_bits + 1 < 125 ? find_lengths<Wide>(state) : find_lengths<Integer>(state);
    find_contacts_of(state);
}

template <class Number> void Problem::find_lengths(const State& state) {
    const Packing& packing = state.packing;
    const auto in = [this](double value) { return in_units<Number>(value, fine); };
    std::vector<Number> q;
    std::vector<Number> r;
    std::vector<Number> together;
    q.reserve(packing.q.size());
    r.reserve(packing.radius.size());
    together.reserve(rows.size());
    std::ranges::transform(packing.q, std::back_inserter(q), in);
    std::ranges::transform(packing.radius, std::back_inserter(r), in);
    for (const Contact& contact : state.contacts) {
        const auto i = static_cast<std::size_t>(contact.i);
        if (contact.kind == ContactKind::held) {
            together.push_back(q[i]);
        } else if (contact.kind == ContactKind::disk_disk) {
            together.push_back(r[i] + r[static_cast<std::size_t>(contact.j)]);
        } else {
            const auto [one, other] = closed_at(packing, contact);
            together.push_back(in(one) + in(other));
        }
    }
    stored = std::move(q);
    radius = std::move(r);
    sum = std::move(together);
}

void Problem::find_contacts_of(const State& state) {
    const std::vector<Known> known = known_coordinates(state, stored, radius);
    const auto level = [this, &known](const Contact& pair, const Row& row, std::size_t a) {
        const Known& at_i = known[layout.of_disk(pair.i) + a];
        const Known& at_j = known[layout.of_disk(pair.j) + a];
        return at_i.known && at_j.known && at_i.from == at_j.from && at_i.value == at_j.value &&
               row.spread(a) == 2; // no period is in between
    };
    std::vector<std::pair<int, int>> touching;
    std::vector<std::pair<int, int>> acting;
    std::vector<unsigned long> change(coordinate_of.size(), 0);
    for (std::size_t l = 0; l < rows.size(); ++l) {
        const Row& row = rows[l];
        const std::array<int, most_axes> spread{row.spread(0), row.spread(1), row.spread(2)};
        const int curvature = spread[0] * spread[0] + spread[1] * spread[1] + spread[2] * spread[2];
        row_curvature_ = std::max(row_curvature_, row.quadratic ? static_cast<unsigned long>(curvature) : 0UL);
        for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
            const int dof = dof_of[static_cast<std::size_t>(row.coordinate[k])];
            if (dof < 0) {
                continue;
            }
            const auto j = static_cast<std::size_t>(dof);
            touching.emplace_back(dof, static_cast<int>(l));
            if (!row.quadratic || !level(state.contacts[l], row, row.axis[k])) {
                acting.push_back(touching.back());
            }
            change[j] += row.quadratic ? static_cast<unsigned long>(std::abs(row.sign[k]) * spread[row.axis[k]]) : 0UL;
        }
    }
    contacts_of = {coordinate_of.size(), touching};
    acting_on = {coordinate_of.size(), acting};
    find_immovable(state);
    column_curvature_ = change.empty() ? 0 : *std::max_element(change.begin(), change.end());
}

namespace {

/// An own image counts twice.
int most_touched_of(const std::vector<Contact>& contacts, int disks) {
    std::vector<int> count(static_cast<std::size_t>(disks), 0);
    for (const Contact& c : contacts) {
        if (c.kind != ContactKind::held) {
            ++count[static_cast<std::size_t>(c.i)];
        }
        if (c.of_disks()) {
            ++count[static_cast<std::size_t>(c.j)];
        }
    }
    return static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
}

} // namespace

int Problem::axis_of(std::size_t dof) const {
    const auto coordinate = static_cast<std::size_t>(coordinate_of[dof]);
    if (coordinate < layout.of_length(0)) {
        return static_cast<int>(coordinate % layout.axes());
    }
    const std::size_t axis = coordinate - layout.of_length(0);
    return axis < layout.axes() && !immovable[axis].periodic ? static_cast<int>(axis) : -1;
}

void Problem::find_immovable(const State& state) {
    for (std::size_t a = 0; a < layout.axes(); ++a) {
        immovable.push_back({state.packing.cell.periodic[a], {}});
    }
    if (state.packing.cell.any()) {
        most_touched = most_touched_of(state.contacts, layout.disks);
    }
    for (std::size_t l = 0; l < rows.size(); ++l) {
        std::array<int, most_axes> along{}; // along an axis all entries of a row are one number, up to a sign
        for (std::size_t k = 0; k < static_cast<std::size_t>(rows[l].count); ++k) {
            const int dof = dof_of[static_cast<std::size_t>(rows[l].coordinate[k])];
            if (const int a = dof < 0 ? -1 : axis_of(static_cast<std::size_t>(dof)); a >= 0) {
                along[static_cast<std::size_t>(a)] += rows[l].sign[k];
            }
        }
        for (std::size_t a = 0; a < layout.axes(); ++a) {
            if (along[a] != 0) {
                immovable[a].acting.push_back(static_cast<int>(l));
            }
        }
    }
}

Integer Problem::entry(int contact, int k, const Lengths& q) const {
    const Row& row = rows[static_cast<std::size_t>(contact)];
    const auto slot = static_cast<std::size_t>(k);
    if (!row.quadratic) {
        return row.sign[slot] * weight();
    }
    Integer d;
    row.separate(q, row.axis[slot], d);
    return row.sign[slot] * d;
}

template <class Number>
std::vector<Product<Number>> Problem::twice_residuals(const std::vector<Number>& q,
                                                      std::vector<Product<Number>> residuals) const {
    residuals.resize(rows.size());
    const std::vector<Number>& closed = sum.in<Number>();
    Number difference;
    Product<Number> square;
    const auto twice_weight = number<Number>(shifted_left(1, weight_bits + 1));
    for (std::size_t l = 0; l < rows.size(); ++l) {
        const Row& row = rows[l];
        Product<Number>& value = residuals[l];
        if (row.quadratic) {
            multiply(square, closed[l], closed[l]);
            value = Product<Number>();
            value -= square;
            for (std::size_t a = 0; a < layout.axes(); ++a) {
                row.separate(q, a, difference);
                multiply(square, difference, difference);
                value += square;
            }
            continue;
        }
        difference = -closed[l];
        for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
            difference += row.sign[k] * q[static_cast<std::size_t>(row.coordinate[k])];
        }
        multiply(value, difference, twice_weight);
    }
    return residuals;
}

template std::vector<Broad> Problem::twice_residuals(const std::vector<Wide>&, std::vector<Broad>) const;
template std::vector<Integer> Problem::twice_residuals(const std::vector<Integer>&, std::vector<Integer>) const;

Integer Problem::force_units(int contact) const {
    const auto l = static_cast<std::size_t>(contact);
    return rows[l].quadratic ? sum[l] : weight();
}

} // namespace isostat::checker
