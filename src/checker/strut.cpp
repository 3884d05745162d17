#include "checker/strut.hpp"

#include "checker/at_wall.hpp"
#include "checker/forces.hpp"
#include "checker/index.hpp"

#include <algorithm>
#include <cmath>

namespace isostat::checker {

namespace {

using Vector = std::array<double, 2>;

/// Direction from the disk to its partner in the contact.
Vector outward(const State& state, const Contact& c, std::size_t disk) {
    if (!c.of_disks()) {
        Vector normal{};
        normal[static_cast<std::size_t>(c.j)] = -AtWall(c, state.packing.layout()).sign;
        return normal;
    }
    const Row row(c, state.packing.layout());
    double x = 0; // from j to i
    double y = 0;
    row.separate(state.packing.q, 0, x);
    row.separate(state.packing.q, 1, y);
    const double length = static_cast<std::size_t>(c.i) == disk ? -std::hypot(x, y) : std::hypot(x, y);
    return {x / length, y / length};
}

/// The place without the disks that carry no force at the turn (S4 (c)): movable disks that just two contacts hold, the
/// two at an angle. The loads on these disks are passed on to their neighbours.
struct Bare {
    std::vector<bool> movable;     ///< disks: free, without a finite load, and not held by an earlier coordinate
    std::vector<bool> left_out;    ///< contacts
    std::vector<Vector> load;      ///< on the disks
    std::vector<double> load_room; ///< error bound of the load
    std::vector<std::vector<std::size_t>> around; ///< contacts of each disk that are not left out

    /// `loose`: earlier held coordinates that hold no disk.
    Bare(const Place& place, const std::vector<int>& loose) {
        const State& state = *place.state;
        const Problem& problem = place.evidence->problem;
        const auto disks = static_cast<std::size_t>(problem.layout.disks);
        movable.assign(disks, true);
        left_out.assign(state.contacts.size(), false);
        load.assign(disks, Vector{});
        load_room.assign(disks, 0);
        for (std::size_t k = 0; k < 2 * disks; ++k) {
            const int dof = problem.dof_of[k];
            if (dof < 0) {
                movable[k / 2] = false;
                continue;
            }
            const Range& finite = place.evidence->finite_load[static_cast<std::size_t>(dof)];
            if (finite.lower != 0 || finite.upper != 0) {
                movable[k / 2] = false;
            }
            if (!state.load.infinitesimal.empty()) {
                load[k / 2][k % 2] = state.load.infinitesimal[k];
            }
        }
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const auto coordinate = static_cast<std::size_t>(state.contacts[l].i);
            const int row = static_cast<int>(l);
            if (state.contacts[l].kind == ContactKind::held && row != place.fresh && coordinate < 2 * disks &&
                std::find(loose.begin(), loose.end(), row) == loose.end()) {
                movable[coordinate / 2] = false;
            }
        }
        while (sweep(state)) {
        }
    }

  private:
    /// Leaves out every such disk; false when there was none.
    bool sweep(const State& state) {
        around.assign(movable.size(), {});
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const Contact& c = state.contacts[l];
            const bool own = c.of_disks() && c.i == c.j; // such a contact acts on the cell alone
            if (left_out[l] || own || c.kind == ContactKind::held) {
                continue;
            }
            around[static_cast<std::size_t>(c.i)].push_back(l);
            if (c.of_disks()) {
                around[static_cast<std::size_t>(c.j)].push_back(l);
            }
        }
        bool any = false;
        for (std::size_t disk = 0; disk < movable.size(); ++disk) {
            const std::vector<std::size_t>& two = around[disk];
            if (!movable[disk] || two.size() != 2 || left_out[two[0]] || left_out[two[1]]) {
                continue;
            }
            const Vector n = outward(state, state.contacts[two[0]], disk);
            const Vector m = outward(state, state.contacts[two[1]], disk);
            const double sine = n[0] * m[1] - n[1] * m[0];
            // choice: not in one line (stability.md S4 (c))
            if (std::abs(sine) < 1e-4) { // far above turn_tolerance: not in one line at the turn either
                continue;
            }
            // The disk exerts p n and q m on its neighbours, its own load being p n + q m.
            const Vector& g = load[disk];
            const double p = (g[0] * m[1] - g[1] * m[0]) / sine;
            const double q = (n[0] * g[1] - n[1] * g[0]) / sine;
            const double room = 2 * (load_room[disk] + turn_tolerance * (std::abs(p) + std::abs(q))) / std::abs(sine);
            give(state.contacts[two[0]], disk, {p * n[0], p * n[1]}, room);
            give(state.contacts[two[1]], disk, {q * m[0], q * m[1]}, room);
            left_out[two[0]] = left_out[two[1]] = true;
            any = true;
        }
        return any;
    }

    void give(const Contact& c, std::size_t from, const Vector& force, double room) {
        if (c.of_disks()) {
            const auto to = static_cast<std::size_t>(static_cast<std::size_t>(c.i) == from ? c.j : c.i);
            load[to][0] += force[0];
            load[to][1] += force[1];
            load_room[to] += room;
        }
    }
};

/// The disks connected to `first` when the contacts a and b are
/// cut; nothing when a wall is, or a disk that is not movable.
std::optional<std::vector<unsigned char>> group(const State& state, const Bare& bare, int first, std::size_t a,
                                                std::size_t b) {
    std::vector<unsigned char> inside(bare.movable.size(), 0);
    std::vector<int> open{first};
    inside[static_cast<std::size_t>(first)] = 1;
    while (!open.empty()) {
        const int disk = open.back();
        open.pop_back();
        if (!bare.movable[static_cast<std::size_t>(disk)]) {
            return std::nullopt;
        }
        for (const std::size_t l : bare.around[static_cast<std::size_t>(disk)]) {
            const Contact& c = state.contacts[l];
            if (l == a || l == b) {
                continue;
            }
            if (!c.of_disks()) {
                return std::nullopt;
            }
            const int other = c.i == disk ? c.j : c.i;
            if (inside[static_cast<std::size_t>(other)] == 0) {
                inside[static_cast<std::size_t>(other)] = 1;
                open.push_back(other);
            }
        }
    }
    return inside;
}

/// The only disk of the group that the contact touches.
std::optional<std::size_t> end_of(const Contact& c, const std::vector<unsigned char>& inside) {
    const auto in = [&](int disk) { return inside[static_cast<std::size_t>(disk)] != 0; };
    const bool first = in(c.i);
    const bool second = c.of_disks() && in(c.j);
    if (first == second) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(first ? c.i : c.j);
}

} // namespace

bool same_at_turn(const Place& place, std::size_t a, std::size_t b) {
    if (place.fresh < 0) {
        return false;
    }
    const ContactForces& force = place.evidence->forces;
    const Range& multiplier = force[static_cast<std::size_t>(place.fresh)];
    const Rational room = std::max<Rational>(abs(multiplier.lower), abs(multiplier.upper));
    const Range difference = force[a] - force[b];
    return difference.lower <= room && difference.upper >= -room;
}

namespace {

std::vector<bool> without_force(const Place& place, const std::vector<int>& loose) {
    const State& state = *place.state;
    if (state.packing.dimension != plane) {
        return std::vector<bool>(state.contacts.size(), false);
    }
    const Bare bare(place, loose);
    std::vector<bool> nothing = bare.left_out;
    for (std::size_t l = 0; l < nothing.size(); ++l) {
        const Contact& c = state.contacts[l];
        if (nothing[l] || c.kind == ContactKind::held) {
            continue;
        }
        const auto cut_off = [&](int disk) {
            const auto inside = group(state, bare, disk, l, l);
            return inside && end_of(c, *inside);
        };
        nothing[l] = cut_off(c.i) || (c.of_disks() && cut_off(c.j));
    }
    return nothing;
}

/// Earlier held coordinates whose multipliers are within the accuracy
/// of their turns: after a release they may be held again at once.
std::vector<int> that_may_rest(const Place& place) {
    const ContactForces& force = place.evidence->forces;
    const auto size = [&](std::size_t l) { return std::max<Rational>(abs(force[l].lower), abs(force[l].upper)); };
    Rational largest = 0;
    for (std::size_t l = 0; l < force.size(); ++l) {
        largest = std::max(largest, size(l));
    }
    std::vector<int> rows;
    for (std::size_t l = 0; l < force.size(); ++l) {
        if (place.is_held(l) && static_cast<int>(l) != place.fresh && size(l) <= Rational(turn_tolerance) * largest) {
            rows.push_back(static_cast<int>(l));
        }
    }
    return rows;
}

} // namespace

std::vector<bool> without_force(const Place& place) {
    std::vector<int> loose = place.zeros; // a hold without a finite force has no effect on the finite loads
    loose.insert(loose.end(), place.ties.begin(), place.ties.end());
    std::sort(loose.begin(), loose.end());
    return without_force(place, loose);
}

bool holds_may_explain(const Place& place, std::size_t a, std::size_t b) {
    if (place.is_held(a)) {
        return true; // a hold released and held again at once is put aside, without a record
    }
    const std::vector<int> rows = that_may_rest(place);
    if (rows.empty()) {
        return false;
    }
    const ContactForces& force = place.evidence->forces;
    Rational room = 0;
    for (const int row : rows) {
        const Range& m = force[static_cast<std::size_t>(row)];
        room += std::max<Rational>(abs(m.lower), abs(m.upper));
    }
    const Range difference = force[a] - force[b];
    return (difference.lower <= room && difference.upper >= -room) ||
           (place.fresh >= 0 && without_force(place, rows)[a]);
}

std::optional<int> strut_order(const Place& place, std::size_t a, std::size_t b) {
    const State& state = *place.state;
    const Contact& first = state.contacts[a];
    const Contact& second = state.contacts[b];
    if (first.kind == ContactKind::held || second.kind == ContactKind::held || state.packing.dimension != plane) {
        return std::nullopt;
    }
    const Bare bare(place, {});
    if (bare.left_out[a] || bare.left_out[b]) {
        return std::nullopt;
    }
    for (const int disk : {first.i, first.of_disks() ? first.j : -1}) {
        const auto inside = disk < 0 ? std::nullopt : group(state, bare, disk, a, b);
        const auto here = inside ? end_of(first, *inside) : std::nullopt;
        const auto there = inside ? end_of(second, *inside) : std::nullopt;
        if (!here || !there) {
            continue;
        }
        const Vector n = outward(state, first, *here);
        const Vector m = outward(state, second, *there);
        double along = 0; // of the load on the group
        double room = 0;
        for (std::size_t k = 0; k < 2; ++k) {
            double load = 0;
            double size = 0;
            for (std::size_t i = 0; i < inside->size(); ++i) {
                if ((*inside)[i] != 0) {
                    load += bare.load[i][k];
                    size += std::abs(bare.load[i][k]);
                    room += bare.load_room[i];
                }
            }
            along += 0.5 * load * (n[k] - m[k]); // exact: a half: mean of two normals (S4)
            room += size * (std::hypot(n[0] + m[0], n[1] + m[1]) + turn_tolerance);
        }
        // S4 (b): f_b - f_a = -along
        return std::abs(along) <= room ? 0 : along < 0 ? -1 : 1;
    }
    return std::nullopt;
}

namespace {

/// The sphere of `wall` touches the two walls, and so does the other sphere of the contact.
bool with_a_sphere_there(const std::vector<Contact>& contacts, const Contact& c, const Contact& wall,
                         const Contact& other) {
    const auto touches = [&](Contact at) {
        at.i = c.i == wall.i ? c.j : c.i;
        return std::find(contacts.begin(), contacts.end(), at) != contacts.end();
    };
    return c.of_disks() && touches(wall) && touches(other);
}

bool equal_in_edge(const Evidence& evidence, const Forces& load, const std::vector<int>& zeros, std::size_t a,
                   std::size_t b) {
    const std::vector<Contact>& contacts = evidence.state.contacts;
    const Problem& problem = evidence.problem;
    const Contact& one = contacts[a];
    const Contact& other = contacts[b];
    if (!one.is_wall() || !other.is_wall() || one.i != other.i || one.j == other.j) {
        return false;
    }
    for (const int axis : {one.j, other.j}) {
        const int dof = problem.dof_of[problem.layout.of_disk(one.i) + static_cast<std::size_t>(axis)];
        const auto row = static_cast<std::size_t>(dof);
        if (dof < 0 || load.acts(row)) {
            return false;
        }
        const std::span<const int> acting = problem.acting_on[row];
        const bool alike = std::all_of(acting.begin(), acting.end(), [&](int l) {
            const auto k = static_cast<std::size_t>(l);
            return k == a || k == b || contains(zeros, k) || with_a_sphere_there(contacts, contacts[k], one, other);
        });
        if (!alike) {
            return false;
        }
    }
    return true;
}

bool equal_in_notch(const Evidence& evidence, const Forces& load, const std::vector<int>& zeros, std::size_t a,
                    std::size_t b) {
    const std::vector<Contact>& contacts = evidence.state.contacts;
    const Packing& packing = evidence.state.packing;
    const auto radius = [&](int m) { return packing.radius[static_cast<std::size_t>(m)]; };
    if (evidence.state.perturbation) { // radii that change differently
        return false;
    }
    for (const Bar& bar : packing.bars) {
        const int grain = contacts[a].i == bar.i || contacts[a].i == bar.j ? contacts[a].j : contacts[a].i;
        const Contact one = pair_of(bar.i, grain);
        const Contact other = pair_of(bar.j, grain);
        if (packing.dimension != plane || radius(bar.i) != radius(bar.j) ||
            !((contacts[a] == one && contacts[b] == other) || (contacts[a] == other && contacts[b] == one))) {
            continue;
        }
        const auto stands = [&](int member, const Contact& at) {
            const Contact wall{at.kind, member, at.j};
            return at.is_wall() && std::find(contacts.begin(), contacts.end(), wall) != contacts.end();
        };
        const auto alone = [&](int member, int axis) { // nothing else acts on it along the axis
            const int dof = evidence.problem.dof_of[static_cast<std::size_t>(plane * member + axis)];
            const auto row = static_cast<std::size_t>(dof);
            const auto acts = [&](int l) {
                const auto k = static_cast<std::size_t>(l);
                return k != a && k != b && contacts[k] != Contact{ContactKind::bar, bar.i, bar.j} &&
                       !contains(zeros, k);
            };
            return dof >= 0 && load[row].lower == 0 && load[row].upper == 0 &&
                   std::ranges::none_of(evidence.problem.contacts_of[row], acts);
        };
        if (std::any_of(contacts.begin(), contacts.end(), [&](const Contact& at) {
                return stands(bar.i, at) && stands(bar.j, at) && alone(bar.i, 1 - at.j) && alone(bar.j, 1 - at.j);
            })) {
            return true;
        }
    }
    return false;
}

} // namespace

bool equal_by_place(const Evidence& evidence, const Forces& load, const std::vector<int>& zeros, std::size_t a,
                    std::size_t b) {
    return equal_in_edge(evidence, load, zeros, a, b) || equal_in_notch(evidence, load, zeros, a, b);
}

bool vanish_with(const Evidence& evidence, const std::vector<int>& contacts, std::size_t one) {
    Forces load = evidence.finite_load;
    for (const auto& [dof, force] : evidence.unit_load().acting()) {
        load.set(dof, force);
    }
    const auto vary = [&](const std::vector<int>& some) {
        return some.size() == 1 || vary_together(evidence.problem, some, load);
    };
    if (vary(contacts)) {
        return true;
    }
    const auto zeros = structural_zeros(evidence.problem, load);
    std::vector<int> rest = contacts;
    return zeros &&
           std::erase_if(
               rest, [&](int l) { return equal_by_place(evidence, load, *zeros, one, static_cast<std::size_t>(l)); }) >
               0 &&
           vary(rest);
}

} // namespace isostat::checker
