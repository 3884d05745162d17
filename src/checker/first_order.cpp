#include "checker/first_order.hpp"

#include "checker/at_wall.hpp"

namespace isostat::checker {

namespace {

Range component(const Problem& problem, const Velocities::Solution& v, std::size_t k) {
    return problem.dof_of[k] >= 0 ? Range::around(v.middle[k], v.radius) : Range(Rational(0));
}

/// d of two disks from the coordinates that `at` gives.
template <class At> PerAxis<Range> separate(const Row& row, At at) {
    PerAxis<Range> d;
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
        d[row.axis[k]] =
            d[row.axis[k]] + Range(Rational(row.sign[k])) * at(static_cast<std::size_t>(row.coordinate[k]));
    }
    return d;
}

} // namespace

namespace {

/// A v = b at the middle of the vertex in integers: v in multiples of 2^-shift, b of 2^(fine - shift).
struct FirstMotion {
    const Problem& problem;
    const Lengths& at;
    std::vector<Integer> target;
    std::vector<Integer> v; ///< per coordinate; 0 where it does not move

    [[nodiscard]] std::vector<Integer> residual() const {
        std::vector<Integer> result = target;
        Integer difference;
        Integer change;
        for (std::size_t l = 0; l < result.size(); ++l) {
            const Row& row = problem.rows[l];
            const auto coordinate = [&row](std::size_t k) { return static_cast<std::size_t>(row.coordinate[k]); };
            for (std::size_t a = 0; row.quadratic && a < problem.layout.axes(); ++a) {
                row.separate(at, a, difference);
                row.separate(v, a, change);
                result[l] -= difference * change;
            }
            for (std::size_t k = 0; !row.quadratic && k < static_cast<std::size_t>(row.count); ++k) {
                change = shifted_left(v[coordinate(k)], problem.weight_bits);
                row.sign[k] > 0 ? result[l] -= change : result[l] += change;
            }
        }
        return result;
    }
};

} // namespace

double Velocities::Solution::fastest() const {
    Rational most = 0;
    for (const Rational& component : middle) {
        most = std::max<Rational>(most, abs(component));
    }
    return most.get_d();
}

Velocities::Solution Velocities::solve(const std::vector<Rational>& b, const Rational& off) const {
    const Problem& problem = e_.problem;
    Solution result;
    result.middle.assign(problem.dof_of.size(), Rational(0));
    Rational largest = 0;
    for (const Rational& rate : b) {
        largest = std::max<Rational>(largest, abs(rate));
    }
    if (largest == 0 && off == 0) {
        return result;
    }
    // The fastest coordinate is above b / the largest entry of A: 120 bits below this are kept.
    const long scale = e_.solver->scale(problem);
    const long shift =
        // guess: bits of v' (checker.md K12)
        120 + scale + problem.fine - (largest == 0 ? 0 : bits(largest.get_num()) - bits(largest.get_den()));
    FirstMotion motion{problem, e_.vertex.middle, {}, std::vector<Integer>(problem.dof_of.size())};
    for (const Rational& rate : b) {
        motion.target.push_back(floor_of(rate, shift - problem.fine)); // off by less than one
    }
    std::vector<Integer> residual = motion.target;
    long size = bits(largest_of(residual));
    for (int step = 0; step < 20 && size > 0 && e_.solver->usable(); ++step) { // guess: refinements of v'
        Eigen::MatrixXd right(problem.contacts(), 1);
        for (int l = 0; l < problem.contacts(); ++l) {
            right(l, 0) = approximate(residual[static_cast<std::size_t>(l)], -size);
        }
        const Eigen::MatrixXd x = e_.solver->solve(right);
        for (int d = 0; d < problem.dofs(); ++d) {
            add_scaled(motion.v[static_cast<std::size_t>(problem.coordinate_of[static_cast<std::size_t>(d)])], x(d, 0),
                       size - scale);
        }
        residual = motion.residual();
        const long now = bits(largest_of(residual));
        if (now >= size) {
            break;
        }
        size = now;
    }
    const Rational open = dyadic(largest_of(residual) + 1, problem.fine - shift);
    const Rational fastest = dyadic(largest_of(motion.v), -shift);
    for (std::size_t k = 0; k < motion.v.size(); ++k) {
        result.middle[k] = dyadic(motion.v[k], -shift);
    }
    result.radius = short_above(e_.inverse.row_sum / (1 - e_.vertex.row_residual) *
                                (open + off + problem.row_curvature() * e_.vertex.radius * fastest));
    return result;
}

Velocities::Solution Velocities::opening(std::size_t contact, int direction) const {
    std::vector<Rational> b(static_cast<std::size_t>(e_.problem.contacts()));
    // F is the gap times the distance of the centres, or times the weight.
    b[contact] = e_.problem.force_factor(static_cast<int>(contact)) * direction;
    return solve(b);
}

Range Velocities::gap_rate(const Contact& pair, const Solution& v) const {
    const auto i = static_cast<std::size_t>(pair.i);
    const auto j = static_cast<std::size_t>(pair.j);
    if (pair.of_disks()) {
        const Row row(pair, e_.problem.layout);
        const auto x = separate(row, [&](std::size_t k) { return coordinate_at(e_.problem, e_.vertex, k); });
        const auto change = separate(row, [&](std::size_t k) { return component(e_.problem, v, k); });
        Range sum = x[0] * change[0];
        for (std::size_t a = 1; a < e_.problem.layout.axes(); ++a) {
            sum = sum + x[a] * change[a];
        }
        const Rational distance = Rational(e_.state.packing.radius[i]) + Rational(e_.state.packing.radius[j]);
        return sum / Range(distance);
    }
    return AtWall(pair, e_.problem.layout).distance([&](std::size_t k) { return component(e_.problem, v, k); });
}

/// |D v|^2: the contribution of the velocity to F'' of a pair of disks.
Range Velocities::turning(const Contact& pair, const Solution& v) const {
    if (!pair.of_disks()) {
        return Range(Rational(0));
    }
    const Row row(pair, e_.problem.layout);
    const auto change = separate(row, [&](std::size_t k) { return component(e_.problem, v, k); });
    Range sum = change[0] * change[0];
    for (std::size_t a = 1; a < e_.problem.layout.axes(); ++a) {
        sum = sum + change[a] * change[a];
    }
    return sum;
}

Range Velocities::bend(const Contact& pair, std::size_t opened, const Solution& v) const {
    const auto& contacts = e_.state.contacts;
    std::vector<Rational> b;
    Rational off = 0;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const bool grows = l == opened && contacts[l].of_disks(); // F'' = h'^2 + D h''
        const Range second = Range(Rational(grows ? 1 : 0)) - turning(contacts[l], v);
        b.push_back((second.lower + second.upper) / 2);
        off = std::max<Rational>(off, (second.upper - second.lower) / 2);
    }
    Range along = gap_rate(pair, solve(b, off));
    if (!pair.of_disks()) {
        return along;
    }
    const Range rate = gap_rate(pair, v);
    const Rational distance = Rational(e_.state.packing.radius[static_cast<std::size_t>(pair.i)]) +
                              Rational(e_.state.packing.radius[static_cast<std::size_t>(pair.j)]);
    return along + (turning(pair, v) - rate * rate) / Range(distance);
}

FirstOrder::FirstOrder(const Evidence& evidence, const std::vector<double>& rho)
    : e_(evidence), rho_(rho), velocities_(evidence) {
    std::vector<Rational> b;
    for (std::size_t l = 0; l < e_.state.contacts.size(); ++l) {
        const Contact& c = e_.state.contacts[l];
        b.push_back(c.kind == ContactKind::held ? Rational(0)
                                                : e_.problem.force_factor(static_cast<int>(l)) * grown(c));
    }
    change_ = velocities_.solve(b);
}

Rational FirstOrder::grown(const Contact& pair) const {
    Rational sum(rho_[static_cast<std::size_t>(pair.i)]);
    if (pair.of_disks()) {
        sum += Rational(rho_[static_cast<std::size_t>(pair.j)]);
    }
    return sum;
}

Range FirstOrder::gap(const Contact& pair) const {
    return velocities_.gap_rate(pair, change_) - Range(grown(pair));
}

std::vector<Range> FirstOrder::forces(const std::vector<Range>& f0) const {
    Forces load(static_cast<std::size_t>(e_.problem.dofs()));
    const auto add = [&](std::size_t coordinate, const Range& value) {
        const int dof = e_.problem.dof_of[coordinate];
        if (dof >= 0) {
            load.set(static_cast<std::size_t>(dof), load[static_cast<std::size_t>(dof)] + value);
        }
    };
    for (std::size_t l = 0; l < e_.state.contacts.size(); ++l) {
        const Contact& c = e_.state.contacts[l];
        if (!c.of_disks()) {
            continue;
        }
        const Range g = f0[l] / Range(e_.problem.force_factor(static_cast<int>(l)));
        const Row& row = e_.problem.rows[l];
        const auto turn = separate(row, [&](std::size_t k) { return component(e_.problem, change_, k); });
        for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
            add(static_cast<std::size_t>(row.coordinate[k]), Range(Rational(row.sign[k])) * g * turn[row.axis[k]]);
        }
    }
    if (e_.state.load.kind == LoadKind::true_stress) { // the force of a wall depends on the other lengths
        const Layout& layout = e_.problem.layout;
        for (std::size_t a = 0; a < layout.axes(); ++a) {
            const Range stress(-stress_of(e_.state.load, a));
            for (std::size_t b = 0; b < layout.axes(); ++b) {
                if (a != b) {                        // the third length, in space
                    const std::size_t c = 3 - a - b; // exact: the third of the axes 0, 1, 2
                    const Range third = layout.dimension == plane
                                            ? Range(Rational(1))
                                            : coordinate_at(e_.problem, e_.vertex, layout.of_length(c));
                    add(layout.of_length(a), stress * third * component(e_.problem, change_, layout.of_length(b)));
                }
            }
        }
    }
    std::vector<Range> f1 = contact_forces(e_.problem, *e_.solver, e_.inverse, e_.vertex, load);
    for (std::size_t l = 0; l < f1.size(); ++l) {
        const Contact& c = e_.state.contacts[l];
        if (c.of_disks()) { // f = g (R_i + R_j), and the radii grow
            f1[l] = f1[l] + f0[l] / Range(e_.problem.force_factor(static_cast<int>(l))) * Range(grown(c));
        }
    }
    return f1;
}

} // namespace isostat::checker
