#pragma once
/// \file
/// Claims about one state, each of them proved: what a certificate says.

#include <isostat/io/certificate_file.hpp>
#include <isostat/rigidity/counting.hpp>

#include <string>
#include <vector>

namespace isostat {

/// What is asked for.
struct CertifyOptions {
    /// The last arithmetic that is tried for a sign: `double_bound`, `double_double` or `multiprecision` (100 digits).
    Rung highest = Rung::multiprecision;
};

/// How many finite forces at the true vertex are proved to be what. All 0 when no true vertex was found.
struct ForceSigns {
    int positive = 0;
    int structural_zero = 0; ///< exactly 0
    int negative = 0;
    int undecided = 0;
};

/// Claims, and what became of the others.
struct Certification {
    CertificateClaims claims;
    /// `proved`: every claim is there, so the true vertex is an isostatic, stable equilibrium without overlap.
    /// `refuted`: one of them is proved to be wrong (`refuted` says which). `undecided`: neither.
    Verdict verdict = Verdict::undecided;
    std::vector<std::string> refuted; ///< one sentence each; they are among `claims.undecided` too
    Counting counting;                ///< of the stored coordinates; `rank_exact` undecided: the rank is a lower bound
    ForceSigns signs;
    /// Finite forces at the true vertex, one per contact, as far as they are known, also where a sign is not proved;
    /// empty without a true vertex. 1 in `structural_zero`: exactly 0.
    std::vector<Interval> finite;
    std::vector<unsigned char> structural_zero;
    std::string potential;     ///< words: what has a strict local minimum where `claims.stable`
    double stored_gap = 0;     ///< largest |gap| of a contact at the stored coordinates, rounded up
    double smallest_sigma = 0; ///< proved lower bound of the smallest singular value of the contact matrix at the true
                               ///< vertex; 0: none
};

/// Proves what it can of `state` with its coordinates exactly as they are stored (they are not put on the grid):
/// 1. counting: exact rank of the contact matrix of the stored coordinates (T4; where the rank mod p is not full and
///    the matrix is small, a kernel checked in rationals);
/// 2. vertex: Newton-Kantorovich (T9, V4, V5) at the stored coordinates, or, when they are too far from a vertex for
///    that, at the end of a Newton iteration that starts there; the claims of radii are about the stored ones;
/// 3. the smallest singular value at the true vertex, from the same theorem (V5): its rank is N_f;
/// 4. forces at the true vertex (V6): finite ones, structural zeros by the pattern of all entries that a contact can
///    have (T11), their infinitesimal forces;
/// 5. gaps of all other pairs at the true vertex, complete by T5 and T6; pairs that cannot move relative to each other
///    must not overlap either (exactly), but do not count among the gaps claimed;
/// 6. ends of the supported interval at the true vertex (V7);
/// 7. stability (T8): forces positive in the lexicographic order, no mechanism; dead loads, or true stresses without
///    forces on disks (their potential: sum sigma_a ln L_a, S5).
/// Every sign is tried in double, then with a corrected vertex in double-double, then in MPFR; `rung` of a claim is the
/// arithmetic that proved it. States that are not isostatic, that hold coordinates, or whose true stresses act
/// together with forces on disks (no potential: no claim of stability) get the claims that can be made. Load, pattern,
/// pairs and point: proofs/definition.md. Lengths or
/// loads beyond 1e-100 and 1e100: no claim. Deterministic. Cost: a rank proof, two
/// factorisations, a candidate list and ten solves in the usual case; each climb adds some solves.
Certification certify(const State& state, const CertifyOptions& options = {});

} // namespace isostat
