#pragma once
/// \file
/// Orders of little fill for factorisations. Decisions do not depend on the order; what they cost, and last digits, do.

#include <span>
#include <vector>

struct klu_common_struct; // of klu.h

namespace isostat::sparse {

/// Contact matrices of spheres with this many rows and more: nested dissection, where the order of METIS costs less
/// than it saves. (1.4 times the operations without it at 750 rows, 2.3 times at 3000.) Those of disks have at most
/// four entries in nearly all columns, and fill so little that AMD's order is as good.
[[nodiscard]] constexpr bool worth_dissection(int rows, int entries) {
    return rows >= 1000 && entries / 5 > rows;
}

/// KLU analyses with nested dissection of A + A^T where that is worth it; else with AMD on the same pattern, which
/// fills least for some thousands of contacts, and above 20 000 rows with COLAMD. (At 40 000, 1.7 million entries of
/// L + U for 1.2 million, and twice the time; at 10 000, 205 000 for 235 000.)
void choose_order(klu_common_struct& common, int rows, int entries);

/// Nested dissection of A A^T, A by columns without repeated rows: `order[k]` is row k of the permuted matrix. Throws
/// std::bad_alloc. The same on every run: METIS draws from the numbers of the C library, one call at a time.
[[nodiscard]] std::vector<int> dissection_of_products(int rows, std::span<const int> start, std::span<const int> row);

} // namespace isostat::sparse
