// Proved bounds against the truth to 200 digits: the bound is never below the error, and it is not useless.
// Enclosures of vertices with bars against the vertex to 200 digits.
// Bounds for contact matrices with more columns than rows.
#include "contact/candidates.hpp"
#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "oracle/random.hpp"
#include "oracle/truth.hpp"
#include "statics/statics.hpp"
#include "support/clumps.hpp"
#include "support/crafted.hpp"
#include "support/free_grains.hpp"
#include "support/regular.hpp"
#include "verified/configuration.hpp"
#include "verified/force_ladder.hpp"
#include "verified/inverse_bound.hpp"
#include "verified/to_vertex.hpp"
#include "verified/vertex_bounds.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/preparation/preparation.hpp>

#include <Eigen/Dense>

using namespace isostat;
using namespace crafted;
using isostat::oracle::Real;

namespace {

using oracle::Real;
using Vector = oracle::Truth::Vector;

void scale(Vector& x) {
    const Real size = sqrt(std::inner_product(x.begin(), x.end(), x.begin(), Real(0)));
    std::ranges::for_each(x, [&size](Real& c) { c /= size; });
}

/// A lower bound of |H^-1|_2 that converges to it: power iteration on H^-T H^-1.
Real norm_of_inverse(oracle::SquareMatrix<Real> h) {
    oracle::SquareMatrix<Real> transposed(h.size());
    for (std::size_t i = 0; i < h.size(); ++i) {
        for (std::size_t j = 0; j < h.size(); ++j) {
            transposed(i, j) = h(j, i);
        }
    }
    BOOST_TEST_REQUIRE((h.factorise() && transposed.factorise()));
    Vector x(h.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = Real(1) + Real(static_cast<int>(i % 7)) / 10;
    }
    Real norm = 0;
    for (int k = 0; k < 30; ++k) {
        scale(x);
        x = h.solve(x);
        norm = sqrt(std::inner_product(x.begin(), x.end(), x.begin(), Real(0)));
        x = transposed.solve(x);
    }
    return norm;
}

/// Bounds of one structure against the truth; returns whether the inverse bound was proved.
bool check(const State& state, const std::vector<double>& force) {
    const Regular at(state);
    if (at.inverse.verdict != Verdict::proved) {
        return false;
    }
    oracle::SquareMatrix<Real> h = oracle::Truth(state, oracle::At::stored).contact_matrix();
    const Real norm = norm_of_inverse(h);
    BOOST_TEST(Real(at.inverse.sigma_min) * norm <= 1,
               "sigma_min " << at.inverse.sigma_min << " above the true one " << 1 / norm.convert_to<double>());
    BOOST_TEST_REQUIRE(h.factorise());
    const Vector exact = h.solve(Vector(force.begin(), force.end()));
    ForceSolution solution = solve_forces(at.structure, at.factorisation, at.inverse, force);
    const auto error = [&] {
        Real worst = 0;
        for (std::size_t l = 0; l < exact.size(); ++l) {
            const Real value = Real(solution.value[l]) + (solution.low.empty() ? Real(0) : Real(solution.low[l]));
            worst = std::max(worst, Real(abs(value - exact[l])));
        }
        return worst;
    };
    BOOST_TEST(error() <= Real(solution.bound), "double: error above the bound");
    const double double_bound = solution.bound;
    ForceLadder ladder(state.packing, at.structure, at.factorisation, at.inverse);
    const int part = ladder.add(force);
    BOOST_TEST_REQUIRE(ladder.climb());
    solution = ladder.solution(part);
    BOOST_TEST(error() <= Real(solution.bound),
               "double-double: error " << error().convert_to<double>() << " above the bound " << solution.bound);
    if (at.inverse.sigma_min > 1e-10) {
        BOOST_TEST(solution.bound < 1e-8 * double_bound);
    }
    return true;
}

/// A free disk between two fixed ones whose directions differ from opposite by `angle`: sigma_min ~ angle / sqrt 2.
State nearly_collinear(double angle) {
    return without_walls::held_by_two({1, 1, 1}, {-2, 0, 2 * std::cos(angle), 2 * std::sin(angle), 0, 0});
}

isostat::sparse::Matrix<double> compressed(const Eigen::MatrixXd& dense) {
    isostat::sparse::Matrix<double> out;
    out.rows = static_cast<int>(dense.rows());
    out.cols = static_cast<int>(dense.cols());
    out.start.push_back(0);
    for (Eigen::Index j = 0; j < dense.cols(); ++j) {
        for (Eigen::Index i = 0; i < dense.rows(); ++i) {
            out.row.push_back(static_cast<int>(i));
            out.value.push_back(dense(i, j));
        }
        out.start.push_back(static_cast<int>(out.row.size()));
    }
    return out;
}

} // namespace

BOOST_AUTO_TEST_CASE(bounds_hold_on_prepared_packings) {
    for (const int n : {1, 2, 5, 12}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            PreparationOptions options{.disks = n, .seed = seed};
            PreparationReport report;
            auto state = prepare(options, report);
            if (!state.ok()) {
                BOOST_TEST_MESSAGE("n = " << n << ", seed " << seed << ": " << state.failure().message());
                continue;
            }
            BOOST_TEST(check(state.value(), state.value().load.external_force(state.value().packing)));
        }
    }
}

BOOST_AUTO_TEST_CASE(bounds_hold_near_singular_matrices) {
    int proved = 0;
    for (const double angle : {0.5, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13}) {
        proved += check(nearly_collinear(angle), {0.3, -1}) ? 1 : 0;
    }
    BOOST_TEST(proved >= 7); // in double-double where the route in double ends
}

BOOST_AUTO_TEST_CASE(an_exactly_collinear_strut_is_never_proved_regular) {
    State state = nearly_collinear(0);
    state.packing.q = {-2, 0, 2, 0, 0, 0, 0, 0};
    fails(IsostaticStructure::prove(state.packing, state.contacts), FailureKind::not_isostatic);
    // Tilted, it is singular as well, but not by its pattern.
    state.packing.q = {-2, -1, 2, 1, 0, 0, 0, 0};
    BOOST_TEST(!IsostaticStructure::prove(state.packing, state.contacts).ok());
    state.packing.q[3] = std::nextafter(1.0, 2.0);
    BOOST_TEST(IsostaticStructure::prove(state.packing, state.contacts).ok());
}

BOOST_AUTO_TEST_CASE(the_long_routes_to_a_bound_are_for_structures_that_may_be_regular) {
    const State state = nearly_collinear(1e-10); // too near for the first route
    const auto structure = crafted::Regular::proved(state);
    const Factorisation factorisation(structure);
    for (const bool worth : {false, true}) {
        InverseBoundCache cache;
        int asked = 0;
        const InverseBound bound = bound_inverse(structure, factorisation, cache, [&] {
            ++asked;
            return worth;
        });
        BOOST_TEST(asked == 1);
        BOOST_TEST((bound.verdict == (worth ? Verdict::proved : Verdict::undecided)));
    }
}

BOOST_AUTO_TEST_CASE(newtons_method_ends_where_all_gaps_of_the_list_are_0_and_no_farther_than_it_may_go) {
    const State vertex = two_disks(1, 2, 1, 1);
    Packing pushed = vertex.packing;
    for (std::size_t k = 0; k < pushed.q.size(); ++k) {
        pushed.q[k] += 0.01 * std::sin(7.0 * static_cast<double>(k + 1));
    }
    long steps = 0;
    Packing end = pushed;
    BOOST_TEST(!to_vertex(end, vertex.contacts, steps).has_value());
    BOOST_TEST(steps > 2);
    for (std::size_t k = 0; k < end.q.size(); ++k) {
        BOOST_TEST(std::abs(end.q[k] - vertex.packing.q[k]) < 1e-14);
    }
    end = pushed;
    const auto failure = required(to_vertex(end, vertex.contacts, steps, 1e-3));
    BOOST_TEST((failure.kind == FailureKind::not_converged));
    BOOST_TEST((end.q == pushed.q));
}

BOOST_AUTO_TEST_CASE(the_true_vertex_lies_within_the_radius) {
    // Two disks: the true vertex is known in closed form.
    const State state = two_disks(1, 2, 1, 1);
    const Regular at(state);
    const Real root2 = sqrt(Real(2));
    const std::vector<Real> exact{1, 1, 1 + 2 * root2, 2, 3 + 2 * root2, 4};
    for (const int way : {0, 1, 2}) {
        const bool extended = way == 2;
        const VertexEnclosure vertex =
            extended   ? enclose_vertex_double_double(state.packing, at.structure, at.factorisation, at.inverse)
            : way == 1 ? enclose_vertex(state.packing, at.structure, at.factorisation, at.inverse)
                       : enclose_vertex(state.packing, at.structure, at.inverse);
        BOOST_TEST_REQUIRE((vertex.verdict == Verdict::proved));
        Real square = 0;
        for (std::size_t k = 0; k < exact.size(); ++k) {
            const Real place =
                Real(state.packing.q[k]) + (vertex.correction.empty() ? Real(0) : Real(vertex.correction[k]));
            square += (place - exact[k]) * (place - exact[k]);
        }
        BOOST_TEST(sqrt(square) <= Real(vertex.radius));
        BOOST_TEST(vertex.radius < (extended ? 1e-26 : way == 1 ? 2e-15 : 1e-13));
        const Enclosure gap = gap_at_vertex(state.packing, vertex, left(1));
        BOOST_TEST(abs(Real(gap.value) - (2 * root2 - 1)) <= Real(gap.radius));
    }
}

BOOST_AUTO_TEST_CASE(the_newton_step_encloses_the_vertex_and_hardly_more) {
    // Against the vertex in double-double, after pushing every disk off it by far more than rounding.
    const std::vector<std::pair<const char*, double>> cases{
        {"/vertex100.txt", 0.0},        {"/vertex100.txt", 1e-13},        {"/vertex100.txt", 1e-10},
        {"/vertex100.txt", 1e-7},       {"/cells/tilt_16.json", 1e-11},   {"/cells/tilt_16.json", 1e-8},
        {"/cells/rect_16.json", 1e-11}, {"/cells/channel_16.json", 1e-11}};
    for (const auto& [file, push] : cases) {
        State moved = crafted::pushed(read_any_state(ISOSTAT_TEST_DATA + std::string(file)).state, push);
        if (moved.packing.cell.any()) {
            snap_to_grid(moved.packing);
        }
        const Regular at(moved);
        const VertexEnclosure step = enclose_vertex(moved.packing, at.structure, at.factorisation, at.inverse);
        const VertexEnclosure fine =
            enclose_vertex_double_double(moved.packing, at.structure, at.factorisation, at.inverse);
        BOOST_TEST_REQUIRE((step.verdict == Verdict::proved));
        BOOST_TEST_REQUIRE((fine.rung == Rung::double_double));
        const double moved_by = isostat::euclidean_norm(fine.correction);
        BOOST_TEST(moved_by <= step.radius + fine.radius);
        BOOST_TEST(step.radius < 1.6 * moved_by);
        BOOST_TEST(step.radius < 0.1 * enclose_vertex(moved.packing, at.structure, at.inverse).radius);
    }
}

BOOST_AUTO_TEST_CASE(forces_turn_with_their_contacts_within_the_bound_and_reach_a_good_part_of_it) {
    const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state;
    const DofMap dofs(state.packing);
    const sparse::Matrix<double> h = contact_matrix(state.packing, dofs, state.contacts);
    oracle::Random random(5);
    std::vector<double> x(state.contacts.size());
    std::ranges::generate(x, [&] { return random.real(-1, 1); });
    x[7] = 20; // the worst disks are at one of its ends
    const double rate = turn_of_forces(state.packing, state.contacts, x);
    double largest = 0;
    const int disks = state.packing.disk_count();
    for (int trial = 0; trial < 4 * disks + 100; ++trial) {
        Packing moved = state.packing;
        double square = 0;
        for (int k = 0; k < 2 * disks; ++k) {
            if (trial >= 4 * disks || k / 2 == trial / 4) { // one disk in some direction, then all
                const double step = 1e-7 * random.real(-1, 1);
                moved.q[static_cast<std::size_t>(k)] += step;
                square += step * step;
            }
        }
        const sparse::Matrix<double> other = contact_matrix(moved, dofs, state.contacts);
        BOOST_TEST_REQUIRE((other.row == h.row));
        std::vector<double> change(x.size(), 0.0);
        for (std::size_t l = 0; l < x.size(); ++l) {
            for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
                change[static_cast<std::size_t>(h.row[e])] += (other.value[e] - h.value[e]) * x[l];
            }
        }
        double size = 0;
        for (const double c : change) {
            size += c * c;
        }
        const double ratio = std::sqrt(size / square) / rate;
        BOOST_TEST(ratio < 1);
        largest = std::max(largest, ratio);
    }
    BOOST_TEST(largest > 0.3);
}

BOOST_AUTO_TEST_CASE(the_distance_to_the_true_vertex_includes_the_correction) {
    // Contacts that overlap by 1e-12 as stored: the corrected radius is far smaller, and no allowance for overlaps.
    // Runs with 1936 and 4900 disks refused their own contacts over this.
    State state = two_disks(1, 2, 1, 1);
    for (double& length : state.packing.q) {
        length *= 1 - 1e-12;
    }
    const Regular at(state);
    const VertexEnclosure vertex =
        enclose_vertex_double_double(state.packing, at.structure, at.factorisation, at.inverse);
    BOOST_TEST_REQUIRE((vertex.verdict == Verdict::proved));
    const Real root2 = sqrt(Real(2));
    const std::vector<Real> exact{1, 1, 1 + 2 * root2, 2, 3 + 2 * root2, 4};
    Real square = 0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
        square += (Real(state.packing.q[k]) - exact[k]) * (Real(state.packing.q[k]) - exact[k]);
    }
    BOOST_TEST(sqrt(square) <= Real(vertex.distance()));
    BOOST_TEST(vertex.distance() < 1e-10);
    BOOST_TEST((certify_admissible(state.packing, 4 * vertex.distance()).verdict == Verdict::proved));
    BOOST_TEST((certify_admissible(state.packing, 4 * vertex.radius).verdict == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(no_vertex_is_proved_where_there_is_none) {
    // Contacts that are open by a tenth of a radius cannot all close near the stored place at once.
    State state = two_disks(1, 2, 1, 1);
    state.packing.q[2] += 0.1;
    const Regular at(state);
    BOOST_TEST((enclose_vertex(state.packing, at.structure, at.inverse).verdict == Verdict::undecided));
    BOOST_TEST(
        (enclose_vertex(state.packing, at.structure, at.factorisation, at.inverse).verdict == Verdict::undecided));
}

BOOST_AUTO_TEST_CASE(vertices_with_bars_lie_within_their_enclosures) {
    for (const char* const name : {"dimer_20_1", "dimer2_20_2", "trimer_20_1"}) {
        const State state = isostat::with_free_motions_held(isostat::test::clumps(name));
        const crafted::Regular at(state);
        const isostat::oracle::Truth truth(state);
        BOOST_TEST_REQUIRE(truth.known);
        for (const int way : {0, 1, 2}) {
            const VertexEnclosure vertex =
                way == 2   ? enclose_vertex_double_double(state.packing, at.structure, at.factorisation, at.inverse)
                : way == 1 ? enclose_vertex(state.packing, at.structure, at.factorisation, at.inverse)
                           : enclose_vertex(state.packing, at.structure, at.inverse);
            BOOST_TEST_INFO_SCOPE(name << ", way " << way);
            BOOST_TEST_REQUIRE((vertex.verdict == Verdict::proved));
            Real square = 0;
            for (std::size_t k = 0; k < state.packing.q.size(); ++k) {
                const Real place =
                    Real(state.packing.q[k]) + (vertex.correction.empty() ? Real(0) : Real(vertex.correction[k]));
                square += (place - truth.q[k]) * (place - truth.q[k]);
            }
            BOOST_TEST(sqrt(square) <= Real(vertex.radius));
            BOOST_TEST(vertex.radius < (way == 2 ? 1e-20 : 1e-9));
        }
    }
}

BOOST_AUTO_TEST_CASE(the_smallest_singular_value_of_independent_rows_is_bounded_from_below_and_not_by_much) {
    std::mt19937_64 random(3);
    for (const auto& [rows, columns] : {std::pair{1, 1}, {3, 5}, {8, 8}, {7, 30}, {20, 23}}) {
        for (const double shrink : {1.0, 1e-2, 1e-4}) { // of one row
            Eigen::MatrixXd h(rows, columns);
            for (double& entry : h.reshaped()) {
                entry = static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5;
            }
            h.row(0) *= shrink;
            const double truth = h.jacobiSvd().singularValues().tail(1)[0];
            const double bound = isostat::smallest_row_singular_value(compressed(h), 2);
            BOOST_TEST(bound <= std::min(truth, 1.0) * (1 + 1e-12));
            BOOST_TEST(bound >= 0.4 * std::min(truth, 1.0));
        }
    }
}

BOOST_AUTO_TEST_CASE(rows_that_depend_on_each_other_have_no_bound) {
    Eigen::MatrixXd h = Eigen::MatrixXd::Ones(3, 6);
    h(0, 0) = 2;
    BOOST_TEST(isostat::smallest_row_singular_value(compressed(h), 2) == 0);
    BOOST_TEST(isostat::smallest_row_singular_value(compressed(h.leftCols(2)), 2) == 0); // and more rows than columns
}

BOOST_AUTO_TEST_CASE(the_residual_of_forces_is_bounded_in_every_unit_of_force) {
    std::mt19937_64 random(5);
    constexpr int n = 6;
    const auto number = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5; };
    Eigen::MatrixXd h(n, n);
    for (double& entry : h.reshaped()) {
        entry = number();
    }
    Eigen::VectorXd z(n);
    for (double& entry : z) {
        entry = number();
    }
    const Eigen::VectorXd v = h * z;
    const Eigen::Matrix<long double, n, 1> rest = v.cast<long double>() - h.cast<long double>() * z.cast<long double>();
    BOOST_TEST_REQUIRE(rest.norm() > 0);
    const auto bound = [&](double unit) {
        std::vector<double> load(v.begin(), v.end()), force(z.begin(), z.end()), r(n), size(n);
        for (std::vector<double>* numbers : {&load, &force}) {
            for (double& entry : *numbers) {
                entry *= unit;
            }
        }
        std::vector<int> terms(n);
        return isostat::residual_of_forces(compressed(h), load, force, r, size, terms) / unit;
    };
    BOOST_TEST(bound(1) >= static_cast<double>(rest.norm()));
    BOOST_TEST(bound(1) < 1e-13);
    for (const double unit : {0x1p-300, 0x1p-500, 0x1p-700, 0x1p-900}) { // squares vanish from 1e-162 on
        BOOST_TEST(std::abs(bound(unit) / bound(1) - 1) < 1e-8, unit);
    }
    BOOST_TEST(bound(0x1p-1040) >= static_cast<double>(rest.norm())); // where products underflow
}
