// Cost of the exact rank, modulo the 61-bit prime and the 31-bit one that proofs try first, against the double
// factorisations of the same contact matrices, and of the candidate list and
// the non-overlap certificate of the same packings. CPU time, the exact rank and each unit in turn, median and range of
// the quotients. The status is 1 when a rank is not full. Usage:
//   bench_exact_rank [--json FILE] [--repeats R] [n | state file | vertex file ...]
// default: 100 400 1936 4900 (a number is prepared first), 15 repeats
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"
#include "contact/candidates.hpp"
#include "exact/rank.hpp"
#include "rigidity/isostatic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace isostat;

namespace {

bool measure(const State& state, int repeats, bench::Table& ratios, bench::Table& parts) {
    const DofMap dofs(state.packing);
    const sparse::Matrix<double> h = bench::matrix_of(state);
    const sparse::Matrix<std::uint64_t> residues = exact_contact_matrix(state.packing, dofs, state.contacts);
    const sparse::Ordering ordering(residues);
    if (h.rows != h.cols || !ordering.structurally_regular()) {
        fmt::print(stderr, "N_f = {}, N = {}, structural rank {}: not a square structure\n", h.rows, h.cols,
                   ordering.structural_rank());
        return false;
    }
    int rank = h.rows;
    const auto eliminate = [&] { rank = std::min(rank, exact::rank(residues, ordering)); };
    sparse::Matrix<std::uint32_t> small{residues.rows, residues.cols, residues.start, residues.row, {}};
    for (const std::uint64_t x : residues.value) { // any values with this pattern: the cost does not depend on them
        small.value.push_back(static_cast<std::uint32_t>(x % exact::mersenne31));
    }
    const auto eliminate31 = [&] { (void)exact::rank(small, ordering); };
    const bench::KluAnalysis klu(h);
    const bench::UmfpackAnalysis umfpack(h);
    int entries = 0;
    const bench::Pair to_klu = bench::in_turn(
        eliminate, [&] { bench::klu(h); }, repeats);
    const bench::Pair to_klu_factors = bench::in_turn(
        eliminate, [&] { entries = klu.factorise(); }, repeats);
    const bench::Pair to_umfpack = bench::in_turn(
        eliminate, [&] { bench::umfpack(h); }, repeats);
    const bench::Pair to_umfpack_factors = bench::in_turn(
        eliminate, [&] { umfpack.factorise(); }, repeats);
    const bench::Pair to_umfpack31 = bench::in_turn(
        eliminate31, [&] { bench::umfpack(h); }, repeats);
    const bench::Pair to_umfpack_factors31 = bench::in_turn(
        eliminate31, [&] { umfpack.factorise(); }, repeats);
    const auto n = static_cast<long>(state.packing.disk_count());
    ratios.add({n, static_cast<long>(h.rows), static_cast<long>(rank), to_umfpack.first, to_umfpack.ratio(),
                to_umfpack_factors.ratio(), to_klu.ratio(), to_klu_factors.ratio(), to_umfpack31.first,
                to_umfpack31.ratio(), to_umfpack_factors31.ratio()});
    parts.add({n, static_cast<long>(ordering.block_start().size()) - 1, static_cast<long>(entries), to_klu.second,
               to_klu_factors.second, to_umfpack.second, to_umfpack_factors.second,
               bench::milliseconds([&] { (void)exact_contact_matrix(state.packing, dofs, state.contacts); }, repeats),
               bench::milliseconds([&] { rank = std::min(rank, exact::rank(residues)); }, std::min(repeats, 3)),
               bench::milliseconds([&] { (void)find_candidates(state.packing, 0.8); }, repeats),
               bench::milliseconds([&] { (void)certify_admissible(state.packing, 0); }, repeats)});
    return rank == h.rows;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources{"100", "400", "1936", "4900"};
    int repeats = 15;
    bench::Program program("bench_exact_rank", "exact rank / one KLU or UMFPACK factorisation of the same matrix");
    program.option("--repeats", repeats, "of each measurement");
    program.words("starts", sources, "numbers of disks or state files");
    if (const auto status = program.parse(argc, argv)) {
        return *status;
    }
    bench::Table ratios("exact_rank",
                        "Exact rank (61-bit prime, ordering at hand) in units of the double factorisations of the same "
                        "matrix, median (range):",
                        {{"n", "n", ""},
                         {"size", "N", ""},
                         {"rank", "rank", ""},
                         {"rank_ms", "exact rank, ms", "ms", "{:.2f}"},
                         {"umfpack", "/ UMFPACK analysis + factorisation", "UMFPACK", "{:.2f}"},
                         {"umfpack_factorisation", "/ UMFPACK factorisation alone", "UMFPACK numeric", "{:.2f}"},
                         {"klu", "/ KLU analysis + factorisation", "KLU", "{:.2f}"},
                         {"klu_factorisation", "/ KLU factorisation alone", "KLU numeric", "{:.2f}"},
                         {"rank31_ms", "31-bit prime (tried first), ms", "ms", "{:.2f}"},
                         {"umfpack31", "/ UMFPACK analysis + factorisation", "UMFPACK", "{:.2f}"},
                         {"umfpack_factorisation31", "/ UMFPACK factorisation alone", "UMFPACK numeric", "{:.2f}"}});
    bench::Table parts("parts", "The units, and other work on the same packing, ms:",
                       {{"n", "n", ""},
                        {"blocks", "blocks", ""},
                        {"entries", "entries of L and U (KLU)", ""},
                        {"klu", "KLU", "ms", "{:.2f}"},
                        {"klu_factorisation", "KLU factorisation", "ms", "{:.2f}"},
                        {"umfpack", "UMFPACK", "ms", "{:.2f}"},
                        {"umfpack_factorisation", "UMFPACK factorisation", "ms", "{:.2f}"},
                        {"residues", "residues", "ms", "{:.2f}"},
                        {"rank_and_ordering", "rank and ordering", "ms", "{:.2f}"},
                        {"candidates", "candidates", "ms", "{:.2f}"},
                        {"admissible", "certificate of no overlap", "ms", "{:.2f}"}});
    bool good = true;
    for (const std::string& source : sources) {
        const auto state = bench::start(source);
        good = state && measure(*state, repeats, ratios, parts) && good;
    }
    program.show(ratios);
    program.show(parts);
    return program.finish(good);
}
