#include "checker/vertex.hpp"

namespace isostat::checker {

namespace {

/// Newton steps with the factorisation at the stored configuration and exact residuals. `largest`: of those at the end.
std::vector<Integer> improved(const Problem& problem, const Solver& solver, Integer& largest) {
    std::vector<Integer> q = problem.stored;
    long size = -1;
    long rounding = 0; // bits of the residual where a coordinate is off by some units
    for (const Integer& length : problem.sum) {
        rounding = std::max(rounding, bits(length) + 3);
    }
    static thread_local std::vector<Integer> residual; // memory that serves one vertex after the other
    for (int step = 0;; ++step) {
        Eigen::MatrixXd b(problem.contacts(), 1);
        residual = problem.twice_residuals(q, std::move(residual));
        largest = largest_of(residual);
        const long now = bits(largest);
        if (step == 40 || now <= rounding || (size >= 0 && now >= size)) {
            return q;
        }
        size = now;
        for (int l = 0; l < problem.contacts(); ++l) {
            b(l, 0) = approximate(residual[static_cast<std::size_t>(l)], -now);
        }
        // F = residual / 2, A = 2^scale times the factorised matrix.
        const Eigen::MatrixXd x = solver.solve(b);
        for (int k = 0; k < problem.dofs(); ++k) {
            add_scaled(q[static_cast<std::size_t>(problem.coordinate_of[static_cast<std::size_t>(k)])], -x(k, 0),
                       now - 1 - solver.scale(problem));
        }
    }
}

Integer largest_move(const Problem& problem, const std::vector<Integer>& q) {
    Integer most = 0;
    Integer move;
    for (std::size_t k = 0; k < q.size(); ++k) {
        move = q[k] - problem.stored[k];
        if (mpz_cmpabs(move.get_mpz_t(), most.get_mpz_t()) > 0) {
            most = move;
        }
    }
    return abs(most);
}

} // namespace

namespace {

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
        Integer residual;
        std::vector<Integer> start = at_stored ? problem.stored : improved(problem, solver, residual);
        const Rational largest(at_stored ? largest_of(problem.twice_residuals(start)) : residual);
        const Rational moved = problem.length(largest_move(problem, start));
        const Rational error = inverse.residual_row + slope * moved;
        const Rational step =
            inverse.row_sum * largest * power_of_two(2 * problem.fine - 1) + (1 + around_error) * around;
        const Rational room = 1 - error;
        if (room <= 0) {
            continue;
        }
        vertex.middle = std::move(start);
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

bool unique_within(const InverseBound& inverse, const TrueVertex& vertex, const Rational& distance) {
    return !inverse.regular_within || (vertex.moved_most + distance) / 2 < *inverse.regular_within;
}

double largest_unique_distance(const InverseBound& inverse, const TrueVertex& vertex) {
    if (!inverse.regular_within) {
        return std::numeric_limits<double>::infinity();
    }
    const Rational limit = 2 * *inverse.regular_within - vertex.moved_most;
    return std::max(0.0, rounded_down(limit * (1 - power_of_two(-40))));
}

} // namespace isostat::checker
