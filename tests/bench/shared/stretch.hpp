#pragma once
// A stretch of trajectory, timed, with the units of the tables measured on its own matrices on the way.

#include "bench/shared/sample.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bench {

/// What a word of the command line names: a number of disks, or of spheres in a box, prepared with seed 1 ("400") or
/// another ("400:7"), or a state file. Says why when there is nothing.
std::optional<isostat::State> start(const std::string& source, int dimension = isostat::plane);

struct StretchOptions {
    isostat::CertifyLevel level = isostat::CertifyLevel::decisions;
    int equilibria = 30;
    long arcs = 0;   ///< ends after this many arcs, wherever that is; 0: at the last equilibrium
    int threads = 1; ///< one: CPU time of the thread; more: time on the wall
    /// Called at every equilibrium; its time is not the run's.
    std::function<void(const isostat::State&)> visit{};
};

struct Stretch {
    isostat::RunCounters counters;
    std::vector<isostat::ArcRecord> arcs;
    double milliseconds_per_arc = 0; ///< all of the run, equilibria included, shared out among its arcs
    double cpu_per_arc = 0;          ///< the same of all threads together, CPU time
    double klu = 0, umfpack = 0;     ///< medians over the equilibria: one analysis + factorisation, milliseconds
    std::string failure;             ///< empty: completed
};

/// The time that the units and `visit` take is not counted. With several threads the units are still those of one.
Stretch run_stretch(const isostat::State& from, const StretchOptions& options);

/// Repeats of the same stretch.
struct Stretches {
    std::vector<Stretch> runs;
    [[nodiscard]] const Stretch& front() const { return runs.front(); }
    [[nodiscard]] Sample per_arc() const;
    [[nodiscard]] Sample cpu_per_arc() const;
    [[nodiscard]] Sample klu() const;
    [[nodiscard]] Sample umfpack() const;
};

} // namespace bench
