#include "preparation/programme.hpp"

#include "contact/contact_set.hpp"
#include "contact/near_pairs.hpp"
#include "core/dot.hpp"
#include "core/work.hpp"
#include "packing/bodies.hpp"
#include "preparation/programme_rows.hpp"

#include <ClpEventHandler.hpp>
#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace isostat::preparation {

namespace {

constexpr double tolerance = 1e-9;
/// Complementarity products at the end of the interior-point method: multipliers of rattlers are of order 1e-5 in the
/// scale of the objective, gaps that matter 1e-6.
constexpr double interior_tolerance = 1e-14;
/// Share of a complete contact list above which overlapping pairs are used as the first basis.
constexpr double mostly_closed = 0.9;

/// Ends the simplex at the next iteration when the user requests a stop.
class StopHandler : public ClpEventHandler {
  public:
    explicit StopHandler(const std::atomic<bool>* stop) : stop_(stop) {}
    int event(Event what) override {
        const bool asked = what == endOfIteration && stop_ != nullptr && stop_->load(std::memory_order_relaxed);
        return asked ? 0 : -1;
    }
    [[nodiscard]] ClpEventHandler* clone() const override { return new StopHandler(*this); } // Clp owns the clone

  private:
    const std::atomic<bool>* stop_;
};

} // namespace

ContactProgramme::ContactProgramme(const std::vector<double>& infinitesimal, double trust, ProgrammeMethod method,
                                   const std::atomic<bool>* stop, double ratio)
    : infinitesimal_(&infinitesimal), trust_(trust), ratio_(ratio), stop_(stop), method_(method),
      inside_(method != ProgrammeMethod::simplex) {}

void ContactProgramme::collect(const Packing& packing, Rows& rows) const {
    // Two disks approach by at most 2 sqrt(packing.dimension) trust:
    // a pair farther apart than that cannot overlap after the step.
    const double reach = 2 * std::sqrt(static_cast<double>(packing.dimension)) * trust_ * (1 + 1e-9);
    // A wall moves farther than a disk, so the reach is that of both together. Across a corner of a cell all periods
    // move, with the tilts along their axes.
    const bool tilted = packing.cell.any() && (packing.cell.tilt_moves[0] || packing.cell.keeps_shape);
    double squares = packing.cell.any() ? 0 : 1;
    for (int a = 0; a < packing.dimension && packing.cell.any(); ++a) {
        squares += tilted ? (a + 1) * (a + 1) : 1;
    }
    const double wall_reach = (std::sqrt(squares) * wall_trust(packing) + 1) * trust_ * (1 + 1e-9);
    std::vector<Contact> near = with_bars(near_contacts(packing, reach, wall_reach), packing);
    if (!packing.bars.empty()) {
        std::ranges::sort(near);
    }
    for (const Contact& contact : near) {
        // In space most images within that reach cannot approach so far. In the plane they stay in the list because the
        // path of the simplex method, and with it the bits, depend on the list.
        if (packing.dimension == plane || !contact.is_unilateral() || rows.can_close(packing, contact, trust_)) {
            rows.add(packing, contact);
        }
    }
}

std::vector<Contact> ContactProgramme::candidates(const Packing& packing) const {
    Rows rows(packing);
    collect(packing, rows);
    return std::move(rows.contact);
}

BoxedProgramme ContactProgramme::boxed(const Packing& packing, const Rows& rows, double eps) const {
    BoxedProgramme programme;
    programme.start = rows.starts();
    programme.column = rows.column;
    programme.value = rows.value;
    const std::size_t disks = infinitesimal_->size();
    programme.bound.assign(rows.columns(), trust_);
    programme.cost.assign(rows.columns(), 0.0);
    for (std::size_t c = 0; c < rows.columns(); ++c) {
        const std::size_t k = rows.dofs.coordinate_of(c);
        if (k < disks) {
            programme.cost[c] = -objective_scale * eps * (*infinitesimal_)[k];
            continue;
        }
        const int a = static_cast<int>(k - disks);
        programme.bound[c] *= wall_trust(packing);
        if (a >= packing.dimension) {
            continue; // a tilt, which has no stress
        }
        programme.cost[c] = a == packing.dimension - 1 ? objective_scale * ratio_ : objective_scale;
        for (int b = 0; b < packing.dimension; ++b) {
            programme.cost[c] *= b == a ? 1.0 : packing.length(b);
        }
    }
    programme.lower.resize(rows.gap.size());
    for (std::size_t k = 0; k < rows.gap.size(); ++k) {
        programme.lower[k] = first_ && rows.contact[k].is_unilateral() ? std::min(0.0, -rows.gap[k]) : -rows.gap[k];
    }
    return programme;
}

bool ContactProgramme::stopped() const {
    return stop_ != nullptr && stop_->load(std::memory_order_relaxed);
}

ProgrammeStep ContactProgramme::solve(const Packing& packing, double eps) {
    Rows rows(packing);
    collect(packing, rows);
    const BoxedProgramme programme = boxed(packing, rows, eps);
    ProgrammeStep step;
    if (inside_) {
        count_work(Work::linear_programmes);
        const bool solved = solve_inside(rows, programme, step);
        if (stopped()) {
            step.outcome = ProgrammeStep::Outcome::interrupted;
        }
        if (solved || stopped()) {
            return step;
        }
    }
    solve_simplex(packing, rows, programme, step);
    return step;
}

void ContactProgramme::solve_simplex(const Packing& packing, Rows& rows, const BoxedProgramme& programme,
                                     ProgrammeStep& step) {
    ClpSimplex simplex;
    StopHandler handler(stop_);
    load(simplex, rows, programme);
    simplex.passInEventHandler(&handler);
    bool primal = false;
    if (first_) {
        primal = start_from_overlaps(simplex, packing, rows);
    } else {
        start_from_last(simplex, rows);
    }
    count_work(Work::linear_programmes);
    if (primal) {
        simplex.primal(1); // 1: start from the values given, not only from the basis
    } else {
        simplex.dual();
    }
    step.pivots = simplex.numberIterations();
    if (simplex.status() != 0 && !stopped()) {
        // A bad basis can make a programme look infeasible, so only the result from the slack basis counts.
        simplex.allSlackBasis(true);
        simplex.dual();
        step.pivots += simplex.numberIterations();
    }
    step.status = simplex.status();
    step.changes = step.pivots;
    if (stopped()) {
        step.outcome = ProgrammeStep::Outcome::interrupted;
    } else if (simplex.status() == 1) {
        step.outcome = ProgrammeStep::Outcome::infeasible;
    } else if (simplex.status() == 0) {
        step.outcome = ProgrammeStep::Outcome::optimal;
        take_solution(simplex, rows, step);
    }
}

void ContactProgramme::load(ClpSimplex& simplex, const Rows& rows, const BoxedProgramme& programme) {
    CoinPackedMatrix matrix(true, rows.row.data(), rows.column.data(), rows.value.data(),
                            static_cast<CoinBigIndex>(rows.value.size()));
    matrix.setDimensions(static_cast<int>(rows.contact.size()), static_cast<int>(programme.bound.size()));
    std::vector<double> lower(programme.bound.size());
    std::ranges::transform(programme.bound, lower.begin(), [](double bound) { return -bound; });
    simplex.setLogLevel(0);
    simplex.loadProblem(matrix, lower.data(), programme.bound.data(), programme.cost.data(), programme.lower.data(),
                        nullptr);
    for (std::size_t k = 0; k < rows.contact.size(); ++k) {
        if (!rows.contact[k].is_unilateral()) {
            simplex.setRowUpper(static_cast<int>(k), programme.lower[k]);
        }
    }
    simplex.setPrimalTolerance(tolerance);
    simplex.setDualTolerance(tolerance);
    simplex.setPerturbation(100); // no perturbation, because the multipliers are the result
}

/// Takes overlapping pairs as the first basis, if there are enough; the point 0 is feasible then.
bool ContactProgramme::start_from_overlaps(ClpSimplex& simplex, const Packing& packing, const Rows& rows) {
    const auto columns = static_cast<int>(rows.columns());
    const auto count = static_cast<int>(rows.contact.size());
    const int disks = packing.dimension * packing.disk_count();
    std::vector<Contact> closed;
    for (std::size_t k = 0; k < rows.gap.size(); ++k) {
        if (rows.gap[k] <= 0) {
            closed.push_back(rows.contact[k]);
        }
    }
    const std::vector<int> degree = contacts_per_disk(packing.disk_count(), closed);
    const auto nonbasic = static_cast<int>(closed.size());
    const auto hanging =
        static_cast<int>(std::ranges::count_if(degree, [&packing](int d) { return d < packing.dimension; }));
    if (nonbasic + packing.dimension * hanging < mostly_closed * columns) {
        return false;
    }
    for (int k = 0; k < count; ++k) {
        simplex.setRowStatus(k,
                             rows.gap[static_cast<std::size_t>(k)] <= 0 ? ClpSimplex::atLowerBound : ClpSimplex::basic);
    }
    for (int k = 0; k < columns; ++k) {
        const int at = rows.dofs.coordinate_of(k);
        const bool loose = at < disks && degree[static_cast<std::size_t>(at / packing.dimension)] < packing.dimension;
        simplex.setColumnStatus(k, loose ? ClpSimplex::superBasic : ClpSimplex::basic);
    }
    std::fill_n(simplex.primalColumnSolution(), columns, 0.0);
    std::fill_n(simplex.primalRowSolution(), count, 0.0);
    return true;
}

/// Starts from the basis of the previous programme, row by contact.
void ContactProgramme::start_from_last(ClpSimplex& simplex, const Rows& rows) const {
    Matching old(row_contact_);
    for (std::size_t k = 0; k < rows.contact.size(); ++k) {
        const auto known = old.find(rows.contact[k]);
        simplex.setRowStatus(static_cast<int>(k),
                             known ? static_cast<ClpSimplex::Status>(row_status_[*known]) : ClpSimplex::basic);
    }
    for (std::size_t k = 0; k < column_status_.size(); ++k) {
        simplex.setColumnStatus(static_cast<int>(k), static_cast<ClpSimplex::Status>(column_status_[k]));
    }
}

/// Stores the optimum in the step, and its basis in this object.
void ContactProgramme::take_solution(const ClpSimplex& simplex, Rows& rows, ProgrammeStep& step) {
    const auto columns = static_cast<std::size_t>(simplex.numberColumns());
    const double* const solution = simplex.primalColumnSolution();
    step.displacement = rows.on_coordinates(solution);
    step.largest = largest(std::span(step.displacement).first(infinitesimal_->size()));
    row_contact_ = std::move(rows.contact);
    row_status_.resize(row_contact_.size());
    column_status_.resize(columns);
    for (std::size_t k = 0; k < row_contact_.size(); ++k) {
        const ClpSimplex::Status status = simplex.getRowStatus(static_cast<int>(k));
        row_status_[k] = status;
        if (status != ClpSimplex::basic) {
            step.contacts.push_back(row_contact_[k]);
        }
    }
    for (std::size_t k = 0; k < columns; ++k) {
        const ClpSimplex::Status status = simplex.getColumnStatus(static_cast<int>(k));
        column_status_[k] = status;
        if (status != ClpSimplex::basic) {
            ++step.bounds;
            step.at_bounds.push_back(rows.dofs.coordinate_of(static_cast<int>(k)));
        }
    }
    first_ = false;
    inside_ = method_ == ProgrammeMethod::interior ||
              (method_ == ProgrammeMethod::interior_first && step.pivots > few_changes);
}

bool ContactProgramme::solve_inside(Rows& rows, const BoxedProgramme& programme, ProgrammeStep& step) {
    ActiveSet active = interior_point(programme, interior_tolerance, stop_);
    if (!active.converged) {
        return false; // infeasible, or out of range: the simplex method decides
    }
    step.outcome = ProgrammeStep::Outcome::optimal;
    step.displacement = rows.on_coordinates(active.x.data());
    step.largest = largest(std::span(step.displacement).first(infinitesimal_->size()));
    std::vector<int> row_status(rows.contact.size());
    Matching old(row_contact_);
    for (std::size_t k = 0; k < rows.contact.size(); ++k) {
        row_status[k] = active.row[k] != 0 ? ClpSimplex::atLowerBound : ClpSimplex::basic;
        if (active.row[k] != 0) {
            step.contacts.push_back(rows.contact[k]);
        }
        const auto known = old.find(rows.contact[k]);
        const bool before = known && row_status_[*known] != ClpSimplex::basic;
        step.changes += before != (active.row[k] != 0) ? 1 : 0;
    }
    column_status_.assign(active.column.size(), ClpSimplex::basic);
    long held = 0;
    for (std::size_t k = 0; k < active.column.size(); ++k) {
        if (active.column[k] != 0) {
            ++held;
            column_status_[k] = active.column[k] < 0 ? ClpSimplex::atLowerBound : ClpSimplex::atUpperBound;
        }
    }
    const long missing =
        std::abs(static_cast<long>(active.column.size()) - static_cast<long>(step.contacts.size()) - held);
    step.bounds = static_cast<int>(held + missing);
    row_contact_ = std::move(rows.contact);
    row_status_ = std::move(row_status);
    first_ = false;
    // The simplex method requires a basis that is nearly right.
    inside_ = method_ == ProgrammeMethod::interior || missing != 0 || step.changes > few_changes;
    return true;
}

} // namespace isostat::preparation
