#include "statics/straight_strut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace isostat {

namespace {

/// Contacts as edges between free disks; all that is not one of them is the node `ground`.
struct ContactGraph {
    struct Step {
        std::size_t node;
        std::size_t edge;
    };
    std::size_t ground = 0;
    std::vector<std::vector<Step>> at;
    std::vector<unsigned char> leads;             ///< this contact is an edge
    std::vector<std::array<std::size_t, 2>> ends; ///< of each contact that is one

    /// Edges without which their two ends are not connected, `left_out` being no edge at all.
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

template <int Dim> struct Disks {
    std::vector<unsigned char> free; ///< every coordinate moves, carries no finite load and is not held
    std::size_t count = 0;

    Disks(const Statics<Dim>& statics, std::span<const ContactId> zero_holds) {
        const auto& contacts = statics.structure().contacts();
        const DofMap<Dim>& dofs = statics.structure().dofs();
        for (const Contact& c : contacts) {
            if (c.kind != ContactKind::held) {
                count = std::max(
                    count, static_cast<std::size_t>(std::max(c.i, c.kind == ContactKind::disk_disk ? c.j : 0)) + 1);
            }
        }
        free.assign(count, 1);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t a = 0; a < Dim; ++a) {
                free[i] = dofs.dof_of(Dim * i + a) < 0 ? 0 : free[i];
            }
        }
        const auto tie = [&](int coordinate) {
            const auto disk = static_cast<std::size_t>(coordinate) / Dim;
            if (disk < count) {
                free[disk] = 0;
            }
        };
        for (const int row : statics.loaded_rows()) {
            tie(dofs.coordinate_of(row));
        }
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (contacts[l].kind == ContactKind::held &&
                std::find(zero_holds.begin(), zero_holds.end(), ContactId(l)) == zero_holds.end()) {
                tie(contacts[l].i);
            }
        }
    }
};

template <int Dim> ContactGraph graph_of(const Statics<Dim>& statics, const Disks<Dim>& disks) {
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
        if (c.kind == ContactKind::held) {
            continue;
        }
        const std::size_t a = node(c.i);
        const std::size_t b = c.kind == ContactKind::disk_disk ? node(c.j) : graph.ground;
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
template <int Dim>
Enclosure excess_over(const Statics<Dim>& statics, std::size_t a, std::size_t b,
                      const std::vector<unsigned char>& inside) {
    const sparse::Matrix<double>& h = statics.structure().matrix();
    const DofMap<Dim>& dofs = statics.structure().dofs();
    const auto within = [&](int row) {
        const auto disk = static_cast<std::size_t>(dofs.coordinate_of(row)) / Dim;
        return disk < inside.size() && inside[disk] != 0;
    };
    const auto push = [&](std::size_t column) { // of a unit force on the group
        std::array<double, Dim> sum{};
        for (int e = h.start[column]; e < h.start[column + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            if (within(h.row[s])) {
                sum[static_cast<std::size_t>(dofs.coordinate_of(h.row[s])) % Dim] += h.value[s];
            }
        }
        return sum;
    };
    const auto from_a = push(a);
    const auto from_b = push(b);
    std::array<double, Dim> load{};
    double size = 0;
    const std::vector<double>& g = statics.infinitesimal_force();
    for (std::size_t row = 0; row < g.size(); ++row) {
        if (within(static_cast<int>(row))) {
            load[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(row))) % Dim] += g[row];
            size += std::abs(g[row]);
        }
    }
    double value = 0;
    double bend = 0;
    for (std::size_t k = 0; k < Dim; ++k) {
        value -= 0.5 * load[k] * (from_a[k] - from_b[k]);
        bend += std::abs(from_a[k] + from_b[k]);
    }
    // The normal of the straight strut lies between the two stored ones; each is known to `normal_uncertainty`.
    return {value, size * (bend + 2 * statics.normal_uncertainty() + 0x1p-44)};
}

} // namespace

template <int Dim>
std::vector<StrutMate> strut_mates(const Statics<Dim>& statics, ContactId of, std::span<const ContactId> zero_holds) {
    const Disks<Dim> disks(statics, zero_holds);
    const ContactGraph graph = graph_of(statics, disks);
    std::vector<StrutMate> mates;
    if (graph.leads[of.index()] == 0) {
        return mates;
    }
    constexpr auto none = static_cast<std::size_t>(-1);
    const std::vector<unsigned char> alone = graph.bridges(none); // these carry no force
    if (alone[of.index()] != 0) {
        return mates;
    }
    const std::vector<unsigned char> without = graph.bridges(of.index());
    for (std::size_t l = 0; l < without.size(); ++l) {
        if (without[l] == 0 || alone[l] != 0) {
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
        inside.resize(disks.count);
        mates.push_back({ContactId(l), excess_over<Dim>(statics, of.index(), l, inside)});
    }
    return mates;
}

template std::vector<StrutMate> strut_mates<2>(const Statics<2>&, ContactId, std::span<const ContactId>);

} // namespace isostat
