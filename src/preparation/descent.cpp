#include "preparation/programme_rows.hpp"

#include <ClpSimplex.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace isostat::preparation {

namespace {

/// Two starts of 20 000 disks took 262 and 289 steps, of 10 000: 32 to 194. After most_steps, programmes follow.
constexpr int most_steps = 400;
constexpr int most_steps_late = 1500; ///< after Newton steps; samples of 60 000 to 100 000 disks took 385 to 810
/// Gaps at the beginning, in the internal unit, to which the products of mean forces correspond: a few overlaps of the
/// dynamics. Five starts of 10 000 disks, relaxed well or hardly, took 47 to 113 steps; with 1e-4 one of the starts,
/// and with 1e-3 two of them, did not end in 130 steps, because the packing first swells and rearranges.
constexpr double first_slack = 2e-5;
constexpr double first_slack_late = 3e-6; ///< after Newton steps
/// Forces of the start below this share of the mean are raised to it.
constexpr double least_force = 0.01;
/// Share of a complete contact list from which on the overlaps of the start are used as its forces.
constexpr double dense_enough = 0.9;
/// The list of pairs is renewed when a disk has moved by this share of the trust bound; the rest bounds a step.
constexpr double renewal = 0.5;
/// Products below which the contacts can be identified, and the number of steps for which the contacts must stay the
/// same. In the scale of the objective a force is of order 400, and the rounding of a gap makes products of 1e-12.
constexpr double settled_product = 1e-9;
constexpr int settled_steps = 3;
/// After so many steps below that product the simplex method goes on, because a single disk may roll about for long.
constexpr int most_below = 25;
/// Slack of pairs that enter the list.
constexpr double least_slack = 1e-9;
constexpr double feasible = 1e-9;

/// The interior point for a renewed list: pairs that stay keep their slack and force, and the others begin with the
/// mean product. `active` is renumbered in the same way.
InteriorPoint carry(const InteriorPoint& point, const std::vector<Contact>& before, const std::vector<Contact>& after,
                    const std::vector<double>& gaps, ActiveSet& active) {
    double product = 0;
    for (std::size_t l = 0; l < point.slack.size(); ++l) {
        product += point.slack[l] * point.force[l] / static_cast<double>(point.slack.size());
    }
    InteriorPoint matched;
    Matching old(before);
    std::vector<unsigned char> held(after.size(), 0);
    for (std::size_t l = 0; l < after.size(); ++l) {
        if (const auto place = old.find(after[l])) {
            matched.slack.push_back(point.slack[*place]);
            matched.force.push_back(point.force[*place]);
            held[l] = active.row[*place];
        } else {
            matched.slack.push_back(std::max(gaps[l], least_slack));
            matched.force.push_back(product / matched.slack.back());
        }
    }
    active.row = std::move(held);
    return matched;
}

/// Largest displacement of a disk since the list was made; 0 while no list exists.
double moved_since(const std::vector<double>& anchor, const std::vector<double>& q, std::size_t disk_coordinates) {
    double moved = 0;
    for (std::size_t k = 0; k < disk_coordinates && !anchor.empty(); ++k) {
        moved = std::max(moved, std::abs(q[k] - anchor[k]));
    }
    return moved;
}

/// Counts the changes of an iteration among the active rows, and how many rows more or fewer than a basis are active.
void count_changes(const ActiveSet& before, const ActiveSet& now, std::size_t coordinates, ProgrammeStep& step) {
    step.changes = 0;
    long held = 0;
    for (std::size_t l = 0; l < now.row.size(); ++l) {
        const bool was = !before.row.empty() && before.row[l] != 0;
        held += now.row[l];
        step.changes += was != (now.row[l] != 0) ? 1 : 0;
    }
    const bool bounded = std::ranges::any_of(now.column, [](auto c) { return c != 0; });
    step.bounds = static_cast<int>(std::abs(held - static_cast<long>(coordinates))) + (bounded ? 1 : 0);
}

/// Moves the degrees of freedom; returns the largest displacement of a disk's coordinate.
double displace(Packing& packing, const DofMap& dofs, const std::vector<double>& x, std::size_t disks) {
    double largest = 0;
    for (int c = 0; c < dofs.dof_count(); ++c) {
        const auto k = static_cast<std::size_t>(dofs.coordinate_of(c));
        const double step = x[static_cast<std::size_t>(c)];
        packing.q[k] += step;
        largest = k < disks ? std::max(largest, std::abs(step)) : largest;
    }
    return largest;
}

} // namespace

InteriorPoint ContactProgramme::first_point(const Packing& packing, const Rows& rows) const {
    // The forces are proportional to the overlaps of a relaxed soft packing, on the scale that balances the walls.
    double virial = 0;
    std::size_t closed = 0;
    for (std::size_t k = 0; k < rows.contact.size(); ++k) {
        if (rows.gap[k] < 0) {
            ++closed;
            virial -= rows.gap[k] * rows.range(packing, k);
        }
    }
    double work = packing.dimension * objective_scale;
    for (int a = 0; a < packing.dimension; ++a) {
        work *= packing.length(a);
    }
    const double first = method_ == ProgrammeMethod::interior ? first_slack_late : first_slack;
    const double centre = work / static_cast<double>(rows.contact.size()) * first;
    const double force = centre / first; // of the order of the mean force, because distances are of order 1
    const bool dense = static_cast<double>(closed) >= dense_enough * static_cast<double>(rows.columns());
    InteriorPoint point;
    for (const double h : rows.gap) {
        if (h < 0 && dense) {
            point.force.push_back(std::max(work / virial * -h, least_force * force));
            point.slack.push_back(centre / point.force.back());
        } else {
            point.slack.push_back(std::max(h, first));
            point.force.push_back(centre / point.slack.back());
        }
    }
    return point;
}

ProgrammeStep ContactProgramme::descend(Packing& packing, double eps,
                                        const std::function<void(const ProgrammeStep&)>& watch) {
    const std::size_t disks = infinitesimal_->size();
    ProgrammeStep step;
    Rows rows(packing);
    InteriorPoint point;
    ActiveSet active;
    std::optional<InteriorDescent> descent;
    std::vector<double> anchor;
    int settled = 0;
    int below = 0;
    const int most = method_ == ProgrammeMethod::interior ? most_steps_late : most_steps;
    while (step.iterations < most && settled < settled_steps && below < most_below) {
        if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) {
            step.outcome = ProgrammeStep::Outcome::interrupted;
            return step;
        }
        Rows next(packing);
        const bool renew = !descent || moved_since(anchor, packing.q, disks) > renewal * trust_;
        if (renew) {
            collect(packing, next);
            point = descent ? carry(point, rows.contact, next.contact, next.gap, active) : first_point(packing, next);
        } else {
            for (const Contact& contact : rows.contact) {
                next.add(packing, contact);
            }
        }
        rows = std::move(next);
        // A gap is never smaller than the linear gap, so the difference is slack.
        for (std::size_t l = 0; l < rows.gap.size(); ++l) {
            point.slack[l] = std::max(point.slack[l], rows.gap[l]);
        }
        BoxedProgramme programme = boxed(packing, rows, eps);
        for (double& bound : programme.bound) {
            bound *= 1 - renewal;
        }
        std::ranges::transform(rows.gap, programme.lower.begin(), [](double h) { return -h; });
        if (renew) {
            anchor = packing.q;
            descent.emplace(programme);
        }
        InteriorStep made = descent->step(programme, point);
        if (!made.done) {
            break;
        }
        ++step.iterations;
        step.largest = displace(packing, rows.dofs, made.active.x, disks);
        count_changes(active, made.active, rows.columns(), step);
        active = std::move(made.active);
        const bool low = made.product < settled_product && made.violation < feasible;
        below += low ? 1 : 0;
        settled = low && step.changes == 0 && step.bounds == 0 ? settled + 1 : 0;
        watch(step);
    }
    if (settled >= settled_steps || below >= most_below) {
        keep_basis(std::move(rows), active, step);
    }
    return step;
}

void ContactProgramme::keep_basis(Rows rows, const ActiveSet& active, ProgrammeStep& step) {
    step.outcome = ProgrammeStep::Outcome::optimal;
    row_contact_ = std::move(rows.contact);
    row_status_.resize(row_contact_.size());
    for (std::size_t l = 0; l < row_contact_.size(); ++l) {
        row_status_[l] = active.row[l] != 0 ? ClpSimplex::atLowerBound : ClpSimplex::basic;
        if (active.row[l] != 0) {
            step.contacts.push_back(row_contact_[l]);
        }
    }
    column_status_.assign(rows.columns(), ClpSimplex::basic);
    first_ = false;
    inside_ = step.bounds != 0 || step.changes > few_changes;
}

} // namespace isostat::preparation
