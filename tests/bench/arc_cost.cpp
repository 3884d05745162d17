// Cost of a trajectory in units of its linear algebra: milliseconds per arc divided by one KLU, and one UMFPACK,
// analysis + factorisation of the same contact matrices, at level `decisions` (regularity, bound of the inverse and
// every decision proved at every vertex). Everything that an equilibrium costs is shared out among its arcs. With one
// thread CPU time, so that other processes disturb little; with several time on the wall, which only a quiet machine
// tells; the units are those of one thread. Each run is repeated from the same start, the tables show medians and
// extremes. The status is 1 when a run fails. Usage:
//   bench_arc_cost [--json FILE] [--equilibria E] [--arcs A] [--repeats R] [--threads T] [--levels]
//   [--dimension D] [n | state file ...]
// default: 400 1936 4900, 30 equilibria, 3 repeats. --arcs A ends each run after A arcs: large packings, where a
// rearrangement can have thousands. --levels: the cost of the levels `states` and `arcs` too, one certificate of an
// equilibrium and one certified arc; the status is 1 when something stays uncertified.
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"

#include <isostat/certificate/certify.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace isostat;
using bench::Sample;

namespace {

struct Row {
    int n = 0;
    bench::Stretches proved;
};

/// Of y ~ n^x between two rows, repeat by repeat.
Sample exponent(const Row& small, const Row& large, const Sample& at_small, const Sample& at_large) {
    const double decades = std::log(static_cast<double>(large.n) / small.n);
    const Sample ratios = at_large.over(at_small);
    Sample out;
    for (const double ratio : ratios.values()) {
        out.add(std::log(ratio) / decades);
    }
    return out;
}

/// One certificate of every equilibrium at level `decisions`, and the same stretch at level `arcs`.
struct Levels {
    Sample certificate; ///< milliseconds, over all states and repeats
    long states = 0, certified = 0;
    bench::Stretches enclosed;

    void visit(const State& state) {
        ++states;
        certificate.add(
            bench::milliseconds([&] { certified += certify(state).verdict == Verdict::proved ? 1 : 0; }, 1).median());
    }
    /// False: a run failed, or something is not certified.
    [[nodiscard]] bool add_to(bench::Table& table, const Row& row) const {
        const ArcTally& tally = enclosed.front().counters.arcs;
        const long count = tally.certified + tally.undecided, repeats = static_cast<long>(enclosed.runs.size());
        const Sample klu = row.proved.klu(), umfpack = row.proved.umfpack(), decisions = row.proved.per_arc();
        Sample arc;
        for (std::size_t k = 0; k < decisions.values().size(); ++k) {
            arc.add(enclosed.per_arc().values()[k] - decisions.values()[k]);
        }
        table.add({static_cast<long>(row.n), row.proved.front().counters.equilibria, row.proved.front().counters.steps,
                   certificate.over(klu.median()), arc.over(klu), certificate.over(umfpack.median()), arc.over(umfpack),
                   static_cast<double>(tally.factorisations) / static_cast<double>(std::max(count, 1L)),
                   fmt::format("{} of {}", certified / repeats, states / repeats),
                   fmt::format("{} of {}", tally.certified, count)});
        return enclosed.front().failure.empty() && certified == states && tally.certified == count;
    }
};

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources{"400", "1936", "4900"};
    int equilibria = 30, arcs = 0, repeats = 3, threads = 1;
    int dimension = plane;
    bool with_levels = false;
    bench::Program program("bench_arc_cost", "milliseconds per arc / one KLU or UMFPACK analysis + factorisation");
    program.option("--equilibria", equilibria, "equilibria of each run");
    program.option("--arcs", arcs, "end each run after this many arcs (0: at its last equilibrium)");
    program.option("--repeats", repeats, "runs of each level");
    program.option("--threads", threads, "threads of each run; above one, time on the wall counts");
    program.option("--dimension", dimension, "3: numbers are of spheres");
    program.flag("--levels", with_levels, "certificates of states and arcs too");
    program.words("starts", sources, "numbers of disks or state files");
    program.parse(argc, argv);
    bench::Table table("arc_cost",
                       fmt::format("Cost of an arc, {}, {}, median (range) of {} runs:",
                                   arcs > 0 ? fmt::format("{} arcs", arcs) : fmt::format("{} equilibria", equilibria),
                                   threads > 1 ? fmt::format("{} threads, time on the wall", threads)
                                               : std::string("one thread, CPU time"),
                                   repeats),
                       {{"n", "n", ""},
                        {"arcs", "arcs", ""},
                        {"klu", "one KLU analysis + factorisation, ms", "ms", "{:.2f}"},
                        {"umfpack", "one UMFPACK, ms", "ms", "{:.2f}"},
                        {"decisions", "decisions, ms", "ms", "{:.2f}"},
                        {"decisions_cpu", "decisions, CPU of all threads, ms", "ms", "{:.2f}"},
                        {"decisions_klu", "decisions / KLU", "KLU", "{:.2f}"},
                        {"decisions_umfpack", "decisions / UMFPACK", "UMFPACK", "{:.2f}"}});
    bench::Table level_table(
        "level_cost", fmt::format("Cost of certificates, median (range) of {} runs; of the states: of all", repeats),
        {{"n", "n", ""},
         {"equilibria", "equilibria", ""},
         {"arcs", "arcs", ""},
         {"state_klu", "certificate of a state / KLU", "KLU", "{:.1f}"},
         {"arc_klu", "certificate of an arc / KLU", "KLU", "{:.2f}"},
         {"state_umfpack", "state / UMFPACK", "UMFPACK", "{:.1f}"},
         {"arc_umfpack", "arc / UMFPACK", "UMFPACK", "{:.2f}"},
         {"centres", "fresh centres / arc", "", "{:.2f}"},
         {"states_proved", "states proved", ""},
         {"arcs_proved", "arcs proved", ""}});
    bool good = true;
    std::vector<Row> rows;
    for (const std::string& source : sources) {
        const auto begin_state = bench::start(source, dimension);
        if (!begin_state) {
            good = false;
            continue;
        }
        Row row;
        row.n = begin_state->packing.disk_count();
        bench::StretchOptions options{.equilibria = equilibria, .arcs = arcs, .threads = std::max(1, threads)};
        Levels levels;
        for (int repeat = 0; repeat < repeats; ++repeat) {
            options.level = CertifyLevel::decisions;
            options.visit = {};
            if (with_levels) {
                options.visit = [&levels](const State& state) { levels.visit(state); };
            }
            row.proved.runs.push_back(bench::run_stretch(*begin_state, options));
            if (with_levels) {
                options.level = CertifyLevel::arcs;
                options.visit = {};
                levels.enclosed.runs.push_back(bench::run_stretch(*begin_state, options));
            }
        }
        if (!row.proved.front().failure.empty()) {
            fmt::print(stderr, "{}: {}\n", source, row.proved.front().failure);
            good = false;
        }
        const Sample proved = row.proved.per_arc();
        table.add({static_cast<long>(row.n), row.proved.front().counters.steps, row.proved.klu().median(),
                   row.proved.umfpack().median(), proved, row.proved.cpu_per_arc(), proved.over(row.proved.klu()),
                   proved.over(row.proved.umfpack())});
        good = (!with_levels || levels.add_to(level_table, row)) && good;
        rows.push_back(std::move(row));
    }
    program.show(table);
    if (with_levels) {
        program.show(level_table);
    }
    if (rows.size() > 1) {
        bench::Table growth("growth", "Cost per arc grows as n to the power of",
                            {{"from", "from n", ""},
                             {"to", "to n", ""},
                             {"decisions", "decisions", "", "{:.2f}"},
                             {"klu", "KLU", "", "{:.2f}"},
                             {"umfpack", "UMFPACK", "", "{:.2f}"}});
        const auto between = [&](const Row& a, const Row& b) {
            growth.add({static_cast<long>(a.n), static_cast<long>(b.n),
                        exponent(a, b, a.proved.per_arc(), b.proved.per_arc()),
                        exponent(a, b, a.proved.klu(), b.proved.klu()),
                        exponent(a, b, a.proved.umfpack(), b.proved.umfpack())});
        };
        for (std::size_t k = 1; k < rows.size(); ++k) {
            between(rows[k - 1], rows[k]);
        }
        if (rows.size() > 2) {
            between(rows.front(), rows.back());
        }
        program.show(growth);
    }
    return program.finish(good);
}
