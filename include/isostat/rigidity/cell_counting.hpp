#pragma once
/// \file
/// Counting for a periodic packing under each way in which its cell may strain.

#include <isostat/rigidity/counting.hpp>
#include <isostat/sparse/pattern.hpp>

#include <array>
#include <cstdint>

namespace isostat {

/// How the cell may strain, A -> (1 + E) A, with all disks moving as they like:
/// - `none`: a fixed cell; - `isotropic`: E = e 1, the shape is kept (a pressure); - `diagonal`: E has d entries;
/// - `full`: E is upper triangular, d (d + 1) / 2 entries: every strain, but for rotations of everything.
/// What the packing itself lets move of its cell (`Cell`) plays no part.
enum class Strain : unsigned char { none, isotropic, diagonal, full };
inline constexpr std::array<Strain, 4> strains{Strain::none, Strain::isotropic, Strain::diagonal, Strain::full};

/// "fixed cell", "isotropic", "diagonal", "full strain".
const char* to_string(Strain strain);

/// Number of entries of E.
template <int Dim> constexpr int strain_count(Strain strain) {
    switch (strain) {
    case Strain::none: return 0;
    case Strain::isotropic: return 1;
    case Strain::diagonal: return Dim;
    case Strain::full: return Dim * (Dim + 1) / 2;
    }
    return 0;
}

/// Rows: the degrees of freedom of the disks that are not fixed, without those of the pinned one; then the entries of
/// E. Column of a contact: |r| times minus the gradient of its gap, exactly, mod 2^61 - 1: r on the disks as in
/// `exact_contact_matrix`, - r_a (A m)_b on E_ab. \pre every axis is periodic
template <int Dim>
sparse::Matrix<std::uint64_t> exact_strained_matrix(const Packing<Dim>& packing, const std::vector<Contact>& contacts,
                                                    Strain strain);

/// N_f, N, rank, h, k of the stored coordinates. The rank is a lower bound from a prime field, and exact (`rank_exact`)
/// where it is as high as N or N_f allow, or where the matrix is small and its kernel was checked in rationals.
/// `free_dofs` is empty. \pre every axis is periodic
template <int Dim>
Counting count_strained(const Packing<Dim>& packing, const std::vector<Contact>& contacts, Strain strain);

/// The same for every way to strain the cell, in the order of `strains`.
using StrainCounts = std::array<Counting, strains.size()>;
template <int Dim> StrainCounts count_strains(const Packing<Dim>& packing, const std::vector<Contact>& contacts);

/// Disks that no pair of the list touches, ascending.
std::vector<int> untouched(int disks, const std::vector<Contact>& pairs);

/// The packing with some disks fixed, so that only the others count: rattlers.
template <int Dim> Packing<Dim> without_disks(Packing<Dim> packing, const std::vector<int>& disks);

/// Goodrich, Liu & Nagel (Phys. Rev. Lett. 109, 095704, 2012): the contacts that N_0 disks without rattlers need in a
/// periodic cell, d N_0 - d + 1 for a positive bulk modulus and d N_0 - d + d (d + 1) / 2 for all elastic moduli. A
/// count alone: it says nothing of ranks.
template <int Dim> constexpr int contacts_for_bulk_modulus(int disks) {
    return Dim * disks - Dim + 1;
}
template <int Dim> constexpr int contacts_for_all_moduli(int disks) {
    return Dim * disks - Dim + Dim * (Dim + 1) / 2;
}

extern template sparse::Matrix<std::uint64_t> exact_strained_matrix<2>(const Packing<2>&, const std::vector<Contact>&,
                                                                       Strain);
extern template Counting count_strained<2>(const Packing<2>&, const std::vector<Contact>&, Strain);
extern template StrainCounts count_strains<2>(const Packing<2>&, const std::vector<Contact>&);
extern template Packing<2> without_disks<2>(Packing<2>, const std::vector<int>&);

} // namespace isostat
