#include "checker/vertex.hpp"

namespace isostat::checker {

namespace {

/// A configuration, and the largest magnitude of its `twice_residuals`.
struct Guess {
    Lengths q;
    Integer largest;
    Integer moved; ///< the largest magnitude of what coordinates are from the stored ones

    template <class Number>
    Guess(const Problem& problem, const std::vector<Number>& at, const std::vector<Product<Number>>& residual)
        : q(at), largest(largest_of(residual)) {
        std::vector<Number> way = at;
        for (std::size_t k = 0; k < at.size(); ++k) {
            way[k] -= problem.stored.in<Number>()[k];
        }
        moved = largest_of(way);
    }
};

/// Newton steps with the factorisation at the stored configuration and exact residuals. Nothing: the way is too long.
template <class Number> std::optional<Guess> improved(const Problem& problem, const Solver& solver) {
    constexpr int most_steps = 40; // guess: Newton steps
    std::vector<Number> q = problem.stored.in<Number>();
    long size = -1;
    // cost: a residual of some units is not refined
    const long rounding = problem.sum.most_bits() + 3; // bits of the residual where a coordinate is off by some units
    static thread_local std::vector<Product<Number>> residual; // memory that serves one vertex after the other
    for (int step = 0;; ++step) {
        Eigen::MatrixXd b(problem.contacts(), 1);
        residual = problem.twice_residuals(q, std::move(residual));
        const long now = most_bits(residual);
        if (step == most_steps || now <= rounding || (size >= 0 && now >= size)) {
            return Guess(problem, q, residual);
        }
        size = now;
        for (int l = 0; l < problem.contacts(); ++l) {
            b(l, 0) = approximate(residual[static_cast<std::size_t>(l)], -now);
        }
        // F = residual / 2, A = 2^scale times the factorised matrix.
        const Eigen::MatrixXd x = solver.solve(b);
        for (int k = 0; k < problem.dofs(); ++k) {
            if (!add_scaled(q[static_cast<std::size_t>(problem.coordinate_of[static_cast<std::size_t>(k)])], -x(k, 0),
                            now - 1 - solver.scale(problem), problem.length_bits + 1)) {
                return {};
            }
        }
    }
}

template <class Number> std::optional<Guess> guess(const Problem& problem, const Solver& solver, bool at_stored) {
    if (!at_stored) {
        return improved<Number>(problem, solver);
    }
    const std::vector<Number>& q = problem.stored.in<Number>();
    return Guess(problem, q, problem.twice_residuals(q));
}

} // namespace

namespace {

// checker.md K28, a row residual that is asked for and taken
const Rational around_error(1, 16); // |R A v| <= (1 + |I - R A|) |v|

} // namespace

TrueVertex find_vertex(const Problem& problem, const Solver& solver, const InverseBound& inverse,
                       const Rational& around) {
    TrueVertex vertex;
    const Rational slope = problem.row_curvature() * inverse.quadratic_sum;
    for (const bool at_stored : {false, true}) {
        if (!at_stored && !solver.usable()) {
            continue;
        }
        std::optional<Guess> start = problem.stored.narrow() ? guess<Wide>(problem, solver, at_stored)
                                                             : guess<Integer>(problem, solver, at_stored);
        if (!start) {
            continue;
        }
        const Rational largest(start->largest);
        const Rational moved = problem.length(start->moved);
        const Rational error = inverse.residual_row + slope * moved;
        const Rational step =
            inverse.row_sum * largest * power_of_two(2 * problem.fine - 1) + (1 + around_error) * around;
        const Rational room = 1 - error;
        if (room <= 0) {
            continue;
        }
        vertex.middle = std::move(start->q);
        vertex.radius = short_above(2 * step / room);
        vertex.moved_least = std::max<Rational>(0, moved - vertex.radius);
        vertex.moved_most = moved + vertex.radius;
        vertex.row_residual = inverse.residual_row + slope * vertex.moved_most;
        vertex.column_residual =
            inverse.residual_column + inverse.column_sum_max * Rational(problem.column_curvature()) * vertex.moved_most;
        // K4 with radius 2 step / room: a row residual below 1 on all of the cube is 2 slope step < room^2.
        vertex.found = vertex.row_residual < 1 && vertex.column_residual < 1 &&
                       (around == 0 || vertex.row_residual < around_error);
        if (vertex.found) {
            return vertex;
        }
    }
    return vertex;
}

Range coordinate_at(const Problem& problem, const TrueVertex& vertex, std::size_t k) {
    return Range::around(problem.length(vertex.middle[k]), problem.dof_of[k] >= 0 ? vertex.radius : Rational(0));
}

bool unique_within(const InverseBound& inverse, const TrueVertex& vertex, const Rational& distance) {
    return !inverse.regular_within || (vertex.moved_most + distance) / 2 < *inverse.regular_within;
}

double largest_unique_distance(const InverseBound& inverse, const TrueVertex& vertex) {
    if (!inverse.regular_within) {
        return std::numeric_limits<double>::infinity();
    }
    const Rational limit = 2 * *inverse.regular_within - vertex.moved_most;
    return std::max(0.0, rounded_down(limit * (1 - power_of_two(-40)))); // checker.md K5 (rounded down)
}

} // namespace isostat::checker
