#include "core/work.hpp"
#include "preparation/programme_rows.hpp"

#include <ClpSimplex.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace isostat::preparation {

namespace {

/// Two starts of 20 000 disks: 262 and 289 steps, of 10 000: 32 to 194. After so many the programmes have to do it.
constexpr int most_steps = 400;
constexpr int most_steps_late = 1500; ///< after Newton steps; samples of 60 000 to 100 000: 385 to 810
/// The gaps at the beginning, in the internal unit, that the products correspond to with mean forces: a few overlaps of
/// the dynamics. Five starts of 10 000 disks, well relaxed or hardly: 47 to 113 steps; with 1e-4 one of them, with 1e-3
/// two do not end in 130, because the packing first swells and rearranges.
constexpr double first_slack = 2e-5;
constexpr double first_slack_late = 3e-6; ///< after Newton steps
/// Forces of the start below this share of the mean are raised to it.
constexpr double least_force = 0.01;
/// Share of a complete contact list from which on the overlaps of the start are taken as its forces.
constexpr double dense_enough = 0.9;
/// The list of pairs is renewed when a disk has moved by this share of the trust bound; a step is bounded by the rest.
constexpr double renewal = 0.5;
/// Products below which the contacts can be read off, and steps for which they must stay the same. In the scale of the
/// objective a force is of order 400 and the rounding of a gap makes products of 1e-12.
constexpr double settled_product = 1e-9;
constexpr int settled_steps = 3;
/// Steps below that product after which the simplex method does the rest: a single disk may roll about for long.
constexpr int most_below = 25;
/// Slack of pairs that come into the list.
constexpr double least_slack = 1e-9;
constexpr double feasible = 1e-9;

/// Walks through two sorted lists: the place in `old` of each contact asked for, in order.
class Matching {
  public:
    explicit Matching(const std::vector<Contact>& old) : old_(old) {}
    std::optional<std::size_t> find(const Contact& contact) {
        while (next_ < old_.size() && old_[next_] < contact) {
            ++next_;
        }
        return next_ < old_.size() && old_[next_] == contact ? std::optional(next_) : std::nullopt;
    }

  private:
    const std::vector<Contact>& old_;
    std::size_t next_ = 0;
};

} // namespace

template <int Dim>
InteriorPoint ContactProgramme<Dim>::first_point(const Packing<Dim>& packing, const Rows& rows) const {
    // The overlaps of a relaxed soft packing are its forces; their scale makes the walls balance (virial).
    double virial = 0;
    std::size_t closed = 0;
    for (std::size_t k = 0; k < rows.contact.size(); ++k) {
        if (rows.gap[k] < 0) {
            ++closed;
            virial -= rows.gap[k] * rows.range(packing, k);
        }
    }
    double work = Dim * objective_scale;
    for (int a = 0; a < Dim; ++a) {
        work *= packing.length(a);
    }
    const double first = method_ == ProgrammeMethod::interior ? first_slack_late : first_slack;
    const double centre = work / static_cast<double>(rows.contact.size()) * first;
    const double force = centre / first; // of order of the mean one, as distances are of order 1
    const bool dense = static_cast<double>(closed) >= dense_enough * static_cast<double>(packing.q.size());
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

template <int Dim>
ProgrammeStep ContactProgramme<Dim>::descend(Packing<Dim>& packing, double eps,
                                             const std::function<void(const ProgrammeStep&)>& watch) {
    const std::size_t disks = infinitesimal_->size();
    const auto wanted = static_cast<long>(packing.q.size());
    ProgrammeStep step;
    Rows rows;
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
        double moved = 0;
        for (std::size_t k = 0; k < disks && !anchor.empty(); ++k) {
            moved = std::max(moved, std::abs(packing.q[k] - anchor[k]));
        }
        Rows next;
        const bool renew = !descent || moved > renewal * trust_;
        if (renew) {
            collect(packing, next);
        } else {
            for (const Contact& contact : rows.contact) {
                next.add(packing, contact);
            }
        }
        if (!descent) {
            point = first_point(packing, next);
        } else if (renew) {
            double product = 0;
            for (std::size_t l = 0; l < point.slack.size(); ++l) {
                product += point.slack[l] * point.force[l] / static_cast<double>(point.slack.size());
            }
            InteriorPoint matched;
            Matching old(rows.contact);
            std::vector<unsigned char> held(next.contact.size(), 0);
            for (std::size_t l = 0; l < next.contact.size(); ++l) {
                if (const auto before = old.find(next.contact[l])) {
                    matched.slack.push_back(point.slack[*before]);
                    matched.force.push_back(point.force[*before]);
                    held[l] = active.row[*before];
                } else {
                    matched.slack.push_back(std::max(next.gap[l], least_slack));
                    matched.force.push_back(product / matched.slack.back());
                }
            }
            point = std::move(matched);
            active.row = std::move(held);
        }
        rows = std::move(next);
        // A gap is never smaller than the linear one: the rest of it is slack.
        for (std::size_t l = 0; l < rows.gap.size(); ++l) {
            point.slack[l] = std::max(point.slack[l], rows.gap[l]);
        }
        BoxedProgramme programme = boxed(packing, rows, eps);
        for (double& bound : programme.bound) {
            bound *= 1 - renewal;
        }
        std::transform(rows.gap.begin(), rows.gap.end(), programme.lower.begin(), [](double h) { return -h; });
        if (renew) {
            anchor = packing.q;
            descent.emplace(programme);
        }
        InteriorStep made = descent->step(programme, point);
        if (!made.done) {
            break;
        }
        ++step.iterations;
        step.largest = 0;
        for (std::size_t k = 0; k < packing.q.size(); ++k) {
            packing.q[k] += made.x[k];
            step.largest = k < disks ? std::max(step.largest, std::abs(made.x[k])) : step.largest;
        }
        step.changes = 0;
        long held = 0;
        for (std::size_t l = 0; l < made.active.row.size(); ++l) {
            const bool before = !active.row.empty() && active.row[l] != 0;
            held += made.active.row[l];
            step.changes += before != (made.active.row[l] != 0) ? 1 : 0;
        }
        active = std::move(made.active);
        const bool bounded = std::any_of(active.column.begin(), active.column.end(), [](auto c) { return c != 0; });
        step.bounds = static_cast<int>(std::abs(held - wanted)) + (bounded ? 1 : 0);
        const bool low = made.product < settled_product && made.violation < feasible;
        below += low ? 1 : 0;
        settled = low && step.changes == 0 && step.bounds == 0 ? settled + 1 : 0;
        watch(step);
    }
    if (settled < settled_steps && below < most_below) {
        return step;
    }
    step.outcome = ProgrammeStep::Outcome::optimal;
    row_contact_ = std::move(rows.contact);
    row_status_.resize(row_contact_.size());
    for (std::size_t l = 0; l < row_contact_.size(); ++l) {
        row_status_[l] = active.row[l] != 0 ? ClpSimplex::atLowerBound : ClpSimplex::basic;
        if (active.row[l] != 0) {
            step.contacts.push_back(row_contact_[l]);
        }
    }
    column_status_.assign(packing.q.size(), ClpSimplex::basic);
    first_ = false;
    inside_ = step.bounds != 0 || step.changes > few_changes;
    return step;
}

template ProgrammeStep ContactProgramme<2>::descend(Packing<2>&, double,
                                                    const std::function<void(const ProgrammeStep&)>&);
template InteriorPoint ContactProgramme<2>::first_point(const Packing<2>&, const Rows&) const;

} // namespace isostat::preparation
