#include "checker/problem.hpp"

#include <isostat/contact/state.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>

namespace isostat::checker {

namespace {

/// The largest e such that a finite double is a multiple of 2^e; `if_zero` for 0.
long granularity(double value, long if_zero) {
    if (value == 0) {
        return if_zero;
    }
    int exponent = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(std::abs(value), &exponent), 53));
    return exponent - 53 + std::countr_zero(static_cast<std::uint64_t>(mantissa));
}

/// A double as an integer multiple of 2^unit. \pre it is one.
Integer in_units(double value, long unit) {
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    const Integer mantissa(std::ldexp(fraction, 53)); // exact: at most 53 bits
    const long shift = exponent - 53 - unit;
    if (shift >= 0) {
        return shifted_left(mantissa, shift);
    }
    Integer result;
    mpz_tdiv_q_2exp(result.get_mpz_t(), mantissa.get_mpz_t(), static_cast<mp_bitcnt_t>(-shift));
    return result;
}

/// Where a coordinate is at every true vertex, counted from the origin or from the upper wall.
struct Known {
    enum From { nothing, origin, upper_wall } from = nothing;
    Integer value = 0;
};

/// Disks on walls, held and fixed coordinates.
std::vector<Known> known_coordinates(const State& state, const std::vector<Integer>& stored,
                                     const std::vector<Integer>& radius) {
    std::vector<Known> known(stored.size());
    const auto at = [](int index) { return static_cast<std::size_t>(index); };
    for (std::size_t k = 0; k < 2 * radius.size(); ++k) {
        if (!state.packing.fixed.empty() && state.packing.fixed[k / 2] != 0) {
            known[k] = {Known::origin, stored[k]};
        }
    }
    for (const Contact& contact : state.contacts) {
        switch (contact.kind) {
        case ContactKind::disk_disk: break;
        case ContactKind::lower_wall:
            known[at(2 * contact.i + contact.j)] = {Known::origin, radius[at(contact.i)]};
            break;
        case ContactKind::upper_wall:
            known[at(2 * contact.i + contact.j)] = {Known::upper_wall, radius[at(contact.i)]};
            break;
        case ContactKind::held: known[at(contact.i)] = {Known::origin, stored[at(contact.i)]}; break;
        }
    }
    return known;
}

/// Whether a coordinate is a degree of freedom (proofs/definition.md).
bool moves(const Packing& packing, std::size_t k) {
    const std::size_t disk = k / 2;
    const Cell& cell = packing.cell;
    if (disk < packing.radius.size()) {
        const bool pinned = disk == static_cast<std::size_t>(cell.pin) && cell.periodic[k % 2];
        return !pinned && (packing.fixed.empty() || packing.fixed[disk] == 0);
    }
    const std::size_t behind = k - 2 * packing.radius.size();
    if (behind >= 2) {
        return cell.tilt_moves[0];
    }
    return cell.periodic[behind] ? cell.period_moves[behind] : packing.walls.upper[behind] == WallKind::movable;
}

/// Why the checker does not handle a cell; empty: it does.
std::string unsupported_cell(const State& state) {
    const Packing& packing = state.packing;
    if (state.load.kind != LoadKind::nominal && packing.cell.tilt_moves[0]) {
        return "true stresses in a periodic cell whose tilt moves: not checked";
    }
    for (const std::vector<double>* load : {&state.load.disk_force, &state.load.infinitesimal}) {
        for (std::size_t a = 0; a < 2; ++a) {
            Rational sum = 0;
            for (std::size_t k = a; k < load->size() && packing.cell.periodic[a]; k += 2) {
                sum += Rational((*load)[k]);
            }
            if (sum != 0) {
                return "loads on the disks do not sum to 0 along a periodic axis: not checked";
            }
        }
    }
    return "";
}

} // namespace

Row::Row(const Contact& contact, int disks) {
    const auto add = [this](int at, int times, int along) {
        const auto k = static_cast<std::size_t>(count++);
        coordinate[k] = at;
        sign[k] = times;
        axis[k] = static_cast<std::uint8_t>(along);
    };
    const int behind = 2 * disks;
    const int i = 2 * contact.i;
    if (contact.kind == ContactKind::held) {
        add(contact.i, 1, 0);
        return;
    }
    if (contact.kind != ContactKind::disk_disk) {
        const bool lower = contact.kind == ContactKind::lower_wall;
        add(i + contact.j, lower ? 1 : -1, contact.j);
        if (!lower) {
            add(behind + contact.j, 1, contact.j);
        }
        return;
    }
    quadratic = true;
    for (int a = 0; a < 4 && contact.i != contact.j; ++a) {
        add((a < 2 ? i : 2 * contact.j) + a % 2, a < 2 ? 1 : -1, a % 2);
    }
    for (int a = 0; a < 2; ++a) {
        if (const std::int8_t m = contact.image.m[static_cast<std::size_t>(a)]; m != 0) {
            add(behind + a, -m, a);
        }
    }
    if (contact.image.m[1] != 0) { // the tilt moves the images along the second axis sideways
        add(behind + 2, -contact.image.m[1], 0);
    }
}

Structure::Structure(const Packing& packing, const std::vector<Contact>& contacts) {
    dof_of.assign(packing.q.size(), -1);
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        if (moves(packing, k)) {
            dof_of[k] = static_cast<int>(coordinate_of.size());
            coordinate_of.push_back(static_cast<int>(k));
        }
    }
    for (const Contact& contact : contacts) {
        rows.emplace_back(contact, packing.disk_count());
    }
    double mean = 0;
    for (const double r : packing.radius) {
        mean += 2 * r / static_cast<double>(packing.disk_count());
    }
    std::frexp(mean, &wall_exponent);
}

namespace {

/// Why a contact is not one of the packing, or is none; empty: nothing.
std::string unsupported_contact(const Packing& packing, const Contact& contact) {
    for (std::size_t a = 0; a < contact.image.m.size(); ++a) {
        if (contact.image.m[a] != 0 && (a >= 2 || !packing.cell.periodic[a])) {
            return "the contact " + to_string(contact) + " is with an image along an axis with walls";
        }
    }
    if (contact.kind == ContactKind::held) {
        return "the state has a " + to_string(contact) + ", which is no contact: not checked";
    }
    const auto axis = static_cast<std::size_t>(contact.j);
    const bool lower = contact.kind == ContactKind::lower_wall;
    if (contact.kind != ContactKind::disk_disk &&
        (lower ? packing.walls.lower : packing.walls.upper)[axis] == WallKind::absent) {
        return "there is no wall for the contact " + to_string(contact);
    }
    return {};
}

} // namespace

Problem::Problem(const State& state, bool held_allowed, int asked)
    : Structure(state.packing, state.contacts), digits(asked) {
    const Packing& packing = state.packing;
    disks = packing.disk_count();
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

    long coordinate_unit = wall_exponent;
    for (const double x : packing.q) {
        coordinate_unit = std::min(coordinate_unit, granularity(x, coordinate_unit));
    }
    long unit = coordinate_unit;
    for (const double r : packing.radius) {
        unit = std::min(unit, granularity(r, unit));
    }
    fine = unit - digits;
    spare = coordinate_unit - fine;
    weight_bits = wall_exponent - fine;
    for (const double x : packing.q) {
        stored.push_back(in_units(x, fine));
    }
    for (const double r : packing.radius) {
        radius.push_back(in_units(r, fine));
    }

    find_contacts_of(state);
    for (const Contact& contact : state.contacts) {
        const Row& row = rows[sum.size()];
        const auto i = static_cast<std::size_t>(contact.i);
        if (contact.kind == ContactKind::held) {
            sum.push_back(stored[i]);
        } else {
            sum.push_back(row.quadratic ? Integer(radius[i] + radius[static_cast<std::size_t>(contact.j)]) : radius[i]);
        }
        sum_square.push_back(row.quadratic ? Integer(sum.back() * sum.back()) : Integer(0));
    }
}

void Problem::find_contacts_of(const State& state) {
    const std::vector<Known> known = known_coordinates(state, stored, radius);
    const auto level = [&known](const Contact& pair, const Row& row, std::size_t a) {
        const Known& at_i = known[2 * static_cast<std::size_t>(pair.i) + a];
        const Known& at_j = known[2 * static_cast<std::size_t>(pair.j) + a];
        return at_i.from != Known::nothing && at_i.from == at_j.from && at_i.value == at_j.value &&
               row.spread(a) == 2; // no period is in between
    };
    contacts_of.resize(coordinate_of.size());
    acting_on.resize(coordinate_of.size());
    std::vector<unsigned long> change(coordinate_of.size(), 0);
    for (std::size_t l = 0; l < rows.size(); ++l) {
        const Row& row = rows[l];
        const std::array<int, 2> spread{row.spread(0), row.spread(1)};
        row_curvature_ =
            row.quadratic
                ? std::max(row_curvature_, static_cast<unsigned long>(spread[0] * spread[0] + spread[1] * spread[1]))
                : row_curvature_;
        for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
            const int dof = dof_of[static_cast<std::size_t>(row.coordinate[k])];
            if (dof < 0) {
                continue;
            }
            const auto j = static_cast<std::size_t>(dof);
            contacts_of[j].push_back(static_cast<int>(l));
            if (!row.quadratic || !level(state.contacts[l], row, row.axis[k])) {
                acting_on[j].push_back(static_cast<int>(l));
            }
            change[j] += row.quadratic ? static_cast<unsigned long>(std::abs(row.sign[k]) * spread[row.axis[k]]) : 0UL;
        }
    }
    find_pinned(state);
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
        if (c.kind == ContactKind::disk_disk) {
            ++count[static_cast<std::size_t>(c.j)];
        }
    }
    return static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
}

} // namespace

void Problem::find_pinned(const State& state) {
    const Cell& cell = state.packing.cell;
    const bool holds = std::any_of(state.contacts.begin(), state.contacts.end(),
                                   [this](const Contact& c) { return c.kind == ContactKind::held && c.i < 2 * disks; });
    for (std::size_t a = 0; a < 2 && !holds; ++a) {
        if (!cell.periodic[a]) {
            continue;
        }
        most_touched = most_touched < 0 ? most_touched_of(state.contacts, disks) : most_touched;
        Pinned& along = pinned.emplace_back(Pinned{a, {}});
        for (std::size_t l = 0; l < rows.size(); ++l) {
            const Contact& c = state.contacts[l];
            const bool on = c.i == cell.pin || (c.kind == ContactKind::disk_disk && c.j == cell.pin);
            if (on && c.kind == ContactKind::disk_disk && c.i != c.j) {
                along.acting.push_back(static_cast<int>(l));
            }
        }
    }
}

Integer Problem::entry(int contact, int k, const std::vector<Integer>& q) const {
    const Row& row = rows[static_cast<std::size_t>(contact)];
    const auto slot = static_cast<std::size_t>(k);
    if (!row.quadratic) {
        return row.sign[slot] * weight();
    }
    Integer d;
    row.separate(q, row.axis[slot], d);
    return row.sign[slot] * d;
}

std::vector<Integer> Problem::twice_residuals(const std::vector<Integer>& q) const {
    std::vector<Integer> residuals;
    residuals.reserve(rows.size());
    Integer difference;
    for (std::size_t l = 0; l < rows.size(); ++l) {
        const Row& row = rows[l];
        Integer& value = residuals.emplace_back();
        if (row.quadratic) {
            mpz_neg(value.get_mpz_t(), sum_square[l].get_mpz_t());
            for (const std::size_t a : {std::size_t{0}, std::size_t{1}}) {
                row.separate(q, a, difference);
                mpz_addmul(value.get_mpz_t(), difference.get_mpz_t(), difference.get_mpz_t());
            }
            continue;
        }
        value = -sum[l];
        for (int k = 0; k < row.count; ++k) {
            const auto slot = static_cast<std::size_t>(k);
            value += row.sign[slot] * q[static_cast<std::size_t>(row.coordinate[slot])];
        }
        value = shifted_left(value, weight_bits + 1);
    }
    return residuals;
}

Integer Problem::force_units(int contact) const {
    const auto l = static_cast<std::size_t>(contact);
    return rows[l].quadratic ? sum[l] : weight();
}

} // namespace isostat::checker
