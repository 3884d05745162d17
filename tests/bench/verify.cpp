// Cost of `verify DIR`: milliseconds per vertex (every end of an arc, and the start) on one thread, divided by one KLU
// analysis + factorisation of the contact matrices at the equilibria. A run is made into a folder, as `run` does it,
// and verified from there; reading the files and the checks of the equilibria count. CPU time. The status is 1 when an
// answer is not "proved" or the ratio is above --at-most. Usage:
//   bench_verify [--json FILE] [--arcs A] [--at-most R] [n | state file ...]
// default: 400 1936 4900, A = 300 arcs each.
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/sample.hpp"
#include "bench/shared/stretch.hpp"
#include "support/segments.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/core/machine.hpp>
#include <isostat/io/run_directory.hpp>

#include <fmt/format.h>
#include <unistd.h>

using namespace isostat;

namespace {

struct Measured {
    long equilibria = 0, arcs = 0;
    double klu = 0;          ///< one analysis + factorisation, milliseconds: median over the equilibria
    double milliseconds = 0; ///< of `verify_run`
    bool proved = false;     ///< every end
};

/// A run from a state into a folder, until it has made so many arcs, and then its verification. Nothing: the run
/// failed.
std::optional<Measured> measure(State state, long wanted) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("bench_verify.{}", ::getpid());
    std::filesystem::remove_all(folder);
    RunHeader header;
    header.program = "bench_verify";
    header.settings = R"({"run":{"rule":"most_negative","certify":"decisions"}})";
    RunCounters counters;
    RunDirectory directory(folder, header, RunDirectory::Mode::fresh, counters);
    const Segment up = towards(1);
    RunOptions options{.max_strain = 1e9};
    bench::Sample klu;
    for (int segment = 0; segment < 60 && counters.steps < wanted; ++segment) {
        directory.begin_segment(segment, up, 0, state.equilibrium);
        if (!run_segment(state, up, segment, options, counters, directory).completed) {
            return {};
        }
        const auto matrix = bench::matrix_of(state);
        for (const double time : bench::milliseconds([&] { bench::klu(matrix); }, 5).values()) {
            klu.add(time);
        }
    }
    directory.finish(RunStatus::completed, "");
    const double begin = bench::cpu_milliseconds();
    const RunVerification run = verify_run(folder);
    const double time = bench::cpu_milliseconds() - begin;
    std::filesystem::remove_all(folder);
    return Measured{run.equilibria, run.arcs, klu.median(), time,
                    run.verdict == Verdict::proved && run.arcs_proved == run.arcs};
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources{"400", "1936", "4900"};
    int arcs = 300, at_most = 0;
    bench::Program program("bench_verify",
                           "milliseconds per vertex of `verify DIR` / one KLU analysis + factorisation");
    program.option("--arcs", arcs, "arcs to verify for each size, and the rest of the rearrangement");
    program.option("--at-most", at_most, "status 1 when a vertex costs more KLU than this (0: whatever it costs)");
    program.words("starts", sources, "numbers of disks or state files");
    program.parse(argc, argv);
    bench::Table table("verify", "Cost of a vertex in `verify DIR`, one thread, CPU time:",
                       {{"n", "n", ""},
                        {"equilibria", "equilibria", ""},
                        {"arcs", "arcs", ""},
                        {"klu", "one KLU analysis + factorisation, ms", "ms", "{:.2f}"},
                        {"vertex", "one vertex, ms", "ms", "{:.1f}"},
                        {"ratio", "vertex / KLU", "KLU", "{:.1f}"},
                        {"proved", "all ends proved", ""}});
    set_threads(1);
    bool good = true;
    for (const std::string& source : sources) {
        const std::optional<State> start = bench::start(source);
        if (!start) {
            return 1;
        }
        const std::optional<Measured> m = measure(*start, arcs);
        if (!m) {
            good = false;
            continue;
        }
        const double vertex = m->milliseconds / static_cast<double>(m->arcs + 1);
        const double ratio = vertex / m->klu;
        table.add(
            {static_cast<long>(start->packing.disk_count()), m->equilibria, m->arcs, m->klu, vertex, ratio, m->proved});
        good = good && m->proved && (at_most == 0 || ratio <= at_most);
    }
    program.show(table);
    return program.finish(good);
}
