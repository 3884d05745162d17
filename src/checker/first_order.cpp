#include "checker/first_order.hpp"

namespace isostat::checker {

namespace {

Range component(const Problem& problem, const Velocities::Solution& v, std::size_t k) {
    return problem.dof_of[k] >= 0 ? Range::around(v.middle[k], v.radius) : Range(Rational(0));
}

Range place(const Problem& problem, const TrueVertex& vertex, std::size_t k) {
    return Range::around(problem.length(vertex.middle[k]), problem.dof_of[k] >= 0 ? vertex.radius : Rational(0));
}

} // namespace

Velocities::Velocities(const Problem& problem, const InverseBound& inverse, const TrueVertex& vertex)
    : problem_(problem), inverse_(inverse), vertex_(vertex), solver_(problem) {}

Velocities::Solution Velocities::solve(const std::vector<Rational>& b) const {
    Solution v;
    v.middle.assign(problem_.dof_of.size(), Rational(0));
    const Rational unit = power_of_two(problem_.fine);
    std::vector<Rational> residual = b;
    Rational worst = -1;
    for (int step = 0; step < 6; ++step) {
        Rational size = 0;
        for (const Rational& r : residual) {
            size = std::max<Rational>(size, abs(r));
        }
        if (size == 0 || !solver_.usable() || (worst >= 0 && 2 * size >= worst)) {
            break;
        }
        worst = size;
        Eigen::MatrixXd right(problem_.contacts(), 1);
        for (int l = 0; l < problem_.contacts(); ++l) {
            right(l, 0) = Rational(residual[static_cast<std::size_t>(l)] / size).get_d();
        }
        const Eigen::MatrixXd x = solver_.solve(right);
        const Rational factor = size * power_of_two(-solver_.scale() - problem_.fine);
        for (int d = 0; d < problem_.dofs(); ++d) {
            if (std::isfinite(x(d, 0))) {
                v.middle[static_cast<std::size_t>(problem_.coordinate_of[static_cast<std::size_t>(d)])] +=
                    Rational(x(d, 0)) * factor;
            }
        }
        for (int l = 0; l < problem_.contacts(); ++l) {
            const Row& row = problem_.rows[static_cast<std::size_t>(l)];
            Rational sum = 0;
            for (int k = 0; k < row.count; ++k) {
                const auto c = static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)]);
                if (problem_.dof_of[c] >= 0) {
                    sum += Rational(problem_.entry(l, k, vertex_.middle)) * v.middle[c];
                }
            }
            residual[static_cast<std::size_t>(l)] = b[static_cast<std::size_t>(l)] - unit * sum;
        }
    }
    Rational open = 0;
    Rational fastest = 0;
    for (const Rational& r : residual) {
        open = std::max<Rational>(open, abs(r));
    }
    for (const Rational& c : v.middle) {
        fastest = std::max<Rational>(fastest, abs(c));
    }
    v.radius =
        short_above(inverse_.row_sum / (1 - vertex_.row_residual) * (open + row_curvature * vertex_.radius * fastest));
    return v;
}

Velocities::Solution Velocities::opening(std::size_t contact, int direction) const {
    std::vector<Rational> b(static_cast<std::size_t>(problem_.contacts()));
    // F is the gap times its distance of centres, or times the weight.
    b[contact] = problem_.force_factor(static_cast<int>(contact)) * direction;
    return solve(b);
}

Range Velocities::gap_rate(const State<2>& state, const Contact& pair, const Solution& v) const {
    const auto i = static_cast<std::size_t>(pair.i);
    const auto j = static_cast<std::size_t>(pair.j);
    if (pair.kind == ContactKind::disk_disk) {
        Range sum(Rational(0));
        for (std::size_t a = 0; a < 2; ++a) {
            const Range x = place(problem_, vertex_, 2 * i + a) - place(problem_, vertex_, 2 * j + a);
            sum = sum + x * (component(problem_, v, 2 * i + a) - component(problem_, v, 2 * j + a));
        }
        const Rational distance = Rational(state.packing.radius[i]) + Rational(state.packing.radius[j]);
        return sum / Range(distance);
    }
    const Range x = component(problem_, v, 2 * i + j);
    return pair.kind == ContactKind::lower_wall
               ? x
               : component(problem_, v, 2 * static_cast<std::size_t>(problem_.disks) + j) - x;
}

FirstOrder::FirstOrder(const State<2>& state, const Problem& problem, const InverseBound& inverse,
                       const TrueVertex& vertex, const std::vector<double>& rho)
    : state_(state), problem_(problem), inverse_(inverse), vertex_(vertex), rho_(rho),
      velocities_(problem, inverse, vertex) {
    std::vector<Rational> b;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& c = state.contacts[l];
        b.push_back(c.kind == ContactKind::held ? Rational(0) : problem.force_factor(static_cast<int>(l)) * grown(c));
    }
    change_ = velocities_.solve(b);
}

Rational FirstOrder::grown(const Contact& pair) const {
    Rational sum(rho_[static_cast<std::size_t>(pair.i)]);
    if (pair.kind == ContactKind::disk_disk) {
        sum += Rational(rho_[static_cast<std::size_t>(pair.j)]);
    }
    return sum;
}

Range FirstOrder::gap(const Contact& pair) const {
    return velocities_.gap_rate(state_, pair, change_) - Range(grown(pair));
}

std::vector<Range> FirstOrder::forces(const std::vector<Range>& f0) const {
    Forces load(static_cast<std::size_t>(problem_.dofs()), Range(Rational(0)));
    const auto add = [&](std::size_t coordinate, const Range& value) {
        const int dof = problem_.dof_of[coordinate];
        if (dof >= 0) {
            load[static_cast<std::size_t>(dof)] = load[static_cast<std::size_t>(dof)] + value;
        }
    };
    for (std::size_t l = 0; l < state_.contacts.size(); ++l) {
        const Contact& c = state_.contacts[l];
        if (c.kind != ContactKind::disk_disk) {
            continue;
        }
        const Range g = f0[l] / Range(problem_.force_factor(static_cast<int>(l)));
        for (std::size_t a = 0; a < 2; ++a) {
            const std::size_t i = 2 * static_cast<std::size_t>(c.i) + a;
            const std::size_t j = 2 * static_cast<std::size_t>(c.j) + a;
            const Range turn = g * (component(problem_, change_, i) - component(problem_, change_, j));
            add(i, turn);
            add(j, Range(Rational(0)) - turn);
        }
    }
    if (state_.load.kind == LoadKind::true_stress) { // the force of a wall follows the other length
        for (std::size_t a = 0; a < 2; ++a) {
            const std::size_t wall = 2 * static_cast<std::size_t>(problem_.disks);
            add(wall + a, Range(-Rational(state_.load.stress[a])) * component(problem_, change_, wall + 1 - a));
        }
    }
    std::vector<Range> f1 = contact_forces(problem_, velocities_.solver(), inverse_, vertex_, load);
    for (std::size_t l = 0; l < f1.size(); ++l) {
        const Contact& c = state_.contacts[l];
        if (c.kind == ContactKind::disk_disk) { // f = g (R_i + R_j), and the radii grow
            f1[l] = f1[l] + f0[l] / Range(problem_.force_factor(static_cast<int>(l))) * Range(grown(c));
        }
    }
    return f1;
}

} // namespace isostat::checker
