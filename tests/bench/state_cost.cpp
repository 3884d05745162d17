// Cost of what is asked of one state, in units of one UMFPACK and one KLU analysis + factorisation of the same contact
// matrix, and of the factorisations alone: exact rank and its parts, bounds, candidates, certificate, inspection,
// verification, in cells the counts of every kind of strain; and the memory of an inspection against that of L + U. One
// process, one thread, CPU time; all of it in turn, median and range of the quotients. Spheres: order of METIS. The
// status is 1 when something stays unproved. Usage:
//   bench_state_cost [--json FILE] [--repeats R] [--dimension D] [n | n:seed | state file ...]
// default: 100 400 1936 4900 (a number is prepared first, in a box), 9 repeats.
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"
#include "contact/candidates.hpp"
#include "exact/rank.hpp"
#include "statics/statics.hpp"
#include "verified/configuration.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>
#include <isostat/core/machine.hpp>

#include <fmt/format.h>
#include <malloc.h>

#include <cstdlib>
#include <fstream>

using namespace isostat;

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

struct Work {
    std::string name;
    std::function<void()> once;
    bench::Sample milliseconds{};
};

bool measure(const State& state, int repeats, bench::Table& table, bench::Table& units) {
    const auto order = bench::order_of(state);
    const sparse::Matrix<double> h = bench::matrix_of(state);
    const bench::KluAnalysis klu(h);
    const bench::UmfpackAnalysis umfpack(h, order);
    const long entries = umfpack.factorise();
    const DofMap dofs(state.packing);
    const auto residues = exact_contact_matrix(state.packing, dofs, state.contacts);
    sparse::Matrix<std::uint32_t> small{residues.rows, residues.cols, residues.start, residues.row, {}};
    for (const std::uint64_t x : residues.value) { // any values with this pattern: the cost does not depend on them
        small.value.push_back(static_cast<std::uint32_t>(x % exact::mersenne31));
    }
    const sparse::Ordering ordering(residues);
    auto proved = IsostaticStructure::prove(state.packing, state.contacts);
    if (!proved.ok()) {
        fmt::print(stderr, "{}\n", proved.failure().message());
        return false;
    }
    const IsostaticStructure& structure = proved.value();
    const Factorisation factors(structure);
    InverseBoundCache cache;
    InverseBound inverse = bound_inverse(structure, factors, cache);
    bool good = true;
    const auto inspect = [&] {
        const Result<Inspection> answer = inspect_vertex(state);
        good = good && answer.ok() && answer.value().record.verdict == Verdict::proved;
    };
    const double memory = memory_of(inspect);
    Certificate certificate;
    certificate.state = state;
    const Certification truth = certify(state);
    certificate.claims = truth.claims;
    for (const std::string& reason : truth.claims.undecided) {
        fmt::print(stderr, "{}\n", reason);
    }
    good = good && truth.verdict == Verdict::proved;
    std::vector<Work> works{
        {"UMFPACK", [&] { bench::umfpack(h, order); }},
        {"UMFPACK, factorisation alone", [&] { umfpack.factorise(); }},
        {"KLU", [&] { bench::klu(h); }},
        {"KLU, factorisation alone", [&] { klu.factorise(); }},
        {"exact rank, 61-bit prime", [&] { good = exact::rank(residues, ordering) == h.rows && good; }},
        {"exact rank, 31-bit prime (tried first)", [&] { (void)exact::rank(small, ordering); }},
        {"order of the exact rank", [&] { const sparse::Ordering again(residues); }},
        {"residues", [&] { (void)exact_contact_matrix(state.packing, dofs, state.contacts); }},
        {"rank proved, all of it",
         [&] { good = IsostaticStructure::prove(state.packing, state.contacts).ok() && good; }},
        {"factors of a run", [&] { const Factorisation again(structure); }},
        {"bound of the inverse", [&] { inverse = bound_inverse(structure, factors, cache); }},
        {"statics", [&] { const Statics again(state.packing, state.load, structure, factors, inverse); }},
        {"candidates", [&] { (void)find_candidates(state.packing, candidate_fraction); }},
        {"no overlap", [&] { (void)certify_admissible(state.packing, 0); }},
        {"certificate", [&] { (void)certify(state); }},
        {"certificate, double only", [&] { (void)certify(state, {.highest = Rung::double_bound}); }},
        {"inspect", inspect},
        {"verify", [&] { good = verify(certificate).verdict == Verdict::proved && good; }}};
    if (state.packing.cell.all()) {
        works.push_back({"kinds of strain", [&] { (void)inspect_cell(state, truth); }});
    }
    for (int repeat = 0; repeat < repeats; ++repeat) {
        for (Work& work : works) {
            work.milliseconds.add(bench::milliseconds(work.once, 1).median());
        }
    }
    const auto n = static_cast<long>(state.packing.disk_count());
    const std::string where = state.packing.cell.any() ? "cell" : "box";
    for (const Work& work : works) {
        const auto over = [&](std::size_t unit) { return work.milliseconds.over(works[unit].milliseconds); };
        table.add({n, where, work.name, work.milliseconds, over(0), over(1), over(2), over(3)});
    }
    constexpr double bytes_of_entry = sizeof(double) + sizeof(int);
    const double bytes = bytes_of_entry * static_cast<double>(entries);
    units.add({n, where, static_cast<long>(h.rows), static_cast<long>(ordering.block_start().size()) - 1,
               static_cast<double>(entries) / h.rows, bytes / 1e6, memory / 1e6, memory / bytes});
    return good;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources{"100", "400", "1936", "4900"};
    int repeats = 9;
    int dimension = plane;
    bench::Program program("bench_state_cost", "what is asked of a state / one UMFPACK or KLU factorisation");
    program.option("--repeats", repeats, "of each measurement");
    program.option("--dimension", dimension, "3: numbers are of spheres");
    program.words("starts", sources, "numbers of grains or state files");
    program.parse(argc, argv);
    set_threads(1);
    bench::Table table("state_cost", "One thread, CPU time, median (range):",
                       {{"n", "n", ""},
                        {"walls", "in", ""},
                        {"work", "work", ""},
                        {"ms", "ms", "ms", "{:.2f}"},
                        {"umfpack", "/ UMFPACK", "UMFPACK", "{:.2f}"},
                        {"umfpack_factorisation", "/ UMFPACK factorisation alone", "UMFPACK numeric", "{:.2f}"},
                        {"klu", "/ KLU", "KLU", "{:.2f}"},
                        {"klu_factorisation", "/ KLU factorisation alone", "KLU numeric", "{:.2f}"}});
    bench::Table units("units", "L + U of UMFPACK, and the memory of an inspection:",
                       {{"n", "n", ""},
                        {"walls", "in", ""},
                        {"size", "N", ""},
                        {"blocks", "blocks", ""},
                        {"entries", "entries of L + U a row", "", "{:.0f}"},
                        {"factors", "L + U, MB", "MB", "{:.1f}"},
                        {"memory", "inspect, MB", "MB", "{:.1f}"},
                        {"ratio", "inspect / L + U", "", "{:.1f}"}});
    bool good = true;
    if (const auto little =
            bench::start("30", dimension)) { // pages of the program are there before its memory is counted
        (void)inspect_vertex(*little);
    }
    for (const std::string& source : sources) {
        const auto state = bench::start(source, dimension);
        good = state && measure(*state, repeats, table, units) && good;
    }
    program.show(table);
    program.show(units);
    return program.finish(good);
}
