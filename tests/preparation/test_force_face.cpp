// Forces of vertices at which more pairs touch than there are degrees of freedom, against closed forms.
#include "preparation/force_face.hpp"
#include "support/mirror.hpp"

using namespace isostat;
using namespace crafted;

namespace {

/// Least and most force of a pair.
std::pair<double, double> force_between(const ForceFace& face, const Contact& pair) {
    const auto at = std::ranges::find(face.pairs, pair);
    BOOST_TEST_REQUIRE((at != face.pairs.end()));
    const auto l = static_cast<std::size_t>(at - face.pairs.begin());
    return {face.least[l], face.most[l]};
}

void is_between(const ForceFace& face, const Contact& pair, double least, double most) {
    const auto found = force_between(face, pair);
    BOOST_TEST(std::abs(found.first - least) < 1e-7, to_string(pair) << ": " << found.first << ", " << least);
    BOOST_TEST(std::abs(found.second - most) < 1e-7, to_string(pair) << ": " << found.second << ", " << most);
}

std::pair<std::vector<Contact>, std::vector<Contact>> split(std::vector<Contact> all,
                                                            const std::vector<Contact>& touching) {
    std::erase_if(all, [&](const Contact& c) { return std::ranges::find(touching, c) != touching.end(); });
    return {all, touching};
}

} // namespace

/// Two equal disks side by side: top wall and floor share the load F2 = 4 between the columns, whoever is listed.
BOOST_AUTO_TEST_CASE(two_columns_share_the_load_in_any_way) {
    const State state = equal_pair();
    for (const Contact& last : {top(0), top(1), bottom(0), bottom(1)}) {
        const auto [contacts, touching] = split(state.contacts, {last});
        const auto face = required(force_face(state.packing, state.load, contacts, touching));
        BOOST_TEST(face.self_stresses.size() == 1U);
        for (const Contact& column : {top(0), bottom(0), top(1), bottom(1)}) {
            is_between(face, column, 0, 4);
        }
        for (const Contact& row : {left(0), pair(0, 1), right(1)}) { // F1 = 2, whatever the columns carry
            is_between(face, row, 2, 2);
        }
        // The self-stress: one column more, the other less.
        const std::vector<double>& stress = face.self_stresses[0];
        for (std::size_t l = 0; l < stress.size(); ++l) {
            const Contact& c = face.pairs[l];
            const double expected = c.kind == ContactKind::disk_disk || c.j == 0 ? 0 : c.i == last.i ? 1 : -1;
            BOOST_TEST(std::abs(stress[l] - expected) < 1e-14);
        }
    }
}

/// As `pile` says, P = F1 / 0.6: forces 0 <= p <= P of which only the sum F2 / 1.6 - P is fixed.
BOOST_AUTO_TEST_CASE(rows_on_a_wall_carry_the_load_as_their_face_says) {
    for (const int columns : {4, 6}) {
        const State state = pile(columns, 4);
        std::vector<Contact> removed;
        for (int c = 1; c + 2 < columns; ++c) {
            removed.push_back(pair(columns + c, columns + c + 1));
        }
        const auto [contacts, touching] = split(state.contacts, removed);
        const auto face = required(force_face(state.packing, state.load, contacts, touching));
        BOOST_TEST(face.self_stresses.size() == static_cast<std::size_t>(columns - 3));
        const double end = 1 / 0.6;
        const double sum = 4 / 1.6 - end;
        BOOST_TEST_REQUIRE(sum < end);
        is_between(face, pair(0, columns), end, end);
        for (int c = 1; c + 1 < columns; ++c) {
            is_between(face, pair(c, columns + c), 0, sum);
            is_between(face, pair(columns + c - 1, columns + c), 0.6 * (end - sum), 0.6 * end);
        }
    }
}

BOOST_AUTO_TEST_CASE(forces_that_only_pull_are_no_face) {
    State state = equal_pair();
    state.load.stress[1] = -1;
    const auto [contacts, touching] = split(state.contacts, {top(1)});
    fails(force_face(state.packing, state.load, contacts, touching), FailureKind::undecided);
}
