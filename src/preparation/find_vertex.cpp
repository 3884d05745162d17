#include "contact/contact_set.hpp"
#include "contact/images.hpp"
#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"
#include "contact/words.hpp"
#include "core/refuse.hpp"
#include "preparation/polish.hpp"
#include "preparation/programme.hpp"
#include "preparation/random.hpp"
#include "preparation/scale.hpp"
#include "preparation/stage.hpp"
#include "verified/to_vertex.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace isostat {

namespace preparation {

namespace {

/// Largest displacement of a disk per programme, in mean radii. Measured at n = 1936: 0.07 needs 13 programmes where
/// 0.27 needs 9, because rattlers fall farther; a larger value adds rows that are never used.
constexpr double trust_in_radii = 0.27;
/// A failed attempt at Newton and the proofs only costs time. An attempt is made after a step below the first value
/// (mean radii) when the basis has nearly settled, or below the second value in any case.
constexpr double attempt_below = 0.05;
constexpr double attempt_always_below = 0.001;
constexpr long settled_pivots = 2;
/// Distance, in largest radii, within which a programme lists the pairs of a cell; its rows need less.
constexpr double listed_within = 8;
/// Bodies turn by less than this allows: by shorter steps, for longer. What still moves then hangs, and swings.
constexpr double trust_of_bodies = 0.1;
constexpr int swinging = 100;
/// After a step below this (mean radii) without pivots the next programme would change nothing.
constexpr double converged_below = 1e-8;
/// The finite weight of the infinitesimal loads may open a weak backbone contact; it is then divided by this, once.
constexpr double weight_divisor = 10;
/// Share of the smallest radius below which a gap counts as touching in the choice of the pinned disk.
constexpr double near_enough = 1e-3;

/// Relative dilation about the lower corner that parts every overlapping pair.
double dilation_needed(const Packing& packing, const std::vector<Contact>& contacts) {
    double needed = 0;
    for (const Contact& c : contacts) {
        const double h = gap(packing, c);
        if (h < 0) {
            const double range = touching_distance(packing.radius, c);
            needed = std::max(needed, range / (range + h) - 1);
        }
    }
    return needed;
}

void require_sensible(const Packing& start, const PreparationOptions& options) {
    Packing checked = start; // a soft packing may overlap its box a little
    for (int a = 0;
         a < start.dimension && !start.radius.empty() && start.q.size() == start.axes() * (start.radius.size() + 1);
         ++a) {
        checked.length(a) = start.length(a) > 0 ? std::max(start.length(a), 2 * start.max_radius()) : start.length(a);
    }
    validate(checked, "start of the linear programmes");
    const auto is_fixed = [](unsigned char flag) { return flag != 0; };
    const Cell& cell = start.cell;
    bool gives_way = std::ranges::none_of(start.fixed, is_fixed);
    for (std::size_t a = 0; a < start.axes(); ++a) {
        const bool box = start.walls.lower[a] == WallKind::fixed && start.walls.upper[a] == WallKind::movable;
        gives_way = gives_way && (cell.periodic[a] ? cell.period_moves[a] || cell.keeps_shape : box);
    }
    if (!gives_way) {
        refuse("start of the linear programmes",
               "expected along each axis a fixed and a movable wall, or a period that moves, and no fixed disk");
    }
    if (cell.any() &&
        (start.disk_count() > options.large_above || (cell.shears() && options.load != LoadKind::nominal))) {
        refuse("start of the linear programmes",
               "expected at most {} disks in a periodic cell, and nominal stresses where its tilt moves",
               options.large_above);
    }
    for (const auto& [name, value] : {std::pair{"stress", options.stress},
                                      {"ratio of the stresses", options.ratio},
                                      {"weight of the infinitesimal loads", options.infinitesimal_weight}}) {
        if (!(value > 0) || !std::isfinite(value)) {
            refuse("preparation", "{} is {}: expected a positive finite number", name, value);
        }
    }
}

/// The sequence of programmes and of attempts at the vertex. Lengths are in the internal unit until `polish`.
class VertexSearch {
  public:
    VertexSearch(const Packing& start, const PreparationOptions& options, PreparationReport& report)
        : options_(options), report_(report), radius_(start.radius), scale_(start.radius),
          packing_(scale_.to_internal(start)), stage_("linear programmes", options) {
        report_.infinitesimal_seed = derived_seed(options.seed, Stream::infinitesimal);
        load_.kind = options.load;
        load_.dimension = start.dimension;
        load_.loaded_axis = start.dimension - 1;
        std::fill_n(load_.stress.begin(), packing_.dimension, options.stress);
        load_.stress[start.axes() - 1] *= options.ratio;
        if (packing_.cell.any()) {
            // The disk with the most overlaps, which is hardly ever a rattler.
            packing_.cell.pin =
                most_held(packing_.disk_count(), near_contacts(packing_, near_enough * packing_.min_radius(), 0));
        }
        load_.infinitesimal = infinitesimal_loads(radius_);
    }

    Result<State> run() {
        const std::vector<double> g = infinitesimal_loads(packing_.radius);
        const bool large = packing_.disk_count() > options_.large_above;
        const ProgrammeMethod method = !large ? ProgrammeMethod::simplex
                                       : packing_.disk_count() > options_.newton_above
                                           ? ProgrammeMethod::interior
                                           : ProgrammeMethod::interior_first;
        ContactProgramme programme(g, (packing_.bars.empty() ? trust_in_radii : trust_of_bodies) * scale_.mean_radius(),
                                   method, options_.stop, options_.ratio);
        double weight = options_.infinitesimal_weight;
        bool divided = false;
        if (large && options_.max_programmes > 0) {
            if (auto vertex = descend(programme, weight)) {
                return succeed(std::move(*vertex));
            }
        }
        while (programmes_ < options_.max_programmes) {
            ProgrammeStep step = programme.solve(packing_, weight);
            ++programmes_;
            pivots_ += step.pivots;
            if (auto failure = judge(step, programme)) {
                return give_up(*failure);
            }
            if (step.outcome == ProgrammeStep::Outcome::infeasible) {
                continue;
            }
            move(step);
            if (auto failure = stuck(step)) {
                return give_up(*failure);
            }
            if (!worth_an_attempt(step) || (step.bounds != 0 && !complete(programme, weight, step.contacts))) {
                continue;
            }
            auto polished = attempt(step.contacts);
            if (polished.ok()) {
                return succeed(std::move(polished.value()));
            }
            // The attempt failed: the next programme has the normals and
            // lengths of the new point, unless the step changed nothing.
            if (step.changes == 0 && step.largest <= converged_below * scale_.mean_radius()) {
                // Clp ignores forces and gaps below its tolerances, and does not know that eps is infinitesimal.
                auto pivoted = finish(step.contacts);
                if (pivoted.ok()) {
                    return succeed(std::move(pivoted.value()));
                }
                if (report_.candidate || pivoted.failure().kind == FailureKind::tie ||
                    pivoted.failure().kind == FailureKind::interrupted) {
                    return give_up(pivoted.failure());
                }
                if (divided || polished.failure().kind != FailureKind::not_converged) {
                    return give_up(
                        failed(polished.failure().kind, "{}; then: {}", polished.failure(), pivoted.failure()));
                }
                weight /= weight_divisor;
                divided = true;
            }
        }
        return give_up(failed(FailureKind::not_converged, "no vertex after {} programmes", programmes_));
    }

  private:
    /// In a cell the loads sum to zero because the pinned disk bears minus the loads of the others.
    [[nodiscard]] std::vector<double> infinitesimal_loads(const std::vector<double>& radius) const {
        std::vector<double> g = generic_infinitesimal(radius, report_.infinitesimal_seed, packing_.dimension);
        balance(g, packing_.cell);
        return g;
    }
    /// The descent, then Newton and the proofs. Empty: the programmes go on from the end of the descent.
    std::optional<Polished> descend(ContactProgramme& programme, double weight) {
        const Stage stage("interior descent", options_);
        const ProgrammeStep end = programme.descend(packing_, weight, [&](const ProgrammeStep& step) {
            stage.progress(static_cast<double>(step.iterations) / (50.0 + static_cast<double>(step.iterations)),
                           fmt::format("step {}: {} changes, {:.1e} radii", step.iterations, step.changes,
                                       step.largest / scale_.mean_radius()));
        });
        std::vector<Contact> contacts = end.contacts;
        const bool completed = end.outcome == ProgrammeStep::Outcome::optimal;
        report_.stages.push_back(
            stage.finish(completed, end.iterations, static_cast<int>(contacts.size()), packing_.solid_fraction()));
        if (!completed || (end.bounds != 0 && !complete(programme, weight, contacts))) {
            return std::nullopt;
        }
        contacts_ = static_cast<int>(contacts.size());
        auto polished = attempt(contacts);
        return polished.ok() ? std::optional(std::move(polished.value())) : std::nullopt;
    }

    /// Adds the contacts that an interior-point method left open; true when the list is complete.
    bool complete(ContactProgramme& programme, double weight, std::vector<Contact>& contacts) {
        return contacts.size() < static_cast<std::size_t>(DofMap(packing_).dof_count()) &&
               programme.complete(packing_, weight, contacts);
    }

    Result<Polished> attempt(const std::vector<Contact>& contacts) {
        return timed([&] { return polish(scale_.to_user(packing_, radius_), contacts, load_, newton_.iterations); });
    }

    Result<Polished> finish(const std::vector<Contact>& contacts) {
        const PivotLimits limits{attempt_below * scale_.mean_radius() * scale_.unit(), options_.stop};
        return timed([&] {
            return pivot_to_vertex(scale_.to_user(packing_, radius_), contacts, load_, limits, newton_.iterations,
                                   report_.candidate);
        });
    }

    template <class Work> Result<Polished> timed(const Work& work) {
        const Stopwatch watch;
        auto result = work();
        newton_.seconds += watch.seconds();
        newton_.cpu_seconds += watch.cpu_seconds();
        return result;
    }

    /// Leaves the state with what moves freely held, and without infinitesimal loads, to another proof.
    Failure with_free_motions(const ProgrammeStep& step) {
        State& state = report_.candidate.emplace();
        state.packing = scale_.to_user(packing_, radius_);
        state.contacts = step.contacts;
        for (const int coordinate : step.at_bounds) {
            state.contacts.emplace_back(ContactKind::held, coordinate, 0);
        }
        std::ranges::sort(state.contacts);
        const auto failure = to_vertex(state.packing, state.contacts, newton_.iterations);
        snap_to_grid(state.packing);
        state.load = load_;
        state.load.infinitesimal.clear();
        state.load.refer_to(state.packing);
        return failure.value_or(
            failed(FailureKind::not_converged, "{} coordinates move freely", step.at_bounds.size()));
    }

    /// A failure when only what bears no force still moves, or the cell is too flat for the next programme.
    std::optional<Failure> stuck(const ProgrammeStep& step) {
        if (!packing_.bars.empty() && programmes_ > swinging && step.bounds != 0) {
            return with_free_motions(step);
        }
        const auto beyond = packing_.cell.any()
                                ? disk_beyond(packing_, listed_within * packing_.max_radius(), farthest_disk)
                                : std::nullopt;
        return beyond ? std::optional(failed(FailureKind::not_converged,
                                             "after programme {} the cell is too flat, or too tilted: {}", programmes_,
                                             *beyond))
                      : std::nullopt;
    }

    std::optional<Failure> judge(const ProgrammeStep& step, const ContactProgramme& programme) {
        switch (step.outcome) {
        case ProgrammeStep::Outcome::optimal: return std::nullopt;
        case ProgrammeStep::Outcome::interrupted:
            return failed(FailureKind::interrupted, "stopped during programme {}", programmes_);
        case ProgrammeStep::Outcome::infeasible: {
            // These overlaps cannot be undone within the trust bounds, so the disks are parted first.
            const double needed = dilation_needed(packing_, programme.candidates(packing_));
            if (dilated_ || !(needed > 0)) {
                return failed(FailureKind::overlap,
                              "programme {} has no feasible point, overlaps up to {:.3g} of a distance", programmes_,
                              needed);
            }
            for (double& x : packing_.q) {
                x *= 1 + needed;
            }
            dilated_ = true;
            return std::nullopt;
        }
        case ProgrammeStep::Outcome::failed: break;
        }
        return failed(FailureKind::not_converged, "Clp ended programme {} with status {}", programmes_, step.status);
    }

    void move(const ProgrammeStep& step) {
        for (std::size_t k = 0; k < packing_.q.size(); ++k) {
            packing_.q[k] += step.displacement[k];
        }
        contacts_ = static_cast<int>(step.contacts.size());
        const double relative = step.largest / scale_.mean_radius();
        stage_.progress(std::clamp(std::log(relative + converged_below) / std::log(converged_below), 0.0, 1.0),
                        fmt::format("programme {}: {} changes, {} of {} contacts, step {:.1e} radii", programmes_,
                                    step.changes, contacts_, DofMap(packing_).dof_count(), relative));
    }

    [[nodiscard]] bool worth_an_attempt(const ProgrammeStep& step) const {
        const double below = step.changes <= settled_pivots ? attempt_below : attempt_always_below;
        return programmes_ > 1 // the first programme keeps the overlaps of the start
               && step.largest <= below * scale_.mean_radius();
    }

    void record(bool completed) {
        PreparationStage entry = stage_.finish(completed, pivots_, contacts_, packing_.solid_fraction());
        entry.seconds -= newton_.seconds;
        entry.cpu_seconds -= newton_.cpu_seconds;
        newton_.name = "newton and proofs";
        newton_.completed = completed;
        newton_.contacts = contacts_;
        newton_.solid_fraction = entry.solid_fraction;
        report_.solid_fraction = entry.solid_fraction;
        report_.stages.push_back(std::move(entry));
        report_.stages.push_back(newton_);
        report_.programmes += programmes_;
        report_.pivots += pivots_;
    }

    Failure give_up(const Failure& why) {
        record(false);
        report_.last = scale_.to_user(packing_, radius_);
        return located(why, "linear programmes");
    }

    State succeed(Polished vertex) {
        newton_.residual = vertex.max_gap;
        record(true);
        report_.solid_fraction = vertex.state.packing.solid_fraction();
        report_.rattlers = vertex.rattlers;
        report_.min_force = vertex.min_force;
        report_.min_gap = vertex.min_gap;
        report_.sigma_min_bound = vertex.sigma_min_bound;
        report_.last.reset();
        report_.candidate.reset();
        return std::move(vertex.state);
    }

    const PreparationOptions& options_;
    PreparationReport& report_;
    std::vector<double> radius_; ///< the user's
    Scale scale_;
    Packing packing_; ///< internal unit
    Load load_;
    Stage stage_;
    PreparationStage newton_;
    int programmes_ = 0;
    long pivots_ = 0;
    int contacts_ = 0;
    bool dilated_ = false;
};

} // namespace

} // namespace preparation

Result<State> find_vertex(const Packing& start, const PreparationOptions& options, PreparationReport& report) {
    require_floating_point();
    preparation::require_sensible(start, options);
    return preparation::VertexSearch(start, options, report).run();
}

} // namespace isostat
