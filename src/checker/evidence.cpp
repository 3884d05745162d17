#include "checker/evidence.hpp"

#include "checker/elimination.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace isostat::checker {

namespace {

/// The rank by exact elimination, for small matrices.
std::optional<int> eliminated_rank(const Problem& problem) {
    if (problem.dofs() > largest_exact_matrix || problem.contacts() > largest_exact_matrix) {
        return {};
    }
    Matrix a(problem.contacts(), problem.dofs());
    for (int l = 0; l < problem.contacts(); ++l) {
        const Row& row = problem.rows[static_cast<std::size_t>(l)];
        for (int k = 0; k < row.count; ++k) {
            const int dof = problem.dof_of[static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)])];
            if (dof >= 0) {
                a.at(l, dof) = problem.entry(l, k, problem.stored);
            }
        }
    }
    return checker::rank(std::move(a));
}

} // namespace

Evidence::Evidence(const State& checked, CheckerArithmetic arithmetic, bool held_allowed,
                   const std::shared_ptr<const Solver>& near, int digits, const Rational& around)
    : state(checked), problem(checked, held_allowed, digits) {
    if (!problem.unsupported.empty()) {
        return;
    }
    square = problem.contacts() == problem.dofs() && problem.contacts() > 0;
    if (!square) {
        rank = eliminated_rank(problem);
        return;
    }
    const auto bound = [this, &around](CheckerArithmetic kind, bool roughly = false) {
        InverseBound found = bound_inverse(problem, *solver, kind, roughly);
        if (found.found || !inverse.found) {
            inverse = std::move(found);
            vertex = inverse.found ? find_vertex(problem, *solver, inverse, around) : TrueVertex();
        }
    };
    if (near) {
        solver = near;
        bound(CheckerArithmetic::singular_value, digits < usual_digits);
    }
    if (!well_known()) {
        solver = std::make_shared<Solver>(problem, near.get());
        bound(arithmetic);
    }
    if (inverse.singular_value > 0 && !vertex.found && arithmetic == CheckerArithmetic::automatic) {
        bound(CheckerArithmetic::rows);
    }
    if (!inverse.found) {
        rank = eliminated_rank(problem);
        return;
    }
    rank = problem.dofs();
    if (vertex.found) {
        finite_load = checker::finite_load(problem, state, vertex);
        forces = contact_forces(problem, *solver, inverse, vertex, finite_load);
    }
}

const Forces& Evidence::unit_load() const {
    if (!unit_load_) {
        unit_load_ = vertex.found ? checker::unit_load(problem, state, vertex) : Forces();
    }
    return *unit_load_;
}

const ContactForces& Evidence::slopes() const {
    if (!slopes_) {
        slopes_ = vertex.found ? contact_forces(problem, *solver, inverse, vertex, unit_load()) : ContactForces();
    }
    return *slopes_;
}

const ContactForces& Evidence::infinitesimal() const {
    if (!infinitesimal_) {
        infinitesimal_ = vertex.found
                             ? contact_forces(problem, *solver, inverse, vertex, infinitesimal_load(problem, state))
                             : ContactForces();
    }
    return *infinitesimal_;
}

Range step_to_limit(const Evidence& evidence, std::size_t contact) {
    return -(evidence.forces[contact] / evidence.slopes()[contact]);
}

std::vector<Range> ForcesAfter::all() const {
    std::vector<Range> forces(evidence.forces.size());
    for (std::size_t l = 0; l < forces.size(); ++l) {
        forces[l] = (*this)[l];
    }
    return forces;
}

int Evidence::count(ContactKind kind) const {
    return static_cast<int>(std::count_if(state.contacts.begin(), state.contacts.end(),
                                          [kind](const Contact& c) { return c.kind == kind; }));
}

std::string Evidence::why_no_inverse() const {
    if (!square) {
        return fmt::format("{} contacts for {} degrees of freedom", problem.contacts(), problem.dofs());
    }
    return "no approximate inverse of the stored matrix was good enough";
}

std::string Evidence::why_no_vertex() const {
    return inverse.found ? "the gaps of the contacts are too large for the bound of the inverse" : why_no_inverse();
}

std::vector<int> having_zero(const ContactForces& ranges) {
    std::vector<int> positions;
    for (std::size_t l = 0; l < ranges.size(); ++l) {
        if (ranges.has_zero(l)) {
            positions.push_back(static_cast<int>(l));
        }
    }
    return positions;
}

Verdict both(Verdict a, Verdict b) {
    if (a == Verdict::refuted || b == Verdict::refuted) {
        return Verdict::refuted;
    }
    return a == Verdict::undecided || b == Verdict::undecided ? Verdict::undecided : Verdict::proved;
}

Verdict lies_in(const Range& value, const Interval& claimed) {
    const bool above = std::isinf(claimed.lower) ? claimed.lower < 0 : value.lower >= Rational(claimed.lower);
    const bool below = std::isinf(claimed.upper) ? claimed.upper > 0 : value.upper <= Rational(claimed.upper);
    if (above && below) {
        return Verdict::proved;
    }
    const bool under = std::isinf(claimed.lower) ? claimed.lower > 0 : value.upper < Rational(claimed.lower);
    const bool over = std::isinf(claimed.upper) ? claimed.upper < 0 : value.lower > Rational(claimed.upper);
    return under || over ? Verdict::refuted : Verdict::undecided;
}

std::string shown(const Range& range) {
    return fmt::format("[{:.17g}, {:.17g}]", rounded_down(range.lower), rounded_up(range.upper));
}

std::string shown(const Interval& interval) {
    return fmt::format("[{:.17g}, {:.17g}]", interval.lower, interval.upper);
}

ClaimCheck answer(ClaimCheck check, Verdict verdict, const std::string& detail) {
    check.verdict = verdict;
    check.detail = detail;
    return check;
}

} // namespace isostat::checker
