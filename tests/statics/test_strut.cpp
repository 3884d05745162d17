// Straight struts at a power turn (statement S4): their two ends carry one force, and the infinitesimal loads order
// them.
#include "statics/straight_strut.hpp"
#include "support/crafted.hpp"
#include "support/loaded.hpp"

#include <isostat/preparation/preparation.hpp>
#include <isostat/statics/decisions.hpp>

#include <boost/test/unit_test.hpp>

#include <queue>

using namespace isostat;
using namespace crafted;

namespace {

Contact held(int coordinate) {
    return {ContactKind::held, coordinate, 0};
}

/// Disks of radius 1 in a row between the side walls, which pull with force 1; another disk carries the top wall.
/// y of every disk of the row is held, that of the first one last in the list.
State<2> row_under_traction(int disks) {
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
    State<2> state = in_box(at, 2.0 * disks, 11, -1, 1, contacts);
    return state;
}

ContactId find(const State<2>& state, const Contact& contact) {
    const auto at = std::find(state.contacts.begin(), state.contacts.end(), contact);
    BOOST_TEST_REQUIRE((at != state.contacts.end()));
    return ContactId(static_cast<std::size_t>(at - state.contacts.begin()));
}

template <class T> std::string why(const Result<T>& result) {
    return result.ok() ? "answered" : result.failure().message;
}

/// The same by definition: both contacts together cut free disks off, neither of them alone.
std::vector<ContactId> slow_mates(const AtVertex& v, ContactId of, ContactId fresh) {
    const auto n = static_cast<std::size_t>(v.state.packing.disk_count());
    std::vector<unsigned char> grounded(n, 0);
    for (std::size_t l = 0; l < v.state.contacts.size(); ++l) {
        const Contact& c = v.state.contacts[l];
        if (c.kind == ContactKind::held && ContactId(l) != fresh && static_cast<std::size_t>(c.i) < 2 * n) {
            grounded[static_cast<std::size_t>(c.i) / 2] = 1;
        }
    }
    const auto cut_off = [&](std::vector<ContactId> without) {
        std::vector<unsigned char> seen = grounded;
        bool more = true;
        while (more) {
            more = false;
            for (std::size_t l = 0; l < v.state.contacts.size(); ++l) {
                const Contact& c = v.state.contacts[l];
                if (c.kind == ContactKind::held ||
                    std::find(without.begin(), without.end(), ContactId(l)) != without.end()) {
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
        return static_cast<int>(std::count(seen.begin(), seen.end(), 0));
    };
    std::vector<ContactId> mates;
    const int before = cut_off({});
    for (std::size_t l = 0; l < v.state.contacts.size(); ++l) {
        const ContactId other(l);
        if (other != of && v.state.contacts[l].kind != ContactKind::held && cut_off({of}) == before &&
            cut_off({other}) == before && cut_off({of, other}) > before) {
            mates.push_back(other);
        }
    }
    return mates;
}

} // namespace

BOOST_AUTO_TEST_SUITE(statics)

BOOST_AUTO_TEST_CASE(the_end_of_a_straight_strut_that_its_own_load_pulls_at_opens) {
    for (const double g : {1.0, -1.0, 1e-9, -1e-9}) {
        State<2> state = row_under_traction(1);
        state.load.infinitesimal[0] = g; // x of the strut
        AtVertex v(state);
        const ContactId fresh = find(state, held(1));
        const auto decision = decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, fresh, 0);
        BOOST_TEST_REQUIRE(decision.ok(), why(decision));
        BOOST_TEST_REQUIRE(decision.value().opening.has_value());
        // Pressed to the right it stays at the right wall.
        BOOST_TEST((v.contact(decision.value().opening->contact) == (g > 0 ? left(0) : right(0))), "g = " << g);
        BOOST_TEST(decision.value().opening->straight_strut);
        BOOST_TEST(decision.value().opening->margin > 1);
        BOOST_TEST((v.statics.rung() == Rung::double_bound));
        // The rule that opens the weakest traction has the opposite order.
        const auto least = decide_opening(v.statics, v.sigma(), OpeningRule::least_negative, fresh, 0);
        BOOST_TEST_REQUIRE(least.ok(), why(least));
        BOOST_TEST((v.contact(least.value().opening->contact) == (g > 0 ? right(0) : left(0))), "g = " << g);
    }
}

BOOST_AUTO_TEST_CASE(a_straight_strut_without_a_load_of_its_own_is_a_tie) {
    State<2> state = row_under_traction(1);
    state.load.infinitesimal[0] = 0;
    AtVertex v(state);
    const auto decision = decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, find(state, held(1)), 0);
    BOOST_TEST_REQUIRE(!decision.ok());
    BOOST_TEST((decision.failure().kind == FailureKind::tie));
    BOOST_TEST(decision.failure().message.find("straight strut") != std::string::npos, why(decision));
}

BOOST_AUTO_TEST_CASE(a_disk_whose_hold_carries_a_load_is_no_strut) {
    State<2> state = row_under_traction(1);
    state.load.disk_force.assign(4, 0.0);
    state.load.disk_force[1] = 0.5; // y of the disk, taken by the hold
    AtVertex v(state);
    const auto decision = decide_opening(v.statics, v.sigma(), OpeningRule::most_negative, ContactId(), 0);
    BOOST_TEST_REQUIRE(!decision.ok());
    BOOST_TEST((decision.failure().kind == FailureKind::tie));
    BOOST_TEST(decision.failure().message.find("exactly equal") != std::string::npos, why(decision));
}

BOOST_AUTO_TEST_CASE(a_row_of_two_is_one_strut_up_to_the_disk_that_another_hold_keeps) {
    State<2> state = row_under_traction(2);
    AtVertex v(state);
    const ContactId fresh = find(state, held(1));
    const auto mates = strut_mates(v.statics, find(state, left(0)), {&fresh, 1});
    BOOST_TEST_REQUIRE(mates.size() == 1U);
    BOOST_TEST((v.contact(mates[0].contact) == pair(0, 1)));
    BOOST_TEST(std::abs(mates[0].excess.value - state.load.infinitesimal[0]) <= 1e-12);
    BOOST_TEST(strut_mates(v.statics, find(state, right(1)), {&fresh, 1}).empty());
}

BOOST_AUTO_TEST_CASE(the_contacts_of_a_strut_are_those_of_the_definition) {
    int found = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        PreparationOptions options;
        options.disks = 20;
        options.seed = seed;
        PreparationReport<2> report;
        auto prepared = prepare<2>(options, report);
        BOOST_TEST_REQUIRE(prepared.ok());
        State<2> state = prepared.value();
        // A coordinate of each disk in turn is held in place of one of its contacts.
        for (std::size_t l = 0; l < state.contacts.size(); l += 3) {
            State<2> turned = state;
            const int coordinate = 2 * turned.contacts[l].i;
            turned.contacts[l] = held(coordinate);
            auto proved = IsostaticStructure<2>::prove(turned.packing, turned.contacts);
            if (!proved.ok()) {
                continue;
            }
            AtVertex v(turned);
            const ContactId fresh(l);
            for (std::size_t of = 0; of < turned.contacts.size(); ++of) {
                if (of == l) {
                    continue;
                }
                std::vector<ContactId> fast;
                for (const StrutMate& mate : strut_mates(v.statics, ContactId(of), {&fresh, 1})) {
                    fast.push_back(mate.contact);
                }
                const auto slow = slow_mates(v, ContactId(of), fresh);
                BOOST_TEST((fast == slow), "seed " << seed << " hold " << l << " contact " << of << ": " << fast.size()
                                                   << " against " << slow.size());
                found += static_cast<int>(slow.size());
            }
        }
    }
    BOOST_TEST(found > 10);
}

BOOST_AUTO_TEST_SUITE_END()
