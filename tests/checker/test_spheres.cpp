// Certificates of spheres: the checker against the digits of an independent program, against brute force, and against
// forgers; its constants of three axes against their worst cases.
#include "checker/claims.hpp"
#include "checker/evidence.hpp"
#include "checker/images.hpp"
#include "checker/maker.hpp"
#include "checker/small_states.hpp"
#include "checker/vertex.hpp"
#include "oracle/pairs.hpp"
#include "support/spheres.hpp"

using namespace claims;
using namespace checker;
using namespace isostat::test;
namespace room = checker;

namespace {

const std::vector<std::string> random_packings{"box_uniform_30_1",    "box_bidisperse_30_1", "box_jitter_30_1",
                                               "slab_uniform_30_1",   "ortho_uniform_30_1",  "tri_uniform_30_1",
                                               "tri_bidisperse_60_1", "ortho_jitter_100_1",  "box_bidisperse_100_1"};

/// All given digits but the last ones.
bool has_digits(const Range& range, const mpq_class& value) {
    const mpq_class room = mpq_class("1/1000000000000000000000000000") * (abs(value) + 1);
    return range.lower <= value + room && value - room <= range.upper && range.upper - range.lower <= 2 * room;
}

/// Nothing but spheres, which are no contacts of each other; in a triclinic cell of side 8 whose 6 entries move, or not
/// in one.
State loose(const std::vector<std::array<double, 4>>& spheres, bool cell) {
    State state;
    Packing& p = state.packing;
    p.dimension = p.cell.dimension = state.load.dimension = 3;
    p.walls = Walls::none();
    for (const auto& s : spheres) {
        p.radius.push_back(s[3]);
        p.q.insert(p.q.end(), s.begin(), s.begin() + 3);
    }
    p.q.insert(p.q.end(), 3, 8.0);
    if (cell) {
        p.cell.repeat();
        p.cell.move(true, true);
        p.q.insert(p.q.end(), 3, 0.0);
    }
    return state;
}

/// A vertex that is known to `radius` only.
room::TrueVertex blurred(const Problem& problem, const Rational& radius) {
    room::TrueVertex vertex;
    vertex.middle = problem.stored;
    vertex.radius = radius;
    return vertex;
}

} // namespace

BOOST_AUTO_TEST_CASE(what_is_certified_of_spheres_verifies) {
    for (const std::string& name : random_packings) {
        BOOST_TEST_INFO_SCOPE(name);
        are_proved(read_and_verified(certified(state_of_spheres(read_spheres(name)))));
    }
    for (const char* name : {"closed_one", "closed_rattler", "closed_two", "closed_three", "closed_tetra"}) {
        BOOST_TEST_INFO_SCOPE(name);
        State state = state_of_spheres(read_spheres(name));
        state.load.stress = {1, 1.3, 1.7};
        const Certificate certificate = certified(state);
        for (const CheckerArithmetic arithmetic : {CheckerArithmetic::singular_value, CheckerArithmetic::fixed64,
                                                   CheckerArithmetic::gmp, CheckerArithmetic::rational}) {
            are_proved(read_and_verified(certificate, arithmetic));
        }
    }
}

BOOST_AUTO_TEST_CASE(ranges_of_forces_of_spheres_hold_the_digits_of_another_program) {
    for (const std::string& name : random_packings) {
        BOOST_TEST_INFO_SCOPE(name);
        const auto file = read_spheres(name);
        const State state = state_of_spheres(file);
        const Evidence evidence(state, CheckerArithmetic::automatic);
        BOOST_TEST_REQUIRE(evidence.vertex.found);
        BOOST_TEST_REQUIRE(file["forces"].size() == evidence.forces.size());
        for (std::size_t l = 0; l < evidence.forces.size(); ++l) {
            BOOST_TEST(has_digits(evidence.forces[l], exactly(file["forces"][l])), evidence.name(l));
            const Range slope = evidence.slopes()[l] * Range(Rational(state.load.stress[2]));
            BOOST_TEST(has_digits(slope, exactly(file["forces_per_unit_ratio"][l])), evidence.name(l));
        }
    }
}

BOOST_AUTO_TEST_CASE(tilts_of_spheres_are_loaded_by_the_lengths_of_the_other_axes) {
    State state = state_of_spheres(read_spheres("tri_uniform_30_1"));
    const PerAxis<double> forces = state.load.stress;
    state.load.reference_length = {2, 4, 0.5};
    state.load.stress = {forces[0] / 2, forces[1], forces[2] / 8};
    state.load.shear = {0x1p-14 * forces[0], -0x1p-15 * forces[0], 0x1p-14 * forces[0]};
    for (int axis = 0; axis < 6; ++axis) {
        state.load.loaded_axis = axis;
        const Certificate made = certified(state);
        are_proved(read_and_verified(made));
        if (axis >= 3) {
            Certificate forged = made;
            forged.state.load.shear[static_cast<std::size_t>(axis) - 3] *= 2;
            BOOST_TEST((answer_to(verify(forged), "forces").verdict == Verdict::refuted));
        }
    }
}

BOOST_AUTO_TEST_CASE(true_stresses_press_on_areas_at_the_true_vertex) {
    State state = state_of_spheres(read_spheres("box_uniform_30_1"));
    const Evidence dead(state, CheckerArithmetic::automatic);
    state.load.kind = LoadKind::true_stress;
    for (std::size_t a = 0; a < 3; ++a) {
        state.load.stress[a] /= state.packing.q[state.packing.length_at((a + 1) % 3)] *
                                state.packing.q[state.packing.length_at((a + 2) % 3)];
    }
    const Evidence now(state, CheckerArithmetic::automatic);
    for (std::size_t l = 0; l < now.forces.size(); ++l) {
        BOOST_TEST(std::abs(now.forces[l].lower.get_d() - dead.forces[l].lower.get_d()) < 1e-10);
    }
    are_proved(read_and_verified(certified(state)));
}

// K1 (b) and K2: with three axes the worst cases are attained.
BOOST_AUTO_TEST_CASE(the_derivative_of_spheres_changes_by_its_curvature) {
    for (const auto& [name, box] : {std::pair("box_uniform_30_1", true), {"tri_uniform_30_1", false}}) {
        const Problem problem(state_of_spheres(read_spheres(name)));
        const Integer step = room::shifted_left(1, problem.spare);
        const auto change = [&](std::size_t l, std::size_t k, const std::vector<Integer>& q) -> Integer {
            const int slot = static_cast<int>(k);
            return abs(problem.entry(static_cast<int>(l), slot, q) -
                       problem.entry(static_cast<int>(l), slot, problem.stored));
        };
        Integer farthest = 0;
        for (std::size_t l = 0; l < problem.rows.size(); ++l) { // all coordinates of the contact part
            const room::Row& row = problem.rows[l];
            std::vector<Integer> q = problem.stored;
            for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
                q[static_cast<std::size_t>(row.coordinate[k])] += row.sign[k] > 0 ? step : Integer(-step);
            }
            Integer sum = 0;
            for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
                sum += change(l, k, q);
            }
            farthest = std::max(farthest, sum);
        }
        BOOST_TEST((farthest == problem.row_curvature() * step));
        BOOST_TEST((!box || problem.row_curvature() == 12));
        farthest = 0;
        for (std::size_t j = 0; j < problem.coordinate_of.size(); ++j) { // one moves against all others
            std::vector<Integer> q = problem.stored;
            for (Integer& x : q) {
                x -= step;
            }
            const int own = problem.coordinate_of[j];
            q[static_cast<std::size_t>(own)] += 2 * step;
            Integer sum = 0;
            for (const int l : problem.contacts_of[j]) {
                const room::Row& row = problem.rows[static_cast<std::size_t>(l)];
                const auto* const at = std::ranges::find(row.coordinate, own);
                sum += change(static_cast<std::size_t>(l), static_cast<std::size_t>(at - row.coordinate.begin()), q);
            }
            farthest = std::max(farthest, sum);
        }
        BOOST_TEST((farthest <= problem.column_curvature() * step));
        BOOST_TEST((!box || farthest == problem.column_curvature() * step));
    }
}

// K9: along (1, 1, 1) the gap moves by 2 sqrt 3 r, more than 3 r; through an image of all axes by 12 r / sqrt 3.
BOOST_AUTO_TEST_CASE(a_gap_of_spheres_is_enclosed_to_the_worst_case_of_three_axes) {
    for (const bool image : {false, true}) {
        // Two spheres, or one and its own image with three tilts, side by side along the diagonal of a cube.
        const double x = image ? -6 : 2;
        const State state = loose({{0, 0, 0, 0.5}, {x, x, x, 0.5}}, image);
        const Problem problem(state);
        const Rational radius = room::power_of_two(-20);
        const std::vector<room::Gap> gaps = smallest_gaps(problem, state, blurred(problem, radius));
        const Contact pair = pair_of(0, 1, image ? Image{{1, 1, 1}} : Image{});
        const auto gap = std::ranges::find_if(gaps, [&pair](const room::Gap& g) { return g.pair == pair; });
        BOOST_TEST_REQUIRE((gap != gaps.end()));
        const room::Row row(pair, problem.layout);
        BOOST_TEST(row.count == (image ? 12 : 6));
        const Integer step = room::floor_of(radius, -problem.fine);
        double moved = 0;
        for (const int way : {-1, 1}) {
            std::vector<Integer> q = problem.stored;
            for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
                q[static_cast<std::size_t>(row.coordinate[k])] -= way * (row.sign[k] > 0 ? step : Integer(-step));
            }
            const Integer distance = sqrt(Integer(row.square(q, 3)));
            const Rational there = problem.length(distance) - 1;
            BOOST_TEST((gap->value.lower <= there && there <= gap->value.upper));
            moved = std::max(moved, std::abs(there.get_d() - (std::sqrt(12.0) - 1)) / radius.get_d());
        }
        BOOST_TEST(moved > (image ? 6.92 : 3.46));
        BOOST_TEST(moved < (image ? 6.94 : 3.47));
        const Rational width = (gap->value.upper - gap->value.lower) / (2 * radius);
        BOOST_TEST(width.get_d() < 2 * moved);
    }
}

// Brute force over all images, for configurations that need not be anything.
BOOST_AUTO_TEST_CASE(the_sweep_finds_the_smallest_gap_of_spheres_among_images) {
    constexpr int far = 5;
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> from(-1, 2);
    for (int sample = 0; sample < 60; ++sample) {
        std::vector<std::array<double, 4>> spheres;
        for (int i = 0; i < 1 + sample % 4; ++i) {
            spheres.push_back({from(random), from(random), from(random), 0.05 + 0.1 * (1 + from(random))});
        }
        State state = loose(spheres, sample % 5 != 4);
        Packing& p = state.packing;
        for (std::size_t a = 0; a < 3; ++a) {
            p.q[p.length_at(a)] = 2.5 + 0.5 * from(random);
        }
        for (std::size_t t = 0; t < 3 && p.cell.any(); ++t) {
            p.q[p.length_at(3 + t)] = 0.5 * from(random);
        }
        if (sample % 5 == 3) { // walls along z
            p.cell.periodic[2] = p.cell.period_moves[2] = p.cell.tilt_moves[1] = p.cell.tilt_moves[2] = false;
            p.q[p.tilt_at(0, 2)] = p.q[p.tilt_at(1, 2)] = 0;
            p.walls.lower[2] = WallKind::fixed;
            p.walls.upper[2] = WallKind::movable;
        }
        BOOST_TEST_INFO_SCOPE(sample);
        small_states::lists_the_smallest_gap(state, oracle::all_pairs(p, far));
    }
}

// A rectangular lattice in a basis that leans by six periods: the nearest image is far along it.
BOOST_AUTO_TEST_CASE(the_sweep_reaches_the_nearest_image_in_a_sheared_cell) {
    struct Shear {
        std::array<double, 3> length, tilt; ///< xy, xz, yz
        Image nearest;
    };
    for (const Shear& shear :
         {Shear{{1.2, 1, 1.2}, {7.2, 0, 0}, {{-6, 1, 0}}}, Shear{{1.2, 1.2, 1}, {0, 7.2, 0}, {{-6, 0, 1}}},
          Shear{{1.2, 1.2, 1}, {0, 0, 7.2}, {{0, -6, 1}}}, Shear{{1.2, 1.2, 1}, {3.6, 0, 2.4}, {{6, -2, 1}}}}) {
        State state = loose({{0, 0, 0, 0.45}}, true);
        for (std::size_t k = 0; k < 3; ++k) {
            state.packing.q[state.packing.length_at(k)] = shear.length[k];
            state.packing.q[state.packing.length_at(3 + k)] = shear.tilt[k];
        }
        const Problem problem(state);
        const std::vector<room::Gap> gaps = smallest_gaps(problem, state, blurred(problem, 0));
        BOOST_TEST_REQUIRE(gaps.size() == 1U);
        BOOST_TEST((gaps[0].pair == pair_of(0, 0, shear.nearest)), to_string(gaps[0].pair, 3));
        BOOST_TEST(std::abs(gaps[0].value.lower.get_d() - 0.1) < 1e-12);
    }
}

// Eight unit spheres of a simple cubic lattice, held by 27 of the 36 contacts: the other nine touch.
BOOST_AUTO_TEST_CASE(a_lattice_whose_other_pairs_touch_is_not_proved) {
    State state;
    Packing& p = state.packing;
    p.dimension = p.cell.dimension = state.load.dimension = 3;
    p.walls = Walls::box(3);
    p.radius.assign(8, 1);
    for (int i = 0; i < 8; ++i) {
        for (int a = 0; a < 3; ++a) {
            const bool second = (i >> a) % 2 != 0;
            p.q.push_back(second ? 3 : 1);
            const bool whole = i == (second ? 1 << a : 0);
            const int mate = i & ~(1 << a);
            state.contacts.push_back(second ? pair_of(mate, i) : Contact(ContactKind::lower_wall, i, a));
            if (second && whole) { // one line per axis reaches the upper wall
                state.contacts.emplace_back(ContactKind::upper_wall, i, a);
            }
            state.load.infinitesimal.push_back(-1);
        }
    }
    p.q.insert(p.q.end(), 3, 4.0);
    state.load.loaded_axis = 2;
    state.load.stress = state.load.reference_length = {1, 1, 1};
    const Certification lattice = certify(state);
    BOOST_TEST((lattice.verdict == Verdict::undecided));
    Certificate certificate = certificate_of(state, lattice.claims);
    BOOST_TEST(certificate.claims.counting.has_value());
    BOOST_TEST(!certificate.claims.gaps.has_value());
    certificate.claims.gaps = GapsClaim{0x1p-1000, Contact(ContactKind::upper_wall, 7, 2)};
    const Verification verification = verify(certificate);
    BOOST_TEST((answer_to(verification, "counting").verdict == Verdict::proved));
    BOOST_TEST((answer_to(verification, "gaps").verdict == Verdict::refuted));
    BOOST_TEST((verification.verdict == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(own_images_of_spheres_at_rest_must_not_overlap) {
    for (const bool overlap : {false, true}) {
        State state = loose({{0, 0, 0, 1}}, true);
        state.packing.cell.move(true, false);
        state.packing.cell.period_moves[2] = false;
        state.packing.length(2) = overlap ? 2 - 0x1p-40 : 2;
        const auto pair = fixed_overlap(Problem(state), state);
        BOOST_TEST(pair.has_value() == overlap);
        BOOST_TEST((!pair || *pair == pair_of(0, 0, {{0, 0, 1}})));
    }
    State fixed = loose({{0, 0, 0, 1}, {0, 0, 2, 1}}, false);
    fixed.packing.fixed = {1, 1};
    BOOST_TEST(!fixed_overlap(Problem(fixed), fixed).has_value());
    fixed.packing.q[5] = 2 - 0x1p-50;
    BOOST_TEST((fixed_overlap(Problem(fixed), fixed) == pair_of(0, 1)));
}

BOOST_AUTO_TEST_CASE(contacts_of_spheres_have_their_names) {
    State state = state_of_spheres(read_spheres("tri_uniform_30_1"));
    Certificate certificate = certified(state);
    certificate.claims.gaps->smallest *= 2;
    BOOST_TEST(answer_to(verify(certificate), "gaps").detail.find(to_string(certificate.claims.gaps->where, 3)) !=
               std::string::npos);
    state.contacts[0].image = {{1, 0, 0}};
    state.packing.cell.periodic[0] = false;
    state.packing.cell.pin = 0;
    BOOST_TEST(Problem(state).unsupported.find(to_string(state.contacts[0], 3)) != std::string::npos);
}
