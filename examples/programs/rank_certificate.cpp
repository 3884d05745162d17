// A certificate of full rank for a proof assistant: coordinates, contacts and the inverse of the contact matrix mod
// 2^61 - 1, as a Coq file that proofs/coq/contact_certificate.v checks. Usage: rank_certificate [STATE.json | DISKS
// [SEED]] > file.v; without a file a random packing is prepared.
#include "exact/rank.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/core/result.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/preparation/preparation.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace {

using namespace isostat;
using Row = std::vector<std::uint64_t>;

/// Rows of the inverse mod p of the transposed matrix, Gauss and Jordan; empty when the matrix is singular mod p.
std::vector<Row> inverse_of_transposed(const sparse::Matrix<std::uint64_t>& h) {
    const auto n = static_cast<std::size_t>(h.rows);
    std::vector<Row> a(n, Row(2 * n, 0));
    for (std::size_t l = 0; l < n; ++l) {
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            a[l][static_cast<std::size_t>(h.row[s])] = h.value[s];
        }
        a[l][n + l] = 1;
    }
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        while (pivot < n && a[pivot][k] == 0) {
            ++pivot;
        }
        if (pivot == n) {
            return {};
        }
        std::swap(a[k], a[pivot]);
        const std::uint64_t scale = exact::inverse(a[k][k]);
        for (std::uint64_t& x : a[k]) {
            x = exact::multiply(x, scale);
        }
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint64_t factor = a[i][k];
            for (std::size_t j = k; i != k && factor != 0 && j < 2 * n; ++j) {
                a[i][j] = exact::subtract(a[i][j], exact::multiply(factor, a[k][j]));
            }
        }
    }
    for (Row& row : a) {
        row.erase(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(n));
    }
    return a;
}

/// Smallest e such that every coordinate is an integer multiple of 2^e.
int unit_exponent(const std::vector<double>& q) {
    int least = 0;
    for (const double x : q) {
        while (x != 0 && std::ldexp(x, -least) != std::floor(std::ldexp(x, -least))) {
            --least;
        }
    }
    return least;
}

State prepared(int disks, std::uint64_t seed) {
    PreparationOptions options;
    options.disks = disks;
    options.seed = seed;
    PreparationReport report;
    auto state = prepare(options, report);
    if (!state.ok()) {
        throw Error(ErrorKind::bad_input, state.failure().message());
    }
    return state.value();
}

void write_certificate(const State& state) {
    const Packing& packing = state.packing;
    if (packing.walls != Walls::box() || !packing.fixed.empty()) {
        throw Error(ErrorKind::bad_input, "a packing in the box, without fixed disks, was expected");
    }
    const DofMap dofs(packing);
    auto inverse = inverse_of_transposed(exact_contact_matrix(packing, dofs, state.contacts));
    if (inverse.empty() || dofs.dof_count() != static_cast<int>(state.contacts.size())) {
        throw Error(ErrorKind::bad_input, "the contact matrix is not regular mod 2^61 - 1: there is no certificate");
    }
    const int exponent = unit_exponent(packing.q);
    const exact::Number scale = exact::Number::from_double(std::ldexp(1.0, -exponent));
    std::printf("(* %d disks. Unit of length: 2^%d. Written by a program; checked below. *)\n", packing.disk_count(),
                exponent);
    std::printf("From Coq Require Import ZArith List.\nFrom mathcomp Require Import all_ssreflect all_algebra.\n"
                "From Isostat Require Import statics contact_certificate.\n\nOpen Scope Z_scope.\n"
                "Definition coordinates : seq Z := [::");
    const char* separator = "\n  ";
    for (const double x : packing.q) {
        std::printf("%s%s", separator, (exact::Number::from_double(x) * scale).text().c_str());
        separator = "; ";
    }
    std::printf("].\nDefinition inverse_rows : seq (seq Z) := [::");
    const std::uint64_t unit = exact::residue(std::ldexp(1.0, exponent)); // rows of pairs are in units of length
    for (std::size_t k = 0; k < inverse.size(); ++k) {
        std::printf("%s", k == 0 ? "\n  [:: " : ";\n  [:: ");
        for (std::size_t l = 0; l < inverse.size(); ++l) {
            const bool pair = state.contacts[l].kind == ContactKind::disk_disk;
            const std::uint64_t entry = pair ? exact::multiply(inverse[k][l], unit) : inverse[k][l];
            std::printf("%s%llu", l == 0 ? "" : "; ", static_cast<unsigned long long>(entry));
        }
        std::printf("]");
    }
    std::printf("].\nClose Scope Z_scope.\nDefinition contacts : seq contact := [::");
    separator = "\n  ";
    for (const Contact& c : state.contacts) {
        const char* name = c.kind == ContactKind::disk_disk    ? "Disks"
                           : c.kind == ContactKind::lower_wall ? "Lower"
                           : c.kind == ContactKind::upper_wall ? "Upper"
                                                               : "Held"; // not in the vocabulary: Coq refuses it
        std::printf("%s%s %d %d", separator, name, c.i, c.j);
        separator = "; ";
    }
    std::printf("].\nDefinition modulus : Z := Eval vm_compute in Z.pred (Z.pow 2 61).\n\n"
                "Lemma certificate_is_accepted : certified %d coordinates contacts modulus inverse_rows = true.\n"
                "Proof. by vm_compute. Qed.\n"
                "Lemma centres_are_distinct : distinct_centres coordinates contacts = true.\n"
                "Proof. by vm_compute. Qed.\n\n"
                "Theorem packing_is_isostatic (F : rcfType) :\n"
                "  let G := contact_matrix %d coordinates contacts F in\n"
                "  [/\\ all (well_formed %d) contacts, G \\in unitmx, \\rank (kermx G) = 0, \\rank (kermx G^T) = 0\n"
                "    & forall load f, (f *m G == load)%%R = (f == forces G load)].\n"
                "Proof. exact: certified_packing_is_isostatic certificate_is_accepted centres_are_distinct. Qed.\n\n"
                "Print Assumptions packing_is_isostatic.\n",
                packing.disk_count(), packing.disk_count(), packing.disk_count());
}

} // namespace

int main(int argc, char** argv) {
    try {
        const int disks = argc > 1 ? std::atoi(argv[1]) : 8;
        write_certificate(disks > 0 ? prepared(disks, argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1)
                                    : read_state(argv[1]).state);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.exit_status();
    }
    return 0;
}
