// Cost of the levels `states` and `arcs`: one certificate of an equilibrium, one certified arc, and the plain run per
// arc, each in units of one KLU analysis + factorisation of the same contact matrices. CPU time of one thread, all of
// it in one run. Usage:
//   bench_level_cost [--equilibria E] [n ...]     default: 10, 100 400 1936
#include <isostat/certificate/certify.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/rigidity/isostatic.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>
#include <klu.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
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

double median(std::vector<double> x) {
    const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), middle, x.end());
    return *middle;
}

double klu_milliseconds(sparse::Matrix<double> h) {
    klu_common common;
    klu_defaults(&common);
    std::vector<double> times;
    for (int k = 0; k < 7; ++k) {
        const double begin = now();
        klu_symbolic* symbolic = klu_analyze(h.rows, h.start.data(), h.row.data(), &common);
        klu_numeric* numeric = klu_factor(h.start.data(), h.row.data(), h.value.data(), symbolic, &common);
        klu_free_numeric(&numeric, &common);
        klu_free_symbolic(&symbolic, &common);
        times.push_back(now() - begin);
    }
    return median(times);
}

/// Measures the reference and one certificate at every equilibrium; the time that this takes is not the run's.
struct Observer : RunObserver<2> {
    std::vector<double> klu, certificate;
    int certified = 0;
    double lost = 0;
    void on_equilibrium(const EquilibriumRecord<2>&, const State<2>& state, const std::vector<double>&) override {
        const double begin = now();
        klu.push_back(klu_milliseconds(contact_matrix(state.packing, DofMap<2>(state.packing), state.contacts)));
        const double middle = now();
        certified += certify(state).verdict == Verdict::proved ? 1 : 0;
        certificate.push_back(now() - middle);
        lost += now() - begin;
    }
};

struct Measured {
    Observer seen;
    RunCounters counters;
    double per_arc = 0;
    std::string failure;
};

Measured measure(State<2> state, int equilibria, CertifyLevel level) {
    Measured out;
    RunOptions options;
    options.certify = level;
    Segment segment;
    segment.equilibria = equilibria;
    const double begin = now();
    const SegmentOutcome outcome = run_segment<2>(state, segment, 0, options, out.counters, out.seen);
    out.per_arc = (now() - begin - out.seen.lost) / static_cast<double>(std::max(out.counters.steps, 1L));
    out.failure = outcome.failure ? outcome.failure->message : "";
    return out;
}

} // namespace

int main(int argc, char** argv) {
    int equilibria = 10;
    std::vector<int> sizes;
    for (int k = 1; k < argc; ++k) {
        const std::string argument = argv[k];
        if (argument == "--equilibria" && k + 1 < argc) {
            equilibria = std::atoi(argv[++k]);
        } else {
            sizes.push_back(std::atoi(argument.c_str()));
        }
    }
    if (sizes.empty()) {
        sizes = {100, 400, 1936};
    }
    bool good = true;
    fmt::print(
        "| n | equilibria, arcs | one KLU analysis + factorisation, ms | plain run per arc | certificate of a state "
        "| certificate of an arc | fresh centres / arc | proved states, arcs |\n|---|---|---|---|---|---|---|---|\n");
    for (const int n : sizes) {
        PreparationOptions options;
        options.disks = n;
        PreparationReport<2> report;
        auto start = prepare(options, report);
        if (!start.ok()) {
            fmt::print(stderr, "{} disks: {}\n", n, start.failure().message);
            good = false;
            continue;
        }
        const Measured plain = measure(start.value(), equilibria, CertifyLevel::decisions);
        const Measured arcs = measure(start.value(), equilibria, CertifyLevel::arcs);
        if (!plain.failure.empty() || !arcs.failure.empty()) {
            fmt::print(stderr, "{} disks: {}\n", n, plain.failure + arcs.failure);
            good = false;
        }
        const double klu = median(plain.seen.klu);
        const long count = arcs.counters.arcs.certified + arcs.counters.arcs.undecided;
        fmt::print(
            "| {} | {}, {} | {:.2f} | {:.2f} | {:.1f} ({:.1f}-{:.1f}) | {:.2f} | {:.2f} | {} of {}, {} of {} |\n", n,
            plain.seen.klu.size() - 1, plain.counters.steps, klu, plain.per_arc / klu,
            median(plain.seen.certificate) / klu,
            *std::min_element(plain.seen.certificate.begin(), plain.seen.certificate.end()) / klu,
            *std::max_element(plain.seen.certificate.begin(), plain.seen.certificate.end()) / klu,
            (arcs.per_arc - plain.per_arc) / klu,
            static_cast<double>(arcs.counters.arcs.factorisations) / static_cast<double>(std::max(count, 1L)),
            plain.seen.certified, plain.seen.klu.size(), arcs.counters.arcs.certified, count);
    }
    return good ? 0 : 1;
}
