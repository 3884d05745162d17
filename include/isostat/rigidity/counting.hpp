#pragma once
/// \file
/// Counting for any contact list: rank, hyperstaticity h, mechanisms k (statement T1); for a periodic packing under
/// each way in which its cell may strain.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>

#include <array>
#include <vector>

namespace isostat {

/// Compressed columns, row indices sorted in each: what `Eigen::Map<Eigen::SparseMatrix<double>>` and scipy take.
struct SparseColumns {
    int rows = 0, columns = 0;
    std::vector<int> start;    ///< columns + 1
    std::vector<int> row;      ///< one per entry
    std::vector<double> value; ///< one per entry
};

/// H (N_f x N): column l is minus the gradient of gap l on the degrees of freedom, in the order of `DofMap`: H f =
/// F_ext, and H^T v are the rates at which the gaps close. Each entry has a relative error of at most 4u (u = 2^-53)
/// for coordinates on the grid; a component that is 0 here is stored as 0. Cost: linear in the number of contacts.
SparseColumns contact_matrix(const State& state);

/// N_f + h = N + k for the exact contact matrix of the stored configuration.
/// `rank` is the rank mod 2^61 - 1. It is a proved *lower* bound of the true rank (T4); when it equals min(N, N_f) it
/// is the rank, `rank_exact` is `proved`, and h = N - rank, k = N_f - rank are exact. Otherwise `rank_exact` is
/// `undecided`: h and k are proved upper bounds, and too large with a chance of about N / 2^61.
struct Counting {
    int dof_count = 0;
    int contact_count = 0;
    int rank = 0;
    int hyperstaticity = 0;
    int mechanisms = 0;
    Verdict rank_exact = Verdict::undecided;
    std::vector<int> free_dofs; ///< k degrees of freedom that leave no mechanism when held (rank N_f is then proved)
};

/// Contacts, walls and fixed disks may be any. Bars do not count: each takes one from N_f, N and rank, so that a clump
/// has 3 degrees of freedom in the plane; h and k are those of the whole list, as bars are independent. Cost: an exact
/// rank when the matrix is square and regular mod p; else also an elimination in natural column order, O(n^2) for
/// packings: meant for inspection, not for the path.
Counting count_contacts(const Packing& packing, const std::vector<Contact>& contacts);

/// The number of bars in a list.
int bar_count(const std::vector<Contact>& contacts);

/// How the cell may strain, A -> (1 + E) A, with all disks moving as they like:
/// - `none`: a fixed cell; - `isotropic`: E = e 1, the shape is kept (a pressure); - `diagonal`: E has d entries;
/// - `full`: E is upper triangular, d (d + 1) / 2 entries: every strain, but for rotations of everything.
/// What this packing itself lets move of its cell (`Cell`) is ignored.
enum class Strain : unsigned char { none, isotropic, diagonal, full };
inline constexpr std::array<Strain, 4> strains{Strain::none, Strain::isotropic, Strain::diagonal, Strain::full};

/// "fixed cell", "isotropic", "diagonal", "full strain".
const char* to_string(Strain strain);

/// Number of entries of E in d dimensions.
constexpr int strain_count(Strain strain, int d) {
    switch (strain) {
    case Strain::none: return 0;
    case Strain::isotropic: return 1;
    case Strain::diagonal: return d;
    case Strain::full: return d * (d + 1) / 2;
    }
    return 0;
}

/// N_f, N, rank, h, k of the stored coordinates for every way to strain the cell, in the order
/// of `strains`. A rank is a lower bound from a prime field, and exact (`rank_exact`) when it
/// is as high as N or N_f allow, or when the matrix is small and its kernel was checked in
/// rationals. `free_dofs` is empty. \pre every axis is periodic. Cost: one exact rank.
using StrainCounts = std::array<Counting, strains.size()>;
StrainCounts count_strains(const Packing& packing, const std::vector<Contact>& contacts);

/// Disks that no contact of the list touches, ascending.
std::vector<int> untouched(int disks, const std::vector<Contact>& pairs);

/// Rattlers as codes of soft grains count them: grains with at most d contacts are removed with their contacts until
/// none is left. Ascending. A grain without force but with more contacts is not counted.
std::vector<int> rattlers_by_coordination(const Packing& packing, std::vector<Contact> contacts);

/// The packing with some disks (rattlers) fixed, so that only the others count.
Packing without_disks(Packing packing, const std::vector<int>& disks);

/// Goodrich, Liu & Nagel (Phys. Rev. Lett. 109, 095704, 2012): the contacts that N_0 disks without rattlers need in a
/// periodic cell, d N_0 - d + 1 for a positive bulk modulus and d N_0 - d + d (d + 1) / 2 for all elastic moduli. The
/// formula counts contacts alone and uses no ranks.
constexpr int contacts_for_bulk_modulus(int disks, int d) {
    return d * disks - d + 1;
}
constexpr int contacts_for_all_moduli(int disks, int d) {
    return d * disks - d + d * (d + 1) / 2;
}

} // namespace isostat
