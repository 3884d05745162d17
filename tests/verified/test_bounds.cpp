// Proved bounds against a reference in 100 digits: the bound is never below the error, and it is not useless.
#include "contact/candidates.hpp"
#include "oracle/random.hpp"
#include "statics/statics.hpp"
#include "support/crafted.hpp"
#include "verified/configuration.hpp"
#include "verified/force_ladder.hpp"
#include "verified/vertex_bounds.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/preparation/preparation.hpp>

#include <boost/multiprecision/cpp_dec_float.hpp>
#include <boost/test/unit_test.hpp>

using namespace isostat;
using namespace crafted;

namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_dec_float<100>, boost::multiprecision::et_off>;
using Dense = std::vector<std::vector<Real>>;

/// H with unit normals of the stored coordinates, to 100 digits.
Dense reference_matrix(const Packing<2>& packing, const std::vector<Contact>& contacts) {
    const DofMap<2> dofs(packing);
    Dense h(static_cast<std::size_t>(dofs.dof_count()), std::vector<Real>(contacts.size(), Real(0)));
    const auto add = [&](int coordinate, std::size_t l, const Real& value) {
        const int dof = dofs.dof_of(static_cast<std::size_t>(coordinate));
        if (dof >= 0) {
            h[static_cast<std::size_t>(dof)][l] += value;
        }
    };
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        if (c.kind == ContactKind::disk_disk) {
            const Real dx = Real(packing.coordinate(DiskId(c.j), 0)) - Real(packing.coordinate(DiskId(c.i), 0));
            const Real dy = Real(packing.coordinate(DiskId(c.j), 1)) - Real(packing.coordinate(DiskId(c.i), 1));
            const Real d = sqrt(dx * dx + dy * dy);
            add(2 * c.i, l, dx / d);
            add(2 * c.i + 1, l, dy / d);
            add(2 * c.j, l, -dx / d);
            add(2 * c.j + 1, l, -dy / d);
        } else if (c.kind == ContactKind::lower_wall) {
            add(2 * c.i + c.j, l, Real(-1));
        } else if (c.kind == ContactKind::upper_wall) {
            add(2 * c.i + c.j, l, Real(1));
            add(2 * packing.disk_count() + c.j, l, Real(-1));
        }
    }
    return h;
}

/// Inverse by Gauss-Jordan with partial pivoting; empty when singular to 80 digits.
Dense inverse(Dense a) {
    const std::size_t n = a.size();
    Dense b(n, std::vector<Real>(n, Real(0)));
    for (std::size_t i = 0; i < n; ++i) {
        b[i][i] = 1;
    }
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < n; ++i) {
            if (abs(a[i][k]) > abs(a[pivot][k])) {
                pivot = i;
            }
        }
        if (abs(a[pivot][k]) < Real("1e-80")) {
            return {};
        }
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        const Real scale = 1 / a[k][k];
        for (std::size_t j = 0; j < n; ++j) {
            a[k][j] *= scale;
            b[k][j] *= scale;
        }
        for (std::size_t i = 0; i < n; ++i) {
            if (i != k && a[i][k] != 0) {
                const Real factor = a[i][k];
                for (std::size_t j = 0; j < n; ++j) {
                    a[i][j] -= factor * a[k][j];
                    b[i][j] -= factor * b[k][j];
                }
            }
        }
    }
    return b;
}

/// A lower bound of |A|_2 that converges to it: power iteration on A^T A.
Real spectral_norm(const Dense& a, int iterations) {
    const std::size_t n = a.size();
    std::vector<Real> x(n, Real(1));
    for (std::size_t i = 0; i < n; ++i) {
        x[i] += Real(static_cast<int>(i % 7)) / 10;
    }
    Real norm = 0;
    for (int k = 0; k < iterations; ++k) {
        Real size = 0;
        for (const Real& c : x) {
            size += c * c;
        }
        size = sqrt(size);
        std::vector<Real> y(n, Real(0));
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                y[i] += a[i][j] * x[j] / size;
            }
        }
        norm = 0;
        for (const Real& c : y) {
            norm += c * c;
        }
        norm = sqrt(norm);
        std::fill(x.begin(), x.end(), Real(0));
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                x[j] += a[i][j] * y[i];
            }
        }
    }
    return norm;
}

/// Bounds of one structure against the reference; returns whether the inverse bound was proved.
bool check(const Packing<2>& packing, const std::vector<Contact>& contacts, const std::vector<double>& force) {
    auto proved = IsostaticStructure<2>::prove(packing, contacts);
    BOOST_TEST_REQUIRE(proved.ok());
    const IsostaticStructure<2>& structure = proved.value();
    const Factorisation factorisation(structure);
    InverseBoundCache cache;
    const InverseBound bound = bound_inverse(structure, factorisation, cache);
    const Dense reference = inverse(reference_matrix(packing, contacts));
    BOOST_TEST_REQUIRE(!reference.empty());
    if (bound.verdict != Verdict::proved) {
        return false;
    }
    const Real norm = spectral_norm(reference, 30);
    BOOST_TEST(Real(bound.sigma_min) * norm <= 1,
               "sigma_min " << bound.sigma_min << " above the true one " << 1 / norm.convert_to<double>());
    std::vector<Real> exact(force.size(), Real(0));
    for (std::size_t l = 0; l < exact.size(); ++l) {
        for (std::size_t i = 0; i < exact.size(); ++i) {
            exact[l] += reference[l][i] * Real(force[i]);
        }
    }
    ForceSolution solution = solve_forces(structure, factorisation, bound, force);
    const auto error = [&] {
        Real worst = 0;
        for (std::size_t l = 0; l < exact.size(); ++l) {
            const Real value = Real(solution.value[l]) + (solution.low.empty() ? Real(0) : Real(solution.low[l]));
            worst = std::max(worst, Real(abs(value - exact[l])));
        }
        return worst;
    };
    const Real in_double = error();
    BOOST_TEST(in_double <= Real(solution.bound), "double: error above the bound");
    const double double_bound = solution.bound;
    ForceLadder<2> ladder(packing, structure, factorisation, bound);
    const int part = ladder.add(force);
    BOOST_TEST_REQUIRE(ladder.climb());
    solution = ladder.solution(part);
    BOOST_TEST(error() <= Real(solution.bound),
               "double-double: error " << error().convert_to<double>() << " above the bound " << solution.bound);
    if (bound.sigma_min > 1e-10) {
        BOOST_TEST(solution.bound < 1e-8 * double_bound);
    }
    return true;
}

/// A free disk between two fixed ones whose directions differ from opposite by `angle`: sigma_min ~ angle / sqrt 2.
State<2> nearly_collinear(double angle) {
    State<2> state;
    state.packing.walls = Walls<2>::none();
    state.packing.radius = {1, 1, 1};
    state.packing.q = {-2, 0, 2 * std::cos(angle), 2 * std::sin(angle), 0, 0, 0, 0};
    state.packing.fixed = {1, 1, 0};
    state.contacts = {pair(0, 2), pair(1, 2)};
    return state;
}

} // namespace

BOOST_AUTO_TEST_SUITE(verified)

BOOST_AUTO_TEST_CASE(bounds_hold_on_prepared_packings) {
    for (const int n : {1, 2, 5, 12}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            PreparationOptions options;
            options.disks = n;
            options.seed = seed;
            PreparationReport<2> report;
            auto state = prepare<2>(options, report);
            if (!state.ok()) {
                BOOST_TEST_MESSAGE("n = " << n << ", seed " << seed << ": " << state.failure().message());
                continue;
            }
            const Packing<2>& packing = state.value().packing;
            BOOST_TEST(check(packing, state.value().contacts, state.value().load.external_force(packing)));
        }
    }
}

BOOST_AUTO_TEST_CASE(bounds_hold_near_singular_matrices) {
    int proved = 0;
    for (const double angle : {0.5, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13}) {
        const State<2> state = nearly_collinear(angle);
        proved += check(state.packing, state.contacts, {0.3, -1}) ? 1 : 0;
    }
    BOOST_TEST(proved >= 7); // by rows where the Cholesky route ends
}

BOOST_AUTO_TEST_CASE(an_exactly_collinear_strut_is_never_proved_regular) {
    State<2> state = nearly_collinear(0);
    state.packing.q = {-2, 0, 2, 0, 0, 0, 0, 0};
    const auto structure = IsostaticStructure<2>::prove(state.packing, state.contacts);
    BOOST_TEST_REQUIRE(!structure.ok());
    BOOST_TEST((structure.failure().kind == FailureKind::not_isostatic));
    // Tilted, it is singular as well, but not by its pattern.
    state.packing.q = {-2, -1, 2, 1, 0, 0, 0, 0};
    BOOST_TEST(!IsostaticStructure<2>::prove(state.packing, state.contacts).ok());
    state.packing.q[3] = std::nextafter(1.0, 2.0);
    BOOST_TEST(IsostaticStructure<2>::prove(state.packing, state.contacts).ok());
}

BOOST_AUTO_TEST_CASE(the_long_routes_to_a_bound_are_for_structures_that_may_be_regular) {
    const State<2> state = nearly_collinear(1e-10); // too near for the first route
    const auto structure = IsostaticStructure<2>::prove(state.packing, state.contacts);
    BOOST_TEST_REQUIRE(structure.ok());
    const Factorisation factorisation(structure.value());
    for (const bool worth : {false, true}) {
        InverseBoundCache cache;
        int asked = 0;
        const InverseBound bound = bound_inverse(structure.value(), factorisation, cache, [&] {
            ++asked;
            return worth;
        });
        BOOST_TEST(asked == 1);
        BOOST_TEST((bound.verdict == (worth ? Verdict::proved : Verdict::undecided)));
    }
}

BOOST_AUTO_TEST_CASE(the_true_vertex_lies_within_the_radius) {
    // Two disks: the true vertex is known in closed form.
    const State<2> state = two_disks(1, 2, 1, 1);
    auto proved = IsostaticStructure<2>::prove(state.packing, state.contacts);
    BOOST_TEST_REQUIRE(proved.ok());
    const Factorisation factorisation(proved.value());
    InverseBoundCache cache;
    const InverseBound bound = bound_inverse(proved.value(), factorisation, cache);
    const Real root2 = sqrt(Real(2));
    const std::vector<Real> exact{1, 1, 1 + 2 * root2, 2, 3 + 2 * root2, 4};
    for (const int way : {0, 1, 2}) {
        const bool extended = way == 2;
        const VertexEnclosure vertex =
            extended   ? enclose_vertex_double_double(state.packing, proved.value(), factorisation, bound)
            : way == 1 ? enclose_vertex(state.packing, proved.value(), factorisation, bound)
                       : enclose_vertex(state.packing, proved.value(), bound);
        BOOST_TEST_REQUIRE((vertex.verdict == Verdict::proved));
        Real square = 0;
        for (std::size_t k = 0; k < exact.size(); ++k) {
            const Real at =
                Real(state.packing.q[k]) + (vertex.correction.empty() ? Real(0) : Real(vertex.correction[k]));
            square += (at - exact[k]) * (at - exact[k]);
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
        State<2> moved = read_any_state<2>(ISOSTAT_TEST_DATA + std::string(file)).state;
        for (std::size_t k = 0; k < moved.packing.q.size(); ++k) {
            moved.packing.q[k] += push * std::sin(7.0 * static_cast<double>(k));
        }
        if (moved.packing.cell.any()) {
            snap_to_grid(moved.packing);
        }
        auto proved = IsostaticStructure<2>::prove(moved.packing, moved.contacts);
        BOOST_TEST_REQUIRE(proved.ok());
        const Factorisation factorisation(proved.value());
        InverseBoundCache cache;
        const InverseBound bound = bound_inverse(proved.value(), factorisation, cache);
        const VertexEnclosure step = enclose_vertex(moved.packing, proved.value(), factorisation, bound);
        const VertexEnclosure fine = enclose_vertex_double_double(moved.packing, proved.value(), factorisation, bound);
        BOOST_TEST_REQUIRE((step.verdict == Verdict::proved));
        BOOST_TEST_REQUIRE((fine.rung == Rung::double_double));
        double square = 0;
        for (const double c : fine.correction) {
            square += c * c;
        }
        BOOST_TEST(std::sqrt(square) <= step.radius + fine.radius);
        BOOST_TEST(step.radius < 1.6 * std::sqrt(square));
        BOOST_TEST(step.radius < 0.1 * enclose_vertex(moved.packing, proved.value(), bound).radius);
    }
}

BOOST_AUTO_TEST_CASE(forces_turn_with_their_contacts_within_the_bound_and_reach_a_good_part_of_it) {
    const State<2> state = read_state<2>(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state;
    const DofMap<2> dofs(state.packing);
    const sparse::Matrix<double> h = contact_matrix(state.packing, dofs, state.contacts);
    oracle::Random random(5);
    std::vector<double> x(state.contacts.size());
    for (double& c : x) {
        c = random.real(-1, 1);
    }
    x[7] = 20; // the worst disks are at one of its ends
    const double rate = turn_of_forces(state.packing, state.contacts, x);
    double largest = 0;
    const int disks = state.packing.disk_count();
    for (int trial = 0; trial < 4 * disks + 100; ++trial) {
        Packing<2> moved = state.packing;
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
    State<2> state = two_disks(1, 2, 1, 1);
    for (double& length : state.packing.q) {
        length *= 1 - 1e-12;
    }
    auto proved = IsostaticStructure<2>::prove(state.packing, state.contacts);
    BOOST_TEST_REQUIRE(proved.ok());
    const Factorisation factorisation(proved.value());
    InverseBoundCache cache;
    const InverseBound bound = bound_inverse(proved.value(), factorisation, cache);
    const VertexEnclosure vertex = enclose_vertex_double_double(state.packing, proved.value(), factorisation, bound);
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
    State<2> state = two_disks(1, 2, 1, 1);
    state.packing.q[2] += 0.1;
    auto proved = IsostaticStructure<2>::prove(state.packing, state.contacts);
    BOOST_TEST_REQUIRE(proved.ok());
    const Factorisation factorisation(proved.value());
    InverseBoundCache cache;
    const InverseBound bound = bound_inverse(proved.value(), factorisation, cache);
    BOOST_TEST((enclose_vertex(state.packing, proved.value(), bound).verdict == Verdict::undecided));
    BOOST_TEST((enclose_vertex(state.packing, proved.value(), factorisation, bound).verdict == Verdict::undecided));
}

BOOST_AUTO_TEST_SUITE_END()
