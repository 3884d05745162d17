// Cost of a trajectory in units of its linear algebra: milliseconds per arc (rank proved, inverse bounded, decisions
// proved at every vertex) divided by one KLU analysis + factorisation of the same contact matrices, and the parts of
// that cost. Usage:
//   bench_arc_cost [n ...]        default: 400 1936 4900
#include <isostat/contact/candidates.hpp>
#include <isostat/exact/rank.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/statics/statics.hpp>
#include <isostat/trajectory/trajectory.hpp>
#include <isostat/verified/configuration.hpp>

#include <fmt/format.h>
#include <klu.h>
#include <umfpack.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

using namespace isostat;

namespace {

using Clock = std::chrono::steady_clock;

/// Median milliseconds of several calls.
template <class Work> double milliseconds(Work work, int repeats = 9) {
    std::vector<double> times;
    for (int k = 0; k < repeats; ++k) {
        const auto begin = Clock::now();
        work();
        times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
    return times[static_cast<std::size_t>(repeats / 2)];
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

/// Counts the arcs and keeps every tenth equilibrium, on which the reference is measured.
struct Sampler : RunObserver<2> {
    std::vector<State<2>> states;
    int equilibria = 0;
    void on_equilibrium(const EquilibriumRecord<2>&, const State<2>& state, const std::vector<double>&) override {
        if (equilibria++ % 10 == 0) {
            states.push_back(state);
        }
    }
};

void parts(const State<2>& state) {
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
}

} // namespace

int main(int argc, char** argv) {
    std::vector<int> sizes;
    for (int k = 1; k < argc; ++k) {
        sizes.push_back(std::atoi(argv[k]));
    }
    if (sizes.empty()) {
        sizes = {400, 1936, 4900};
    }
    fmt::print("seed 1, dead loads, rule most_negative; KLU: median over the equilibria of the run\n");
    fmt::print("{:>6} {:>8} {:>6} {:>10} {:>12} {:>8}\n", "n", "arcs", "eq.", "ms / arc", "KLU a+f, ms", "ratio");
    for (const int n : sizes) {
        PreparationOptions options;
        options.disks = n;
        PreparationReport<2> report;
        auto prepared = prepare(options, report);
        if (!prepared.ok()) {
            fmt::print("{:>6} not prepared: {}\n", n, prepared.failure().message);
            continue;
        }
        State<2> state = prepared.value();
        Sampler sampler;
        RunCounters counters;
        Segment segment;
        segment.equilibria = 30;
        const auto begin = Clock::now();
        const auto outcome = run_segment<2>(state, segment, 0, RunOptions{}, counters, sampler);
        const double total = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
        std::vector<double> reference;
        for (const State<2>& s : sampler.states) {
            reference.push_back(klu_milliseconds(contact_matrix(s.packing, DofMap<2>(s.packing), s.contacts)));
        }
        std::nth_element(reference.begin(), reference.begin() + static_cast<long>(reference.size() / 2),
                         reference.end());
        const double klu = reference[reference.size() / 2];
        const double per_arc = total / static_cast<double>(counters.steps);
        fmt::print("{:>6} {:>8} {:>6} {:>10.2f} {:>12.2f} {:>8.2f}{}\n", n, counters.steps, counters.equilibria,
                   per_arc, klu, per_arc / klu, outcome.failure ? "  " + outcome.failure->message : "");
        parts(sampler.states.back());
    }
    return 0;
}
