// Cost of a trajectory in units of its linear algebra: milliseconds per arc divided by one KLU analysis + factorisation
// of the same contact matrices, at level `plain` (everything proved at equilibria only) and at level `decisions`
// (regularity, bound of the inverse and every decision proved at every vertex), and the parts of that cost. Everything
// that an equilibrium costs is shared out among its arcs. CPU time of one thread, so that other processes disturb
// little; each run is repeated from the same start, the levels in turn, the table shows medians and extremes. Usage:
//   bench_arc_cost [--json FILE] [--equilibria E] [--repeats R] [n | state file ...]     default: 400 1936 4900, 30, 3
#include <isostat/contact/candidates.hpp>
#include <isostat/exact/rank.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/statics/statics.hpp>
#include <isostat/trajectory/trajectory.hpp>
#include <isostat/verified/configuration.hpp>

#include <fmt/format.h>
#include <klu.h>
#include <umfpack.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <optional>
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

/// Median milliseconds of several calls.
template <class Work> double milliseconds(Work work, int repeats = 9) {
    std::vector<double> times;
    for (int k = 0; k < repeats; ++k) {
        const double begin = now();
        work();
        times.push_back(now() - begin);
    }
    return median(times);
}

double klu_milliseconds(sparse::Matrix<double> h) {
    klu_common common;
    klu_defaults(&common);
    return milliseconds([&] {
        klu_symbolic* symbolic = klu_analyze(h.rows, h.start.data(), h.row.data(), &common);
        klu_numeric* numeric = klu_factor(h.start.data(), h.row.data(), h.value.data(), symbolic, &common);
        klu_free_numeric(&numeric, &common);
        klu_free_symbolic(&symbolic, &common);
    });
}

double umfpack_milliseconds(const sparse::Matrix<double>& h) {
    return milliseconds([&] {
        void* symbolic = nullptr;
        void* numeric = nullptr;
        umfpack_di_symbolic(h.rows, h.cols, h.start.data(), h.row.data(), h.value.data(), &symbolic, nullptr, nullptr);
        umfpack_di_numeric(h.start.data(), h.row.data(), h.value.data(), symbolic, &numeric, nullptr, nullptr);
        umfpack_di_free_numeric(&numeric);
        umfpack_di_free_symbolic(&symbolic);
    });
}

/// Measures the reference on every tenth equilibrium, in between, so that both see the same machine; its own time is
/// not counted.
struct Sampler : RunObserver<2> {
    std::vector<double> klu;
    State<2> last;
    double lost = 0;
    int equilibria = 0;
    void on_equilibrium(const EquilibriumRecord<2>&, const State<2>& state, const std::vector<double>&) override {
        if (equilibria++ % 10 == 0) {
            const double begin = now();
            klu.push_back(klu_milliseconds(contact_matrix(state.packing, DofMap<2>(state.packing), state.contacts)));
            last = state;
            lost += now() - begin;
        }
    }
};

/// One level of a line of the table.
struct Measured {
    long arcs = 0;
    int equilibria = 0;
    std::vector<double> per_arc, klu, ratio;
    std::string failure;
};

struct Row {
    int n = 0;
    Measured plain, proved;
    double rank_against_umfpack = 0;
};

/// Median and extremes.
std::string spread(const std::vector<double>& x) {
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    return fmt::format("{:.2f} ({:.2f}-{:.2f})", median(x), *low, *high);
}

State<2> measure(const State<2>& start, CertifyLevel level, int equilibria, Measured& measured) {
    State<2> state = start;
    Sampler sampler;
    RunCounters counters;
    Segment segment;
    segment.equilibria = equilibria;
    RunOptions options;
    options.certify = level;
    const double begin = now();
    const auto outcome = run_segment<2>(state, segment, 0, options, counters, sampler);
    const double total = now() - begin - sampler.lost;
    measured.arcs = counters.steps;
    measured.equilibria = counters.equilibria;
    measured.per_arc.push_back(total / static_cast<double>(std::max(1L, counters.steps)));
    measured.klu.push_back(median(sampler.klu));
    measured.ratio.push_back(measured.per_arc.back() / measured.klu.back());
    measured.failure = outcome.failure ? outcome.failure->message : "";
    return sampler.last;
}

double parts(const State<2>& state) {
    const DofMap<2> dofs(state.packing);
    const auto residues = exact_contact_matrix(state.packing, dofs, state.contacts);
    const sparse::Ordering ordering(residues);
    auto proved = IsostaticStructure<2>::prove(state.packing, state.contacts);
    const IsostaticStructure<2>& structure = proved.value();
    const Factorisation factorisation(structure);
    InverseBoundCache cache;
    InverseBound inverse = bound_inverse(structure, factorisation, cache);
    const double umfpack = umfpack_milliseconds(structure.matrix());
    const double rank = milliseconds([&] { (void)exact::rank(residues, ordering); });
    fmt::print("    exact rank {:.2f} ms = {:.2f} of one UMFPACK analysis + factorisation ({:.2f} ms)\n", rank,
               rank / umfpack, umfpack);
    fmt::print("    symbolic analysis {:.2f}, numeric factorisation {:.2f}, bound of the inverse {:.2f}, statics "
               "{:.2f}, candidates {:.2f} ms\n",
               milliseconds([&] { const sparse::Ordering again(residues); }),
               milliseconds([&] { const Factorisation again(structure); }),
               milliseconds([&] { inverse = bound_inverse(structure, factorisation, cache); }), milliseconds([&] {
                   const Statics<2> again(state.packing, state.load, structure, factorisation, inverse);
               }),
               milliseconds([&] { (void)find_candidates(state.packing, 0.8); }));
    return rank / umfpack;
}

std::optional<State<2>> start(const std::string& source) {
    if (source.find_first_not_of("0123456789") != std::string::npos) {
        return read_state<2>(source).state;
    }
    PreparationOptions options;
    options.disks = std::atoi(source.c_str());
    PreparationReport<2> report;
    auto prepared = prepare(options, report);
    if (!prepared.ok()) {
        fmt::print("{}: not prepared: {}\n", source, prepared.failure().message);
        return std::nullopt;
    }
    return prepared.value();
}

std::string list(const std::vector<double>& x) {
    return fmt::format("[{:.5g}]", fmt::join(x, ", "));
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources;
    std::string json;
    int equilibria = 30;
    int repeats = 3;
    for (int k = 1; k < argc; ++k) {
        const std::string word = argv[k];
        if (k + 1 < argc && word == "--json") {
            json = argv[++k];
        } else if (k + 1 < argc && word == "--equilibria") {
            equilibria = std::atoi(argv[++k]);
        } else if (k + 1 < argc && word == "--repeats") {
            repeats = std::atoi(argv[++k]);
        } else {
            sources.push_back(word);
        }
    }
    if (sources.empty()) {
        sources = {"400", "1936", "4900"};
    }
    std::vector<Row> rows;
    for (const std::string& source : sources) {
        const auto begin_state = start(source);
        if (!begin_state) {
            continue;
        }
        Row row;
        row.n = begin_state->packing.disk_count();
        for (int repeat = 0; repeat < repeats; ++repeat) {
            (void)measure(*begin_state, CertifyLevel::plain, equilibria, row.plain);
            const State<2> last = measure(*begin_state, CertifyLevel::decisions, equilibria, row.proved);
            if (repeat == 0) {
                row.rank_against_umfpack = parts(last);
            }
        }
        rows.push_back(row);
    }
    fmt::print(
        "\n| n | arcs | one KLU analysis + factorisation, ms | plain / KLU | decisions / KLU | decisions / plain | "
        "exact rank / UMFPACK |\n|---|---|---|---|---|---|---|\n");
    const auto quotient = [](const Row& row) {
        std::vector<double> x;
        for (std::size_t k = 0; k < row.plain.per_arc.size(); ++k) {
            x.push_back(row.proved.per_arc[k] / row.plain.per_arc[k]);
        }
        return x;
    };
    for (const Row& row : rows) {
        const std::string& failure = row.plain.failure.empty() ? row.proved.failure : row.plain.failure;
        fmt::print("| {} | {}{} | {:.2f} | {} | {} | {} | {:.2f} |{}\n", row.n, row.proved.arcs,
                   row.plain.arcs == row.proved.arcs ? "" : fmt::format(" (plain {})", row.plain.arcs),
                   median(row.proved.klu), spread(row.plain.ratio), spread(row.proved.ratio), spread(quotient(row)),
                   row.rank_against_umfpack, failure.empty() ? "" : "  " + failure);
    }
    if (rows.size() > 1) {
        const auto growth = [&](const Measured Row::*level) {
            return std::log(median((rows.back().*level).per_arc) / median((rows.front().*level).per_arc)) /
                   std::log(double(rows.back().n) / rows.front().n);
        };
        fmt::print("\ncost per arc from n = {} to {} grows as n^{:.2f} (plain), n^{:.2f} (decisions)\n", rows.front().n,
                   rows.back().n, growth(&Row::plain), growth(&Row::proved));
    }
    if (!json.empty()) {
        std::ofstream file(json);
        file << "{\"table\": \"arc_cost\", \"rows\": [";
        const auto level = [](const Measured& m) {
            return fmt::format("{{\"arcs\": {}, \"equilibria\": {}, \"ms_per_arc\": {}, \"klu_ms\": {}, \"ratio\": {}, "
                               "\"completed\": {}}}",
                               m.arcs, m.equilibria, list(m.per_arc), list(m.klu), list(m.ratio), m.failure.empty());
        };
        for (std::size_t k = 0; k < rows.size(); ++k) {
            file << fmt::format("{}{{\"n\": {}, \"plain\": {}, \"decisions\": {}, \"rank_against_umfpack\": {:.5g}}}",
                                k == 0 ? "" : ", ", rows[k].n, level(rows[k].plain), level(rows[k].proved),
                                rows[k].rank_against_umfpack);
        }
        file << "]}\n";
    }
    return 0;
}
