// Cost of the exact rank against the double factorisations of the same contact matrices, and of the candidate list and
// the non-overlap certificate of the same packings. CPU milliseconds, smallest of several calls; compare within one
// line. Usage:
//   bench_exact_rank [vertex file | n ...]      a number is prepared first (n = 4900 takes a while); default 100 400
//   1936

#include <isostat/contact/candidates.hpp>
#include <isostat/exact/rank.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/rigidity/isostatic.hpp>

#include <fmt/format.h>
#include <klu.h>
#include <umfpack.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

using namespace isostat;

namespace {

double cpu_milliseconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// Smallest of several calls: other processes only add.
template <class Work> double milliseconds(Work work, int repeats = 15) {
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < repeats; ++k) {
        const double begin = cpu_milliseconds();
        work();
        best = std::min(best, cpu_milliseconds() - begin);
    }
    return best;
}

/// Text: n; radius x y gx gy per disk; Lx Ly; N; type i j per contact (0 disks, 1 left, 2 bottom, 3 right, 4 top). '#'
/// starts a comment.
bool read_vertex(const std::string& path, State<2>& state) {
    std::ifstream file(path);
    std::string line;
    while (file.peek() == '#' && std::getline(file, line)) {
    }
    int n = 0;
    file >> n;
    double unused = 0;
    for (int i = 0; i < n; ++i) {
        double r = 0;
        double x = 0;
        double y = 0;
        file >> r >> x >> y >> unused >> unused;
        state.packing.radius.push_back(r);
        state.packing.q.insert(state.packing.q.end(), {x, y});
    }
    double lx = 0;
    double ly = 0;
    int count = 0;
    file >> lx >> ly >> count;
    state.packing.q.insert(state.packing.q.end(), {lx, ly});
    for (int l = 0; l < count; ++l) {
        int type = 0;
        int i = 0;
        int j = 0;
        file >> type >> i >> j;
        if (type == 0) {
            state.contacts.push_back({ContactKind::disk_disk, std::min(i, j), std::max(i, j)});
        } else {
            state.contacts.push_back({type < 3 ? ContactKind::lower_wall : ContactKind::upper_wall, i, (type - 1) % 2});
        }
    }
    return static_cast<bool>(file);
}

void measure(const std::string& name, const State<2>& state) {
    const DofMap<2> dofs(state.packing);
    sparse::Matrix<double> h = contact_matrix(state.packing, dofs, state.contacts);
    const sparse::Matrix<std::uint64_t> residues = exact_contact_matrix(state.packing, dofs, state.contacts);
    const sparse::Ordering ordering(residues);
    if (h.rows != h.cols || !ordering.structurally_regular()) {
        fmt::print("{}: N_f = {}, N = {}, structural rank {}: not a square structure\n", name, h.rows, h.cols,
                   ordering.structural_rank());
        return;
    }
    klu_common common;
    klu_defaults(&common);
    const double klu_analysis = milliseconds([&] {
        klu_symbolic* symbolic = klu_analyze(h.rows, h.start.data(), h.row.data(), &common);
        klu_free_symbolic(&symbolic, &common);
    });
    klu_symbolic* symbolic = klu_analyze(h.rows, h.start.data(), h.row.data(), &common);
    const double klu = milliseconds([&] {
        klu_numeric* numeric = klu_factor(h.start.data(), h.row.data(), h.value.data(), symbolic, &common);
        klu_free_numeric(&numeric, &common);
    });
    klu_numeric* numeric = klu_factor(h.start.data(), h.row.data(), h.value.data(), symbolic, &common);
    const int entries = numeric == nullptr ? 0 : numeric->lnz + numeric->unz;
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
    const double umfpack = milliseconds([&] {
        void* analysis = nullptr;
        void* factors = nullptr;
        umfpack_di_symbolic(h.rows, h.cols, h.start.data(), h.row.data(), h.value.data(), &analysis, nullptr, nullptr);
        umfpack_di_numeric(h.start.data(), h.row.data(), h.value.data(), analysis, &factors, nullptr, nullptr);
        umfpack_di_free_numeric(&factors);
        umfpack_di_free_symbolic(&analysis);
    });
    int rank = 0;
    const double exact = milliseconds([&] { rank = exact::rank(residues, ordering); });
    sparse::Matrix<std::uint32_t> small{residues.rows, residues.cols, residues.start, residues.row, {}};
    for (const std::uint64_t x : residues.value) { // any values with this pattern: the cost does not depend on them
        small.value.push_back(static_cast<std::uint32_t>(x % exact::mersenne31));
    }
    const double exact31 = milliseconds([&] { (void)exact::rank(small, ordering); });
    const double without = milliseconds([&] { rank = std::min(rank, exact::rank(residues)); }, 3);
    const double reduce = milliseconds([&] { (void)exact_contact_matrix(state.packing, dofs, state.contacts); });
    const double candidates = milliseconds([&] { (void)find_candidates(state.packing, 0.8); });
    const double certificate = milliseconds([&] { (void)certify_admissible(state.packing, 0); });
    fmt::print(
        "{:>10} {:>6} {:>6} {:>6} {:>7} | {:>7.2f} {:>7.2f} {:>7.2f} {:>7.2f} {:>7.2f} {:>7.2f} {:>7.2f} | {:>6.2f} "
        "{:>6.2f} | {:>6.2f} {:>6.2f}\n",
        name, h.rows, rank, ordering.block_start().size() - 1, entries, klu_analysis, klu, umfpack, reduce, exact,
        exact31, without, exact / umfpack, exact / (klu_analysis + klu), candidates, certificate);
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources(argv + 1, argv + argc);
    if (sources.empty()) {
        sources = {"100", "400", "1936"};
    }
    fmt::print(
        "{:>10} {:>6} {:>6} {:>6} {:>7} | {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} | {:>6} {:>6} | {:>6} {:>6}\n",
        "source", "N", "rank", "blocks", "KLU L+U", "KLU an.", "KLU LU", "UMFPACK", "reduce", "rank", "31 bits",
        "no ord.", "/UMF", "/KLU", "cand.", "cert.");
    for (const std::string& source : sources) {
        State<2> state;
        if (source.find_first_not_of("0123456789") == std::string::npos) {
            PreparationOptions options;
            options.disks = std::atoi(source.c_str());
            PreparationReport<2> report;
            auto prepared = prepare<2>(options, report);
            if (!prepared.ok()) {
                fmt::print("{}: not prepared: {}\n", source, prepared.failure().message);
                continue;
            }
            state = prepared.value();
        } else if (!read_vertex(source, state)) {
            fmt::print("{}: not a vertex file\n", source);
            return 65;
        }
        measure(source.substr(source.find_last_of('/') + 1), state);
    }
    return 0;
}
