#include "core/roundoff.hpp"
#include "statics/equal_forces.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace isostat {

namespace {

/// Contacts as edges between free disks; everything else is the node `ground`.
struct ContactGraph {
    struct Step {
        std::size_t node;
        std::size_t edge;
    };
    std::size_t ground = 0;
    std::vector<std::vector<Step>> at;
    std::vector<unsigned char> leads;             ///< this contact is an edge
    std::vector<std::array<std::size_t, 2>> ends; ///< of each contact that is one

    /// Edges whose removal disconnects their ends, with `left_out` not an edge.
    [[nodiscard]] std::vector<unsigned char> bridges(std::size_t left_out) const {
        struct Frame {
            std::size_t node;
            std::size_t by; ///< the edge that led here
            std::size_t next;
        };
        constexpr auto none = static_cast<std::size_t>(-1);
        std::vector<unsigned char> found(leads.size(), 0);
        std::vector<std::size_t> order(at.size(), none);
        std::vector<std::size_t> low(at.size(), none);
        std::size_t clock = 0;
        std::vector<Frame> way;
        for (std::size_t root = 0; root < at.size(); ++root) {
            if (order[root] != none) {
                continue;
            }
            order[root] = low[root] = clock++;
            way.push_back({root, none, 0});
            while (!way.empty()) {
                Frame& here = way.back();
                if (here.next < at[here.node].size()) {
                    const Step step = at[here.node][here.next++];
                    if (step.edge == here.by || step.edge == left_out) {
                        continue;
                    }
                    if (order[step.node] == none) {
                        order[step.node] = low[step.node] = clock++;
                        way.push_back({step.node, step.edge, 0});
                    } else {
                        low[here.node] = std::min(low[here.node], order[step.node]);
                    }
                    continue;
                }
                const Frame done = here;
                way.pop_back();
                if (!way.empty()) {
                    low[way.back().node] = std::min(low[way.back().node], low[done.node]);
                    found[done.by] = low[done.node] > order[way.back().node] ? 1 : 0;
                }
            }
        }
        return found;
    }

    /// 1 for the nodes that stay connected to `start` without the two edges.
    [[nodiscard]] std::vector<unsigned char> reached(std::size_t start, std::size_t a, std::size_t b) const {
        std::vector<unsigned char> seen(at.size(), 0);
        std::vector<std::size_t> open{start};
        seen[start] = 1;
        while (!open.empty()) {
            const std::size_t node = open.back();
            open.pop_back();
            for (const Step& step : at[node]) {
                if (step.edge != a && step.edge != b && seen[step.node] == 0) {
                    seen[step.node] = 1;
                    open.push_back(step.node);
                }
            }
        }
        return seen;
    }
};

struct Disks {
    std::vector<unsigned char> free; ///< every coordinate moves, carries no finite load and is not held with a force
    std::vector<unsigned char> held; ///< by an unknown infinitesimal force
    std::size_t count = 0;

    Disks(const Statics& statics, const ZeroHolds& zero) {
        const auto& contacts = statics.structure().contacts();
        const DofMap& dofs = statics.structure().dofs();
        assert(dofs.layout().dimension == plane);
        for (const Contact& c : contacts) {
            if (c.kind != ContactKind::held) {
                count = std::max(count, static_cast<std::size_t>(std::max(c.i, c.of_disks() ? c.j : 0)) + 1);
            }
        }
        free.assign(count, 1);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t a = 0; a < plane; ++a) {
                free[i] = dofs.dof_of(plane * i + a) < 0 ? 0 : free[i];
            }
        }
        const auto tie = [&](int coordinate) {
            const auto disk = static_cast<std::size_t>(coordinate) / plane;
            if (disk < count) {
                free[disk] = 0;
            }
        };
        for (const int row : statics.loaded_rows()) {
            tie(dofs.coordinate_of(row));
        }
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (contacts[l].kind == ContactKind::held && !zero.has(ContactId(l))) {
                tie(contacts[l].i);
            }
        }
        held.assign(count, 0);
        for (const ContactId l : zero.others) {
            const auto disk = static_cast<std::size_t>(contacts[l.index()].i) / plane;
            if (zero.fresh.valid() && disk < count && !statics.is_structural_zero(l)) {
                held[disk] = 1;
            }
        }
    }
};

/// Forces of unit contacts and infinitesimal loads on one disk.
using Vector = PerAxis<double>;

/// The force on the disk of a unit force in the contact.
Vector push(const Statics& statics, std::size_t contact, std::size_t disk) {
    const sparse::Matrix<double>& h = statics.structure().matrix();
    const DofMap& dofs = statics.structure().dofs();
    Vector on{};
    for (int e = h.start[contact]; e < h.start[contact + 1]; ++e) {
        const auto s = static_cast<std::size_t>(e);
        const auto coordinate = static_cast<std::size_t>(dofs.coordinate_of(h.row[s]));
        if (coordinate / plane == disk) {
            on[coordinate % plane] += h.value[s];
        }
    }
    return on;
}

/// Bound of the distance of normals at the turn from the stored ones, with the rounding of sums over all contacts (S4).
double doubt_of(const Statics& statics) {
    using roundoff::u;
    // stability.md S4 (rounding)
    return 2 * statics.normal_uncertainty() + (static_cast<double>(statics.structure().size()) + 512) * u;
}

/// The infinitesimal loads after the disks that carry no finite force at the turn
/// are removed with their contacts (S4 (c)): free disks that two contacts, not in
/// one line, hold. Disks are removed one by one, when two contacts are left on them.
struct Bare {
    std::vector<unsigned char> gone; ///< of contacts
    std::vector<Vector> load;        ///< of each disk: its own, and those passed on by removed disks
    std::vector<double> error;       ///< of the loads passed on, as a length

    Bare(const Statics& statics, const Disks& disks, const ZeroHolds& zero)
        : gone(statics.structure().contacts().size(), 0), load(disks.count), error(disks.count, 0) {
        const DofMap& dofs = statics.structure().dofs();
        const std::vector<double>& g = statics.infinitesimal_force();
        for (std::size_t row = 0; row < g.size(); ++row) {
            const auto coordinate = static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(row)));
            if (coordinate / plane < disks.count) {
                load[coordinate / plane][coordinate % plane] = g[row];
            }
        }
        const auto& contacts = statics.structure().contacts();
        for (const ContactId l : zero.others) {
            const auto coordinate = static_cast<std::size_t>(contacts[l.index()].i);
            if (coordinate / plane < disks.count) {
                // The force l is structurally zero in the finite forces, as solved and after the turn.
                const Enclosure part = statics.infinitesimal(l);
                load[coordinate / plane][coordinate % plane] -=
                    part.value * push(statics, l.index(), coordinate / plane)[coordinate % plane];
                error[coordinate / plane] += part.radius;
            }
        }
        std::vector<std::vector<std::size_t>> at(disks.count);
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (contacts[l].kind != ContactKind::held) {
                at[static_cast<std::size_t>(contacts[l].i)].push_back(l);
                if (contacts[l].of_disks()) {
                    at[static_cast<std::size_t>(contacts[l].j)].push_back(l);
                }
            }
        }
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < disks.count; ++i) {
            if (disks.free[i] != 0 && disks.held[i] == 0) {
                open.push_back(i);
            }
        }
        while (!open.empty()) {
            const std::size_t i = open.back();
            open.pop_back();
            std::erase_if(at[i], [&](std::size_t l) { return gone[l] != 0; });
            if (at[i].size() == 2 && take_away(statics, i, at[i][0], at[i][1])) {
                for (const std::size_t l : at[i]) {
                    const int j = !contacts[l].of_disks()                        ? -1
                                  : static_cast<std::size_t>(contacts[l].i) == i ? contacts[l].j
                                                                                 : contacts[l].i;
                    const auto other = static_cast<std::size_t>(j);
                    if (j >= 0 && disks.free[other] != 0 && disks.held[other] == 0) {
                        open.push_back(other);
                    }
                }
            }
        }
    }

  private:
    /// False when the two contacts may be in one line at the turn.
    bool take_away(const Statics& statics, std::size_t disk, std::size_t a, std::size_t b) {
        const Vector n = push(statics, a, disk);
        const Vector m = push(statics, b, disk);
        const double cross = n[0] * m[1] - n[1] * m[0];
        // Far more than the error of the place of the turn; the normals of a strut fail by many orders.
        constexpr double well_apart = 0x1p-16;                                    // stability.md S4 (c)
        if (!(std::abs(cross) > well_apart + 8 * statics.normal_uncertainty())) { // stability.md S4 (rounding)
            return false;
        }
        const Vector& g = load[disk];
        const double in_a = (g[0] * m[1] - g[1] * m[0]) / cross;
        const double in_b = (n[0] * g[1] - n[1] * g[0]) / cross;
        // Singular values of two unit columns: the smaller is at least |cross| / sqrt 2, at the turn 3/4 of that.
        const double doubt = doubt_of(statics);
        const double wrong =
            2 * (error[disk] + doubt * (std::abs(in_a) + std::abs(in_b) + std::abs(g[0]) + std::abs(g[1]))) /
            std::abs(cross);
        pass_on(statics, a, disk, in_a, wrong + doubt * std::abs(in_a));
        pass_on(statics, b, disk, in_b, wrong + doubt * std::abs(in_b));
        return true;
    }

    void pass_on(const Statics& statics, std::size_t contact, std::size_t from, double force, double wrong) {
        gone[contact] = 1;
        const Contact& c = statics.structure().contacts()[contact];
        if (!c.of_disks()) {
            return;
        }
        const auto to = static_cast<std::size_t>(static_cast<std::size_t>(c.i) == from ? c.j : c.i);
        const Vector on = push(statics, contact, to);
        for (std::size_t k = 0; k < plane; ++k) {
            load[to][k] -= force * on[k];
        }
        error[to] += wrong;
    }
};

ContactGraph graph_of(const Statics& statics, const Disks& disks, const std::vector<unsigned char>& gone) {
    const auto& contacts = statics.structure().contacts();
    ContactGraph graph;
    graph.ground = disks.count;
    graph.at.resize(disks.count + 1);
    graph.leads.assign(contacts.size(), 0);
    graph.ends.resize(contacts.size());
    const auto node = [&](int disk) {
        const auto i = static_cast<std::size_t>(disk);
        return disks.free[i] != 0 ? i : graph.ground;
    };
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        if (c.kind == ContactKind::held || gone[l] != 0) {
            continue;
        }
        const std::size_t a = node(c.i);
        const std::size_t b = c.of_disks() ? node(c.j) : graph.ground;
        if (a != b) {
            graph.at[a].push_back({b, l});
            graph.at[b].push_back({a, l});
            graph.leads[l] = 1;
            graph.ends[l] = {a, b};
        }
    }
    return graph;
}

/// f_b - f_a per unit of the infinitesimal loads, the disks `inside` being cut off by the contacts a and b.
Enclosure excess_over(const Statics& statics, std::size_t a, std::size_t b, const std::vector<unsigned char>& inside,
                      const Bare& bare) {
    Vector from_a{};
    Vector from_b{};
    Vector load{};
    double size = 0;
    double error = 0;
    const auto add = [](Vector& sum, const Vector& v) {
        for (std::size_t k = 0; k < plane; ++k) {
            sum[k] += v[k];
        }
    };
    const auto ends = [&](std::size_t contact, Vector& sum) { // by a unit force on the group
        const Contact& c = statics.structure().contacts()[contact];
        for (const int disk : {c.i, c.of_disks() ? c.j : -1}) {
            if (disk >= 0 && inside[static_cast<std::size_t>(disk)] != 0) {
                add(sum, push(statics, contact, static_cast<std::size_t>(disk)));
            }
        }
    };
    ends(a, from_a);
    ends(b, from_b);
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (inside[i] != 0) {
            add(load, bare.load[i]);
            error += bare.error[i];
            for (const double g : bare.load[i]) {
                size += std::abs(g);
            }
        }
    }
    double value = 0;
    double bend = 0;
    for (std::size_t k = 0; k < plane; ++k) {
        value -= 0.5 * load[k] * (from_a[k] - from_b[k]); // exact: a half: mean of two normals (S4)
        bend += std::abs(from_a[k] + from_b[k]);
    }
    // The normal of the straight strut lies between the two stored ones; each is known to `normal_uncertainty`.
    return {value, size * (bend + doubt_of(statics)) + 2 * error};
}

constexpr auto none = static_cast<std::size_t>(-1);

} // namespace

struct Turn::Parts {
    Disks disks;
    Bare bare;
    ContactGraph graph;
    std::vector<unsigned char> alone; ///< grains that a single contact cuts off leave it without force
};

Turn::Turn(const Statics& statics, ZeroHolds zero) : statics_(statics), zero_(std::move(zero)) {
    const Disks disks(statics, zero_);
    Bare bare(statics, disks, zero_);
    ContactGraph graph = graph_of(statics, disks, bare.gone);
    std::vector<unsigned char> alone = graph.bridges(none);
    parts_ = std::make_unique<const Parts>(Parts{disks, std::move(bare), std::move(graph), std::move(alone)});
}

Turn::~Turn() = default;

bool Turn::carries_nothing(ContactId contact) const {
    return parts_->bare.gone[contact.index()] != 0 || parts_->alone[contact.index()] != 0;
}

std::vector<EqualForce> Turn::mates(ContactId of) const {
    const ContactGraph& graph = parts_->graph;
    std::vector<EqualForce> mates;
    if (graph.leads[of.index()] == 0 || carries_nothing(of)) {
        return mates;
    }
    const std::vector<unsigned char> without = graph.bridges(of.index());
    for (std::size_t l = 0; l < without.size(); ++l) {
        if (without[l] == 0 || parts_->alone[l] != 0) {
            continue;
        }
        const auto [one, other] = graph.ends[of.index()];
        std::vector<unsigned char> inside = graph.reached(one, of.index(), l);
        if (inside[graph.ground] != 0) {
            inside = graph.reached(other, of.index(), l);
        }
        if (inside[graph.ground] != 0) {
            continue;
        }
        const Disks& disks = parts_->disks;
        inside.resize(disks.count);
        Enclosure excess;
        if (!zero_.fresh.valid()) {
            excess = statics_.infinitesimal(ContactId(l)) - statics_.infinitesimal(of);
        } else {
            excess = excess_over(statics_, of.index(), l, inside, parts_->bare);
            for (std::size_t i = 0; i < disks.count; ++i) {
                if (inside[i] != 0 && disks.held[i] != 0) {
                    excess.radius = std::numeric_limits<double>::infinity();
                }
            }
        }
        mates.push_back({ContactId(l), excess});
    }
    return mates;
}

} // namespace isostat
