// Claims against the true vertex to 200 digits and against closed forms; states about which less can be said.
#include "oracle/claims.hpp"
#include "support/crafted.hpp"
#include "support/free_grains.hpp"
#include "support/prepared.hpp"
#include "support/units.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>

using namespace isostat;
using namespace crafted;
using oracle::Real;

namespace {

bool contains(const Interval& interval, const Real& x) {
    return Real(interval.lower) <= x && x <= Real(interval.upper);
}

std::string all(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& s : sentences) {
        text += s + "; ";
    }
    return text;
}

oracle::Truth known_truth(const State& state) {
    oracle::Truth truth(state);
    BOOST_REQUIRE_MESSAGE(truth.known, truth.why);
    return truth;
}

/// The independent checker contradicts no claim, and confirms nearly all; returns how many it leaves open.
int open_for_the_checker(const State& state, const Certification& c) {
    const Certificate certificate{state, "state", sha256(""), "test", c.claims};
    int open = 0;
    for (const ClaimCheck& check : verify(certificate).checks) {
        BOOST_TEST((!check.claimed || check.verdict != Verdict::refuted), check.claim << ": " << check.detail);
        open += check.claimed && check.verdict == Verdict::undecided ? 1 : 0;
    }
    return open;
}

/// Every claim that is made holds for the true vertex; returns whether all were made. `open`: claims that the checker
/// may leave undecided (gaps and forces that are equal for a geometric reason, forces below its resolution).
bool check_claims(const State& state, const Certification& c, int open = 0) {
    BOOST_TEST(open_for_the_checker(state, c) <= open);
    const CertificateClaims& claims = c.claims;
    const std::size_t n = state.contacts.size();
    const int made = (claims.counting ? 1 : 0) + (claims.vertex ? 1 : 0) + (claims.forces ? 1 : 0) +
                     (claims.gaps ? 1 : 0) + (claims.load_interval ? 1 : 0) + (claims.stable ? 1 : 0);
    BOOST_TEST(made + static_cast<int>(claims.undecided.size()) == 6, all(claims.undecided));
    BOOST_TEST((c.verdict == Verdict::proved) == (made == 6));
    BOOST_TEST((c.verdict == Verdict::refuted) == !c.refuted.empty());
    if (!claims.vertex) {
        BOOST_TEST((!claims.forces && !claims.gaps && !claims.load_interval && !claims.stable));
        return false;
    }
    BOOST_REQUIRE((!claims.forces || claims.forces->finite.size() == n));
    const oracle::Truth truth = known_truth(state);
    BOOST_TEST(oracle::objections(claims, state, truth) == std::vector<std::string>{},
               boost::test_tools::per_element());
    BOOST_TEST(claims.vertex->radius <= claims.vertex->unique_radius);
    for (std::size_t l = 0; claims.forces && l < n; ++l) {
        const auto& zeros = claims.forces->structural_zeros;
        const bool zero = std::ranges::find(zeros, static_cast<int>(l)) != zeros.end();
        const Interval& f = claims.forces->finite[l];
        BOOST_TEST((zero ? f == Interval{0, 0} : f.lower > 0), to_string(state.contacts[l]));
    }
    for (std::size_t k = 0; claims.forces && k < claims.forces->structural_zeros.size(); ++k) {
        BOOST_TEST(claims.forces->infinitesimal[k].lower > 0);
    }
    if (claims.gaps && truth.nearest() != nullptr) {
        const Real nearest = truth.nearest()->gap;
        BOOST_TEST(Real(claims.gaps->smallest) >= nearest * Real("0.999"));
        BOOST_TEST(abs(truth.gap(claims.gaps->where) - nearest) <= nearest * Real("1e-6"));
    } else if (claims.gaps) {
        BOOST_TEST(std::isinf(claims.gaps->smallest));
    }
    return made == 6;
}

/// A state with every free coordinate moved by up to `size`.
State shaken(State state, double size, unsigned seed) {
    std::mt19937 random(seed);
    const DofMap dofs(state.packing);
    for (std::size_t k = 0; k < state.packing.q.size(); ++k) {
        if (dofs.dof_of(k) >= 0) {
            state.packing.q[k] += size * (static_cast<double>(random()) * 0x1p-31 - 1);
        }
    }
    return state;
}

/// A free disk of radius 1 held by two fixed ones on its left and right, a little below it (height h), under a force
/// that presses it down.
State between_two(double h) {
    const double side = std::sqrt(1 + h * h) * 2 - 1;
    State state = without_walls::held_by_two({side, side, 1}, {-2, 0, 2, 0, 0, 2 * h});
    state.load.stress = {1, 1};
    state.load.reference_length = {1, 1};
    state.load.disk_force = {0, 0, 0, 0, 0.25, -1};
    if (h < 0.3) {
        state.load.disk_force[4] = 0;
    }
    return state;
}

State sample(const std::string& name) {
    return read_state(std::string(ISOSTAT_TEST_DATA) + "/" + name).state;
}

/// With contact l added to the known forces of two disks: F1 = 1, radii 1 and r.
double two_disks_limit(double r) {
    return (r - 1) / (2 * std::sqrt(r));
}

} // namespace

BOOST_AUTO_TEST_CASE(the_samples_certify) {
    for (const auto& [name, positive, zero] :
         {std::tuple("vertex100.txt", 188, 14), std::tuple("vertex400.txt", 760, 42),
          std::tuple("vertex1936.txt", 3664, 210)}) {
        const State state = sample(name);
        const Certification c = certify(state);
        BOOST_TEST((c.verdict == Verdict::proved), name << ": " << all(c.claims.undecided));
        BOOST_TEST(c.signs.positive == positive);
        BOOST_TEST(c.signs.structural_zero == zero);
        BOOST_TEST((c.claims.counting->rank == state.packing.disk_count() * 2 + 2));
    }
}

BOOST_AUTO_TEST_CASE(closed_forms_of_one_two_and_three_disks_lie_in_the_claimed_intervals) {
    for (const State& state :
         {one_disk(1.5, 0.25), two_disks(1, 1.1, 1, 1.5), two_disks(1, 2, 1, 1), two_disks(1, 5, 2, 3),
          three_disks(1, 1, 1.5, 3, 1), three_disks(1, 1.0625, 1.5, 3, 1), three_disks(1, 1, 0.5, 3, 1)}) {
        const Certification c = certify(state);
        const bool symmetric = state.packing.disk_count() == 3 && state.packing.radius[0] == state.packing.radius[1];
        BOOST_TEST(check_claims(state, c, symmetric ? 3 : 0), all(c.claims.undecided));
    }
    const Real root2 = sqrt(Real(2));
    const CertificateClaims claims = certify(two_disks(1, 2, 1, 1)).claims;
    BOOST_REQUIRE((claims.forces && claims.load_interval && claims.gaps));
    const Real t = 1 / (2 * root2);
    const std::vector<Real> forces{Real(1), t, 3 / (2 * root2), Real(1), Real(1), 1 - t};
    for (std::size_t l = 0; l < forces.size(); ++l) {
        BOOST_TEST(contains(claims.forces->finite[l], forces[l]));
        BOOST_TEST(claims.forces->finite[l].upper - claims.forces->finite[l].lower < 1e-12);
    }
    BOOST_TEST(contains(claims.load_interval->low.stress, t));
    BOOST_TEST((claims.load_interval->low.opens == bottom(1)));
    BOOST_TEST(claims.load_interval->high.unbounded);
    BOOST_TEST((claims.gaps->where == left(1) || claims.gaps->where == top(0)));
    BOOST_TEST(Real(claims.gaps->smallest) <= 2 * root2 - 1);
    // Three disks: both ends, the lower one a class of five forces that vanish with the load.
    const CertificateClaims c = certify(three_disks(1, 1, 1.5, 3, 1)).claims;
    BOOST_REQUIRE(c.load_interval);
    BOOST_TEST(contains(c.load_interval->high.stress, 3 * 2 * sqrt(Real(1.5) * Real(3.5))));
    BOOST_TEST((c.load_interval->high.opens == pair(0, 1)));
    BOOST_TEST(contains(c.load_interval->low.stress, Real(0)));
}

BOOST_AUTO_TEST_CASE(every_interval_contains_the_value_at_the_true_vertex_of_random_packings) {
    int complete = 0, tried = 0;
    for (const int n : {1, 2, 3, 5, 8, 12}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const auto state = prepared_or_none({.disks = n, .seed = seed});
            if (!state) {
                continue;
            }
            for (const double size : {0.0, 1e-13, 1e-10, 1e-7, 1e-5}) {
                const State moved = shaken(*state, size, static_cast<unsigned>(seed));
                BOOST_TEST_INFO_SCOPE("n = " << n << ", seed " << seed << ", moved by " << size);
                const Certification c = certify(moved);
                ++tried;
                complete += check_claims(moved, c) ? 1 : 0;
                BOOST_TEST((c.verdict != Verdict::refuted), all(c.refuted));
            }
        }
    }
    BOOST_TEST(tried >= 100);
    BOOST_TEST(complete >= tried - 2, complete << " of " << tried);
}

BOOST_AUTO_TEST_CASE(intervals_and_a_strict_minimum_hold_under_true_stresses) {
    for (const double size : {0.0, 3e-11, 1e-9, 1e-6}) {
        State state = shaken(two_disks(1, 2, 1, 1.25), size, 5);
        state.load.kind = LoadKind::true_stress;
        const Certification c = certify(state);
        check_claims(state, c);
        // The force is stress times a length that is itself known to a radius only.
        State one = shaken(one_disk(1.5, 0.25), size, 5);
        one.load.kind = LoadKind::true_stress;
        check_claims(one, certify(one));
        BOOST_TEST((c.claims.forces && c.claims.load_interval && c.claims.gaps), all(c.claims.undecided));
        BOOST_TEST(c.claims.stable);
        BOOST_TEST((c.verdict == Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(a_moved_vertex_is_found_again_and_its_distance_is_covered) {
    for (const double size : {1e-12, 1e-9, 1e-6, 1e-4, 1e-3}) {
        for (unsigned seed = 1; seed <= 10; ++seed) {
            const State state = shaken(three_disks(1, 1.0625, 1.5, 3, 1), size, seed);
            const Certification c = certify(state);
            BOOST_TEST(check_claims(state, c), all(c.claims.undecided));
            if (c.claims.vertex) {
                BOOST_TEST(c.claims.vertex->radius < 100 * size + 1e-12);
            }
        }
    }
    // n = 100, every coordinate off by up to 1e-6: the vertex is the same one.
    const State state = sample("vertex100.txt");
    const Certification moved = certify(shaken(state, 1e-6, 3));
    BOOST_TEST((moved.verdict == Verdict::proved), all(moved.claims.undecided));
    BOOST_REQUIRE(moved.claims.vertex);
    BOOST_TEST(moved.claims.vertex->radius > 1e-7);
    const Certification exact = certify(state);
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Interval& a = moved.claims.forces->finite[l];
        const Interval& b = exact.claims.forces->finite[l];
        BOOST_TEST((a.lower <= b.upper && b.lower <= a.upper));
    }
    // Far off there is nothing to prove, and nothing is claimed.
    const Certification far = certify(shaken(state, 0.05, 3));
    BOOST_TEST((far.verdict == Verdict::undecided), all(far.refuted));
    BOOST_TEST((far.claims.counting && !far.claims.vertex && !far.claims.stable));
}

BOOST_AUTO_TEST_CASE(radii_hold_where_a_second_vertex_is_near) {
    // The mirror image of the disk, below the line of the fixed ones, touches them too.
    int proved = 0;
    for (const double h : {0.5, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        for (const double shift : {0.0, 1e-12, 1e-9 * h, 1e-4 * h, 1e-2 * h}) {
            for (const double sign : {-1.0, 1.0}) {
                State state = between_two(h);
                state.packing.q[5] += sign * shift;
                const Certification c = certify(state);
                BOOST_TEST_INFO_SCOPE("h = " << h << ", moved by " << sign * shift);
                check_claims(state, c);
                if (c.claims.vertex) {
                    ++proved;
                    const oracle::Truth truth = known_truth(state);
                    BOOST_TEST(Real(c.claims.vertex->unique_radius) < truth.q[5] + Real(state.packing.q[5]));
                    BOOST_TEST(Real(c.claims.vertex->radius) <= 3 * truth.moved + Real(1e-13 / h));
                }
            }
        }
    }
    BOOST_TEST(proved >= 50, proved);
}

BOOST_AUTO_TEST_CASE(a_force_near_zero_is_decided_by_a_higher_rung_or_not_at_all) {
    // The contact of disk 1 with the bottom carries F2 - t F1: here 0 to the last digit of a double, but t is
    // irrational.
    State state = two_disks(1, 2, 1, two_disks_limit(2));
    const Certification low = certify(state, {.highest = Rung::double_bound});
    BOOST_TEST((low.verdict == Verdict::undecided), all(low.claims.undecided));
    BOOST_TEST((low.claims.vertex && !low.claims.forces && !low.claims.stable));
    const Certification high = certify(state);
    const oracle::Truth truth = known_truth(state);
    const Real force = truth.force[5];
    BOOST_TEST(abs(force) < Real("1e-15"));
    BOOST_TEST((high.verdict == (force > 0 ? Verdict::proved : Verdict::refuted)), all(high.claims.undecided));
    check_claims(state, high);
    for (const double next : {0.0, 1.0}) { // the doubles beside it: one on each side of the true limit
        State beside = state;
        beside.load.stress[1] = std::nextafter(state.load.stress[1], next);
        const Real f = known_truth(beside).force[5];
        const Certification c = certify(beside);
        BOOST_TEST((c.verdict == (f > 0 ? Verdict::proved : Verdict::refuted)));
        BOOST_TEST(c.signs.negative == (f > 0 ? 0 : 1));
        check_claims(beside, c);
    }
    // 1e-25 beside 1 needs the corrected vertex, 1e-60 needs MPFR, an exact 0 is never claimed.
    for (const auto& [size, rung] : {std::pair(1e-25, Rung::double_double), std::pair(1e-60, Rung::multiprecision)}) {
        const State small = one_disk(1, size);
        const Certification c = certify(small);
        BOOST_TEST(check_claims(small, c, size < 1e-30 ? 3 : 0), all(c.claims.undecided));
        BOOST_REQUIRE(c.claims.forces);
        BOOST_TEST((c.claims.forces->rung == rung));
        State pulled = small;
        pulled.load.stress[1] = -size;
        BOOST_TEST((certify(pulled).verdict == Verdict::refuted));
    }
    const Certification zero = certify(one_disk(1, 0));
    BOOST_TEST((zero.verdict == Verdict::undecided));
    BOOST_TEST((!zero.claims.forces && !zero.claims.stable && zero.claims.vertex));
}

BOOST_AUTO_TEST_CASE(negative_forces_refute_and_so_does_a_rattler_pulled_off_its_contacts) {
    State state = two_disks(1, 2, 1, 0.3); // below the limit 0.354
    const Certification c = certify(state);
    BOOST_TEST((c.verdict == Verdict::refuted));
    BOOST_TEST(c.signs.negative == 1);
    BOOST_TEST((c.claims.vertex && c.claims.gaps && !c.claims.forces && !c.claims.load_interval && !c.claims.stable));
    check_claims(state, c);
    State rattling = sample("vertex100.txt");
    const Certification before = certify(rattling);
    BOOST_REQUIRE((before.claims.forces && !before.claims.forces->structural_zeros.empty()));
    const auto zero = static_cast<std::size_t>(before.claims.forces->structural_zeros.front());
    const auto rattler = static_cast<std::size_t>(rattling.contacts[zero].i);
    std::ranges::transform(rattling.load.infinitesimal, rattling.load.infinitesimal.begin(), std::negate());
    const Certification after = certify(rattling);
    BOOST_TEST((after.verdict == Verdict::refuted), "the rattler " << rattler << " and all others are pulled up");
    BOOST_TEST(!after.claims.forces);
    rattling.load.infinitesimal.clear(); // no infinitesimal load: exact zeros are not positive
    const Certification without = certify(rattling);
    BOOST_TEST((without.verdict == Verdict::undecided));
    BOOST_TEST(!without.claims.forces);
}

BOOST_AUTO_TEST_CASE(overlaps_at_the_true_vertex_refute) {
    const State state = two_disks(1, 7, 1, 5); // disk 1 is larger than (3 + 2 sqrt 2) R0: it cuts the left wall
    const Certification c = certify(state);
    BOOST_TEST((c.verdict == Verdict::refuted));
    BOOST_TEST((!c.claims.gaps && !c.claims.stable && c.claims.vertex));
    BOOST_TEST(all(c.refuted).find("1-left") != std::string::npos, all(c.refuted));
    // Open by less than the position is known to in double, tangent, overlapping by as little.
    const double critical = 3 + 2 * std::sqrt(2.0);
    for (const double off : {-1e-14, 0.0, 1e-14}) {
        const State near = two_disks(1, critical + off, 1, 5);
        const Certification n = certify(near);
        const Real h = known_truth(near).gap(left(1));
        BOOST_TEST((n.verdict == (h > 0 ? Verdict::proved : Verdict::refuted)), all(n.claims.undecided));
        check_claims(near, n);
    }
}

BOOST_AUTO_TEST_CASE(claims_scale_with_the_units_and_end_where_doubles_do) {
    const State state = three_disks(1, 1.0625, 1.5, 3, 1);
    const CertificateClaims claims = certify(state).claims;
    BOOST_REQUIRE(claims.forces);
    for (const auto& [length, stress] :
         {std::pair(200, -200), std::pair(-200, 300), std::pair(320, -320), std::pair(-330, 330)}) {
        State scaled = state;
        units::stretch(scaled.packing, std::ldexp(1.0, length));
        for (double& s : scaled.load.stress) {
            s = std::ldexp(s, stress); // reference lengths stay 1: forces scale with the stress
        }
        const Certification c = certify(scaled);
        BOOST_TEST((c.verdict == Verdict::proved), all(c.claims.undecided));
        BOOST_TEST(c.claims.vertex->radius == std::ldexp(claims.vertex->radius, length));
        BOOST_TEST(c.claims.gaps->smallest == std::ldexp(claims.gaps->smallest, length));
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            BOOST_TEST(c.claims.forces->finite[l].lower == std::ldexp(claims.forces->finite[l].lower, stress));
        }
        check_claims(scaled, c);
    }
    // Squares of these lengths are 0 or infinite in doubles: nothing may be concluded from them.
    for (const int length : {-560, -400, 400, 560}) {
        State scaled = state;
        units::stretch(scaled.packing, std::ldexp(1.0, length));
        const Certification c = certify(scaled);
        BOOST_TEST((c.verdict == Verdict::undecided));
        BOOST_TEST((!c.claims.counting && !c.claims.vertex && !c.claims.stable));
    }
    State faint = state;
    faint.load.stress = {3e-310, 1e-310};
    BOOST_TEST((certify(faint).verdict == Verdict::undecided));
}

BOOST_AUTO_TEST_CASE(a_rattler_a_million_times_smaller_is_decided_by_the_infinitesimal_loads) {
    State state = two_disks(1, 2, 1, 1);
    const double r = 1e-6;
    state.packing.radius.push_back(r);
    state.packing.q.insert(state.packing.q.begin() + 4, {r, r}); // in the corner, below disk 0
    state.contacts.push_back(left(2));
    state.contacts.push_back(bottom(2));
    for (const double direction : {-1.0, 1.0}) {
        state.load.infinitesimal = {-1, -1, -1, -1, direction * r * r, -r * r};
        const Certification c = certify(state);
        BOOST_TEST((c.verdict == (direction < 0 ? Verdict::proved : Verdict::refuted)), all(c.claims.undecided));
        BOOST_TEST(c.signs.structural_zero == 2);
        check_claims(state, c);
    }
}

BOOST_AUTO_TEST_CASE(an_exact_tie_of_two_contacts_leaves_the_end_of_the_interval_open) {
    // Both base disks are lifted: their contacts with the bottom open at twice the lift.
    for (const double lift : {0.375, 0.3, 0.2, 0.17, 0.1, 0.05}) {
        State state = three_disks(1, 1, 1.5, 3, 1);
        state.load.disk_force = {0, lift, 0, lift, 0, 0};
        const Certification tie = certify(state);
        check_claims(state, tie, 2);
        BOOST_TEST((tie.claims.forces && tie.claims.stable && !tie.claims.load_interval));
        BOOST_TEST((tie.verdict == Verdict::undecided));
        BOOST_TEST(all(tie.claims.undecided).find("not ordered") != std::string::npos, all(tie.claims.undecided));
        for (const double less : {1e-3, 1e-15}) {
            state.load.disk_force[3] = lift * (1 - less);
            const Certification ordered = certify(state);
            check_claims(state, ordered, 2);
            BOOST_TEST((ordered.verdict == Verdict::proved), all(ordered.claims.undecided));
            if (ordered.claims.load_interval) {
                BOOST_TEST((ordered.claims.load_interval->low.opens == bottom(0)));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(no_vertex_is_claimed_where_there_is_none_or_a_double_one) {
    // Two disks that a third between them can just reach at once (a double root: its mechanism is at rest), or cannot.
    for (const double missing : {0.0, 1e-12, 1e-6, 1e-3}) {
        for (double y = 1e-1; y > 1e-12; y /= 10) {
            State state = between_two(0.5);
            state.packing.radius = {1 - missing, 1, 1};
            state.packing.q[5] = y;
            const Certification c = certify(state);
            BOOST_TEST((!c.claims.vertex && !c.claims.forces && !c.claims.stable),
                       "missing " << missing << ", y = " << y);
            BOOST_TEST((c.verdict != Verdict::proved));
        }
    }
}

BOOST_AUTO_TEST_CASE(structures_that_are_not_isostatic_get_their_exact_counts_and_nothing_else) {
    const auto only_counting = [](const State& state, int rank, int h, int k) {
        const Certification c = certify(state);
        BOOST_TEST((c.verdict == Verdict::refuted), all(c.claims.undecided));
        BOOST_REQUIRE(c.claims.counting);
        BOOST_TEST(c.claims.counting->rank == rank);
        BOOST_TEST(c.claims.counting->hyperstaticity == h);
        BOOST_TEST(c.claims.counting->hypostaticity == k);
        BOOST_TEST((!c.claims.vertex && !c.claims.forces && !c.claims.gaps && !c.claims.load_interval));
        BOOST_TEST(!c.claims.stable);
        BOOST_TEST(c.claims.undecided.size() == 5U);
    };
    only_counting(square_lattice(3), 20, 4, 0);
    only_counting(triangular_patch(2, 3), 14, 3, 0);
    State fewer = two_disks(1, 2, 1, 1);
    fewer.contacts.pop_back();
    only_counting(fewer, 5, 0, 1);
    // A disk exactly between two fixed ones: N = N_f, singular, h = k = 1; the kernel is checked in rationals.
    State strut = between_two(0.5);
    strut.packing.radius = {1, 1, 1};
    strut.packing.q[5] = 0;
    only_counting(strut, 1, 1, 1);
    State lattice = square_lattice(3); // h and k: only the kernel can tell
    std::erase_if(lattice.contacts, [](const Contact& c) { return c.i == 4 || c.j == 4; });
    const Certification c = certify(lattice);
    BOOST_REQUIRE(c.claims.counting);
    BOOST_TEST(c.claims.counting->hyperstaticity > 0);
    BOOST_TEST(c.claims.counting->hypostaticity == 2);
}

BOOST_AUTO_TEST_CASE(a_state_that_holds_a_coordinate_claims_nothing) {
    State state = two_disks(1, 2, 1, 1);
    state.contacts.back() = {ContactKind::held, 3, 0}; // y of disk 1 in place of its contact with the bottom
    const Certification c = certify(state);
    BOOST_TEST((c.verdict == Verdict::undecided));
    BOOST_TEST((!c.claims.counting && !c.claims.vertex && !c.claims.forces && !c.claims.gaps));
    BOOST_TEST((!c.claims.load_interval && !c.claims.stable));
    BOOST_TEST(c.claims.undecided.size() == 6U);
}

BOOST_AUTO_TEST_CASE(claims_hold_for_many_small_packings, *boost::unit_test::label("slow")) {
    int complete = 0, tried = 0;
    for (const int n : {2, 3, 4, 6}) {
        for (std::uint64_t seed = 100; seed < 140; ++seed) {
            const auto state = prepared_or_none({.disks = n, .seed = seed});
            if (!state) {
                continue;
            }
            for (const double size : {0.0, 5e-11, 1e-6}) {
                State moved = shaken(*state, size, static_cast<unsigned>(seed));
                moved.load.stress[1] *= 1 + 0.1 * static_cast<double>(seed % 7); // past the end of some intervals
                BOOST_TEST_INFO_SCOPE("n = " << n << ", seed " << seed << ", moved by " << size);
                const Certification c = certify(moved);
                ++tried;
                complete += check_claims(moved, c) ? 1 : 0;
                const oracle::Truth truth = known_truth(moved);
                const bool negative =
                    std::ranges::any_of(truth.force, [](const Real& f) { return f < -Real("1e-60"); });
                BOOST_TEST(((c.verdict == Verdict::refuted) == negative), all(c.claims.undecided));
            }
        }
    }
    BOOST_TEST(complete > tried / 2, complete << " of " << tried);
    BOOST_TEST(complete < tried);
}

BOOST_AUTO_TEST_CASE(every_equilibrium_of_a_biaxial_run_at_n_100_certifies, *boost::unit_test::label("slow")) {
    Played run = completed(play(sample("vertex100.txt"), +1, 20));
    const Played back = completed(play(run.state, -1, {}, 1.0));
    std::vector<State> states = run.records.states;
    states.insert(states.end(), back.records.states.begin(), back.records.states.end());
    std::vector<EquilibriumRecord> records = run.records.equilibria;
    records.insert(records.end(), back.records.equilibria.begin(), back.records.equilibria.end());
    BOOST_TEST(states.size() > 25U);
    for (std::size_t k = 0; k < states.size(); ++k) {
        const Certification c = certify(states[k]);
        BOOST_TEST((c.verdict == Verdict::proved), k << ": " << all(c.claims.undecided));
        if (c.claims.load_interval) { // the run decided the same contacts
            BOOST_TEST((c.claims.load_interval->low.opens == records[k].opens_low));
            BOOST_TEST((c.claims.load_interval->high.opens == records[k].opens_high));
            BOOST_TEST(c.claims.load_interval->high.stress.lower <= records[k].stress_high * (1 + 1e-6));
            BOOST_TEST(c.claims.load_interval->high.stress.upper >= records[k].stress_high * (1 - 1e-6));
        }
    }
}
