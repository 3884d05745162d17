#include "checker/forces.hpp"

#include "checker/index.hpp"

#include <optional>

namespace isostat::checker {

namespace {

/// A length and the tilts of its axis: the load on each is the product of the lengths of all other axes.
std::size_t axis_of(std::size_t place, std::size_t axes) {
    return place < axes ? place : place == axes ? 1 : 2;
}

/// Force on a length, or on a tilt, per unit of its stress, outwards negative: minus the product of the lengths of all
/// other axes. \pre for a tilt: dead loads
Range force_per_stress(const Problem& problem, const State& state, const TrueVertex& vertex, std::size_t place) {
    Range force(Rational(-1));
    for (std::size_t b = 0; b < problem.layout.axes(); ++b) {
        if (b == axis_of(place, problem.layout.axes())) {
            continue;
        }
        const std::size_t at = problem.layout.of_length(b);
        force = force * (state.load.kind == LoadKind::nominal
                             ? Range(Rational(state.load.reference_length[b]))
                             : Range::around(problem.length(vertex.middle[at]),
                                             problem.dof_of[at] >= 0 ? vertex.radius : Rational(0)));
    }
    return force;
}

Forces disk_loads(const Problem& problem, const std::vector<double>& per_coordinate) {
    Forces load(static_cast<std::size_t>(problem.dofs()));
    for (std::size_t j = 0; j < load.size(); ++j) {
        const auto coordinate = static_cast<std::size_t>(problem.coordinate_of[j]);
        if (coordinate < per_coordinate.size() && per_coordinate[coordinate] != 0) {
            load[j] = Range(Rational(per_coordinate[coordinate]));
        }
    }
    return load;
}

} // namespace

Rational stress_of(const Load& load, std::size_t place) {
    return load.path ? Rational(load.path->at[place]) + Rational(load.path->rate[place]) * Rational(load.path->t)
                     : Rational(load.stress_of(place));
}

Forces finite_load(const Problem& problem, const State& state, const TrueVertex& vertex) {
    Forces load = disk_loads(problem, state.load.disk_force);
    const std::size_t walls = problem.layout.of_length(0);
    for (std::size_t place = 0; walls + place < problem.dof_of.size(); ++place) {
        if (const int dof = problem.dof_of[walls + place]; dof >= 0) {
            load[at(dof)] = Range(stress_of(state.load, place)) * force_per_stress(problem, state, vertex, place);
        }
    }
    return load;
}

Forces unit_load(const Problem& problem, const State& state, const TrueVertex& vertex) {
    Forces load(static_cast<std::size_t>(problem.dofs()));
    const std::size_t walls = problem.layout.of_length(0);
    for (std::size_t place = 0; walls + place < problem.dof_of.size(); ++place) { // tilts follow the lengths
        const int dof = problem.dof_of[walls + place];
        if (const double rate = state.load.rate_of(place); dof >= 0 && rate != 0) {
            load[at(dof)] = Range(Rational(rate)) * force_per_stress(problem, state, vertex, place);
        }
    }
    return load;
}

Forces infinitesimal_load(const Problem& problem, const State& state) {
    return disk_loads(problem, state.load.infinitesimal);
}

namespace {

/// target += times * value; times is seldom other than +-1.
void add_multiple(Integer& target, int times, const Integer& value) {
    if (times == 1) {
        target += value;
    } else if (times == -1) {
        target -= value;
    } else {
        target += times * value;
    }
}

/// The balance A^T g = -load in integers: g in multiples of 2^-shift per unit of length, forces of 2^(fine - shift).
/// Thousands of numbers, whose memory serves one vertex after the other.
class Balance {
  public:
    void begin(const Problem& problem, const TrueVertex& vertex, const Forces& load, long shift) {
        problem_ = &problem;
        blur_ = ceiling_of(2 * vertex.radius, -problem.fine);
        rounding_ = 0;
        sought_.resize(problem.rows.size());
        std::fill(sought_.begin(), sought_.end(), 0);
        target_.resize(load.size());
        unknown_.resize(load.size());
        for (std::size_t j = 0; j < load.size(); ++j) {
            target_[j] = unknown_[j] = 0;
            if (const auto& [lower, upper] = load[j]; lower != 0 || upper != 0) {
                target_[j] = floor_of(-upper, shift - problem.fine);
                unknown_[j] = ceiling_of(-lower, shift - problem.fine) - target_[j];
            }
        }
        const std::size_t axes = problem.layout.axes();
        difference_.resize(axes * sought_.size());
        for (std::size_t l = 0; l < sought_.size(); ++l) {
            for (std::size_t a = 0; a < axes; ++a) {
                difference_[axes * l + a] = 0;
                if (problem.rows[l].quadratic) {
                    problem.rows[l].separate(vertex.middle, a, difference_[axes * l + a]);
                }
            }
        }
        find_residual();
        for (const Integer& entry : difference_) {
            rounding_ = std::max(rounding_, bits(entry) + 3);
        }
    }
    [[nodiscard]] const std::vector<Integer>& sought() const { return sought_; }

    /// Refines until the residual stops falling, or is the rounding of g.
    void refine(const Solver& solver) {
        long size = bits(largest_of(residual_));
        for (int step = 0; step < most_refinements && size > rounding_; ++step) {
            Eigen::MatrixXd b(problem_->dofs(), 1);
            for (int j = 0; j < problem_->dofs(); ++j) {
                b(j, 0) = approximate(residual_[at(j)], -size);
            }
            const Eigen::MatrixXd x = solver.solve_transposed(b);
            for (std::size_t l = 0; l < sought_.size(); ++l) {
                add_scaled(sought_[l], x(static_cast<Eigen::Index>(l), 0), size - solver.scale(*problem_));
            }
            find_residual();
            const long now = bits(largest_of(residual_));
            if (now >= size) {
                return;
            }
            size = now;
        }
    }

    /// Upper bound of the residual at the true vertex (K6): entries of contacts of two disks differ by twice the
    /// radius, or more through periods.
    [[nodiscard]] Integer residual_at_vertex() {
        unsure_.resize(residual_.size());
        std::fill(unsure_.begin(), unsure_.end(), 0);
        Integer size;
        for (std::size_t l = 0; l < sought_.size(); ++l) {
            const Row& row = problem_->rows[l];
            size = abs(sought_[l]);
            for (std::size_t k = 0; row.quadratic && k < at(row.count); ++k) {
                if (const int dof = problem_->dof_of[at(row.coordinate[k])]; dof >= 0) {
                    const int weight = (std::abs(row.sign[k]) * row.spread(row.axis[k]) + 1) / 2; // of twice the radius
                    add_multiple(unsure_[at(dof)], weight, size);
                }
            }
        }
        Integer worst = 0;
        for (std::size_t j = 0; j < residual_.size(); ++j) {
            size = abs(residual_[j]);
            size += unknown_[j];
            mpz_addmul(size.get_mpz_t(), blur_.get_mpz_t(), unsure_[j].get_mpz_t());
            if (size > worst) {
                std::swap(size, worst);
            }
        }
        return worst;
    }

  private:
    static constexpr int most_refinements = 60;

    /// -load - A^T g at the middle of the vertex and the lower end of -load.
    void find_residual() {
        residual_ = target_;
        const std::size_t axes = problem_->layout.axes();
        std::array<Integer, most_axes> products;
        for (std::size_t l = 0; l < sought_.size(); ++l) {
            const Row& row = problem_->rows[l];
            for (std::size_t a = 0; row.quadratic && a < axes; ++a) {
                products[a] = difference_[axes * l + a] * sought_[l];
            }
            if (!row.quadratic) {
                products[row.axis[0]] = shifted_left(sought_[l], problem_->weight_bits);
            }
            for (std::size_t k = 0; k < at(row.count); ++k) {
                if (const int dof = problem_->dof_of[at(row.coordinate[k])]; dof >= 0) {
                    add_multiple(residual_[at(dof)], -row.sign[k], products[row.axis[k]]);
                }
            }
        }
    }

    const Problem* problem_ = nullptr;
    std::vector<Integer> sought_, target_, residual_, unsure_;
    std::vector<Integer> unknown_;    ///< width of the load
    std::vector<Integer> difference_; ///< entries of the contacts of two disks, axis by axis
    Integer blur_;
    long rounding_ = 0; ///< bits of a residual from the rounding of g
};

/// Bits before the binary point of the largest magnitude in a load; nothing: the load is 0.
std::optional<long> size_of(const Forces& load) {
    Rational largest = 0;
    for (const Range& force : load) {
        largest = std::max<Rational>(largest, std::max<Rational>(abs(force.upper), abs(force.lower)));
    }
    if (largest == 0) {
        return {};
    }
    return bits(largest.get_num()) - bits(largest.get_den());
}

} // namespace

std::vector<Range> contact_forces(const Problem& problem, const Solver& solver, const InverseBound& inverse,
                                  const TrueVertex& vertex, const Forces& load) {
    std::vector<Range> forces(problem.rows.size());
    const std::optional<long> size = size_of(load);
    if (!size) {
        return forces;
    }
    // Entries of A are below 2^(scale + fine), so forces per length are above the largest load / that. 40 bits more
    // than the vertex has are kept below.
    const long shift = problem.digits + 40 + solver.scale(problem) + problem.fine - *size;
    static thread_local Balance balance;
    balance.begin(problem, vertex, load, shift);
    if (solver.usable()) {
        balance.refine(solver);
    }
    const Rational error =
        Rational(balance.residual_at_vertex()) / (1 - vertex.column_residual) * power_of_two(problem.fine);
    const auto around_by = [&error](const Rational& column_sum) { return ceiling_of(error * column_sum); };
    Integer around = around_by(inverse.column_sum_max);
    Integer end;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        if (!inverse.column_sum.empty()) {
            around = around_by(inverse.column_sum[l]);
        }
        const Integer factor = problem.force_units(static_cast<int>(l));
        const auto set = [&](Rational& force, const Integer& per_length) { // in place: there are thousands
            mpz_mul(force.get_num_mpz_t(), per_length.get_mpz_t(), factor.get_mpz_t());
            scale(force, problem.fine - shift);
        };
        set(forces[l].lower, end = balance.sought()[l] - around);
        set(forces[l].upper, end = balance.sought()[l] + around);
    }
    return forces;
}

int free_of_others(const Problem& problem, const std::vector<int>& contacts, const Forces& load) {
    std::vector<bool> listed(problem.rows.size(), false);
    for (const int l : contacts) {
        listed[static_cast<std::size_t>(l)] = true;
    }
    const auto free = [&listed](const std::vector<int>& touching) {
        return std::all_of(touching.begin(), touching.end(),
                           [&listed](int l) { return listed[static_cast<std::size_t>(l)]; });
    };
    int count = 0;
    std::array<bool, most_axes> some_left{}; // per axis: of its degrees of freedom some do not count
    std::array<bool, most_axes> loaded_along{};
    for (std::size_t j = 0; j < problem.acting_on.size(); ++j) {
        const bool loaded = load[j].lower != 0 || load[j].upper != 0;
        const bool counts = !loaded && free(problem.acting_on[j]);
        count += counts ? 1 : 0;
        if (const int axis = problem.axis_of(j); axis >= 0) {
            const auto a = static_cast<std::size_t>(axis);
            some_left[a] = some_left[a] || !counts;
            loaded_along[a] = loaded_along[a] || loaded;
        }
    }
    for (std::size_t a = 0; a < problem.immovable.size(); ++a) { // the sum of all others of the axis
        count += some_left[a] && !loaded_along[a] && free(problem.immovable[a].acting) ? 1 : 0;
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
