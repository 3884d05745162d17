#pragma once
/// \file
/// The contact matrix of a periodic packing with the strain of its cell, exactly.

#include "sparse/pattern.hpp"

#include <isostat/exact/number.hpp>
#include <isostat/rigidity/counting.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace isostat {

/// Rows: the degrees of freedom of the disks that are not fixed, without those of the pinned one; then those of E =
/// e 1 + E', E'_00 = 0: e, the rest of the diagonal, what is above it, of which every kind of strain has the first so
/// many. Column of a contact: |r| times minus the gradient of its gap, exactly, mod 2^61 - 1: r on the disks as in
/// `exact_contact_matrix`, - r_a (A m)_b on E_ab. \pre every axis is periodic
sparse::Matrix<std::uint64_t> exact_strained_matrix(const Packing& packing, const std::vector<Contact>& contacts,
                                                    Strain strain);

/// The same matrix in the field, of coordinates `at(k)`, k as in `Packing::q`; `packing` says which there are.
exact::NumberMatrix strained_matrix(const Packing& packing, const std::function<exact::Number(std::size_t)>& at,
                                    const std::vector<Contact>& contacts, Strain strain);

/// What the matrix counts: its kernel is sought where its rank mod p is not as high as rows and columns allow.
Counting count_matrix(const exact::NumberMatrix& matrix);

/// The counts of rigid bodies, of those of a list with so many bars, which are independent.
Counting without_bars(Counting all, int bars);

} // namespace isostat
