// Cost of the levels `states` and `arcs`: one certificate of an equilibrium, one certified arc, and the run at level
// `decisions` per arc, each in units of one KLU and one UMFPACK analysis + factorisation of the same contact matrices.
// CPU time of one thread, all of it in one run, repeated. The status is 1 when a run fails or something stays
// uncertified. Usage:
//   bench_level_cost [--json FILE] [--equilibria E] [--arcs A] [--repeats R] [n | state file ...]
// default: 10 equilibria, 3 repeats, 100 400 1936
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"

#include <isostat/certificate/certify.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace isostat;
using bench::Sample;

int main(int argc, char** argv) {
    std::vector<std::string> sources{"100", "400", "1936"};
    int equilibria = 10;
    int arcs = 0;
    int repeats = 3;
    bench::Program program("bench_level_cost", "cost of certified states and arcs / one KLU or UMFPACK");
    program.option("--equilibria", equilibria, "equilibria of each run");
    program.option("--arcs", arcs, "end each run after this many arcs (0: at its last equilibrium)");
    program.option("--repeats", repeats, "runs of each level");
    program.words("starts", sources, "numbers of disks or state files");
    if (const auto status = program.parse(argc, argv)) {
        return *status;
    }
    bench::Table table(
        "level_cost",
        fmt::format("Cost of certificates, median (range) of {} runs; of the states: of all of them", repeats),
        {{"n", "n", ""},
         {"equilibria", "equilibria", ""},
         {"arcs", "arcs", ""},
         {"klu", "one KLU analysis + factorisation, ms", "ms", "{:.2f}"},
         {"umfpack", "one UMFPACK, ms", "ms", "{:.2f}"},
         {"decisions_klu", "run at `decisions` per arc / KLU", "KLU", "{:.2f}"},
         {"state_klu", "certificate of a state / KLU", "KLU", "{:.1f}"},
         {"arc_klu", "certificate of an arc / KLU", "KLU", "{:.2f}"},
         {"decisions_umfpack", "`decisions` / UMFPACK", "UMFPACK", "{:.2f}"},
         {"state_umfpack", "state / UMFPACK", "UMFPACK", "{:.1f}"},
         {"arc_umfpack", "arc / UMFPACK", "UMFPACK", "{:.2f}"},
         {"centres", "fresh centres / arc", "", "{:.2f}"},
         {"states_proved", "states proved", ""},
         {"arcs_proved", "arcs proved", ""}});
    bool good = true;
    for (const std::string& source : sources) {
        const auto from = bench::start(source);
        if (!from) {
            good = false;
            continue;
        }
        bench::Stretches decided, enclosed;
        Sample certificate; // milliseconds, over all states and repeats
        long certified = 0;
        long states = 0;
        bench::StretchOptions options;
        options.equilibria = equilibria;
        options.arcs = arcs;
        options.reference_every = 1;
        for (int repeat = 0; repeat < repeats; ++repeat) {
            options.level = CertifyLevel::decisions;
            options.visit = [&](const State& state) {
                ++states;
                certificate.add(
                    bench::milliseconds([&] { certified += certify(state).verdict == Verdict::proved ? 1 : 0; }, 1)
                        .median());
            };
            decided.runs.push_back(bench::run_stretch(*from, options));
            options.level = CertifyLevel::arcs;
            options.visit = {};
            enclosed.runs.push_back(bench::run_stretch(*from, options));
        }
        const ArcTally& tally = enclosed.front().counters.arcs;
        const long count = tally.certified + tally.undecided;
        for (const bench::Stretches* level : {&decided, &enclosed}) {
            if (!level->front().failure.empty()) {
                fmt::print(stderr, "{}: {}\n", source, level->front().failure);
                good = false;
            }
        }
        good = good && certified == states && tally.certified == count;
        const Sample decisions = decided.per_arc();
        const Sample klu = decided.klu();
        const Sample umfpack = decided.umfpack();
        Sample arc;
        for (std::size_t k = 0; k < decisions.values().size(); ++k) {
            arc.add(enclosed.per_arc().values()[k] - decisions.values()[k]);
        }
        table.add({static_cast<long>(from->packing.disk_count()),
                   static_cast<long>(decided.front().counters.equilibria), decided.front().counters.steps, klu.median(),
                   umfpack.median(), decisions.over(klu), certificate.over(klu.median()), arc.over(klu),
                   decisions.over(umfpack), certificate.over(umfpack.median()), arc.over(umfpack),
                   static_cast<double>(tally.factorisations) / static_cast<double>(std::max(count, 1L)),
                   fmt::format("{} of {}", certified / repeats, states / repeats),
                   fmt::format("{} of {}", tally.certified, count)});
    }
    program.show(table);
    return program.finish(good);
}
