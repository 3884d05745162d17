#include "checker/forces.hpp"

#include "checker/index.hpp"

#include <optional>

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

namespace {

/// The balance A^T g = -load in integers: g in multiples of 2^-shift per unit of length, forces of 2^(fine - shift).
class Balance {
  public:
    Balance(const Problem& problem, const TrueVertex& vertex, const Forces& load, long shift)
        : problem_(problem), sought_(problem.rows.size()), blur_(ceiling_of(2 * vertex.radius, -problem.fine)) {
        for (const Range& force : load) {
            target_.push_back(floor_of(-force.upper, shift - problem.fine));
            unknown_.push_back(ceiling_of(-force.lower, shift - problem.fine) - target_.back());
        }
        for (const Row& row : problem.rows) {
            for (int a = 0; row.quadratic && a < 2; ++a) {
                difference_.push_back(vertex.middle[at(row.coordinate[at(a)])] -
                                      vertex.middle[at(row.coordinate[at(a + 2)])]);
            }
        }
        find_residual();
        for (const Integer& entry : difference_) {
            rounding_ = std::max(rounding_, bits(entry) + 3);
        }
    }
    [[nodiscard]] const std::vector<Integer>& sought() const { return sought_; }

    /// Until the residual does not become smaller, or is what the roundings of g leave.
    void refine(const Solver& solver) {
        long size = bits(largest_of(residual_));
        for (int step = 0; step < most_refinements && size > rounding_; ++step) {
            Eigen::MatrixXd b(problem_.dofs(), 1);
            for (int j = 0; j < problem_.dofs(); ++j) {
                b(j, 0) = approximate(residual_[at(j)], -size);
            }
            const Eigen::MatrixXd x = solver.solve_transposed(b);
            for (std::size_t l = 0; l < sought_.size(); ++l) {
                add_scaled(sought_[l], x(static_cast<Eigen::Index>(l), 0), size - solver.scale(problem_));
            }
            find_residual();
            const long now = bits(largest_of(residual_));
            if (now >= size) {
                return;
            }
            size = now;
        }
    }

    /// At least the residual at the true vertex (K6): entries of contacts of two disks differ by twice the radius.
    [[nodiscard]] Integer residual_at_vertex() const {
        Integer worst = 0;
        for (std::size_t j = 0; j < residual_.size(); ++j) {
            Integer sum = 0;
            for (const int l : problem_.contacts_of[j]) {
                if (problem_.rows[at(l)].quadratic) {
                    sum += abs(sought_[at(l)]);
                }
            }
            sum = abs(residual_[j]) + unknown_[j] + blur_ * sum;
            worst = std::max(worst, sum);
        }
        return worst;
    }

  private:
    static constexpr int most_refinements = 60;

    /// -load - A^T g at the middle of the vertex and the lower end of -load.
    void find_residual() {
        residual_ = target_;
        Integer product;
        auto difference = difference_.begin();
        for (std::size_t l = 0; l < sought_.size(); ++l) {
            const Row& row = problem_.rows[l];
            const auto subtract = [&](int k, bool negative) {
                if (const int dof = problem_.dof_of[at(row.coordinate[at(k)])]; dof >= 0) {
                    Integer& r = residual_[at(dof)];
                    negative ? r += product : r -= product;
                }
            };
            if (row.quadratic) {
                for (int a = 0; a < 2; ++a) {
                    product = *difference++ * sought_[l];
                    subtract(a, false);
                    subtract(a + 2, true);
                }
                continue;
            }
            product = shifted_left(sought_[l], problem_.weight_bits);
            for (int k = 0; k < row.count; ++k) {
                subtract(k, row.sign[at(k)] < 0);
            }
        }
    }

    const Problem& problem_;
    std::vector<Integer> sought_, target_, residual_;
    std::vector<Integer> unknown_;    ///< width of the load
    std::vector<Integer> difference_; ///< entries of the contacts of two disks, x and y
    Integer blur_;
    long rounding_ = 0; ///< bits of a residual when g is off by some units
};

/// The number of bits before the binary point of the largest magnitude in a load; nothing: it is 0.
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
    // Entries of A are below 2^(scale + fine): forces per length above the largest load / that. 40 bits more than the
    // vertex has, 120 or more, are kept below.
    const long shift = problem.digits + 40 + solver.scale(problem) + problem.fine - *size;
    Balance balance(problem, vertex, load, shift);
    if (solver.usable()) {
        balance.refine(solver);
    }
    const Rational error =
        Rational(balance.residual_at_vertex()) / (1 - vertex.column_residual) * power_of_two(problem.fine);
    const Rational* column = nullptr;
    Integer around;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        if (column == nullptr || *column != inverse.column_sum[l]) { // with a singular value all are one number
            column = &inverse.column_sum[l];
            around = ceiling_of(error * *column);
        }
        const Integer factor = problem.force_units(static_cast<int>(l));
        const Integer& g = balance.sought()[l];
        forces[l] = {dyadic((g - around) * factor, problem.fine - shift),
                     dyadic((g + around) * factor, problem.fine - shift)};
    }
    return forces;
}

int free_of_others(const Problem& problem, const std::vector<int>& contacts, const Forces& load) {
    std::vector<bool> listed(problem.rows.size(), false);
    for (const int l : contacts) {
        listed[static_cast<std::size_t>(l)] = true;
    }
    int count = 0;
    for (std::size_t j = 0; j < problem.acting_on.size(); ++j) {
        const bool loaded = load[j].lower != 0 || load[j].upper != 0;
        const std::vector<int>& touching = problem.acting_on[j];
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
