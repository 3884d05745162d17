#include "checker/forces.hpp"

namespace isostat::checker {

namespace {

/// Force of the wall of an axis per unit stress on it, outwards negative: minus the length of the other axis.
Range wall_force(const Problem& problem, const State<2>& state, const TrueVertex& vertex, std::size_t axis) {
    const std::size_t other = 1 - axis;
    if (state.load.kind == LoadKind::nominal) {
        return Range(-Rational(state.load.reference_length[other]));
    }
    const std::size_t coordinate = 2 * static_cast<std::size_t>(problem.disks) + other;
    const bool moves = problem.dof_of[coordinate] >= 0;
    const Rational length = problem.length(vertex.middle[coordinate]);
    return Range::around(-length, moves ? vertex.radius : Rational(0));
}

Forces disk_loads(const Problem& problem, const std::vector<double>& per_coordinate) {
    Forces load(static_cast<std::size_t>(problem.dofs()), Range(Rational(0)));
    for (std::size_t j = 0; j < load.size(); ++j) {
        const auto coordinate = static_cast<std::size_t>(problem.coordinate_of[j]);
        if (coordinate < per_coordinate.size()) {
            load[j] = Range(Rational(per_coordinate[coordinate]));
        }
    }
    return load;
}

} // namespace

Forces finite_load(const Problem& problem, const State<2>& state, const TrueVertex& vertex) {
    Forces load = disk_loads(problem, state.load.disk_force);
    for (std::size_t a = 0; a < 2; ++a) {
        const int dof = problem.dof_of[2 * static_cast<std::size_t>(problem.disks) + a];
        if (dof >= 0) {
            load[static_cast<std::size_t>(dof)] =
                Range(Rational(state.load.stress[a])) * wall_force(problem, state, vertex, a);
        }
    }
    return load;
}

Forces unit_load(const Problem& problem, const State<2>& state, const TrueVertex& vertex) {
    Forces load(static_cast<std::size_t>(problem.dofs()), Range(Rational(0)));
    const auto axis = static_cast<std::size_t>(state.load.loaded_axis);
    const int dof = problem.dof_of[2 * static_cast<std::size_t>(problem.disks) + axis];
    if (dof >= 0) {
        load[static_cast<std::size_t>(dof)] = wall_force(problem, state, vertex, axis);
    }
    return load;
}

Forces infinitesimal_load(const Problem& problem, const State<2>& state) {
    return disk_loads(problem, state.load.infinitesimal);
}

std::vector<Range> contact_forces(const Problem& problem, const Solver& solver, const InverseBound& inverse,
                                  const TrueVertex& vertex, const Forces& load) {
    // A^T g = -load, g in multiples of 2^-shift (per unit of length). The factor of the first guess sets the scale.
    const auto n = static_cast<std::size_t>(problem.dofs());
    double largest = 0;
    for (const Range& force : load) {
        largest = std::max({largest, std::abs(rounded_up(force.upper)), std::abs(rounded_down(force.lower))});
    }
    std::vector<Rational> g(n);
    if (largest > 0 && solver.usable()) {
        const long load_exponent = std::ilogb(largest);
        // Entries of A are below 2^(scale + fine): forces per length above largest / that. 120 bits below are kept.
        const long shift = 120 + solver.scale() + problem.fine - load_exponent;
        std::vector<Integer> sought(n);
        const long residual_exponent = problem.fine - shift;
        std::vector<Integer> target;
        for (const Range& force : load) {
            const Rational middle = (force.lower + force.upper) / 2 * power_of_two(-residual_exponent);
            target.emplace_back(-middle.get_num() / middle.get_den());
        }
        long size = -1;
        for (int step = 0; step < 20; ++step) {
            std::vector<Integer> residual = target;
            for (int l = 0; l < problem.contacts(); ++l) {
                const Row& row = problem.rows[static_cast<std::size_t>(l)];
                for (int k = 0; k < row.count; ++k) {
                    const int dof =
                        problem.dof_of[static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)])];
                    if (dof >= 0) {
                        residual[static_cast<std::size_t>(dof)] -=
                            problem.entry(l, k, vertex.middle) * sought[static_cast<std::size_t>(l)];
                    }
                }
            }
            long now = 0;
            for (const Integer& r : residual) {
                now = std::max(now, bits(r));
            }
            if (now == 0 || (size >= 0 && now >= size)) {
                break;
            }
            size = now;
            Eigen::MatrixXd b(problem.dofs(), 1);
            for (std::size_t j = 0; j < n; ++j) {
                b(static_cast<Eigen::Index>(j), 0) = approximate(residual[j], -now);
            }
            const Eigen::MatrixXd x = solver.solve_transposed(b);
            for (std::size_t l = 0; l < n; ++l) {
                sought[l] += scaled_integer(x(static_cast<Eigen::Index>(l), 0), now - solver.scale());
            }
        }
        for (std::size_t l = 0; l < n; ++l) {
            g[l] = Rational(sought[l]) * power_of_two(-shift);
        }
    }

    // The residual at the true vertex, for every degree of freedom (K6).
    std::vector<Range> residual;
    for (const Range& force : load) {
        residual.push_back(Range(Rational(0)) - force);
    }
    for (int l = 0; l < problem.contacts(); ++l) {
        const Row& row = problem.rows[static_cast<std::size_t>(l)];
        const Rational& factor = g[static_cast<std::size_t>(l)];
        const Rational blur = row.quadratic ? Rational(2 * vertex.radius * abs(factor)) : Rational(0);
        for (int k = 0; k < row.count && factor != 0; ++k) {
            const int dof = problem.dof_of[static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)])];
            if (dof >= 0) {
                const Rational product = problem.length(problem.entry(l, k, vertex.middle)) * factor;
                Range& r = residual[static_cast<std::size_t>(dof)];
                r = r - Range::around(product, blur);
            }
        }
    }
    Rational worst = 0;
    for (const Range& r : residual) {
        worst = std::max<Rational>(worst, std::max<Rational>(abs(r.lower), abs(r.upper)));
    }
    worst = short_above(worst / (1 - vertex.column_residual));
    std::vector<Range> forces;
    for (std::size_t l = 0; l < n; ++l) {
        const Range per_length = Range::around(g[l], worst * inverse.column_sum[l]);
        forces.push_back(per_length * Range(problem.force_factor(static_cast<int>(l))));
    }
    return forces;
}

int free_of_others(const Problem& problem, const std::vector<int>& contacts, const Forces& load) {
    std::vector<bool> listed(problem.rows.size(), false);
    for (const int l : contacts) {
        listed[static_cast<std::size_t>(l)] = true;
    }
    int count = 0;
    for (std::size_t j = 0; j < problem.contacts_of.size(); ++j) {
        const bool loaded = load[j].lower != 0 || load[j].upper != 0;
        const std::vector<int>& touching = problem.contacts_of[j];
        count += !loaded && std::all_of(touching.begin(), touching.end(),
                                        [&listed](int l) { return listed[static_cast<std::size_t>(l)]; })
                     ? 1
                     : 0;
    }
    return count;
}

bool vanish_structurally(const Problem& problem, const std::vector<int>& contacts, const Forces& load) {
    return free_of_others(problem, contacts, load) == static_cast<int>(contacts.size());
}

bool vary_together(const Problem& problem, const std::vector<int>& contacts, const Forces& load) {
    return free_of_others(problem, contacts, load) + 1 == static_cast<int>(contacts.size());
}

} // namespace isostat::checker
