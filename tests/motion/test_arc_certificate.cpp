// Certificates of arcs with known answers: a free disk rolls over a fixed one past obstacles.
#include "motion/certify_arc.hpp"
#include "motion/moving_part.hpp"
#include "motion/rolling.hpp"
#include "support/channel_roll.hpp"

using namespace isostat;
using namespace crafted;

namespace {

/// A vertex with all that a certificate needs of it.
struct Known {
    Packing packing;
    IsostaticStructure structure;
    Factorisation factorisation;
    InverseBound inverse;
    VertexEnclosure enclosure;

    Known(Packing p, IsostaticStructure s) : packing(std::move(p)), structure(std::move(s)), factorisation(structure) {
        InverseBoundCache cache;
        inverse = bound_inverse(structure, factorisation, cache);
        enclosure = enclose_vertex(packing, structure, inverse);
    }
    static Known of(Packing packing, const std::vector<Contact>& contacts) {
        snap_to_grid(packing);
        auto proved = required(IsostaticStructure::prove(packing, contacts));
        return {std::move(packing), std::move(proved)};
    }
    [[nodiscard]] ArcVertex vertex() const { return {packing, structure, factorisation, inverse, enclosure}; }
};

/// Without what an arc before has left.
ArcCertificate certify_alone(const ArcVertex& start, ContactId opened, int direction, const ArcVertex& end,
                             const PowerLoad& power, const CandidateList& candidates) {
    InverseBoundCache cache;
    return certify_arc(start, opened, direction, end, power, candidates, cache);
}

constexpr double stop_angle = 2;

/// Disk 3 stops it; disk 4, if any, is an obstacle.
struct CertifiedRolling : RollingDisk {
    explicit CertifiedRolling(double fx = -1, double fy = 0.1) {
        stop(stop_angle);
        push(fx, fy);
    }
    [[nodiscard]] Known start() { return at(start_angle, pair(1, 2)); }
    [[nodiscard]] Known stopped() { return at(stop_angle, pair(2, 3)); }
    [[nodiscard]] Known at(double angle, const Contact& second) {
        put(angle);
        return Known::of(packing, {pair(0, 2), second});
    }
    /// Whatever a path follower may have said: from the start straight to `end`.
    [[nodiscard]] ArcCertificate certify(const Known& from, const Known& end) const {
        const CandidateList candidates = find_candidates(from.packing, candidate_fraction);
        return certify_alone(from.vertex(), ContactId(1), +1, end.vertex(), PowerLoad{&load, false, false}, candidates);
    }
    ArcCertificate certify() { return certify(start(), stopped()); }
};

bool proved(const ArcCertificate& certificate) {
    return certificate.verdict == Verdict::proved;
}

} // namespace

BOOST_AUTO_TEST_CASE(an_arc_between_two_known_contacts_is_certified) {
    CertifiedRolling rolling;
    const ArcCertificate certificate = rolling.certify();
    BOOST_TEST(proved(certificate), certificate.reason);
    BOOST_TEST((certificate.power == Verdict::proved), certificate.power_reason);
    BOOST_TEST(certificate.pieces > 3);
    BOOST_TEST(certificate.moving == 2);
    BOOST_TEST(certificate.tube < 1e-12);
    BOOST_TEST(certificate.tube_margin > 1e6);
    BOOST_TEST(certificate.gap_margin > 1);
}

BOOST_AUTO_TEST_CASE(a_contact_that_was_missed_inside_an_arc_is_not_certified) {
    // The end of the arc is the same, and admissible, on both sides: only the way there tells.
    for (const double clearance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
        for (const double sign : {+1.0, -1.0}) {
            CertifiedRolling rolling;
            rolling.obstacle(1.0, 0.25, sign * clearance);
            const ArcCertificate certificate = rolling.certify();
            BOOST_TEST(proved(certificate) == (sign > 0), "clearance " << sign * clearance << certificate.reason);
            if (sign < 0) {
                BOOST_TEST(certificate.reason.find("2-4") != std::string::npos, certificate.reason);
            }
        }
    }
    CertifiedRolling grazing;
    grazing.obstacle(1.0, 0.25, 0);
    BOOST_TEST(!proved(grazing.certify()));
}

BOOST_AUTO_TEST_CASE(an_end_behind_the_first_contact_is_not_certified) {
    CertifiedRolling rolling; // past disk 3, to a contact with disk 4 that it would have met later
    const double later = 3.8;
    rolling.stop(later);
    const Known start = rolling.start();
    BOOST_TEST(proved(rolling.certify(start, rolling.stopped())));
    const ArcCertificate certificate = rolling.certify(start, rolling.at(later, pair(2, 4)));
    BOOST_TEST(!proved(certificate));
    BOOST_TEST(certificate.reason.find("2-3") != std::string::npos, certificate.reason);
}

BOOST_AUTO_TEST_CASE(an_end_on_another_curve_is_not_certified) {
    CertifiedRolling rolling;
    const Known start = rolling.start();
    CertifiedRolling inner; // the same contacts, but the fixed disk is a little smaller
    inner.packing.radius[0] = 1 - 1e-7;
    const double d = 2 - 1e-7;
    inner.packing.q[4] = d * std::cos(stop_angle);
    inner.packing.q[5] = d * std::sin(stop_angle);
    inner.packing.q[6] = inner.packing.q[4] - 2 * std::sin(stop_angle);
    inner.packing.q[7] = inner.packing.q[5] + 2 * std::cos(stop_angle);
    BOOST_TEST(!proved(rolling.certify(start, Known::of(inner.packing, {pair(0, 2), pair(2, 3)}))));
}

BOOST_AUTO_TEST_CASE(ends_that_are_not_proved_vertices_certify_nothing) {
    CertifiedRolling rolling;
    const Known start = rolling.start();
    Known end = rolling.stopped();
    BOOST_TEST(proved(rolling.certify(start, end)));
    end.enclosure.verdict = Verdict::undecided;
    BOOST_TEST(!proved(rolling.certify(start, end)));
    end.enclosure.verdict = Verdict::proved;
    end.enclosure.radius = 0.1; // a vertex, but nobody knows where
    BOOST_TEST(!proved(rolling.certify(start, end)));
}

BOOST_AUTO_TEST_CASE(the_power_is_judged_apart_from_the_contacts) {
    CertifiedRolling pushed;
    BOOST_TEST((pushed.certify().power == Verdict::proved));
    CertifiedRolling pulled(+1, 0.1); // the load works against the motion
    const ArcCertificate against = pulled.certify();
    BOOST_TEST(proved(against), against.reason);
    BOOST_TEST((against.power == Verdict::undecided));
    CertifiedRolling over(0, 1); // power cos(angle): turns at pi / 2, before the stop
    BOOST_TEST((over.certify().power == Verdict::undecided));
    CertifiedRolling before(0, 1);
    const Known start = before.start();
    const Known turn = before.at(std::numbers::pi / 2, Contact{ContactKind::held, 4, 0});
    const ArcCertificate certificate = before.certify(start, turn);
    BOOST_TEST(proved(certificate), certificate.reason);
    BOOST_TEST((certificate.power == Verdict::proved), certificate.power_reason);
    BOOST_TEST(certificate.power_open_end > 0);
    BOOST_TEST(certificate.power_open_end < 1e-6);
    const Known beyond = before.at(std::numbers::pi / 2 + 2e-2, Contact{ContactKind::held, 4, 0});
    BOOST_TEST((before.certify(start, beyond).power == Verdict::undecided));
}

BOOST_AUTO_TEST_CASE(a_released_coordinate_is_followed_to_the_side_to_which_it_goes) {
    CertifiedRolling rolling;
    const Known turn = rolling.at(1.2, Contact{ContactKind::held, 4, 0});
    const Known stop = rolling.stopped();
    const CandidateList candidates = find_candidates(turn.packing, candidate_fraction);
    const PowerLoad power{&rolling.load, false, false};
    const auto down = certify_alone(turn.vertex(), ContactId(1), -1, stop.vertex(), power, candidates);
    BOOST_TEST(proved(down), down.reason); // x falls on the way to the stop
    const auto up = certify_alone(turn.vertex(), ContactId(1), +1, stop.vertex(), power, candidates);
    BOOST_TEST(!proved(up)); // to disk 1 first
    const Known back = rolling.start();
    const auto returned = certify_alone(turn.vertex(), ContactId(1), +1, back.vertex(), power, candidates);
    BOOST_TEST(proved(returned), returned.reason);
}

BOOST_AUTO_TEST_CASE(a_coordinate_released_next_to_the_stop_goes_the_other_way) {
    // The tube about the stop reaches back beyond the start: that the curve is in it does not mean that it goes there.
    // Near the top y hardly says where the disk is, so that the tube about the start is shorter than that about the
    // stop.
    constexpr double top = 1.7;
    for (const double before : {1e-3, 1e-2}) {
        CertifiedRolling rolling;
        rolling.packing.q[6] = 2 * std::cos(top) - 2 * std::sin(top);
        rolling.packing.q[7] = 2 * std::sin(top) + 2 * std::cos(top);
        const Known stop = rolling.at(top, pair(2, 3));
        const Known turn = rolling.at(top - before, Contact{ContactKind::held, 5, 0});
        const CandidateList candidates = find_candidates(turn.packing, candidate_fraction);
        const PowerLoad power{&rolling.load, false, false};
        const auto down = certify_alone(turn.vertex(), ContactId(1), -1, stop.vertex(), power, candidates);
        BOOST_TEST(proved(down), down.reason);
        const auto up = certify_alone(turn.vertex(), ContactId(1), +1, stop.vertex(), power, candidates);
        BOOST_TEST(!proved(up), "released " << before << " before the stop");
    }
}

BOOST_AUTO_TEST_CASE(an_end_that_may_lie_behind_the_start_is_not_certified) {
    // Both places are known to 1e-6 only; the coordinate released falls, and the end is 1e-7 before or 1e-4 after it.
    for (const double ahead : {-1e-7, 1e-4}) {
        CertifiedRolling rolling;
        Known turn = rolling.at(1.2, Contact{ContactKind::held, 4, 0});
        Known end = rolling.at(1.2 + ahead, Contact{ContactKind::held, 5, 0});
        turn.enclosure.radius = end.enclosure.radius = 1e-6;
        const CandidateList candidates = find_candidates(turn.packing, candidate_fraction);
        const PowerLoad power{&rolling.load, false, false};
        const auto down = certify_alone(turn.vertex(), ContactId(1), -1, end.vertex(), power, candidates);
        BOOST_TEST(proved(down) == (ahead > 0), down.reason);
    }
}

BOOST_AUTO_TEST_CASE(a_list_of_candidates_serves_half_of_its_reach) {
    CertifiedRolling rolling;
    const Known start = rolling.start();
    const Known stop = rolling.stopped();
    const ArcVertex from = start.vertex();
    const ArcVertex to = stop.vertex();
    const MovingPart part(from, to, 1, 1e-15, 1e-15);
    InverseBoundCache cache;
    const auto centre = part.at_start(cache);
    BOOST_TEST_REQUIRE((centre != nullptr));
    CurvePiece piece(part.curve(), *centre, 1);
    constexpr double h = 1e-6;
    BOOST_TEST_REQUIRE(piece.prove(h));
    for (const double share : {0.0, 0.25, 0.49, 0.5001, 0.6, 1.0, 1.9}) { // of the reach, that the disk has moved since
        CandidateList list = find_candidates(start.packing, candidate_fraction);
        list.reference[4] += 0.6 * share * list.reach;
        list.reference[5] += 0.8 * share * list.reach;
        BOOST_TEST(part.complete(piece, h, list) == (share < 0.5), share);
    }
}

BOOST_AUTO_TEST_CASE(the_opened_contact_may_close_again_after_a_whole_turn) {
    CertifiedRolling rolling;
    rolling.packing.q[6] = 40; // no stop
    const double line = start_angle - std::numbers::pi / 4;
    const double back = line - std::numbers::pi / 4 + 2 * std::numbers::pi; // on the other side of disk 1
    const Known start = rolling.start();
    const ArcCertificate certificate = rolling.certify(start, rolling.at(back, pair(1, 2)));
    BOOST_TEST(proved(certificate), certificate.reason);
    BOOST_TEST(certificate.pieces > 20);
}

BOOST_AUTO_TEST_CASE(an_arc_in_a_channel_is_certified_unless_a_pair_of_images_meets_on_the_way) {
    const auto certify = [](const cells::ChannelRoll& roll) {
        const State from = roll.start();
        const State to = roll.end();
        const Known start = Known::of(from.packing, from.contacts);
        const Known end = Known::of(to.packing, to.contacts);
        return certify_alone(start.vertex(), ContactId(roll.slot), +1, end.vertex(),
                             PowerLoad{&from.load, false, false}, find_candidates(start.packing, candidate_fraction));
    };
    for (const int shift : {0, 1, -2}) {
        for (const double clearance : {1e-2, 1e-5, 1e-8, 1e-10}) {
            BOOST_TEST_INFO_SCOPE("disk 1 stored " << shift << " periods away, clearance " << clearance);
            const ArcCertificate passes = certify({clearance, shift});
            BOOST_TEST(proved(passes), passes.reason);
            BOOST_TEST((passes.power == Verdict::proved), passes.power_reason);
            BOOST_TEST(passes.witness.whole);
            BOOST_TEST(passes.tube < 1e-11);
            const cells::ChannelRoll roll{-clearance, shift};
            const ArcCertificate meets = certify(roll);
            BOOST_TEST(!proved(meets));
            BOOST_TEST(meets.reason.find("the gap of " + to_string(roll.passing())) == 0U, meets.reason);
        }
    }
}
