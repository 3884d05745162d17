// Straight struts at a power turn (statement S4): their two ends carry one force, and the infinitesimal loads order
// them.
#include "statics/decisions.hpp"
#include "statics/equal_forces.hpp"
#include "support/crafted.hpp"
#include "support/loaded.hpp"
#include "support/prepared.hpp"
#include "support/strut.hpp"

#include <isostat/preparation/preparation.hpp>

using namespace isostat;
using namespace crafted;

namespace {

Contact held(int coordinate) {
    return {ContactKind::held, coordinate, 0};
}

/// Disks of radius 1 in a row between the side walls, which pull with force 1; another disk carries the top wall.
/// y of every disk of the row is held, that of the first one last in the list.
State row_under_traction(int disks) {
    std::vector<DiskAt> at;
    std::vector<Contact> contacts{left(0)};
    for (int i = 0; i < disks; ++i) {
        at.push_back({1, 1.0 + 2 * i, 1});
        contacts.push_back(i + 1 < disks ? pair(i, i + 1) : right(i));
    }
    at.push_back({5.5, 3, 5.5}); // the forces do not ask whether it overlaps the row
    contacts.insert(contacts.end(), {bottom(disks), top(disks), held(2 * disks)});
    for (int i = disks; i-- > 0;) {
        contacts.push_back(held(2 * i + 1));
    }
    State state = in_box(at, 2.0 * disks, 11, -1, 1, contacts);
    return state;
}

ContactId find(const State& state, const Contact& contact) {
    const auto at = std::ranges::find(state.contacts, contact);
    BOOST_TEST_REQUIRE((at != state.contacts.end()));
    return ContactId(static_cast<std::size_t>(at - state.contacts.begin()));
}

/// Does nothing unless the disk has just two neighbours.
void set_between_its_neighbours(State& state, int disk) {
    std::vector<std::size_t> neighbours;
    for (const Contact& c : state.contacts) {
        if (c.kind == ContactKind::held || (c.i != disk && (c.kind != ContactKind::disk_disk || c.j != disk))) {
            continue;
        }
        if (c.kind != ContactKind::disk_disk) {
            return;
        }
        neighbours.push_back(static_cast<std::size_t>(c.i == disk ? c.j : c.i));
    }
    if (neighbours.size() == 2) {
        for (std::size_t k = 0; k < 2; ++k) {
            std::vector<double>& q = state.packing.q;
            q[2 * static_cast<std::size_t>(disk) + k] = 0.5 * (q[2 * neighbours[0] + k] + q[2 * neighbours[1] + k]);
        }
    }
}

/// The same by definition.
struct SlowTurn {
    const AtVertex& v;
    std::vector<unsigned char> grounded; ///< disks with a coordinate held earlier
    std::vector<unsigned char> nothing;  ///< contacts that carry nothing

    SlowTurn(const AtVertex& vertex, ContactId fresh) : v(vertex) {
        const auto n = static_cast<std::size_t>(v.state.packing.disk_count());
        grounded.assign(n, 0);
        nothing.assign(v.state.contacts.size(), 0);
        for (std::size_t l = 0; l < v.state.contacts.size(); ++l) {
            const Contact& c = v.state.contacts[l];
            if (c.kind == ContactKind::held && ContactId(l) != fresh && static_cast<std::size_t>(c.i) < 2 * n) {
                grounded[static_cast<std::size_t>(c.i) / 2] = 1;
            }
        }
        for (std::size_t pass = 0; pass < n; ++pass) {
            for (std::size_t i = 0; i < n; ++i) {
                std::vector<std::size_t> around;
                for (std::size_t l = 0; l < v.state.contacts.size(); ++l) {
                    const Contact& c = v.state.contacts[l];
                    const auto disk = static_cast<int>(i);
                    if (nothing[l] == 0 && c.kind != ContactKind::held &&
                        (c.i == disk || (c.kind == ContactKind::disk_disk && c.j == disk))) {
                        around.push_back(l);
                    }
                }
                if (grounded[i] == 0 && around.size() == 2 && at_an_angle(around[0], around[1], static_cast<int>(i))) {
                    nothing[around[0]] = nothing[around[1]] = 1;
                }
            }
        }
        std::vector<unsigned char> alone(nothing.size(), 0);
        const int before = cut_off({});
        for (std::size_t l = 0; l < alone.size(); ++l) {
            alone[l] = v.state.contacts[l].kind != ContactKind::held && cut_off({ContactId(l)}) > before ? 1 : 0;
        }
        for (std::size_t l = 0; l < alone.size(); ++l) {
            nothing[l] = nothing[l] != 0 || alone[l] != 0 ? 1 : 0;
        }
    }

    [[nodiscard]] bool at_an_angle(std::size_t a, std::size_t b, int disk) const {
        const auto direction = [&](std::size_t l) {
            const Contact& c = v.state.contacts[l];
            const std::vector<double>& q = v.state.packing.q;
            if (c.kind != ContactKind::disk_disk) {
                return c.j == 0 ? 0.0 : std::acos(0.0);
            }
            const auto i = static_cast<std::size_t>(disk);
            const auto j = static_cast<std::size_t>(c.i == disk ? c.j : c.i);
            return std::atan2(q[2 * j + 1] - q[2 * i + 1], q[2 * j] - q[2 * i]);
        };
        return std::abs(std::sin(direction(a) - direction(b))) > 1e-4;
    }

    /// Disks that hang on nothing without these contacts.
    [[nodiscard]] int cut_off(const std::vector<ContactId>& without) const {
        std::vector<unsigned char> seen = grounded;
        bool more = true;
        while (more) {
            more = false;
            for (std::size_t l = 0; l < v.state.contacts.size(); ++l) {
                const Contact& c = v.state.contacts[l];
                if (c.kind == ContactKind::held || nothing[l] != 0 ||
                    std::ranges::find(without, ContactId(l)) != without.end()) {
                    continue;
                }
                const auto i = static_cast<std::size_t>(c.i);
                if (c.kind != ContactKind::disk_disk) {
                    more = more || seen[i] == 0;
                    seen[i] = 1;
                } else if (const auto j = static_cast<std::size_t>(c.j); seen[i] != seen[j]) {
                    seen[i] = seen[j] = 1;
                    more = true;
                }
            }
        }
        return static_cast<int>(std::ranges::count(seen, 0));
    }

    /// Both contacts together cut free disks off, neither of them alone.
    [[nodiscard]] std::vector<ContactId> mates(ContactId of) const {
        std::vector<ContactId> found;
        if (nothing[of.index()] != 0) {
            return found;
        }
        const int before = cut_off({});
        for (std::size_t l = 0; l < v.state.contacts.size(); ++l) {
            const ContactId other(l);
            if (other != of && v.state.contacts[l].kind != ContactKind::held && nothing[l] == 0 &&
                cut_off({of, other}) > before) {
                found.push_back(other);
            }
        }
        return found;
    }
};

/// What opens where coordinate 1 has just been held.
Opening opening_at_turn(AtVertex& v, OpeningRule rule = OpeningRule::most_negative) {
    return required(required(decide_opening(v.statics, v.sigma(), rule, {find(v.state, held(1)), {}}, 0)).opening);
}

} // namespace

BOOST_AUTO_TEST_CASE(the_end_of_a_straight_strut_that_its_own_load_pulls_at_opens) {
    for (const double g : {1.0, -1.0, 1e-9, -1e-9}) {
        State state = row_under_traction(1);
        state.load.infinitesimal[0] = g; // x of the strut
        AtVertex v(state);
        const Opening opening = opening_at_turn(v);
        // Pressed to the right it stays at the right wall.
        BOOST_TEST((v.contact(opening.contact) == (g > 0 ? left(0) : right(0))), "g = " << g);
        BOOST_TEST(opening.equal_forces);
        BOOST_TEST(opening.margin > 1);
        BOOST_TEST((v.statics.rung() == Rung::double_bound));
        // The rule that opens the weakest traction has the opposite order.
        const ContactId least = opening_at_turn(v, OpeningRule::least_negative).contact;
        BOOST_TEST((v.contact(least) == (g > 0 ? right(0) : left(0))), "g = " << g);
        // Held since an earlier vertex, the same.
        const auto later = required(decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, {}, 0));
        BOOST_TEST((required(later.opening).contact == opening.contact), "g = " << g);
    }
}

/// A member that touches nothing, 3-4, turns about the other one, and its height is held without a finite force.
BOOST_AUTO_TEST_CASE(a_body_that_two_contacts_hold_is_a_strut_with_the_loads_of_all_its_members) {
    for (const double g : {1.0, -1.0}) {
        State state = row_under_traction(1);
        state.packing.radius.push_back(0.25);
        state.packing.q.insert(state.packing.q.begin() + 4, {1.375, 1.5});
        state.packing.bars = {{0, 2, 0.625}};
        state.contacts.insert(state.contacts.end(), {{ContactKind::bar, 0, 2}, held(5)});
        state.load.infinitesimal = {-2 * g, 0, 0, 0, 3 * g, 0};
        AtVertex v(state);
        const Opening opening = opening_at_turn(v);
        BOOST_TEST((v.contact(opening.contact) == (g > 0 ? left(0) : right(0))), "g = " << g);
        BOOST_TEST(opening.equal_forces);
    }
}

BOOST_AUTO_TEST_CASE(a_turn_at_which_every_force_is_positive_is_no_equilibrium) {
    // One disk upright on another: a maximum of the potential, which no arc that lowers it reaches (S3).
    const auto on_top = [](double x) {
        return in_box({{1, 1, 1}, {1, x, 3}}, 2, 4, 1, 1, {left(0), bottom(0), right(0), pair(0, 1), top(1), held(2)});
    };
    State state = on_top(1 + 1e-9);
    AtVertex v(state);
    fails(decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, {find(state, held(2)), {}}, 0),
          FailureKind::undecided);
    // Held earlier it has a force, and is let go.
    const auto later = required(decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, {}, 0));
    BOOST_TEST((v.contact(required(later.opening).contact) == held(2)));
}

BOOST_AUTO_TEST_CASE(a_straight_strut_without_a_load_of_its_own_is_a_tie) {
    State state = row_under_traction(1);
    state.load.infinitesimal[0] = 0;
    AtVertex v(state);
    fails(decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, {find(state, held(1)), {}}, 0),
          FailureKind::tie, {"straight strut"});
}

BOOST_AUTO_TEST_CASE(a_disk_whose_hold_carries_a_load_is_no_strut) {
    State state = row_under_traction(1);
    state.load.disk_force.assign(4, 0.0);
    state.load.disk_force[1] = 0.5; // y of the disk, taken by the hold
    AtVertex v(state);
    fails(decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, {}, 0), FailureKind::tie, {"exactly equal"});
}

BOOST_AUTO_TEST_CASE(a_grain_without_force_that_joins_a_strut_to_the_rest_only_puts_its_load_on_it) {
    for (const double angle : {0.5235987755982988, 1.3089969389957472}) {
        for (const StrutLoad& load : strut_loads()) {
            State state = strut_with_a_grain(angle, load);
            const double pushed = load.on_strut - 0.5 * load.towards_strut;
            const ContactId fresh = find(state, held(2));
            {
                AtVertex v(state);
                const auto mates = Turn(v.statics, {fresh, {}}).mates(find(state, left(0)));
                BOOST_TEST_REQUIRE(mates.size() == 1U);
                BOOST_TEST((v.contact(mates[0].contact) == right(0)));
                BOOST_TEST(std::abs(mates[0].excess.value - pushed) <= 1e-12);
                const auto decision =
                    required(decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, {fresh, {}}, 0));
                BOOST_TEST((v.contact(decision.opening->contact) == (load.to_the_right ? left(0) : right(0))));
                BOOST_TEST(decision.opening->equal_forces);
            }
            // Held earlier, without a finite force: that hold takes what is added along it.
            state.load.infinitesimal[2] += 0.7;
            AtVertex v(state);
            const auto later = Turn(v.statics, {ContactId(6), {fresh}}).mates(find(state, left(0)));
            BOOST_TEST_REQUIRE(later.size() == 1U);
            BOOST_TEST(std::abs(later[0].excess.value - pushed) <= 1e-12);
            const auto no_fresh = Turn(v.statics, {ContactId(), {fresh}}).mates(find(state, left(0)));
            BOOST_TEST_REQUIRE(no_fresh.size() == 1U);
            BOOST_TEST(std::abs(no_fresh[0].excess.value - pushed) <= 1e-12);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_row_of_two_is_one_strut_up_to_the_disk_that_another_hold_keeps) {
    State state = row_under_traction(2);
    AtVertex v(state);
    const ContactId fresh = find(state, held(1));
    const auto mates = Turn(v.statics, {fresh, {}}).mates(find(state, left(0)));
    BOOST_TEST_REQUIRE(mates.size() == 1U);
    BOOST_TEST((v.contact(mates[0].contact) == pair(0, 1)));
    BOOST_TEST(std::abs(mates[0].excess.value - state.load.infinitesimal[0]) <= 1e-12);
    BOOST_TEST(Turn(v.statics, {fresh, {}}).mates(find(state, right(1))).empty());
}

// Two disks a little out of line, and the forces of the strut as far apart: the holds were released and turned back at
// once, so the exact turn is here, and digits of its place do not choose.
BOOST_AUTO_TEST_CASE(the_ends_of_a_strut_whose_holds_turned_back_are_ordered_by_the_loads) {
    for (const double g : {1.0, -1.0}) {
        State state = row_under_traction(2);
        state.packing.q[3] += 4e-6; // y of the second disk
        state.load.infinitesimal[0] = state.load.infinitesimal[2] = g;
        AtVertex v(state, false);
        const auto force = [&](const Contact& c) { return v.statics.force(find(state, c), v.sigma()); };
        BOOST_TEST_REQUIRE((force(pair(0, 1)) - force(left(0))).negative());
        const ZeroHolds aside{ContactId(), {find(state, held(1)), find(state, held(3))}};
        const OpeningDecision decision =
            required(decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, aside, 0));
        BOOST_TEST_REQUIRE(decision.opening.has_value());
        BOOST_TEST((v.contact(decision.opening->contact) == (g > 0 ? left(0) : right(1))), "g = " << g);
    }
}

BOOST_AUTO_TEST_CASE(the_load_on_a_long_strut_is_bounded_with_the_rounding_of_its_sum) {
    constexpr int disks = 4000;
    State state = row_under_traction(disks);
    std::ranges::fill(state.load.infinitesimal, 0.0);
    // 1 + 2^-54 is rounded to 1 again and again: the sum in double is -1.3e-13, the true one 0.9e-13.
    for (std::size_t i = 0; i < disks; ++i) {
        state.load.infinitesimal[2 * i] = i == 0 ? 1 : 0x1p-54;
    }
    const double last = -(1 + 1.3e-13);
    state.load.infinitesimal[2 * (disks - 1)] = last;
    const double sum = (disks - 2) * 0x1p-54 + (1 + last);
    AtVertex v(state, false);
    while (v.statics.rung() == Rung::double_bound) { // the bounds of the holds' own forces would cover everything
        BOOST_TEST_REQUIRE(v.statics.climb());
    }
    const ContactId fresh = find(state, held(1));
    ZeroHolds zero{fresh, {}};
    for (int i = 1; i < disks; ++i) {
        zero.others.push_back(find(state, held(2 * i + 1)));
    }
    const auto mates = Turn(v.statics, zero).mates(find(state, left(0)));
    const auto end = std::ranges::find_if(
        mates, [&](const EqualForce& mate) { return v.contact(mate.contact) == right(disks - 1); });
    BOOST_TEST_REQUIRE((end != mates.end()));
    BOOST_TEST(std::abs(end->excess.value - sum) > 2e-13); // what was lost
    BOOST_TEST(std::abs(end->excess.value - sum) <= end->excess.radius);
    BOOST_TEST(end->excess.radius < 1e-11);
}

BOOST_AUTO_TEST_CASE(the_contacts_of_a_strut_are_those_of_the_definition) {
    int found = 0;
    int nothing = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        const State state = prepared(20, seed);
        // A coordinate of each disk in turn is held in place of one of its contacts; when two are left the disk is
        // moved between its neighbours: a strut.
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            State turned = state;
            const int disk = turned.contacts[l].i;
            turned.contacts[l] = held(2 * disk);
            set_between_its_neighbours(turned, disk);
            auto proved = IsostaticStructure::prove(turned.packing, turned.contacts);
            if (!proved.ok()) {
                continue;
            }
            AtVertex v(turned, false);
            const ContactId fresh(l);
            const Turn turn(v.statics, {fresh, {}});
            const SlowTurn slow(v, fresh);
            for (std::size_t of = 0; of < turned.contacts.size(); ++of) {
                if (turned.contacts[of].kind == ContactKind::held) {
                    continue;
                }
                BOOST_TEST(turn.carries_nothing(ContactId(of)) == (slow.nothing[of] != 0),
                           "seed " << seed << " hold " << l << " contact " << of);
                nothing += slow.nothing[of];
                std::vector<ContactId> fast;
                for (const EqualForce& mate : turn.mates(ContactId(of))) {
                    fast.push_back(mate.contact);
                }
                const auto expected = slow.mates(ContactId(of));
                BOOST_TEST((fast == expected), "seed " << seed << " hold " << l << " contact " << of << ": "
                                                       << fast.size() << " against " << expected.size());
                found += static_cast<int>(expected.size());
            }
        }
    }
    BOOST_TEST(nothing > 10);
    BOOST_TEST(found > 10);
}
