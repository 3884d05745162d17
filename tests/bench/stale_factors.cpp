// Accuracy against time of forces and positions when factors are taken over from an earlier vertex instead of made
// anew: what refinement of stale factors loses. Forces: of the matrix of one equilibrium, with factors of an
// equilibrium some arcs earlier, corrected for the contacts exchanged in between, against forces in double-double.
// Positions: distance of the stored vertices of a run from the true ones, level by level. CPU time of one thread.
// Usage:
//   bench_stale_factors [--json FILE] [--equilibria E] STATE_FILE         E: 10
#include <isostat/io/state_file.hpp>
#include <isostat/statics/statics.hpp>
#include <isostat/trajectory/trajectory.hpp>
#include <isostat/verified/configuration.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace isostat;

namespace {

/// CPU milliseconds of this thread.
double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// Median, smallest and largest of several calls.
struct Spread {
    double median, low, high;
};
template <class Work> Spread milliseconds(Work work) {
    std::vector<double> times;
    for (int k = 0; k < 9; ++k) {
        const double begin = now();
        work();
        times.push_back(now() - begin);
    }
    std::sort(times.begin(), times.end());
    return {times[4], times.front(), times.back()};
}

struct Recorder : RunObserver<2> {
    std::vector<State<2>> states;
    std::vector<int> arcs;
    void on_equilibrium(const EquilibriumRecord<2>& record, const State<2>& state,
                        const std::vector<double>&) override {
        states.push_back(state);
        arcs.push_back(record.arcs);
    }
};

Recorder run(const State<2>& start, CertifyLevel level, int equilibria) {
    Recorder recorder;
    State<2> state = start;
    RunCounters counters;
    Segment segment;
    segment.equilibria = equilibria;
    RunOptions options;
    options.certify = level;
    const auto outcome = run_segment<2>(state, segment, 0, options, counters, recorder);
    if (!outcome.completed) {
        fmt::print("{}: {}\n", to_string(level), outcome.failure->message);
    }
    return recorder;
}

/// A state with its structure, its forces in double-double and the distance to its true vertex.
struct Reference {
    IsostaticStructure<2> structure;
    Factorisation factorisation;
    InverseBound inverse;
    std::vector<double> load, force;
    double bound = 0, size = 0, distance = 0;

    Reference(const State<2>& state, IsostaticStructure<2> proved)
        : structure(std::move(proved)), factorisation(structure) {
        InverseBoundCache cache;
        inverse = bound_inverse(structure, factorisation, cache);
        Statics<2> statics(state.packing, state.load, structure, factorisation, inverse);
        (void)statics.climb();
        const double sigma = state.load.stress[static_cast<std::size_t>(state.load.loaded_axis)];
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

std::unique_ptr<Reference> reference(const State<2>& state) {
    auto proved = IsostaticStructure<2>::prove(state.packing, state.contacts);
    return proved.ok() ? std::make_unique<Reference>(state, std::move(proved.value())) : nullptr;
}

} // namespace

int main(int argc, char** argv) {
    std::string json;
    std::string source;
    int equilibria = 10;
    for (int k = 1; k < argc; ++k) {
        const std::string word = argv[k];
        if (k + 1 < argc && word == "--json") {
            json = argv[++k];
        } else if (k + 1 < argc && word == "--equilibria") {
            equilibria = std::atoi(argv[++k]);
        } else {
            source = word;
        }
    }
    if (source.empty()) {
        return 64;
    }
    const State<2> start = read_state<2>(source).state;
    const Recorder plain = run(start, CertifyLevel::plain, equilibria);
    const Recorder proved = run(start, CertifyLevel::decisions, equilibria);
    std::string rows;
    const auto row = [&rows](const std::string& text) { rows += (rows.empty() ? "" : ", ") + text; };

    const State<2>& last = plain.states.back();
    const auto end = reference(last);
    const double klu = milliseconds([&] { const ApproximateInverse anew(end->structure.matrix()); }).median;
    fmt::print(
        "| factors from | contacts exchanged since | asked | passes | ms / KLU analysis + factorisation | error of "
        "the forces |\n|---|---|---|---|---|---|\n");
    const auto line = [&](int arcs, int exchanged, const std::string& asked, int passes, Spread time, double error) {
        fmt::print("| {} | {} | {} | {} | {:.3f} ({:.3f}-{:.3f}) | {:.1e} |\n",
                   arcs == 0 ? "this vertex" : fmt::format("{} arcs before", arcs), exchanged, asked, passes,
                   time.median / klu, time.low / klu, time.high / klu, error);
        row(fmt::format(
            "{{\"arcs\": {}, \"exchanged\": {}, \"asked\": \"{}\", \"passes\": {}, \"time\": [{:.5g}, {:.5g}, "
            "{:.5g}], \"error\": {:.5g}}}",
            arcs, exchanged, asked, passes, time.median / klu, time.low / klu, time.high / klu, error));
    };
    {
        std::vector<double> f = end->load;
        end->factorisation.solve_forces(f);
        std::vector<double> again;
        const Spread time = milliseconds([&] {
            again = end->load;
            end->factorisation.solve_forces(again);
        });
        line(0, 0, "one pass", 1, time, end->error(f));
    }
    int arcs = 0;
    for (std::size_t back = plain.states.size() - 1; back-- > 0;) {
        arcs += plain.arcs[back + 1];
        if (plain.states[back].contacts.size() != last.contacts.size()) {
            break;
        }
        ApproximateInverse inverse(
            contact_matrix(plain.states[back].packing, end->structure.dofs(), plain.states[back].contacts));
        int exchanged = 0;
        for (std::size_t slot = 0; slot < last.contacts.size(); ++slot) {
            if (plain.states[back].contacts[slot] != last.contacts[slot]) {
                inverse = inverse.exchanged(static_cast<int>(slot), end->structure.matrix());
                ++exchanged;
            }
        }
        for (const double accuracy : {1e-6, 1e-9, 1e-12, 0x1p-51}) {
            const Factorisation taken_over(end->structure, inverse);
            std::vector<double> f = end->load;
            taken_over.solve_forces_from(f, {}, accuracy);
            const int passes = taken_over.passes();
            std::vector<double> again;
            const Spread time = milliseconds([&] {
                again = end->load;
                taken_over.solve_forces_from(again, {}, accuracy);
            });
            line(arcs, exchanged, taken_over.is_fresh() ? "given up, factorised" : fmt::format("{:.0e}", accuracy),
                 passes, time, end->error(f));
        }
    }
    fmt::print(
        "\nerror of the reference: at most {:.1e}\n\n| level | equilibria | largest distance of a stored coordinate "
        "from the true vertex |\n|---|---|---|\n",
        end->bound / end->size);
    std::string levels;
    for (const auto& [name, recorder] : {std::pair{"plain", &plain}, std::pair{"decisions", &proved}}) {
        double distance = 0;
        for (const State<2>& state : recorder->states) {
            const auto at = reference(state);
            distance = std::max(distance, at ? at->distance : std::numeric_limits<double>::infinity());
        }
        fmt::print("| {} | {} | {:.1e} |\n", name, recorder->states.size(), distance);
        levels +=
            fmt::format("{}{{\"level\": \"{}\", \"distance\": {:.5g}}}", levels.empty() ? "" : ", ", name, distance);
    }
    if (!json.empty()) {
        std::ofstream(json) << fmt::format(
            "{{\"table\": \"stale_factors\", \"reference\": {:.5g}, \"rows\": [{}], \"levels\": [{}]}}\n",
            end->bound / end->size, rows, levels);
    }
    return 0;
}
