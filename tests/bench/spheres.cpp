// Cost of what is asked of spheres, in units U of one UMFPACK analysis + factorisation (order of METIS) of the same
// contact matrix: the exact rank alone, a state with all proofs (exact rank, singular value, true vertex, forces, gaps,
// interval), what a periodic cell is asked besides (counts of every kind of strain, what is jammed), the verification
// of a certificate, an arc at level `decisions` with its share of the equilibria; and the memory of a state against
// that of L + U. One process, one thread, CPU time; the work and the unit in turn, median and range of the quotients.
// The status is 1 when something stays unproved. Usage:
//   bench_spheres [--json FILE] [--repeats R] [--arcs A] [n | n:seed | state file ...]
// default: 500 1000 (a number is prepared first, in a box), 5 repeats, 200 arcs. --arcs 0: no run.
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>
#include <isostat/core/machine.hpp>

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

using namespace isostat;
using bench::Sample;

namespace {

/// Bytes that the process holds now, or held at most.
double held(const std::string& key) {
    std::ifstream in("/proc/self/status");
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with(key)) {
            return 1024 * std::strtod(line.c_str() + key.size(), nullptr);
        }
    }
    return 0;
}

/// Bytes that work takes at its peak, beyond what was there.
template <class Work> double memory_of(Work work) {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5; // Linux: the peak begins anew
    const double before = held("VmRSS:");
    work();
    return held("VmHWM:") - before;
}

struct Settings {
    int repeats = 5;
    int arcs = 200;
};

bool measure(const State& state, const Settings& settings, bench::Table& table, bench::Table& units) {
    const sparse::Matrix<double> h = bench::matrix_of(state);
    const auto unit = [](const sparse::Matrix<double>& of) {
        return [&of] { bench::umfpack(of, bench::FillReducing::metis); };
    };
    const long entries = bench::UmfpackAnalysis(h, bench::FillReducing::metis).factorise();
    constexpr double bytes_of_entry = sizeof(double) + sizeof(int);
    bool proved = true;
    const auto inspect = [&] {
        const Result<Inspection> answer = inspect_vertex(state);
        proved = proved && answer.ok() && answer.value().record.verdict == Verdict::proved;
    };
    const double memory = memory_of(inspect);
    Certificate certificate;
    certificate.state = state;
    const Certification truth = certify(state);
    certificate.claims = truth.claims;
    const auto in_units = [&](auto work) { return bench::in_turn(work, unit(h), settings.repeats).ratio(); };
    const bench::Pair rank =
        bench::in_turn([&] { proved = IsostaticStructure::prove(state.packing, state.contacts).ok() && proved; },
                       unit(h), settings.repeats);
    bench::Cell arc = std::monostate();
    long arcs = 0;
    if (settings.arcs > 0) {
        bench::StretchOptions options{.equilibria = 1000, .arcs = settings.arcs};
        const bench::Stretch run = bench::run_stretch(state, options);
        arcs = run.counters.steps;
        const sparse::Matrix<double> last =
            run.last.contacts.empty() ? h : bench::matrix_of(run.last); // no equilibrium
        arc = run.milliseconds_per_arc / bench::milliseconds(unit(last), settings.repeats).median();
        if (!run.failure.empty()) {
            fmt::print(stderr, "{}\n", run.failure);
            proved = false;
        }
    }
    const auto n = static_cast<long>(state.packing.disk_count());
    bench::Cell cell = std::monostate();
    if (state.packing.cell.all()) {
        cell = in_units([&] { (void)inspect_cell(state, truth); });
    }
    table.add({n, std::string(state.packing.cell.any() ? "cell" : "box"), rank.second, rank.ratio(),
               in_units([&] { const sparse::Ordering again(h); }), in_units(inspect), cell,
               in_units([&] { proved = verify(certificate).verdict == Verdict::proved && proved; }), arcs, arc,
               memory / (bytes_of_entry * static_cast<double>(entries))});
    units.add({n, static_cast<long>(h.rows), static_cast<double>(entries) / h.rows,
               bytes_of_entry * static_cast<double>(entries) / 1e6, memory / 1e6});
    return proved;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources{"500", "1000"};
    Settings settings;
    bench::Program program("bench_spheres", "what is asked of spheres / one UMFPACK factorisation of the same matrix");
    program.option("--repeats", settings.repeats, "of each measurement");
    program.option("--arcs", settings.arcs, "of the run");
    program.words("starts", sources, "numbers of spheres or state files");
    if (const auto status = program.parse(argc, argv)) {
        return *status;
    }
    set_threads(1);
    bench::Table table(
        "spheres", "In units of one UMFPACK analysis + factorisation (METIS), one thread, CPU time, median (range):",
        {{"n", "n", ""},
         {"walls", "in", ""},
         {"unit", "unit, ms", "ms", "{:.1f}"},
         {"rank", "exact rank", "UMFPACK", "{:.2f}"},
         {"order", "of which its order", "UMFPACK", "{:.2f}"},
         {"inspect", "inspect", "UMFPACK", "{:.2f}"},
         {"cell", "kinds of strain", "UMFPACK", "{:.2f}"},
         {"verify", "verify", "UMFPACK", "{:.1f}"},
         {"arcs", "arcs", ""},
         {"arc", "an arc", "UMFPACK", "{:.2f}"},
         {"memory", "memory of inspect / L + U", "", "{:.1f}"}});
    bench::Table units("units", "The unit:",
                       {{"n", "n", ""},
                        {"size", "N", ""},
                        {"entries", "entries of L + U a row", "", "{:.0f}"},
                        {"factors", "L + U, MB", "MB", "{:.1f}"},
                        {"memory", "inspect, MB", "MB", "{:.1f}"}});
    bool good = true;
    if (const auto small = bench::start("30", 3)) { // pages of the program are there before its memory is counted
        (void)inspect_vertex(*small);
    }
    for (const std::string& source : sources) {
        const auto state = bench::start(source, 3);
        good = state && measure(*state, settings, table, units) && good;
    }
    program.show(table);
    program.show(units);
    return program.finish(good);
}
