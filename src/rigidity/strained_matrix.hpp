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

/// Rows: the degrees of freedom of the disks that are neither fixed nor pinned; then those of E = e 1 + E', E'_00 = 0:
/// e, the other diagonal entries, the entries above the diagonal; every kind of strain has the first few of these rows.
/// Column of a contact: |r| times minus the gradient of its gap, exactly, mod 2^61 - 1: r on the disks as in
/// `exact_contact_matrix`, - r_a (A m)_b on E_ab. \pre every axis is periodic
sparse::Matrix<std::uint64_t> exact_strained_matrix(const Packing& packing, const std::vector<Contact>& contacts,
                                                    Strain strain);

/// The same matrix in the field; `at(k)` is coordinate k of `Packing::q`, and `packing` says which coordinates exist.
exact::NumberMatrix strained_matrix(const Packing& packing, const std::function<exact::Number(std::size_t)>& at,
                                    const std::vector<Contact>& contacts, Strain strain);

/// Counts of a matrix; its kernel is computed when its rank mod p is below both numbers of rows and columns.
Counting count_matrix(const exact::NumberMatrix& matrix);

/// The counts of rigid bodies, from those of a list with this number of bars, which are independent.
Counting without_bars(Counting all, int bars);

} // namespace isostat
