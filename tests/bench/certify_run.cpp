// Certifies every equilibrium of the programmes of scenes: how many, in which arithmetic, which not and why, and the
// cost of a full certificate in units of one UMFPACK and one KLU analysis + factorisation of the same matrix (CPU time,
// in turn, median and range). Usage:
//   bench_certify_run [--json FILE] [--first K] [--repeats R] [scene.toml | n | state ...]
//     a scene: prepared and run as its programme says; --first K stops after K equilibria of each segment
//     a number of disks, a state file or vertex text: certified as it is (cost only)
// default: 100 400 1936 4900, 9 repeats
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

using namespace isostat;
using bench::Sample;

namespace {

bool cost(const std::string& name, const State& state, int repeats, bench::Table& table) {
    const auto matrix = bench::matrix_of(state);
    Certification c;
    const auto full = [&] { c = certify(state); };
    CertifyOptions in_double{.highest = Rung::double_bound};
    const bench::Pair to_umfpack = bench::in_turn(
        full, [&] { bench::umfpack(matrix); }, repeats);
    const bench::Pair to_klu = bench::in_turn(
        full, [&] { bench::klu(matrix); }, repeats);
    table.add({name, static_cast<long>(state.packing.disk_count()), static_cast<long>(state.contacts.size()),
               to_umfpack.first, bench::milliseconds([&] { (void)certify(state, in_double); }, repeats),
               to_umfpack.second, to_umfpack.ratio(), to_klu.ratio(), std::string(to_string(c.verdict))});
    for (const std::string& reason : c.claims.undecided) {
        fmt::print(stderr, "{}: {}\n", name, reason);
    }
    return c.verdict == Verdict::proved;
}

/// Certifies what it is handed; the state is printed with 17 digits and read back first, as a user's would be.
class Certifier final : public RunObserver {
  public:
    void on_equilibrium(const EquilibriumRecord& record, const State& state, const std::vector<double>&) override {
        const State stored = parse_state(state_text(state), "state").state;
        Certification c;
        const Sample spent = bench::milliseconds([&] { c = certify(stored); }, 1);
        ++count;
        total += spent.median();
        time.add(spent.median());
        proved += c.verdict == Verdict::proved ? 1 : 0;
        const CertificateClaims& claims = c.claims;
        if (claims.vertex) {
            widest_radius = std::max(widest_radius, claims.vertex->radius);
            ++vertex[claims.vertex->rung];
        }
        if (claims.forces) {
            ++forces[claims.forces->rung];
        }
        if (claims.gaps) {
            ++gaps[claims.gaps->rung];
        }
        if (claims.load_interval) {
            ++interval[claims.load_interval->rung];
            const LoadIntervalClaim& i = *claims.load_interval;
            agree += i.low.opens == record.opens_low && i.high.opens == record.opens_high ? 1 : 0;
        }
        smallest_sigma = std::min(smallest_sigma, c.smallest_sigma);
        for (const std::string& reason : claims.undecided) {
            fmt::print(stderr, "equilibrium {}: {}\n", record.number, reason);
        }
        keep[record.number] = state;
    }

    int count = 0, proved = 0, agree = 0;
    double total = 0, widest_radius = 0, smallest_sigma = 1e300;
    Sample time;
    std::map<Rung, int> vertex, forces, gaps, interval;
    std::map<int, State> keep;
};

std::string tally(const std::map<Rung, int>& counts) {
    std::string text;
    for (const auto& [rung, count] : counts) {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, to_string(rung));
    }
    return text;
}

bool play(const std::string& file, int first, int repeats, bench::Table& costs, bench::Table& runs) {
    const Scene scene = read_scene(file);
    PreparationReport report;
    auto prepared = prepare(scene.preparation, report);
    if (!prepared.ok()) {
        fmt::print(stderr, "{}: not prepared: {}\n", file, prepared.failure().message());
        return false;
    }
    State state = prepared.value();
    const std::string name = file.substr(file.find_last_of('/') + 1);
    bool good = cost(name + ", start", state, repeats, costs);
    Certifier certifier;
    RunCounters counters;
    int number = 0;
    double run_time = 0;
    for (const ProgrammeStep& step : scene.programme) {
        if (step.from) {
            const auto start = certifier.keep.find(*step.from);
            if (start == certifier.keep.end()) {
                continue;
            }
            state = start->second;
        }
        Segment segment = segment_of(step, state.load, file);
        if (first > 0) {
            segment.equilibria = std::min(first, segment.equilibria.value_or(first));
        }
        const double before = certifier.total;
        SegmentOutcome outcome;
        const double begin = bench::cpu_milliseconds();
        outcome = run_segment(state, segment, number++, scene.run, counters, certifier);
        run_time += bench::cpu_milliseconds() - begin - (certifier.total - before);
        if (!outcome.completed) {
            fmt::print(stderr, "{}, segment {}: {}\n", name, number - 1, outcome.failure->message());
            good = false;
        }
    }
    runs.add({name, static_cast<long>(state.packing.disk_count()), static_cast<long>(certifier.count),
              static_cast<long>(certifier.proved), static_cast<long>(certifier.agree), tally(certifier.vertex),
              tally(certifier.forces), tally(certifier.gaps), tally(certifier.interval), certifier.widest_radius,
              certifier.smallest_sigma, certifier.time, 1e-3 * certifier.total, 1e-3 * run_time});
    return good && certifier.proved == certifier.count;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> inputs{"100", "400", "1936", "4900"};
    int first = 0;
    int repeats = 9;
    bench::Program program("bench_certify_run", "certificates of whole programmes / one UMFPACK or KLU");
    program.option("--first", first, "equilibria of each segment (0: all)");
    program.option("--repeats", repeats, "of each cost");
    program.words("inputs", inputs, "scenes, numbers of disks, or state files");
    if (const auto status = program.parse(argc, argv)) {
        return *status;
    }
    bench::Table costs("certificate_cost", "One certificate, median (range):",
                       {{"state", "state", ""},
                        {"n", "n", ""},
                        {"size", "N", ""},
                        {"certificate", "certificate, ms", "ms", "{:.2f}"},
                        {"in_double", "double only, ms", "ms", "{:.2f}"},
                        {"umfpack_ms", "UMFPACK analysis + factorisation, ms", "ms", "{:.2f}"},
                        {"umfpack", "certificate / UMFPACK", "UMFPACK", "{:.2f}"},
                        {"klu", "certificate / KLU", "KLU", "{:.2f}"},
                        {"verdict", "verdict", ""}});
    bench::Table runs("certified_runs", "All equilibria of a programme:",
                      {{"scene", "scene", ""},
                       {"n", "n", ""},
                       {"equilibria", "equilibria", ""},
                       {"certified", "certified", ""},
                       {"agree", "with the opening contacts of the run", ""},
                       {"vertex", "vertex", ""},
                       {"forces", "forces", ""},
                       {"gaps", "gaps", ""},
                       {"interval", "load interval", ""},
                       {"radius", "vertex known within", "", "{:.1e}"},
                       {"sigma_min", "σ_min at least", "", "{:.1e}"},
                       {"certificate", "certificate, ms", "ms", "{:.2f}"},
                       {"certificates_s", "all certificates, s", "s", "{:.2f}"},
                       {"run_s", "the run itself, s", "s", "{:.2f}"}});
    bool good = true;
    for (const std::string& input : inputs) {
        if (input.ends_with(".toml")) {
            good = play(input, first, repeats, costs, runs) && good;
        } else {
            const auto state = bench::start(input);
            good = state && cost(input.substr(input.find_last_of('/') + 1), *state, repeats, costs) && good;
        }
    }
    program.show(costs);
    if (!runs.empty()) {
        program.show(runs);
    }
    return program.finish(good);
}
