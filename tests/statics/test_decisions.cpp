// Decisions of the statics: classes, ties, rules, and the ladder of precision.
#include "statics/decisions.hpp"
#include "statics/equal_forces.hpp"
#include "support/clumps.hpp"
#include "support/crafted.hpp"
#include "support/loaded.hpp"
#include "support/prepared.hpp"

using namespace isostat;
using namespace crafted;

namespace {

/// About the stored configuration.
struct Loaded : AtVertex {
    explicit Loaded(State s) : AtVertex(std::move(s), false) {}
};

} // namespace

BOOST_AUTO_TEST_CASE(forces_that_share_one_support_vanish_as_a_structural_class) {
    Loaded loaded(three_disks(1, 1, 1.5, 1, 1));
    const auto limit = required(find_limit(loaded.statics, loaded.sigma(), -1));
    // Without F2 the top disk carries nothing: its three contacts and the two bottoms reach zero together.
    std::set<Contact> members;
    for (const ContactId l : limit.tie_class) {
        members.insert(loaded.contact(l));
    }
    BOOST_TEST((members == std::set<Contact>{top(2), pair(0, 2), pair(1, 2), bottom(0), bottom(1)}));
    BOOST_TEST(std::abs(limit.stress) <= limit.stress_error + 1e-15);
    // The member with the smallest f1 / |slope|.
    for (const ContactId l : limit.tie_class) {
        const auto key = [&](ContactId c) {
            return loaded.statics.infinitesimal(c).value / std::abs(loaded.statics.slope(c).value);
        };
        BOOST_TEST(key(limit.opens) <= key(l));
    }
}

// D3: every other force is positive on all of [stress - error, stress + error].
BOOST_AUTO_TEST_CASE(forces_at_a_limit_are_known_no_better_than_the_limit) {
    int told = 0; // where this is what the margin says
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        Loaded loaded(prepared(50, seed));
        for (const int direction : {+1, -1}) {
            const auto found = required(find_limit(loaded.statics, loaded.sigma(), direction));
            const LoadLimit& limit = found;
            double with = std::numeric_limits<double>::infinity();
            double without = with;
            for (int l = 0; l < loaded.structure.size() && !limit.unbounded; ++l) {
                const ContactId id(l);
                const bool member = std::ranges::count(limit.tie_class, id) > 0;
                if (member || loaded.statics.is_structural_zero(id)) {
                    continue;
                }
                const Enclosure f = loaded.statics.force(id, limit.stress);
                const Enclosure b = loaded.statics.slope(id);
                const double radius = f.radius + (std::abs(b.value) + b.radius) * limit.stress_error;
                BOOST_TEST(f.value > radius);
                with = std::min(with, f.value / radius);
                without = std::min(without, f.value / f.radius);
            }
            BOOST_TEST(limit.margin <= with * (1 + 1e-9));
            told += limit.margin >= with * (1 - 1e-9) && with < 0.9 * without ? 1 : 0;
        }
    }
    BOOST_TEST(told > 0);
}

BOOST_AUTO_TEST_CASE(classes_of_prepared_packings_vanish_together_and_nothing_else_does) {
    int classes = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        Loaded loaded(prepared(50, seed));
        for (const int direction : {+1, -1}) {
            const auto limit = required(find_limit(loaded.statics, loaded.sigma(), direction));
            std::set<int> members;
            for (const ContactId l : limit.tie_class) {
                members.insert(l.value());
            }
            classes += members.size() > 1 ? 1 : 0;
            for (std::size_t l = 0; l < loaded.state.contacts.size(); ++l) {
                const ContactId id(l);
                if (loaded.statics.is_structural_zero(id)) {
                    continue;
                }
                const Enclosure f = loaded.statics.force(id, limit.stress);
                if (members.count(id.value()) != 0) {
                    BOOST_TEST(std::abs(f.value) <=
                               f.radius + limit.stress_error * (std::abs(loaded.statics.slope(id).value) * 1.001 +
                                                                loaded.statics.slope(id).radius));
                } else {
                    BOOST_TEST(f.positive());
                }
            }
        }
    }
    BOOST_TEST(classes > 0);
}

BOOST_AUTO_TEST_CASE(two_equal_tractions_are_a_tie_and_unequal_ones_are_ordered) {
    // A small disk pulled out of the notch between two equal ones: equal tractions in its two lower contacts, larger
    // than in the upper one.
    Loaded equal(three_disks(1, 1, 0.1, 1, -1));
    const Failure tie = fails(decide_opening(equal.statics, equal.sigma(), OpeningRule::most_negative, {}, 0),
                              FailureKind::tie, {"0-2", "1-2", "exactly equal"});
    std::vector<Contact> tied = tie.contacts();
    std::ranges::sort(tied);
    BOOST_TEST((tied == std::vector<Contact>{{ContactKind::disk_disk, 0, 2}, {ContactKind::disk_disk, 1, 2}}));
    BOOST_TEST((equal.statics.rung() == Rung::exact)); // a tie is proved, not given up
    // It compares no forces.
    const auto by_name = required(decide_opening(equal.statics, equal.sigma(), OpeningRule::least_index, {}, 0));
    BOOST_TEST((equal.state.contacts[by_name.opening->contact.index()] == pair(0, 2)));
    for (const double delta : {1e-1, 1e-3, 1e-6, 1e-9, 1e-12}) {
        Loaded larger_right(three_disks(1, 1 + delta, 0.1, 1, -1));
        Loaded larger_left(three_disks(1 + delta, 1, 0.1, 1, -1));
        const auto right = required(decide_opening(larger_right.statics, -1, OpeningRule::most_negative, {}, 0));
        const auto left = required(decide_opening(larger_left.statics, -1, OpeningRule::most_negative, {}, 0));
        // Mirror images open mirrored contacts.
        const Contact a = larger_right.contact(right.opening->contact);
        const Contact b = larger_left.contact(left.opening->contact);
        BOOST_TEST(((a == pair(0, 2) && b == pair(1, 2)) || (a == pair(1, 2) && b == pair(0, 2))), "delta " << delta);
        BOOST_TEST(right.margin > 1);
    }
}

BOOST_AUTO_TEST_CASE(the_rules_choose_what_their_names_say) {
    // Pull everything: several tractions.
    State state = prepared(30, 3);
    state.load.stress = {1, 4};
    Loaded loaded(state);
    const auto choose = [&](OpeningRule rule, std::uint64_t bits) {
        const auto decision = required(decide_opening(loaded.statics, 4, rule, {}, bits));
        BOOST_TEST_REQUIRE(decision.opening.has_value());
        return decision.opening->contact;
    };
    std::vector<ContactId> negative;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        if (loaded.statics.force(ContactId(l), 4).negative()) {
            negative.push_back(ContactId(l));
        }
    }
    BOOST_TEST_REQUIRE(negative.size() > 2U);
    const auto value = [&](ContactId l) { return loaded.statics.force(l, 4).value; };
    const ContactId most = choose(OpeningRule::most_negative, 0);
    const ContactId least = choose(OpeningRule::least_negative, 0);
    std::set<int> drawn;
    for (const ContactId l : negative) {
        BOOST_TEST(value(most) <= value(l));
        BOOST_TEST(value(least) >= value(l));
    }
    for (std::uint64_t bits = 0; bits < 3 * negative.size(); ++bits) {
        const ContactId l = choose(OpeningRule::random, bits);
        BOOST_TEST(value(l) < 0);
        drawn.insert(l.value());
    }
    BOOST_TEST(drawn.size() == negative.size());
    const auto& contacts = loaded.state.contacts;
    const ContactId first = *std::ranges::min_element(
        negative, [&](ContactId a, ContactId b) { return contacts[a.index()] < contacts[b.index()]; });
    BOOST_TEST((choose(OpeningRule::least_index, 7) == first));
}

BOOST_AUTO_TEST_CASE(without_infinitesimal_loads_a_rattler_leaves_its_sign_undecided) {
    // Disk 1 lies in the corner between bottom and right wall without touching anything else.
    State state =
        in_box({{2, 2, 2}, {0.5, 3.5, 0.5}}, 4, 4, 1, 1, {left(0), right(0), bottom(0), top(0), right(1), bottom(1)});
    state.load.infinitesimal = {0.1, -1, 0.1, -1}; // into the corner
    Loaded resting(state);
    BOOST_TEST(resting.statics.is_structural_zero(ContactId(4)));
    BOOST_TEST(resting.statics.is_structural_zero(ContactId(5)));
    const auto rests = required(decide_opening(resting.statics, 1, OpeningRule::most_negative, {}, 0));
    BOOST_TEST(!rests.opening.has_value());
    state.load.infinitesimal[2] = -0.1; // away from the right wall
    Loaded leaving(state);
    const auto leaves = decide_opening(leaving.statics, 1, OpeningRule::most_negative, {}, 0);
    BOOST_TEST_REQUIRE((leaves.ok() && leaves.value().opening.has_value()));
    BOOST_TEST((leaving.contact(leaves.value().opening->contact) == right(1)));
    BOOST_TEST(leaves.value().opening->infinitesimal);
    state.load.infinitesimal.clear();
    Loaded unloaded(state);
    fails(decide_opening(unloaded.statics, 1, OpeningRule::most_negative, {}, 0), FailureKind::undecided);
}

BOOST_AUTO_TEST_CASE(a_load_that_no_force_limits_is_unbounded_and_says_so) {
    Loaded loaded(one_disk(1, 1));
    BOOST_TEST(required(find_limit(loaded.statics, 1, +1)).unbounded);
    const auto down = required(find_limit(loaded.statics, 1, -1));
    BOOST_TEST(!down.unbounded);
    BOOST_TEST(down.stress == 0.0);
    BOOST_TEST(down.tie_class.size() == 2U);
}

/// The slope is 0 to all digits, and no pattern of the matrix says so. Exact numbers would: they are left out.
BOOST_AUTO_TEST_CASE(a_force_that_the_balance_of_the_whole_keeps_constant_gives_no_limit) {
    AtVertex notch(isostat::test::notch(1, 2), true, {.exact_size = 0});
    const std::vector<Contact>& contacts = notch.state.contacts;
    const ContactId at_left(static_cast<std::size_t>(std::ranges::find(contacts, left(0)) - contacts.begin()));
    BOOST_TEST(!notch.statics.slope_is_zero(at_left));
    BOOST_TEST(notch.statics.slope_cancels(at_left));
    BOOST_TEST(required(find_limit(notch.statics, 2, +1)).unbounded);
}

/// A dimer of equal members that lies level hands on what presses at both, in equal parts: a tie for the digits.
BOOST_AUTO_TEST_CASE(two_members_that_lie_level_bear_one_force_and_the_infinitesimal_loads_order_them) {
    const auto mates = [](const State& state) {
        AtVertex at(state);
        const auto found = std::ranges::find(at.state.contacts, pair(0, 2));
        std::vector<Contact> equal;
        for (const EqualForce& e :
             equal_by_place(at.statics, ContactId(static_cast<std::size_t>(found - at.state.contacts.begin())))) {
            equal.push_back(at.contact(e.contact));
        }
        return equal;
    };
    const State perch = isostat::test::perch(1, 1, 3);
    BOOST_TEST((mates(perch) == std::vector<Contact>{pair(1, 2)}));
    BOOST_TEST(mates(isostat::test::notch(1, 1)).empty()); // the side walls press on the dimer
    State unequal = perch;
    unequal.packing.radius[1] += 0x1p-53;
    BOOST_TEST(mates(unequal).empty());
    State pushed = perch;
    pushed.load.disk_force[2] = 0x1p-40;
    BOOST_TEST(mates(pushed).empty());
    for (const double pull : {-1.0, 1.0}) { // on the dimer: the member that the load presses to the disk stays
        State state = perch;
        state.load.infinitesimal = {pull, 0, 0, 0, 0, 0};
        AtVertex at(state);
        const OpeningDecision opens = required(decide_opening(at.statics, 1, OpeningRule::most_negative, {}, 0));
        BOOST_TEST_REQUIRE(opens.opening.has_value());
        BOOST_TEST(opens.opening->equal_forces);
        BOOST_TEST((at.contact(opens.opening->contact) == pair(pull < 0 ? 0 : 1, 2)));
    }
}

/// Random lists of contacts, at random places: disks, of which one may be fixed, one contact at the left wall, and
/// coordinates that are held. What sums show to be constant has a slope that is not told from 0.
BOOST_AUTO_TEST_CASE(slopes_that_sums_show_to_vanish_do) {
    std::mt19937_64 random(1);
    const auto uniform = [&] { return 1 + 8 * (static_cast<double>(random() >> 11) * 0x1p-53); };
    int regular = 0;
    int shown = 0;
    for (int attempt = 0; attempt < 20000 && regular < 300; ++attempt) {
        const int disks = 3 + attempt % 3;
        std::vector<DiskAt> places;
        std::vector<Contact> list{left(attempt % disks)};
        std::vector<Contact> others;
        for (int i = 0; i < disks; ++i) {
            places.push_back({0.5, uniform(), uniform()});
            for (const Contact& c : {bottom(i), right(i), top(i), Contact{ContactKind::held, 2 * i, 0}}) {
                others.push_back(c);
            }
            for (int j = i + 1; j < disks; ++j) {
                others.push_back(pair(i, j));
            }
        }
        State state = in_box(places, 10, 10, 1, 1, {});
        state.packing.fixed.assign(static_cast<std::size_t>(disks), 0);
        state.packing.fixed[0] = attempt % 4 == 0 ? 1 : 0;
        std::ranges::shuffle(others, random);
        const DofMap dofs(state.packing);
        list.insert(list.end(), others.begin(), others.begin() + dofs.dof_count() - 1);
        std::ranges::sort(list);
        state.contacts = list;
        if (!IsostaticStructure::prove(state.packing, list).ok()) {
            continue;
        }
        ++regular;
        Loaded loaded(state);
        for (std::size_t l = 0; l < list.size(); ++l) {
            if (loaded.statics.slope_cancels(ContactId(l))) {
                BOOST_TEST(!loaded.statics.slope(ContactId(l)).decided());
                shown += loaded.statics.slope_is_zero(ContactId(l)) ? 0 : 1;
            } else {
                BOOST_TEST(!loaded.statics.slope_is_zero(ContactId(l)));
            }
        }
    }
    BOOST_TEST(regular == 300);
    BOOST_TEST(shown > 10);
}
