// Accuracy against time of forces and positions when factors are taken over from an earlier vertex instead of made
// anew: what refinement of stale factors loses. Forces: of the matrix of one equilibrium, with factors of an
// equilibrium some arcs earlier, corrected for the contacts exchanged in between, against forces in double-double.
// Positions: distance of the stored vertices of a run from the true ones, level by level. CPU time of one thread.
// Units: one KLU, one UMFPACK analysis + factorisation of the same matrix. Usage:
//   bench_stale_factors [--json FILE] [--equilibria E] [--repeats R] [n | STATE_FILE]        1936, E: 10, R: 9
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"
#include "statics/statics.hpp"
#include "verified/configuration.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace isostat;

namespace {

struct Recorder : RunObserver {
    std::vector<State> states;
    std::vector<int> arcs;
    void on_equilibrium(const EquilibriumRecord& record, const State& state, const std::vector<double>&) override {
        states.push_back(state);
        arcs.push_back(record.arcs);
    }
};

Recorder run(const State& start, int equilibria) {
    Recorder recorder;
    State state = start;
    RunCounters counters;
    Segment segment;
    segment.equilibria = equilibria;
    RunOptions options;
    const auto outcome = run_segment(state, segment, 0, options, counters, recorder);
    if (!outcome.completed) {
        fmt::print(stderr, "{}\n", outcome.failure->message());
    }
    return recorder;
}

/// A state with its structure, its forces in double-double and the distance to its true vertex.
struct Reference {
    IsostaticStructure structure;
    Factorisation factorisation;
    InverseBound inverse;
    std::vector<double> load, force;
    double bound = 0, size = 0, distance = 0;

    Reference(const State& state, IsostaticStructure proved) : structure(std::move(proved)), factorisation(structure) {
        InverseBoundCache cache;
        inverse = bound_inverse(structure, factorisation, cache);
        Statics statics(state.packing, state.load, structure, factorisation, inverse);
        (void)statics.climb();
        const double sigma = state.load.loaded_stress();
        load = statics.external_force(sigma);
        for (std::size_t l = 0; l < load.size(); ++l) {
            force.push_back(statics.force(ContactId(l), sigma).value);
            size = std::max(size, std::abs(force.back()));
        }
        bound = statics.bound(sigma);
        const VertexEnclosure vertex = enclose_vertex_double_double(state.packing, structure, factorisation, inverse);
        for (const double c : vertex.correction) {
            distance = std::max(distance, std::abs(c));
        }
    }
    [[nodiscard]] double error(const std::vector<double>& f) const {
        double largest = 0;
        for (std::size_t l = 0; l < f.size(); ++l) {
            largest = std::max(largest, std::abs(f[l] - force[l]));
        }
        return largest / size;
    }
};

std::unique_ptr<Reference> reference(const State& state) {
    auto proved = IsostaticStructure::prove(state.packing, state.contacts);
    return proved.ok() ? std::make_unique<Reference>(state, std::move(proved.value())) : nullptr;
}

} // namespace

int main(int argc, char** argv) {
    std::string source = "1936";
    int equilibria = 10;
    int repeats = 9;
    bench::Program program("bench_stale_factors", "what refinement of factors taken over loses, against its cost");
    program.option("--equilibria", equilibria, "equilibria of the runs");
    program.option("--repeats", repeats, "of each time");
    program.option("start", source, "number of disks or state file");
    if (const auto status = program.parse(argc, argv)) {
        return *status;
    }
    const auto start = bench::start(source);
    if (!start) {
        return 1;
    }
    const Recorder proved = run(*start, equilibria);
    const State& last = proved.states.back();
    const auto end = reference(last);
    if (!end) {
        return 1;
    }
    bench::Table forces("stale_factors",
                        fmt::format("Forces at equilibrium {} of {} disks; error of the reference at most {:.1e}:",
                                    proved.states.size() - 1, last.packing.disk_count(), end->bound / end->size),
                        {{"arcs", "factors from how many arcs before", ""},
                         {"exchanged", "contacts exchanged since", ""},
                         {"asked", "accuracy asked", "", "{:.0e}"},
                         {"passes", "passes", ""},
                         {"klu", "time / KLU analysis + factorisation", "KLU", "{:.3f}"},
                         {"umfpack", "time / UMFPACK", "UMFPACK", "{:.3f}"},
                         {"error", "error of the forces", "", "{:.1e}"},
                         {"refactorised", "given up, factorised", ""}});
    const auto line = [&](int arcs, int exchanged, bench::Cell asked, int passes, bool given_up, double error,
                          auto work) {
        const auto& matrix = end->structure.matrix();
        const bench::Pair to_klu = bench::in_turn(
            work, [&] { bench::klu(matrix); }, repeats);
        const bench::Pair to_umfpack = bench::in_turn(
            work, [&] { bench::umfpack(matrix); }, repeats);
        forces.add({static_cast<long>(arcs), static_cast<long>(exchanged), std::move(asked), static_cast<long>(passes),
                    to_klu.ratio(), to_umfpack.ratio(), error, given_up});
    };
    std::vector<double> f = end->load;
    end->factorisation.solve_forces(f);
    std::vector<double> again;
    line(0, 0, std::monostate(), 1, false, end->error(f), [&] {
        again = end->load;
        end->factorisation.solve_forces(again);
    });
    int arcs = 0;
    for (std::size_t back = proved.states.size() - 1; back-- > 0;) {
        arcs += proved.arcs[back + 1];
        if (proved.states[back].contacts.size() != last.contacts.size()) {
            break;
        }
        ApproximateInverse inverse(
            contact_matrix(proved.states[back].packing, end->structure.dofs(), proved.states[back].contacts));
        int exchanged = 0;
        for (std::size_t slot = 0; slot < last.contacts.size(); ++slot) {
            if (proved.states[back].contacts[slot] != last.contacts[slot]) {
                inverse = inverse.exchanged(static_cast<int>(slot), end->structure.matrix());
                ++exchanged;
            }
        }
        for (const double accuracy : {1e-6, 1e-9, 1e-12, 0x1p-51}) {
            int passes = 0;
            bool given_up = false;
            // A new object each time: one that gave up keeps its new factors.
            const auto solve = [&] {
                const Factorisation taken_over(end->structure, inverse);
                f = end->load;
                taken_over.solve_forces_from(f, {}, accuracy);
                passes = taken_over.passes();
                given_up = taken_over.is_fresh();
            };
            solve();
            line(arcs, exchanged, accuracy, passes, given_up, end->error(f), solve);
        }
    }
    bench::Table levels(
        "levels", "Distance of the stored vertices of a run from the true ones:",
        {{"equilibria", "equilibria", ""}, {"distance", "largest distance of a coordinate", "", "{:.1e}"}});
    double distance = 0;
    for (const State& state : proved.states) {
        const auto at = reference(state);
        distance = std::max(distance, at ? at->distance : std::numeric_limits<double>::infinity());
    }
    levels.add({static_cast<long>(proved.states.size()), distance});
    program.show(forces);
    program.show(levels);
    return program.finish();
}
