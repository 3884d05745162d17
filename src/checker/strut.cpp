#include "checker/strut.hpp"

#include <cmath>

namespace isostat::checker {

namespace {

using Vector = std::array<double, 2>;

/// From the disk to what it touches through the contact.
Vector outward(const State<2>& state, const Contact& c, std::size_t disk) {
    if (c.kind != ContactKind::disk_disk) {
        Vector normal{};
        normal[static_cast<std::size_t>(c.j)] = c.kind == ContactKind::upper_wall ? 1 : -1;
        return normal;
    }
    const auto other = static_cast<std::size_t>(static_cast<std::size_t>(c.i) == disk ? c.j : c.i);
    const double x = state.packing.q[2 * other] - state.packing.q[2 * disk];
    const double y = state.packing.q[2 * other + 1] - state.packing.q[2 * disk + 1];
    const double length = std::hypot(x, y);
    return {x / length, y / length};
}

/// The disks that hang together with `first` when the contacts a and b are cut; nothing when a wall does, or a disk
/// that is fixed, finitely loaded, or has a coordinate held earlier.
std::optional<std::vector<unsigned char>> group(const Place& place, int first, std::size_t a, std::size_t b) {
    const State<2>& state = *place.state;
    const Problem& problem = place.evidence->problem;
    const auto free = [&](int disk) {
        for (int k = 2 * disk; k < 2 * disk + 2; ++k) {
            const int dof = problem.dof_of[static_cast<std::size_t>(k)];
            if (dof < 0) {
                return false;
            }
            const Range& load = place.evidence->finite_load[static_cast<std::size_t>(dof)];
            if (load.lower != 0 || load.upper != 0) {
                return false;
            }
        }
        return true;
    };
    std::vector<unsigned char> inside(static_cast<std::size_t>(problem.disks), 0);
    std::vector<int> open{first};
    inside[static_cast<std::size_t>(first)] = 1;
    while (!open.empty()) {
        const int disk = open.back();
        open.pop_back();
        if (!free(disk)) {
            return std::nullopt;
        }
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const Contact& c = state.contacts[l];
            const bool held = c.kind == ContactKind::held;
            if (l == a || l == b || static_cast<int>(l) == place.fresh) {
                continue;
            }
            if (held ? c.i / 2 != disk : c.i != disk && (c.kind != ContactKind::disk_disk || c.j != disk)) {
                continue;
            }
            if (c.kind != ContactKind::disk_disk) {
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
    const bool second = c.kind == ContactKind::disk_disk && in(c.j);
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
    const std::vector<Range>& force = place.evidence->forces;
    const Range& multiplier = force[static_cast<std::size_t>(place.fresh)];
    const Rational room = std::max<Rational>(abs(multiplier.lower), abs(multiplier.upper));
    const Range difference = force[a] - force[b];
    return difference.lower <= room && difference.upper >= -room;
}

std::optional<int> strut_order(const Place& place, std::size_t a, std::size_t b) {
    const State<2>& state = *place.state;
    const Contact& first = state.contacts[a];
    const Contact& second = state.contacts[b];
    if (first.kind == ContactKind::held || second.kind == ContactKind::held) {
        return std::nullopt;
    }
    for (const int disk : {first.i, first.kind == ContactKind::disk_disk ? first.j : -1}) {
        const auto inside = disk < 0 ? std::nullopt : group(place, disk, a, b);
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
            for (std::size_t i = 0; i < inside->size() && !state.load.infinitesimal.empty(); ++i) {
                if ((*inside)[i] != 0) {
                    load += state.load.infinitesimal[2 * i + k];
                    size += std::abs(state.load.infinitesimal[2 * i + k]);
                }
            }
            along += 0.5 * load * (n[k] - m[k]);
            room += size * (std::hypot(n[0] + m[0], n[1] + m[1]) + turn_tolerance);
        }
        // S4 (b): f_b - f_a = -along
        return std::abs(along) <= room ? 0 : along < 0 ? -1 : 1;
    }
    return std::nullopt;
}

} // namespace isostat::checker
