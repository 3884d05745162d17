// Bounds against the formulas of proofs/bounds.md and proofs/exchange.md, evaluated to 200 digits: never below them and
// hardly above, also where the error itself stays far below. And bounds where the error comes near them.
#include "oracle/random.hpp"
#include "oracle/truth.hpp"
#include "support/crafted.hpp"
#include "support/free_grains.hpp"
#include "support/regular.hpp"
#include "support/scale.hpp"
#include "support/scratch.hpp"
#include "verified/configuration.hpp"
#include "verified/first_order.hpp"
#include "verified/force_solution.hpp"
#include "verified/norm.hpp"
#include "verified/singular_value.hpp"
#include "verified/vertex_bounds.hpp"

#include <isostat/io/state_file.hpp>

using namespace isostat;
using namespace crafted;

namespace {

using oracle::Real;
const Real u = Real(1) / Real(9007199254740992.0);

/// value is at least `least`, and above it by no more than the relative `slack`.
void check_above(double value, const Real& least, double slack) {
    BOOST_TEST(Real(value) >= least, value << " is below " << least.convert_to<double>());
    BOOST_TEST(Real(value) <= least * Real(1 + slack), value << " is far above " << least.convert_to<double>());
}

Real norm_of(const std::vector<Real>& x) {
    Real square = 0;
    for (const Real& c : x) {
        square += c * c;
    }
    return sqrt(square);
}

State sample(const char* name = "vertex100.txt") {
    return read_state(std::string(ISOSTAT_TEST_DATA) + "/" + name).state;
}

struct Known : Regular {
    explicit Known(State s) : Regular(std::move(s)) { BOOST_REQUIRE((inverse.verdict == Verdict::proved)); }
};

/// K of V4 (a).
Real lipschitz_of(const State& state) {
    std::vector<int> count(state.packing.radius.size(), 0);
    Real smallest = -1;
    for (const Contact& c : state.contacts) {
        if (c.kind == ContactKind::disk_disk) {
            ++count[static_cast<std::size_t>(c.i)];
            ++count[static_cast<std::size_t>(c.j)];
            const Real d = Real(state.packing.radius[static_cast<std::size_t>(c.i)]) +
                           Real(state.packing.radius[static_cast<std::size_t>(c.j)]);
            smallest = smallest < 0 || d < smallest ? d : smallest;
        }
    }
    return 2 * sqrt(Real(*std::ranges::max_element(count))) / smallest;
}

/// |F|_2 of T9.
Real residual_of(const State& state) {
    std::vector<Real> f;
    const auto at = [&](int k) { return Real(state.packing.q[static_cast<std::size_t>(k)]); };
    for (const Contact& c : state.contacts) {
        const Real r = Real(state.packing.radius[static_cast<std::size_t>(c.i)]);
        if (c.kind == ContactKind::disk_disk) {
            const Real dx = at(2 * c.j) - at(2 * c.i);
            const Real dy = at(2 * c.j + 1) - at(2 * c.i + 1);
            const Real d = r + Real(state.packing.radius[static_cast<std::size_t>(c.j)]);
            f.push_back((dx * dx + dy * dy - d * d) / (2 * d));
        } else {
            const Real x = at(2 * c.i + c.j);
            f.push_back((c.kind == ContactKind::lower_wall ? x : at(2 * state.packing.disk_count() + c.j) - x) - r);
        }
    }
    return norm_of(f);
}

/// A free disk of radius `free` between two fixed ones of radius 1, which are opposite up to `angle`; all turned by
/// `tilt`. Singular values: some angle / sqrt 2, and sqrt 2.
State between_two(double angle, double tilt, double free = 1) {
    const double d = 1 + free;
    return without_walls::held_by_two({1, 1, free}, {-d * std::cos(tilt), -d * std::sin(tilt),
                                                     d * std::cos(tilt + angle), d * std::sin(tilt + angle), 0, 0});
}

/// The unit vector from disk k to disk 2 at its place plus `shift`: the gradient of their gap.
std::array<Real, 2> gradient(const State& state, std::size_t k, const std::array<Real, 2>& shift) {
    std::array<Real, 2> n;
    for (std::size_t a = 0; a < 2; ++a) {
        n[a] = Real(state.packing.q[4 + a]) + shift[a] - Real(state.packing.q[2 * k + a]);
    }
    const Real length = sqrt(n[0] * n[0] + n[1] * n[1]);
    return {n[0] / length, n[1] / length};
}

/// The velocity of disk 2 at which its gap to disk 0 grows at unit rate and that to disk 1 stays.
std::array<Real, 2> motion(const State& state, const std::array<Real, 2>& shift = {0, 0}) {
    const auto a = gradient(state, 0, shift);
    const auto b = gradient(state, 1, shift);
    const Real determinant = a[0] * b[1] - a[1] * b[0];
    return {b[1] / determinant, -b[0] / determinant};
}

/// The smallest singular value of the 2 x 2 matrix of disk 2 and its two contacts.
Real smaller_singular_value(const State& state) {
    const auto a = gradient(state, 0, {0, 0});
    const auto b = gradient(state, 1, {0, 0});
    const Real product = a[0] * b[0] + a[1] * b[1]; // eigenvalues of A A^T: 1 + product, 1 - product
    return sqrt(1 - abs(product));
}

} // namespace

BOOST_AUTO_TEST_CASE(norms_are_rounded_up_whatever_their_length_and_range) {
    oracle::Random random(3);
    for (const std::size_t size : {1U, 2U, 7U, 1000U, 100000U}) {
        for (const double scale : {1.0, 0x1p-600, 0x1p600}) {
            std::vector<double> x(size);
            Real square = 0;
            for (double& c : x) {
                c = scale * random.real(-1, 1);
                square += Real(c) * Real(c);
            }
            check_above(norm_above(x), sqrt(square), 2e-10);
        }
    }
}

BOOST_AUTO_TEST_CASE(rounding_of_entries_is_that_of_V1) {
    for (const State& state : {sample(), two_disks(1, 2, 1, 1), between_two(0.3, 0.7)}) {
        const sparse::Matrix<double> h = contact_matrix(state.packing, DofMap(state.packing), state.contacts);
        std::vector<Real> row(static_cast<std::size_t>(h.rows), Real(0));
        Real most = 0;
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            Real column = 0;
            for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
                column += abs(Real(h.value[e]));
                row[static_cast<std::size_t>(h.row[e])] += abs(Real(h.value[e]));
            }
            most = std::max(most, column);
        }
        check_above(rounding_of_entries(h, state.packing.dimension),
                    5 * u * sqrt(most * *std::ranges::max_element(row)), 0.01);
    }
}

BOOST_AUTO_TEST_CASE(what_the_entries_lack_is_taken_off_the_singular_value) {
    oracle::Random random(4);
    for (int trial = 0; trial < testing::scaled(1000); ++trial) {
        const double square = std::pow(10.0, random.real(-30, 0));
        const double entry_error = std::sqrt(square) * random.real(0, 1.5);
        const Real exact = sqrt(Real(square)) - Real(entry_error);
        const double bound = smallest_singular_value(square, entry_error);
        BOOST_TEST(Real(bound) <= exact);
        BOOST_TEST(Real(bound) >= exact - 8 * u * sqrt(Real(square)));
    }
    BOOST_TEST(!(smallest_singular_value(-1, 0) > 0));
    BOOST_TEST(!(smallest_singular_value(0, 0) > 0));
}

BOOST_AUTO_TEST_CASE(rates_of_change_are_those_of_V4_and_V6) {
    oracle::Random random(5);
    for (const State& state : {sample(), two_disks(1, 2, 1, 1), three_disks(1, 1.1, 1.3, 1, 1)}) {
        const Known known(state);
        const Real k = lipschitz_of(state);
        check_above(lipschitz(state.packing, state.contacts), k, 1e-12);
        check_above(normal_rate(state.packing, state.contacts), k / Real("0.99"), 0.011);
        const VertexEnclosure vertex =
            enclose_vertex(state.packing, known.structure, known.factorisation, known.inverse);
        check_above(vertex.lipschitz, k, 1e-12);
        std::vector<double> x(state.contacts.size());
        std::vector<Real> weight(state.packing.radius.size(), Real(0));
        for (std::size_t l = 0; l < x.size(); ++l) {
            x[l] = random.real(-1, 1);
            const Contact& c = state.contacts[l];
            if (c.kind == ContactKind::disk_disk) {
                const Real w = abs(Real(x[l])) / Real(target(state.packing, c));
                weight[static_cast<std::size_t>(c.i)] += w;
                weight[static_cast<std::size_t>(c.j)] += w;
            }
        }
        const Real heaviest = *std::ranges::max_element(weight);
        check_above(turn_of_forces(state.packing, state.contacts, x), 2 * heaviest / Real("0.99"), 0.02);
    }
}

BOOST_AUTO_TEST_CASE(rates_of_change_in_cells_are_those_of_C5) {
    // w^2 = 2 + |m|^2 of a pair, |m|^2 of a disk and its own image; the cell is a place of its own, where contacts with
    // images meet.
    oracle::Random random(6);
    for (const char* name : {"tilt", "rect", "channel"}) {
        const State state = read_any_state(scratch::data(std::string("cells/") + name + "_16.json")).state;
        const std::size_t disks = state.packing.radius.size();
        std::vector<Real> fourth(disks + 1, Real(0));
        std::vector<Real> turn(disks + 1, Real(0));
        std::vector<double> x;
        for (const Contact& c : state.contacts) {
            x.push_back(random.real(-1, 1));
            if (c.kind != ContactKind::disk_disk) {
                continue;
            }
            const Real m2 = c.image.m[0] * c.image.m[0] + c.image.m[1] * c.image.m[1];
            const Real m = sqrt(m2);
            const bool own = c.i == c.j;
            const Real d = target(state.packing, c);
            const Real w2 = (own ? 0 : 2) + m2;
            const Real part = abs(Real(x.back())) / d;
            for (const int i : {c.i, c.j}) {
                fourth[static_cast<std::size_t>(i)] += own ? Real(0) : Real(w2 * w2 / (d * d));
                turn[static_cast<std::size_t>(i)] += own ? Real(0) : Real(part * (2 + m));
            }
            fourth[disks] += m2 == 0 ? Real(0) : Real(w2 * w2 / (d * d));
            turn[disks] += part * m * ((own ? 0 : 2) + m);
        }
        const auto largest = [](const std::vector<Real>& v) { return *std::ranges::max_element(v); };
        check_above(lipschitz(state.packing, state.contacts), sqrt(largest(fourth)), 1e-8);
        check_above(turn_of_forces(state.packing, state.contacts, x), largest(turn) / Real("0.99"), 0.03);
    }
}

BOOST_AUTO_TEST_CASE(residuals_of_forces_are_counted_as_V3_says) {
    const Known known(sample());
    const std::vector<double> force = known.state.load.external_force(known.state.packing);
    const ForceSolution solution = solve_forces(known.structure, known.factorisation, known.inverse, force);
    const sparse::Matrix<double>& h = known.structure.matrix();
    std::vector<Real> size, residual;
    std::vector<int> terms(force.size(), 0);
    for (const double f : force) {
        size.push_back(abs(Real(f)));
        residual.emplace_back(f);
    }
    for (std::size_t l = 0; l < solution.value.size(); ++l) {
        for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
            const auto i = static_cast<std::size_t>(h.row[e]);
            const Real term = Real(h.value[e]) * Real(solution.value[l]);
            size[i] += abs(term);
            residual[i] -= term;
            ++terms[i];
        }
    }
    std::vector<Real> rounding;
    for (std::size_t i = 0; i < size.size(); ++i) {
        rounding.push_back((terms[i] + Real("6.01")) * u * size[i]);
    }
    check_above(solution.bound * known.inverse.sigma_min, norm_of(rounding), 0.2);
    BOOST_TEST(norm_of(residual) < norm_of(rounding)); // so the 20 % are not the residual's
}

BOOST_AUTO_TEST_CASE(a_vertex_is_proved_up_to_the_quarter_of_Kantorovich_and_not_beyond) {
    const State state = pushed(sample(), 1e-12);
    const Known known(state);
    const Real k = lipschitz_of(state);
    const VertexEnclosure first = enclose_vertex(state.packing, known.structure, known.factorisation, known.inverse);
    BOOST_TEST_REQUIRE((first.verdict == Verdict::proved));
    std::vector<Real> step;
    for (const double s : first.step) {
        step.emplace_back(s);
    }
    const Real length = norm_of(step);
    const Real residual = residual_of(state);
    for (const double h : {0.02, 0.1, 0.2, 0.24, 0.2501, 0.3, 0.5, 0.99}) {
        // A worse bound of the inverse is a bound too: h = beta K eta is what it is made to be.
        InverseBound worse = known.inverse;
        worse.sigma_min = (k * length / Real(h)).convert_to<double>(); // eta > |p|
        const VertexEnclosure by_step = enclose_vertex(state.packing, known.structure, known.factorisation, worse);
        BOOST_TEST((by_step.verdict == Verdict::proved) == (h < 0.25), h);
        if (h < 0.25) {
            check_above(by_step.radius, length * (1 + Real(h) / 2), 0.2);
            check_above(by_step.step_radius, length * Real(h), 1);
        }
        worse.sigma_min = sqrt(k * residual / Real(h)).convert_to<double>(); // eta = beta |F|
        const VertexEnclosure plain = enclose_vertex(state.packing, known.structure, worse);
        BOOST_TEST((plain.verdict == Verdict::proved) == (h < 0.25), h);
        if (h < 0.25) {
            check_above(plain.radius, 2 * residual / Real(worse.sigma_min), 0.05);
        }
    }
}

BOOST_AUTO_TEST_CASE(what_a_newton_step_leaves_is_counted_as_V4_says) {
    // Pushed so far that the stored normals are not those of F: rho >= w |G| |p|, eta = |p| + beta rho.
    const State state = pushed(sample(), 1e-7);
    const Known known(state);
    const VertexEnclosure vertex = enclose_vertex(state.packing, known.structure, known.factorisation, known.inverse);
    BOOST_TEST_REQUIRE((vertex.verdict == Verdict::proved));
    const sparse::Matrix<double>& h = known.structure.matrix();
    Real worst = 0;
    std::vector<Real> left, step;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        Real size = 0;
        for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
            size += abs(Real(h.value[e]) * Real(vertex.step[static_cast<std::size_t>(h.row[e])]));
        }
        left.push_back(size);
        step.emplace_back(vertex.step[l]);
        if (state.contacts[l].kind == ContactKind::disk_disk) {
            const Real ratio =
                Real(gap(state.packing, state.contacts[l])) / Real(target(state.packing, state.contacts[l]));
            worst = std::max(worst, Real(abs(ratio)));
        }
    }
    const Real beta = (1 + 2 * worst) / Real(known.inverse.sigma_min);
    const Real rest = beta * worst * norm_of(left);
    const Real eta = norm_of(step) + rest;
    const Real product = beta * lipschitz_of(state) * eta;
    BOOST_TEST((rest > product * eta / 50)); // so that its absence would be seen
    check_above(vertex.step_radius, (rest + product * eta) * (1 - Real("1e-6")), 0.01);
    check_above(vertex.radius, eta * (1 + product) * (1 - Real("1e-6")), 0.01);
    // Gaps that are exactly 0: what remains is 2^-98 D of each.
    const State exact = without_walls::held_by_two({3, 3, 2}, {-3, 0, 3, 0, 0, 4});
    const Known at(exact);
    const VertexEnclosure here = enclose_vertex(exact.packing, at.structure, at.factorisation, at.inverse);
    BOOST_TEST_REQUIRE((here.verdict == Verdict::proved));
    check_above(here.radius, sqrt(Real(2)) * 5 * Real(0x1p-98) / Real(at.inverse.sigma_min), 0.01);
}

BOOST_AUTO_TEST_CASE(the_rounding_of_a_factorisation_is_taken_off_the_shift) {
    // The shift is half of the smallest eigenvalue, and V1 takes E off: 2 gamma_8 of each of two rows, 32 u, where the
    // code may take a smaller one, row by row.
    for (const double angle : {3e-7, 4e-7, 1e-6}) {
        const Known known(between_two(angle, 0.6));
        BOOST_TEST((known.inverse.route == InverseBound::Route::cholesky));
        const Real sigma = smaller_singular_value(known.state);
        const Real bound = known.inverse.sigma_min;
        BOOST_TEST(bound * bound <= sigma * sigma / 2 - 16 * u);
        BOOST_TEST(bound * bound >= sigma * sigma / 2 - 64 * u);
    }
}

BOOST_AUTO_TEST_CASE(a_bound_is_carried_less_the_change_of_the_kept_rows) {
    // Disk 2 between two fixed ones is pushed towards their line: half of its singular value is lost, as V8 says. The
    // contact exchanged is another disk's, between three fixed ones far away.
    for (const double angle : {1e-1, 1e-2, 1e-3}) {
        State state = between_two(angle, 0);
        auto& q = state.packing.q;
        const double c = std::cos(0.9);
        const double s = std::sin(0.9);
        q.insert(q.end() - 2, {18, 0, 20 + 2 * c, 2 * s, 20 + 2 * c, -2 * s, 20, 0});
        state.packing.radius.insert(state.packing.radius.end(), {1, 1, 1, 1});
        state.packing.fixed.insert(state.packing.fixed.end(), {1, 1, 1, 0});
        state.contacts.insert(state.contacts.end(), {pair(3, 6), pair(4, 6)});
        const Known known(state);
        InverseBound bound = known.inverse; // disk 6 has larger ones
        bound.sigma_min = smaller_singular_value(state).convert_to<double>() * (1 - 1e-12);
        State moved = state;
        moved.packing.q[5] = 0.5 * std::tan(angle / 2) * 2;
        const auto next =
            required(IsostaticStructure::exchange(known.structure, moved.packing, ContactId(3), pair(5, 6)));
        const ApproximateInverse& before = known.factorisation.approximate();
        const auto carried = required(
            carry_bound(known.structure, bound, next, before.exchanged(3, next.matrix()), before.mechanism(3)));
        const double left = smaller_singular_value(moved).convert_to<double>();
        BOOST_TEST(left < 0.51 * bound.sigma_min);
        BOOST_TEST(carried.bound.sigma_min <= left);
        BOOST_TEST(carried.bound.sigma_min >= 0.95 * left);
    }
}

BOOST_AUTO_TEST_CASE(motions_are_known_to_the_rounding_of_their_residual) {
    oracle::Random random(8);
    VertexEnclosure here; // the stored place is the true one
    here.verdict = Verdict::proved;
    for (int trial = 0; trial < testing::scaled(300); ++trial) {
        const State state = between_two(std::pow(10.0, random.real(-4, -1)), random.real(0, std::numbers::pi));
        const Known known(state);
        const std::vector<double> rho(3, 0.0);
        const FirstOrder first(state.packing, known.structure, known.factorisation, known.inverse, here, rho);
        const auto exact = motion(state);
        for (const std::size_t a : {0U, 1U}) {
            const Enclosure v = first.rate(ContactId(0), 1, {ContactKind::held, static_cast<int>(4 + a), 0});
            BOOST_TEST(abs(Real(v.value) - exact[a]) <= Real(v.radius));
            BOOST_TEST(v.radius * known.inverse.sigma_min < 1e-13 * (std::abs(v.value) + 1) / known.inverse.sigma_min);
        }
    }
}

BOOST_AUTO_TEST_CASE(rates_of_gaps_turn_with_the_line_of_a_small_pair) {
    // The true vertex is anywhere within 1e-9: the line between two disks of 1e-3 turns by far more than the contacts.
    oracle::Random random(9);
    constexpr double away = 1e-9;
    VertexEnclosure near;
    near.verdict = Verdict::proved;
    near.radius = away;
    double largest = 0;
    for (int trial = 0; trial < testing::scaled(300); ++trial) {
        State state = between_two(random.real(0.8, 2), random.real(0, std::numbers::pi), 1e-3);
        const double place = random.real(0, 2 * std::numbers::pi);
        auto& q = state.packing.q;
        q.insert(q.end() - 2, {2.5e-3 * std::cos(place), 2.5e-3 * std::sin(place)});
        state.packing.radius.push_back(1e-3);
        state.packing.fixed.push_back(1);
        const Known known(state);
        const std::vector<double> rho(4, 0.0);
        const FirstOrder first(state.packing, known.structure, known.factorisation, known.inverse, near, rho);
        const Enclosure rate = first.rate(ContactId(0), 1, pair(2, 3));
        const double direction = random.real(0, 2 * std::numbers::pi);
        const std::array<Real, 2> shift{away * std::cos(direction), away * std::sin(direction)};
        const auto v = motion(state, shift);
        const auto n = gradient(state, 3, shift);
        const Real off = abs(n[0] * v[0] + n[1] * v[1] - Real(rate.value));
        BOOST_TEST(off <= Real(rate.radius));
        largest = std::max(largest, (off / Real(rate.radius)).convert_to<double>());
    }
    BOOST_TEST(largest > 0.1);
}
