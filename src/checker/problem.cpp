#include "checker/problem.hpp"

#include <isostat/contact/contact.hpp>

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
std::vector<Known> known_coordinates(const State<2>& state, const std::vector<Integer>& stored,
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

Row row_of(const Contact& contact, int disks) {
    Row row;
    const int i = 2 * contact.i;
    if (contact.kind == ContactKind::disk_disk) {
        const int j = 2 * contact.j;
        row.quadratic = true;
        row.count = 4;
        row.coordinate = {i, i + 1, j, j + 1};
        return row;
    }
    if (contact.kind == ContactKind::held) {
        row.count = 1;
        row.coordinate = {contact.i, 0, 0, 0};
        row.sign = {1, 0, 0, 0};
        return row;
    }
    const bool lower = contact.kind == ContactKind::lower_wall;
    row.count = lower ? 1 : 2;
    row.coordinate = {i + contact.j, 2 * disks + contact.j, 0, 0};
    row.sign = {lower ? 1 : -1, 1, 0, 0};
    return row;
}

} // namespace

Structure::Structure(const Packing<2>& packing, const std::vector<Contact>& contacts) {
    dof_of.assign(packing.q.size(), -1);
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        const std::size_t disk = k / 2;
        const bool moves = disk < packing.radius.size() ? packing.fixed.empty() || packing.fixed[disk] == 0
                                                        : packing.walls.upper[k % 2] == WallKind::movable;
        if (moves) {
            dof_of[k] = static_cast<int>(coordinate_of.size());
            coordinate_of.push_back(static_cast<int>(k));
        }
    }
    for (const Contact& contact : contacts) {
        rows.push_back(row_of(contact, packing.disk_count()));
    }
    double mean = 0;
    for (const double r : packing.radius) {
        mean += 2 * r / static_cast<double>(packing.disk_count());
    }
    std::frexp(mean, &wall_exponent);
}

Problem::Problem(const State<2>& state, bool held_allowed, int asked)
    : Structure(state.packing, state.contacts), digits(asked) {
    const Packing<2>& packing = state.packing;
    disks = packing.disk_count();
    for (const Contact& contact : state.contacts) {
        if (contact.kind == ContactKind::held && held_allowed) {
            continue;
        }
        if (contact.kind == ContactKind::held) {
            unsupported = "the state has a " + to_string<2>(contact) + ", which is no contact: not checked";
            return;
        }
        const auto axis = static_cast<std::size_t>(contact.j);
        const bool lower = contact.kind == ContactKind::lower_wall;
        if (contact.kind != ContactKind::disk_disk &&
            (lower ? packing.walls.lower : packing.walls.upper)[axis] == WallKind::absent) {
            unsupported = "there is no wall for the contact " + to_string<2>(contact);
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

    const std::vector<Known> known = known_coordinates(state, stored, radius);
    const auto level = [&known](int i, int j, int axis) {
        const Known& at_i = known[static_cast<std::size_t>(2 * i + axis)];
        const Known& at_j = known[static_cast<std::size_t>(2 * j + axis)];
        return at_i.from != Known::nothing && at_i.from == at_j.from && at_i.value == at_j.value;
    };
    contacts_of.resize(coordinate_of.size());
    acting_on.resize(coordinate_of.size());
    for (std::size_t l = 0; l < rows.size(); ++l) {
        const Row& row = rows[l];
        const Contact& contact = state.contacts[l];
        for (int k = 0; k < row.count; ++k) {
            const int dof = dof_of[static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)])];
            if (dof >= 0) {
                contacts_of[static_cast<std::size_t>(dof)].push_back(static_cast<int>(l));
                if (!row.quadratic || !level(contact.i, contact.j, k % 2)) {
                    acting_on[static_cast<std::size_t>(dof)].push_back(static_cast<int>(l));
                }
            }
        }
        const auto i = static_cast<std::size_t>(contact.i);
        if (contact.kind == ContactKind::held) {
            sum.push_back(stored[i]);
        } else {
            sum.push_back(row.quadratic ? Integer(radius[i] + radius[static_cast<std::size_t>(contact.j)]) : radius[i]);
        }
        sum_square.push_back(row.quadratic ? Integer(sum.back() * sum.back()) : Integer(0));
    }
}

unsigned long Problem::most_quadratic() const {
    unsigned long most = 0;
    for (const std::vector<int>& touching : contacts_of) {
        unsigned long quadratic = 0;
        for (const int l : touching) {
            quadratic += rows[static_cast<std::size_t>(l)].quadratic ? 1 : 0;
        }
        most = std::max(most, quadratic);
    }
    return most;
}

Integer Problem::entry(int contact, int k, const std::vector<Integer>& q) const {
    const Row& row = rows[static_cast<std::size_t>(contact)];
    const auto slot = static_cast<std::size_t>(k);
    if (!row.quadratic) {
        return row.sign[slot] * weight();
    }
    const auto own = static_cast<std::size_t>(row.coordinate[slot]);
    const auto other = static_cast<std::size_t>(row.coordinate[(slot + 2) % 4]);
    return q[own] - q[other];
}

std::vector<Integer> Problem::twice_residuals(const std::vector<Integer>& q) const {
    std::vector<Integer> residuals;
    residuals.reserve(rows.size());
    Integer difference;
    for (std::size_t l = 0; l < rows.size(); ++l) {
        const Row& row = rows[l];
        const auto at = [&](int k) -> const Integer& {
            return q[static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)])];
        };
        Integer& value = residuals.emplace_back();
        if (row.quadratic) {
            mpz_neg(value.get_mpz_t(), sum_square[l].get_mpz_t());
            for (const int k : {0, 1}) {
                difference = at(k) - at(k + 2);
                mpz_addmul(value.get_mpz_t(), difference.get_mpz_t(), difference.get_mpz_t());
            }
            continue;
        }
        value = -sum[l];
        for (int k = 0; k < row.count; ++k) {
            value += row.sign[static_cast<std::size_t>(k)] * at(k);
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
