#include "checker/forces.hpp"

#include "checker/index.hpp"

#include <bit>
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
        force = force * (state.load.kind == LoadKind::nominal ? Range(Rational(state.load.reference_length[b]))
                                                              : coordinate_at(problem, vertex, at));
    }
    return force;
}

Forces disk_loads(const Problem& problem, const std::vector<double>& per_coordinate) {
    Forces load(static_cast<std::size_t>(problem.dofs()));
    for (std::size_t j = 0; j < load.size(); ++j) {
        const auto coordinate = static_cast<std::size_t>(problem.coordinate_of[j]);
        if (coordinate < per_coordinate.size() && per_coordinate[coordinate] != 0) {
            load.set(j, Range(Rational(per_coordinate[coordinate])));
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
            load.set(at(dof), Range(stress_of(state.load, place)) * force_per_stress(problem, state, vertex, place));
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
            load.set(at(dof), Range(Rational(rate)) * force_per_stress(problem, state, vertex, place));
        }
    }
    return load;
}

Forces infinitesimal_load(const Problem& problem, const State& state) {
    return disk_loads(problem, state.load.infinitesimal);
}

namespace {

/// The balance A^T g = -load in integers: g in multiples of 2^-shift per unit of length, forces of 2^(fine - shift).
/// Thousands of numbers, whose memory serves one vertex after the other. `Number`: that of the lengths.
template <class Number> class Balance {
  public:
    using Sum = Product<Number>;

    /// False: the numbers may be too large.
    bool begin(const Problem& problem, const TrueVertex& vertex, const Forces& load, long shift) {
        problem_ = &problem;
        const Integer blur = ceiling_of(2 * vertex.radius, -problem.fine);
        constexpr bool narrow = std::is_same_v<Number, Wide>;
        if (narrow && bits(blur) > 100) { // checker.md K26 (B)
            return false;
        }
        blur_ = number<Number>(blur);
        sought_.assign(problem.rows.size(), 0);
        target_.assign(load.size(), Sum());
        unknown_.assign(load.size(), Sum());
        for (const auto& [dof, force] : load.acting()) {
            const Integer lower = -ceiling_of(force.upper, shift - problem.fine);
            const Integer width = -floor_of(force.lower, shift - problem.fine) - lower;
            if (narrow && std::max(bits(lower), bits(width)) > 250) { // 250: checker.md K26 (sums)
                return false;
            }
            target_[dof] = number<Sum>(lower);
            unknown_[dof] = number<Sum>(width);
        }
        const std::size_t axes = problem.layout.axes();
        difference_.resize(axes * sought_.size());
        int times = 1; // of one contact in one sum
        for (std::size_t l = 0; l < sought_.size(); ++l) {
            const Row& row = problem.rows[l];
            for (std::size_t a = 0; a < axes; ++a) {
                difference_[axes * l + a] = 0;
                if (row.quadratic) {
                    row.separate(vertex.middle.in<Number>(), a, difference_[axes * l + a]);
                    times = std::max(times, (row.spread(a) * row.spread(a) + 1) / 2);
                }
            }
        }
        const long entry_bits = most_bits(difference_);
        rounding_ = entry_bits + 3; // cost: a residual of some units is not refined
        const std::size_t touching = std::max(problem.contacts_of.lengths().second, std::size_t{1});
        const auto terms = static_cast<long>(std::bit_width(touching * static_cast<std::size_t>(times)));
        // checker.md K26 (G and C)
        largest_ = std::min(125 - terms, 250 - terms - std::max(entry_bits, problem.weight_bits + 1));
        residual_ = target_; // g = 0
        return !narrow || largest_ > 0;
    }
    [[nodiscard]] const std::vector<Number>& sought() const { return sought_; }

    /// Refines until the residual stops falling, is the rounding of g or less than a quarter of what the vertex leaves
    /// open. False: g is too large.
    bool refine(const Solver& solver) {
        long size = most_bits(residual_);
        // cost: a residual below an eighth of what the vertex leaves open is not refined
        const auto open = [this] { return blur_ == 0 ? 0 : bits(blur_) + most_bits(sought_) - 4; };
        for (int step = 0; step < most_refinements && size > std::max(rounding_, open()); ++step) {
            Eigen::MatrixXd b(problem_->dofs(), 1);
            for (int j = 0; j < problem_->dofs(); ++j) {
                b(j, 0) = approximate(residual_[at(j)], -size);
            }
            // A residual in GMP's integers costs more than a second step.
            const Eigen::MatrixXd x = solver.solve_transposed(b, std::is_same_v<Number, Wide> ? 1 : 2);
            for (std::size_t l = 0; l < sought_.size(); ++l) {
                if (!add_scaled(sought_[l], x(static_cast<Eigen::Index>(l), 0), size - solver.scale(*problem_),
                                largest_)) {
                    return false;
                }
            }
            find_residual();
            const long now = most_bits(residual_);
            if (now >= size) {
                return true;
            }
            size = now;
        }
        return true;
    }

    /// Upper bound of the residual at the true vertex (K6): entries of contacts of two disks differ by twice the
    /// radius, or more through periods.
    [[nodiscard]] Integer residual_at_vertex() {
        unsure_.assign(residual_.size(), 0);
        for (std::size_t l = 0; l < sought_.size(); ++l) {
            const Row& row = problem_->rows[l];
            const auto size = static_cast<Number>(magnitude(sought_[l]));
            for (std::size_t k = 0; row.quadratic && k < at(row.count); ++k) {
                if (const int dof = problem_->dof_of[at(row.coordinate[k])]; dof >= 0) {
                    // of twice the radius
                    unsure_[at(dof)] += (std::abs(row.sign[k]) * row.spread(row.axis[k]) + 1) / 2 * size;
                }
            }
        }
        Sum worst = Sum();
        Sum blurred;
        for (std::size_t j = 0; j < residual_.size(); ++j) {
            Sum size = magnitude(residual_[j]);
            size += unknown_[j];
            multiply(blurred, blur_, unsure_[j]);
            size += blurred;
            if (worst < size) {
                std::swap(size, worst);
            }
        }
        return integer_of(worst);
    }

  private:
    static constexpr int most_refinements = 60; // guess: refinements of g'

    /// -load - A^T g at the middle of the vertex and the lower end of -load.
    void find_residual() {
        residual_ = target_;
        const std::size_t axes = problem_->layout.axes();
        std::array<Sum, most_axes> products;
        const auto weight = number<Number>(problem_->weight());
        for (std::size_t l = 0; l < sought_.size(); ++l) {
            const Row& row = problem_->rows[l];
            for (std::size_t a = 0; row.quadratic && a < axes; ++a) {
                multiply(products[a], difference_[axes * l + a], sought_[l]);
            }
            if (!row.quadratic) {
                multiply(products[row.axis[0]], sought_[l], weight);
            }
            for (std::size_t k = 0; k < at(row.count); ++k) {
                if (const int dof = problem_->dof_of[at(row.coordinate[k])]; dof >= 0) {
                    for (int times = std::abs(row.sign[k]); times > 0; --times) { // seldom more than 1
                        Sum& sum = residual_[at(dof)];
                        row.sign[k] > 0 ? sum -= products[row.axis[k]] : sum += products[row.axis[k]];
                    }
                }
            }
        }
    }

    const Problem* problem_ = nullptr;
    std::vector<Number> sought_, unsure_;
    std::vector<Sum> target_, residual_;
    std::vector<Sum> unknown_;       ///< width of the load
    std::vector<Number> difference_; ///< entries of the contacts of two disks, axis by axis
    Number blur_ = 0;
    long rounding_ = 0; ///< bits of a residual from the rounding of g
    long largest_ = 0;  ///< bits that g may have
};

/// Bits before the binary point of the largest magnitude in a load, or one more; nothing: the load is 0.
std::optional<long> size_of(const Forces& load) {
    std::optional<long> largest;
    for (const auto& [dof, force] : load.acting()) {
        for (const Rational* end : {&force.lower, &force.upper}) {
            if (*end != 0) {
                const long size = bits(end->get_num()) - bits(end->get_den());
                largest = std::max(size, largest.value_or(size));
            }
        }
    }
    return largest;
}

/// A dyadic range in place: there are thousands.
void set_range(Range& range, const Integer& middle, const Integer& around, const Integer& factor, long exponent) {
    const auto set = [&](Rational& end, const Integer& units) {
        mpz_mul(end.get_num_mpz_t(), units.get_mpz_t(), factor.get_mpz_t());
        scale(end, exponent);
    };
    set(range.lower, middle - around);
    set(range.upper, middle + around);
}

/// Nothing: the numbers may be too large.
template <class Number>
std::optional<ContactForces> forces_in(const Problem& problem, const Solver& solver, const InverseBound& inverse,
                                       const TrueVertex& vertex, const Forces& load, long shift) {
    static thread_local Balance<Number> balance;
    if (!balance.begin(problem, vertex, load, shift) || (solver.usable() && !balance.refine(solver))) {
        return {};
    }
    const Rational error =
        Rational(balance.residual_at_vertex()) / (1 - vertex.column_residual) * power_of_two(problem.fine);
    const auto around_by = [&error](const Rational& column_sum) { return ceiling_of(error * column_sum); };
    Integer around = around_by(inverse.column_sum_max);
    if constexpr (std::is_same_v<Number, Wide>) {
        if (inverse.column_sum.empty() && bits(around) <= 125) { // checker.md K26 (G and C)
            return ContactForces(problem, balance.sought(), number<Wide>(around), problem.fine - shift);
        }
    }
    std::vector<Range> forces(problem.rows.size());
    for (std::size_t l = 0; l < forces.size(); ++l) {
        if (!inverse.column_sum.empty()) {
            around = around_by(inverse.column_sum[l]);
        }
        set_range(forces[l], integer_of(balance.sought()[l]), around, problem.force_units(static_cast<int>(l)),
                  problem.fine - shift);
    }
    return forces;
}

} // namespace

ContactForces::operator std::vector<Range>() const {
    std::vector<Range> all;
    for (std::size_t l = 0; l < size(); ++l) {
        all.push_back((*this)[l]);
    }
    return all;
}

Range ContactForces::operator[](std::size_t contact) const {
    if (middle_.empty()) {
        return ranges_[contact];
    }
    Range range;
    set_range(range, integer_of(middle_[contact]), integer_of(around_),
              problem_->force_units(static_cast<int>(contact)), exponent_);
    return range;
}

Bounds ContactForces::bounds(std::size_t l) const {
    const double unit = times_power(1, exponent_);
    if (middle_.empty() || !std::isnormal(unit)) {
        return bounds_of((*this)[l]);
    }
    // An end is rounded three times before the room is added.
    const auto of_double = [](Wide value) { return static_cast<double>(value); };
    const Wide units = problem_->rows[l].quadratic ? problem_->sum.in<Wide>()[l] : Wide(1) << problem_->weight_bits;
    const double lower = of_double(middle_[l] - around_) * (of_double(units) * unit);
    const double upper = of_double(middle_[l] + around_) * (of_double(units) * unit);
    // checker.md K26 (roundings of a force as doubles)
    return Bounds::outwards(lower - 0x1p-49 * std::abs(lower), upper + 0x1p-49 * std::abs(upper));
}

ContactForces contact_forces(const Problem& problem, const Solver& solver, const InverseBound& inverse,
                             const TrueVertex& vertex, const Forces& load) {
    const std::optional<long> size = size_of(load);
    if (!size) {
        return std::vector<Range>(problem.rows.size());
    }
    // Entries of A are below 2^(scale + fine), so forces per length are above the largest load / that. 40 bits more
    // than the vertex has are kept below.
    // checker.md K26 (40 more than the vertex has)
    const long shift = problem.digits + 40 + solver.scale(problem) + problem.fine - *size;
    std::optional<ContactForces> forces;
    if (vertex.middle.narrow()) {
        forces = forces_in<Wide>(problem, solver, inverse, vertex, load, shift);
    }
    if (!forces) {
        TrueVertex of_any_size = vertex;
        of_any_size.middle = std::vector<Integer>(vertex.middle);
        forces = forces_in<Integer>(problem, solver, inverse, of_any_size, load, shift);
    }
    return *std::move(forces);
}

int free_of_others(const Problem& problem, const std::vector<int>& contacts, const Forces& load) {
    std::vector<bool> listed(problem.rows.size(), false);
    for (const int l : contacts) {
        listed[static_cast<std::size_t>(l)] = true;
    }
    const auto free = [&listed](const auto& touching) {
        return std::all_of(touching.begin(), touching.end(),
                           [&listed](int l) { return listed[static_cast<std::size_t>(l)]; });
    };
    int count = 0;
    std::array<bool, most_axes> some_left{}; // per axis: of its degrees of freedom some do not count
    std::array<bool, most_axes> loaded_along{};
    for (std::size_t j = 0; j < problem.acting_on.size(); ++j) {
        const bool loaded = load.acts(j);
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
