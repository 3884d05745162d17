#pragma once
// One packing in other clothes (labels, sides, axes), and the comparison of the runs event by event.

#include "support/crafted.hpp"
#include "support/prepared.hpp"

namespace crafted {

using namespace isostat;

/// A contact as seen after a change of labels and sides.
template <class Map> inline std::vector<std::pair<Contact, Contact>> events(const Recorder& records, Map map) {
    std::vector<std::pair<Contact, Contact>> list;
    for (const auto& arc : records.arcs) {
        list.emplace_back(map(arc.opened), map(arc.closed));
    }
    return list;
}
inline Contact same(const Contact& contact) {
    return contact;
}

inline void check_same_sequence(const Played& a, const Played& b,
                                const std::vector<std::pair<Contact, Contact>>& events_b,
                                double stress_tolerance = 1e-8) {
    const auto events_a = events(a.records, same);
    BOOST_TEST_REQUIRE(events_a.size() == events_b.size());
    for (std::size_t k = 0; k < events_a.size(); ++k) {
        BOOST_TEST((events_a[k] == events_b[k]),
                   "arc " << k + 1 << ": " << to_string(events_a[k].first) << " -> " << to_string(events_a[k].second)
                          << " against " << to_string(events_b[k].first) << " -> " << to_string(events_b[k].second));
    }
    for (std::size_t k = 0; k < a.records.equilibria.size(); ++k) {
        BOOST_TEST(a.records.equilibria[k].stress == b.records.equilibria[k].stress,
                   boost::test_tools::tolerance(stress_tolerance));
    }
}

/// The same packing seen otherwise, and how its contacts read in the original.
struct Disguised {
    State state;
    std::function<Contact(const Contact&)> back;
};

inline Disguised disguised(State state, const std::function<Contact(const Contact&)>& there,
                           std::function<Contact(const Contact&)> back) {
    for (Contact& c : state.contacts) {
        c = there(c);
    }
    return {std::move(state), std::move(back)};
}

/// Disk label[k] is the k-th one.
inline Disguised with_labels(const State& start, const std::vector<int>& label) {
    std::vector<int> inverse(label.size());
    State state = start;
    for (std::size_t k = 0; k < label.size(); ++k) {
        const auto old = static_cast<std::size_t>(label[k]);
        inverse[old] = static_cast<int>(k);
        state.packing.radius[k] = start.packing.radius[old];
        for (std::size_t a = 0; a < 2; ++a) {
            state.packing.q[2 * k + a] = start.packing.q[2 * old + a];
            state.load.infinitesimal[2 * k + a] = start.load.infinitesimal[2 * old + a];
        }
    }
    const auto relabel = [](const std::vector<int>& to) {
        return [to](const Contact& c) {
            return c.kind == ContactKind::disk_disk
                       ? pair_of(to[static_cast<std::size_t>(c.i)], to[static_cast<std::size_t>(c.j)], c.image)
                   : c.kind == ContactKind::held && c.i / 2 < static_cast<int>(to.size())
                       ? Contact{c.kind, 2 * to[static_cast<std::size_t>(c.i / 2)] + c.i % 2, 0}
                   : c.kind == ContactKind::held ? c
                                                 : Contact{c.kind, to[static_cast<std::size_t>(c.i)], c.j};
        };
    };
    return disguised(std::move(state), relabel(inverse), relabel(label));
}

/// Disks in another order, contacts too.
inline Disguised relabelled(const State& start, unsigned seed) {
    std::vector<int> label(start.packing.radius.size());
    std::iota(label.begin(), label.end(), 0);
    std::mt19937 random(seed);
    for (std::size_t k = label.size(); k > 1; --k) {
        std::swap(label[k - 1], label[random() % k]);
    }
    Disguised other = with_labels(start, label);
    std::ranges::reverse(other.state.contacts);
    return other;
}

/// Left and right exchanged.
inline Disguised mirrored(const State& start) {
    State state = start;
    for (std::size_t i = 0; i < static_cast<std::size_t>(start.packing.disk_count()); ++i) {
        state.packing.q[2 * i] = start.packing.length(0) - start.packing.q[2 * i];
        state.load.infinitesimal[2 * i] = -start.load.infinitesimal[2 * i];
    }
    const auto mirror = [](const Contact& c) {
        if (c.kind == ContactKind::lower_wall && c.j == 0) {
            return Contact{ContactKind::upper_wall, c.i, 0};
        }
        if (c.kind == ContactKind::upper_wall && c.j == 0) {
            return Contact{ContactKind::lower_wall, c.i, 0};
        }
        return c;
    };
    return disguised(std::move(state), mirror, mirror);
}

/// x and y exchanged.
inline Disguised exchanged(const State& start) {
    State state = start;
    for (std::size_t k = 0; k < state.packing.length_at(2); k += 2) {
        std::swap(state.packing.q[k], state.packing.q[k + 1]);
    }
    for (std::size_t k = 0; k < state.load.infinitesimal.size(); k += 2) {
        std::swap(state.load.infinitesimal[k], state.load.infinitesimal[k + 1]);
    }
    std::swap(state.load.stress[0], state.load.stress[1]);
    std::swap(state.load.reference_length[0], state.load.reference_length[1]);
    state.load.loaded_axis = 0;
    const auto exchange = [](const Contact& c) {
        return c.kind == ContactKind::disk_disk ? c
               : c.kind == ContactKind::held    ? Contact{c.kind, c.i ^ 1, 0}
                                                : Contact{c.kind, c.i, 1 - c.j};
    };
    return disguised(std::move(state), exchange, exchange);
}

/// (x, y) -> (L_y - y, x): left becomes bottom, bottom right, right top, top left.
inline Disguised quarter_turned(const State& start) {
    const Disguised once = exchanged(start);
    Disguised twice = mirrored(once.state);
    const auto back = [once = once.back, twice = twice.back](const Contact& c) { return once(twice(c)); };
    return {std::move(twice.state), back};
}

inline void check_same_sequence(const Played& played, const Disguised& other, int equilibria, int direction = +1) {
    const Played run = play(other.state, direction, equilibria);
    check_same_sequence(played, run, events(run.records, other.back));
}

} // namespace crafted
