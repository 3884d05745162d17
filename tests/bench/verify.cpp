// Cost of `verify DIR`: milliseconds per vertex (every end of an arc, and the start) on one thread, divided by one KLU
// analysis + factorisation of the contact matrices at both ends of the same rearrangements. Every rearrangement is
// played into a folder of its own, as `run` does it, and verified from there; reading the files and the checks of the
// equilibria count. CPU time. The status is 1 when an answer is not "proved" or the ratio is above --at-most. Usage:
//   bench_verify [--json FILE] [--arcs A] [--longest L] [--at-most R] [n | state file ...]
// default: 400 1936 4900, A = 40 arcs each. Rearrangements of more than L = 100 arcs are played, not verified.
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/sample.hpp"
#include "bench/shared/stretch.hpp"

#include <isostat/checker/verify_run.hpp>
#include <isostat/core/threads.hpp>
#include <isostat/io/run_directory.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

using namespace isostat;

namespace {

/// One rearrangement from an equilibrium, which becomes the next one; its records in a folder. The number of arcs;
/// nothing: the run failed.
std::optional<long> play(State<2>& state, CertifyLevel level, const std::filesystem::path& folder) {
    RunHeader header;
    header.program = "bench_verify";
    header.settings = R"({"run":{"rule":"most_negative"}})";
    RunCounters counters;
    RunDirectory directory(folder, header, RunDirectory::Mode::fresh, counters);
    Segment up;
    up.equilibria = 1;
    RunOptions options;
    options.max_strain = 1e9;
    options.certify = level;
    directory.begin_segment(0, up, 0, counters.equilibria);
    const SegmentOutcome outcome = run_segment<2>(state, up, 0, options, counters, directory);
    directory.finish(outcome.completed ? RunStatus::completed : RunStatus::failed, "");
    return outcome.completed ? std::optional(counters.steps) : std::nullopt;
}

struct Measured {
    int rearrangements = 0;
    long arcs = 0;
    long vertices = 0;
    double milliseconds = 0;
    bench::Sample klu, ratio; ///< per rearrangement
    bool proved = true;
};

Measured measure(State<2> state, CertifyLevel level, long wanted, long longest) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("bench_verify.{}", ::getpid());
    Measured out;
    for (int k = 0; k < 60 && out.arcs < wanted; ++k) {
        const State<2> from = state;
        std::filesystem::remove_all(folder);
        const std::optional<long> arcs = play(state, level, folder);
        if (!arcs) {
            break;
        }
        if (*arcs > longest) {
            continue;
        }
        bench::Sample klu;
        for (const State<2>* at : {&from, &std::as_const(state)}) {
            const auto matrix = bench::matrix_of(*at);
            for (const double time : bench::milliseconds([&] { bench::klu(matrix); }, 5).values()) {
                klu.add(time);
            }
        }
        const double begin = bench::cpu_milliseconds();
        const RunVerification run = verify_run(folder);
        const double time = bench::cpu_milliseconds() - begin;
        out.proved = out.proved && run.verdict == Verdict::proved;
        out.klu.add(klu.median());
        out.ratio.add(time / static_cast<double>(*arcs + 1) / klu.median());
        out.milliseconds += time;
        out.vertices += *arcs + 1;
        out.arcs += *arcs;
        ++out.rearrangements;
    }
    std::filesystem::remove_all(folder);
    return out;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources{"400", "1936", "4900"};
    int arcs = 40;
    int longest = 100;
    int at_most = 0;
    bench::Program program("bench_verify",
                           "milliseconds per vertex of `verify DIR` / one KLU analysis + factorisation");
    program.option("--arcs", arcs, "arcs to verify for each size");
    program.option("--longest", longest, "rearrangements of more arcs are not verified");
    program.option("--at-most", at_most, "status 1 when a vertex costs more KLU than this (0: whatever it costs)");
    program.words("starts", sources, "numbers of disks or state files");
    if (const auto status = program.parse(argc, argv)) {
        return *status;
    }
    bench::Table table("verify", "Cost of a vertex in `verify DIR`, one thread, CPU time:",
                       {{"n", "n", ""},
                        {"level", "level", ""},
                        {"rearrangements", "rearrangements", ""},
                        {"arcs", "arcs", ""},
                        {"klu", "one KLU analysis + factorisation, ms", "ms", "{:.2f}"},
                        {"vertex", "one vertex, ms", "ms", "{:.1f}"},
                        {"ratio", "vertex / KLU, all", "KLU", "{:.1f}"},
                        {"ratios", "vertex / KLU, by rearrangement", "KLU", "{:.1f}"},
                        {"proved", "all ends proved", ""}});
    set_threads(1);
    bool good = true;
    for (const std::string& source : sources) {
        const std::optional<State<2>> start = bench::start(source);
        if (!start) {
            return 1;
        }
        for (const auto& [level, name] :
             {std::pair(CertifyLevel::plain, "plain"), std::pair(CertifyLevel::decisions, "decisions")}) {
            const Measured m = measure(*start, level, arcs, longest);
            if (m.vertices == 0) {
                good = false;
                continue;
            }
            const double vertex = m.milliseconds / static_cast<double>(m.vertices);
            const double ratio = vertex / m.klu.median();
            table.add({static_cast<long>(start->packing.disk_count()), std::string(name),
                       static_cast<long>(m.rearrangements), m.arcs, m.klu, vertex, ratio, m.ratio, m.proved});
            good = good && m.proved && (at_most == 0 || ratio <= at_most);
        }
    }
    program.show(table);
    return program.finish(good);
}
