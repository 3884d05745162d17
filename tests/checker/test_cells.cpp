// Certificates of periodic cells: the checker against approximations of its own, against the program that proves, and
// against forgers.
#include "checker/claims.hpp"
#include "checker/forces.hpp"
#include "checker/maker.hpp"
#include "checker/replay.hpp"
#include "checker/small_states.hpp"
#include "checker/strut.hpp"
#include "checker/vertex.hpp"
#include "oracle/pairs.hpp"
#include "support/cells.hpp"
#include "support/scale.hpp"

using namespace claims;

namespace {

/// Two disks of a centred rectangle under a shear, with an own image. Inversion makes the forces equal in pairs: the
/// ends of the interval are ties that no counting explains.
State sheared_rectangle() {
    State state = cells::two_disks(true, 5, 2);
    state.contacts.push_back(cells::across(0, 0, 1, 0));
    state.load.shear = {0.3};
    return state;
}

} // namespace

BOOST_AUTO_TEST_CASE(ties_by_inversion_are_claimed_by_nobody) {
    const State state = sheared_rectangle();
    Certificate made = maker::certificate(state);
    BOOST_TEST((answer_to(verify(made), "load_interval").verdict == Verdict::undecided));
    const Certification result = certify(state);
    BOOST_TEST((result.verdict == Verdict::undecided));
    BOOST_TEST(!result.claims.load_interval.has_value());
    made.claims = result.claims;
    for (const ClaimCheck& check : verify(made).checks) {
        BOOST_TEST((check.verdict == (check.claim == "load_interval" ? Verdict::undecided : Verdict::proved)),
                   check.claim << ": " << check.detail);
    }
}

BOOST_AUTO_TEST_CASE(what_is_certified_in_a_cell_verifies) {
    std::vector<State> states = cells::small();
    for (const char* name : {"rect_16", "tilt_16", "channel_16"}) {
        states.push_back(cells::of_file(name));
        are_proved(verify(maker::certificate(states.back())));
    }
    for (const State& state : states) {
        const std::string text = certificate_text(certified(state));
        const Certificate read = parse_certificate(text, "text");
        BOOST_TEST(certificate_text(read) == text);
        BOOST_TEST(state_difference(read.state, state).empty());
        are_proved(verify(read));
    }
}

BOOST_AUTO_TEST_CASE(claims_do_not_depend_on_pin_or_representatives) {
    for (const char* name : {"rect_16", "tilt_16", "channel_16"}) {
        const State state = cells::of_file(name);
        State other = state;
        other.packing.cell.pin = 5;
        std::vector<Image> shift(state.packing.radius.size());
        shift[3] = cells::image(1, 0);
        shift[6] = cells::image(-1, 0);
        other = cells::with_other_representatives(other, shift);
        Certificate certificate = certified(other);
        const Certificate original = certified(state);
        are_proved(verify(certificate));
        certificate.claims.forces = original.claims.forces;
        certificate.claims.load_interval = original.claims.load_interval;
        for (const std::size_t end : {0U, 1U}) { // the same contact by its new name
            LoadEndClaim& claim =
                end == 0 ? certificate.claims.load_interval->low : certificate.claims.load_interval->high;
            const auto at = std::ranges::find(state.contacts, claim.opens) - state.contacts.begin();
            claim.opens = other.contacts[static_cast<std::size_t>(at)];
        }
        are_proved(verify(certificate));
    }
}

BOOST_AUTO_TEST_CASE(another_pin_or_shear_is_another_state) {
    const State state = cells::of_file("tilt_16");
    State other = state;
    other.packing.cell.pin = 5;
    BOOST_TEST(state_difference(state, other) == "the cell");
    other = state;
    other.load.shear[0] = 1e-3;
    BOOST_TEST(state_difference(state, other) == "a shear stress");
}

BOOST_AUTO_TEST_CASE(an_overlap_with_an_image_is_refuted) {
    const auto verdict = [](double radius) { // beside it there is room up to sqrt 2 - 1
        return answer_to(verify(maker::certificate(cells::with_a_rattler(radius))), "gaps").verdict;
    };
    BOOST_TEST((verdict(0.41) == Verdict::proved));
    BOOST_TEST((verdict(0.42) == Verdict::refuted));
}

// An own image that cannot move is no pair for the smallest gap, but must not overlap.
BOOST_AUTO_TEST_CASE(own_images_at_rest_must_not_overlap) {
    const auto gaps_of = [](double period) {
        State state = cells::in_cell({{1, 0, 0}}, {2, period, 0}, false, 1, 1, {cells::across(0, 0, 1, 0)});
        state.packing.cell.period_moves = {true, false};
        return answer_to(verify(maker::certificate(state)), "gaps");
    };
    BOOST_TEST((gaps_of(2).verdict == Verdict::proved)); // they touch
    const ClaimCheck overlap = gaps_of(2 - 0x1p-40);
    BOOST_TEST((overlap.verdict == Verdict::refuted));
    BOOST_TEST(overlap.detail == "0-0(0,1) overlap, and cannot move");
}

BOOST_AUTO_TEST_CASE(cells_with_too_many_images_are_left_undecided) {
    State state = cells::one_tilted_disk(2, 1, 0.25);
    Certificate certificate = certified(state);
    certificate.state.packing.q.back() += 60 * certificate.state.packing.lattice(0, 0); // another basis of the lattice
    for (Contact& c : certificate.state.contacts) {
        c.image.m[0] = static_cast<std::int8_t>(c.image.m[0] - 60 * c.image.m[1]);
        c = pair_of(c.i, c.j, c.image);
    }
    const ClaimCheck check = answer_to(verify(certificate), "gaps");
    BOOST_TEST((check.verdict == Verdict::undecided));
    BOOST_TEST(check.detail.find("too sheared") != std::string::npos, check.detail);
}

// Brute force over all pairs and images, for configurations that need not be anything.
BOOST_AUTO_TEST_CASE(the_sweep_finds_the_smallest_gap_among_images) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> from(-1, 2);
    for (int sample = 0; sample < testing::scaled(200); ++sample) {
        const int n = 1 + static_cast<int>(random() % 5);
        std::vector<cells::DiskAt> disks;
        const double lx = 1 + from(random) + 0.5;
        const double ly = 1.2 + from(random) / 2;
        for (int i = 0; i < n; ++i) {
            disks.push_back({0.05 + 0.1 * (1 + from(random)), lx * from(random), ly * from(random)});
        }
        State state = cells::in_cell(disks, {lx, ly, from(random)}, sample % 3 == 0, 1, 1, {});
        if (sample % 4 == 3) {
            state.packing.cell = {{sample % 8 == 3, sample % 8 != 3}, {false, false}, {false}, 0};
            state.packing.cell.period_moves = state.packing.cell.periodic;
            state.packing.q.back() = 0;
            const std::size_t walled = sample % 8 == 3 ? 1 : 0;
            state.packing.walls.lower[walled] = WallKind::fixed;
            state.packing.walls.upper[walled] = WallKind::movable;
        }
        const std::vector<Contact> pairs = oracle::all_pairs(state.packing, 12);
        state.contacts = {pairs[random() % pairs.size()]};
        small_states::lists_the_smallest_gap(state, pairs);
    }
}

// The vertex may be anywhere in its enclosure, the cell too, so the ranges of the forces hold those of every point of
// it; of three disks not a hundred times more.
BOOST_AUTO_TEST_CASE(forces_hold_at_every_point_of_the_enclosure) {
    const std::vector<std::pair<State, int>> all{{crafted::three_disks(1, 1.1, 1.3, 1, 1.5), -12},
                                                 {cells::one_tilted_disk(2, 1, 0.25), -20},
                                                 {sheared_rectangle(), -20},
                                                 {cells::of_file("tilt_16"), -20}};
    for (const auto& [state, exponent] : all) {
        const checker::Problem problem(state);
        const checker::Solver solver(problem);
        const checker::InverseBound inverse = checker::bound_inverse(problem, solver, CheckerArithmetic::fixed64);
        checker::TrueVertex vertex = checker::find_vertex(problem, solver, inverse);
        BOOST_REQUIRE(vertex.found);
        const checker::Rational radius = checker::power_of_two(exponent);
        vertex.moved_most += radius;
        vertex.column_residual = inverse.residual_column + inverse.column_sum_max *
                                                               checker::Rational(problem.column_curvature()) *
                                                               vertex.moved_most;
        const auto forces_at = [&, &of = state](const checker::TrueVertex& at) {
            return checker::contact_forces(problem, solver, inverse, at, checker::finite_load(problem, of, at));
        };
        vertex.radius = radius;
        const std::vector<checker::Range> enclosed = forces_at(vertex);
        checker::Rational farthest = 0; // of the way to an end
        std::mt19937_64 random(1);
        const bool in_box = !state.packing.cell.any();
        for (int sample = 0; sample < testing::scaled(in_box ? 200 : 50); ++sample) {
            checker::TrueVertex point = vertex;
            point.radius = 0;
            std::vector<checker::Integer> middle = point.middle;
            for (const int k : problem.coordinate_of) {
                const int sign = random() % 2 == 0 ? 1 : -1;
                middle[static_cast<std::size_t>(k)] += sign * checker::floor_of(radius, -problem.fine);
            }
            point.middle = std::move(middle);
            const std::vector<checker::Range> there = forces_at(point);
            for (std::size_t l = 0; l < there.size(); ++l) {
                BOOST_REQUIRE((there[l].lower >= enclosed[l].lower && there[l].upper <= enclosed[l].upper));
                const checker::Rational centre = (enclosed[l].lower + enclosed[l].upper) / 2;
                const checker::Rational way = abs(there[l].lower - centre) / (enclosed[l].upper - centre);
                farthest = std::max(farthest, way);
            }
        }
        BOOST_TEST((!in_box || farthest.get_d() > 0.01));
    }
}

// K1 (b) and K2: rows and columns of the derivative between two configurations.
BOOST_AUTO_TEST_CASE(the_derivative_changes_by_at_most_its_curvature) {
    std::mt19937_64 random(5);
    std::vector<State> states = cells::small();
    states.push_back(cells::of_file("tilt_16"));
    for (const State& state : states) {
        const checker::Problem problem(state);
        checker::Integer farthest_row = 0, farthest_column = 0;
        const checker::Integer step = checker::shifted_left(1, problem.spare);
        for (int sample = 0; sample < testing::scaled(100); ++sample) {
            std::vector<checker::Integer> q = problem.stored;
            for (const int k : problem.coordinate_of) {
                q[static_cast<std::size_t>(k)] += random() % 2 == 0 ? step : checker::Integer(-step);
            }
            std::vector<checker::Integer> column(problem.coordinate_of.size());
            for (int l = 0; l < problem.contacts(); ++l) {
                checker::Integer row = 0;
                const checker::Row& entries = problem.rows[static_cast<std::size_t>(l)];
                for (int k = 0; k < entries.count; ++k) {
                    const int dof =
                        problem.dof_of[static_cast<std::size_t>(entries.coordinate[static_cast<std::size_t>(k)])];
                    if (dof >= 0) {
                        const checker::Integer change =
                            abs(problem.entry(l, k, q) - problem.entry(l, k, problem.stored));
                        row += change;
                        column[static_cast<std::size_t>(dof)] += change;
                    }
                }
                farthest_row = std::max(farthest_row, row);
            }
            farthest_column = std::max(farthest_column, checker::largest_of(column));
        }
        BOOST_TEST((farthest_row <= problem.row_curvature() * step));
        BOOST_TEST((farthest_column <= problem.column_curvature() * step));
        BOOST_TEST((2 * farthest_column > problem.column_curvature() * step || problem.dofs() > 10));
    }
}

// A row of three disks along x, the last one stored elsewhere: the second carries force only where the row is straight.
BOOST_AUTO_TEST_CASE(a_disk_between_images_carries_force_where_they_are_on_one_line) {
    for (const double y : {0.0, 0.3}) {
        const double first = std::sqrt(1.5 * 1.5 - y * y);
        const double second = std::sqrt(1.2 * 1.2 - y * y);
        const double period = first + second + 1.7;
        State state =
            cells::in_cell({{1, 0, 0}, {0.5, first, y}, {0.7, first + second - period, 2}}, {period, 2, 0}, false, 1, 1,
                           {cells::across(0, 1, 0, 0),
                            cells::across(1, 2, 1, -1),
                            cells::across(0, 2, 0, -1),
                            cells::across(0, 0, 0, 1),
                            {ContactKind::held, 3, 0},
                            {ContactKind::held, 5, 0}});
        snap_to_grid(state.packing);
        checker::Place place;
        (void)checker::make_place(state, place, {}, 4);
        BOOST_TEST_REQUIRE(place.evidence->vertex.found);
        for (const std::size_t l : {0U, 1U}) {
            BOOST_TEST(checker::without_force(place)[l] == (y > 0));
        }
    }
}
