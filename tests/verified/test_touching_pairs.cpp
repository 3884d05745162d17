// Rates of pairs that touch: exactly 0 where contacts that stay closed make one body of the two grains, a number with a
// bound where not; against radii and places that are really moved.
#include "support/crafted.hpp"
#include "support/regular.hpp"
#include "verified/first_order.hpp"

using namespace isostat;
using namespace crafted;

namespace {

/// A hexagon of seven equal disks, flat between the four walls, with sixteen contacts for sixteen degrees of freedom:
/// its contact 1-6 and the contact of 3 with the top wall touch besides.
State hexagon_in_a_box() {
    const double h = std::numbers::sqrt3;
    return in_box(
        {{1, 3, 1 + h}, {1, 5, 1 + h}, {1, 4, 1 + 2 * h}, {1, 2, 1 + 2 * h}, {1, 1, 1 + h}, {1, 2, 1}, {1, 4, 1}}, 6,
        2 + 2 * h, 1, 1,
        {pair(0, 1), pair(0, 2), pair(0, 3), pair(0, 4), pair(0, 5), pair(0, 6), pair(1, 2), pair(2, 3), pair(3, 4),
         pair(4, 5), pair(5, 6), left(4), right(1), bottom(5), bottom(6), top(2)});
}

struct Vertex : Regular {
    explicit Vertex(const State& s)
        : Regular(s), enclosure(enclose_vertex(state.packing, structure, factorisation, inverse)),
          first(state.packing, structure, factorisation, inverse, enclosure, rho) {}
    VertexEnclosure enclosure;
    std::vector<double> rho = {0.5, -0.25, 0.125, 0.75, -0.5, 0.25, -0.125};
    FirstOrder first;

    [[nodiscard]] Enclosure rate(const Contact& opened, const Contact& touching) const {
        const auto& list = structure.contacts();
        return first.rate(ContactId(static_cast<std::size_t>(std::ranges::find(list, opened) - list.begin())), +1,
                          touching);
    }
};

bool is_zero(const Enclosure& e) {
    return e.value == 0 && e.radius == 0;
}

} // namespace

BOOST_AUTO_TEST_CASE(a_pair_within_a_body_rests_while_a_wall_lets_go_and_moves_when_the_body_opens) {
    const Vertex vertex(hexagon_in_a_box());
    const Contact last = pair(1, 6);
    const auto& contacts = vertex.structure.contacts();
    for (const Contact& opened : contacts) {
        const Enclosure rate = vertex.rate(opened, last);
        if (opened.kind == ContactKind::disk_disk) {
            BOOST_TEST(rate.decided(), to_string(opened)); // every contact of a wheel carries its self-stress
        } else {
            BOOST_TEST(is_zero(rate), to_string(opened));
        }
    }
}

BOOST_AUTO_TEST_CASE(walls_belong_to_the_body_that_rests) {
    const Vertex vertex(hexagon_in_a_box());
    // The hexagon stands on two feet: it and the walls above and below are one body, that slides between the others.
    BOOST_TEST(is_zero(vertex.rate(left(4), top(3))));
    BOOST_TEST(is_zero(vertex.rate(right(1), top(3))));
    BOOST_TEST(vertex.rate(bottom(5), top(3)).decided());
    BOOST_TEST(vertex.rate(top(2), top(3)).decided());
}

BOOST_AUTO_TEST_CASE(the_first_order_gap_of_a_pair_that_rests_is_the_same_wherever_its_body_stands) {
    // Turned by a right angle within the same box (its walls exchanged) the wheel keeps the gap of its last contact.
    const Vertex vertex(hexagon_in_a_box());
    State turned = hexagon_in_a_box();
    auto& q = turned.packing.q;
    for (std::size_t i = 0; i < 7; ++i) {
        std::swap(q[2 * i], q[2 * i + 1]);
    }
    std::swap(q[14], q[15]);
    turned.contacts = {pair(0, 1), pair(0, 2), pair(0, 3), pair(0, 4), pair(0, 5), pair(0, 6), pair(1, 2), pair(2, 3),
                       pair(3, 4), pair(4, 5), pair(5, 6), bottom(4),  top(1),     left(5),    left(6),    right(2)};
    const Vertex other(turned);
    const Enclosure a = vertex.first.gap(pair(1, 6));
    const Enclosure b = other.first.gap(pair(1, 6));
    BOOST_TEST(a.decided());
    BOOST_TEST(!(a - b).decided());
    BOOST_TEST(std::abs(a.value - b.value) < 1e-12);
}
