#include "preparation/attempt.hpp"
#include "preparation/programme.hpp"
#include "preparation/random.hpp"
#include "preparation/scale.hpp"
#include "preparation/stage.hpp"

#include <isostat/core/error.hpp>
#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace preparation {

namespace {

/// Largest displacement of a disk per programme, in mean radii. Measured: 0.07 needs 17 programmes where 0.27 needs 8
/// (rattlers fall farther), and a larger one adds rows that are never used.
constexpr double trust_in_radii = 0.27;
/// A Newton attempt is worth its cost below this step, in mean radii. A failed attempt only costs time.
constexpr double attempt_below = 0.05;
/// The programme has converged: the next one would not move the disks beyond its own tolerance.
constexpr double converged_below = 1e-8;
/// The finite weight of the infinitesimal loads may tip a weak backbone contact; then it is divided by this, at most
/// twice.
constexpr double weight_divisor = 100;
constexpr int weight_divisions = 2;

/// Largest (1 + w) that dilating the packing about the lower corner needs to part every overlapping pair.
template <int Dim> double dilation_needed(const Packing<Dim>& packing, const std::vector<Contact>& contacts) {
    double needed = 0;
    for (const Contact& c : contacts) {
        const double h = gap(packing, c);
        if (h < 0) {
            double range = packing.radius[static_cast<std::size_t>(c.i)];
            if (c.kind == ContactKind::disk_disk) {
                range += packing.radius[static_cast<std::size_t>(c.j)];
            }
            needed = std::max(needed, range / (range + h) - 1);
        }
    }
    return needed;
}

template <int Dim> void dilate(Packing<Dim>& packing, double by) {
    for (double& x : packing.q) {
        x *= 1 + by;
    }
}

} // namespace

} // namespace preparation

template <int Dim>
Result<State<Dim>> find_vertex(const Packing<Dim>& start, const PreparationOptions& options,
                               PreparationReport<Dim>& report) {
    using namespace preparation;
    validate(start, "start of the linear programmes");
    if (!(start.walls == Walls<Dim>::box()) ||
        std::count(start.fixed.begin(), start.fixed.end(), 0) != std::ssize(start.fixed)) {
        throw Error(ErrorKind::bad_input,
                    "the linear programmes need a box with two fixed and two movable walls and no fixed disk");
    }
    if (!(options.stress > 0) || !std::isfinite(options.stress)) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("stress is {}: expected a positive finite number", options.stress));
    }
    const Scale scale(start.radius);
    Packing<Dim> packing = scale.to_internal(start);
    report.last = start;
    report.infinitesimal_seed = derived_seed(options.seed, Stream::infinitesimal);
    Load<Dim> load;
    load.kind = options.load;
    load.stress.fill(options.stress);
    load.infinitesimal = generic_infinitesimal<Dim>(start.radius, report.infinitesimal_seed);
    const std::vector<double> g = generic_infinitesimal<Dim>(packing.radius, report.infinitesimal_seed);

    Stage stage("linear programmes", options);
    long newton_steps = 0;
    double newton_residual = 0;
    long pivots = 0;
    int programmes = 0;
    int contacts = 0;
    const auto close = [&](bool completed) {
        PreparationStage entry = stage.finish();
        entry.completed = completed;
        entry.iterations = pivots;
        entry.contacts = contacts;
        entry.solid_fraction = packing.solid_fraction();
        report.stages.push_back(entry);
        report.programmes += programmes;
        report.pivots += pivots;
        report.solid_fraction = entry.solid_fraction;
        if (newton_steps > 0) {
            PreparationStage newton;
            newton.name = "newton"; // its time is within that of the programmes
            newton.completed = completed;
            newton.iterations = newton_steps;
            newton.residual = newton_residual;
            newton.contacts = contacts;
            newton.solid_fraction = entry.solid_fraction;
            report.stages.push_back(newton);
        }
    };
    const auto fail = [&](FailureKind kind, const std::string& why) {
        close(false);
        report.last = scale.to_user(packing, start.radius);
        return Failure{kind, fmt::format("linear programmes: {}", why)};
    };

    const double mean_radius = scale.mean_radius();
    const double trust = trust_in_radii * mean_radius;
    double eps = options.infinitesimal_weight;
    int divisions = 0;
    bool dilated = false;
    ContactProgramme<Dim> programme(g, trust, options.stop);
    while (programmes < options.max_programmes) {
        const ProgrammeStep step = programme.solve(packing, eps);
        pivots += step.pivots;
        ++programmes;
        switch (step.outcome) {
        case ProgrammeStep::Outcome::optimal: break;
        case ProgrammeStep::Outcome::interrupted:
            return fail(FailureKind::interrupted, fmt::format("stopped during programme {}", programmes));
        case ProgrammeStep::Outcome::failed:
            return fail(FailureKind::not_converged,
                        fmt::format("Clp ended programme {} with status {}", programmes, step.status));
        case ProgrammeStep::Outcome::infeasible: {
            // Overlaps too large to be undone within the trust bounds: part the disks first.
            const double needed = dilation_needed(packing, programme.candidates(packing));
            if (dilated || !(needed > 0)) {
                return fail(FailureKind::overlap,
                            fmt::format("programme {} has no feasible point, overlaps up to {:.3g} of a distance",
                                        programmes, needed));
            }
            dilate(packing, needed);
            dilated = true;
            continue;
        }
        }
        for (std::size_t k = 0; k < packing.q.size(); ++k) {
            packing.q[k] += step.displacement[k];
        }
        contacts = static_cast<int>(step.contacts.size());
        stage.progress(std::clamp(-std::log10(step.largest / mean_radius + 1e-12) / 8, 0.0, 1.0),
                       fmt::format("programme {}: {} pivots, {} of {} contacts, step {:.1e}", programmes, step.pivots,
                                   contacts, packing.q.size(), step.largest / mean_radius));
        if (step.bounds != 0 || step.largest > attempt_below * mean_radius || programmes < 2) {
            continue; // the first programme keeps the overlaps of the start
        }
        auto polished = polish(scale.to_user(packing, start.radius), step.contacts, load, newton_steps);
        if (polished.ok()) {
            Polished<Dim>& vertex = polished.value();
            newton_residual = vertex.max_gap;
            close(true);
            report.solid_fraction = vertex.state.packing.solid_fraction();
            report.rattlers = vertex.rattlers;
            report.min_force = vertex.min_force;
            report.min_gap = vertex.min_gap;
            report.sigma_min_bound = vertex.sigma_min_bound;
            report.last.reset();
            return std::move(vertex.state);
        }
        // Not yet: the next programme sees the normals and the lengths of the point reached. When it cannot change
        // anything any more:
        if (step.largest <= converged_below * mean_radius && step.pivots == 0) {
            if (polished.failure().kind != FailureKind::not_converged || divisions == weight_divisions) {
                return fail(polished.failure().kind, polished.failure().message);
            }
            eps /= weight_divisor;
            ++divisions;
        }
    }
    return fail(FailureKind::not_converged, fmt::format("no vertex after {} programmes", programmes));
}

template struct PreparationReport<2>;
template Result<State<2>> find_vertex<2>(const Packing<2>&, const PreparationOptions&, PreparationReport<2>&);

} // namespace isostat
