#pragma once
/// \file
/// Orders of little fill for factorisations. They change cost and last digits, never decisions.

#include <span>
#include <vector>

struct klu_common_struct; // declared in klu.h

namespace isostat::sparse {

/// Whether nested dissection is worth its cost: for contact matrices of spheres with this many rows and more, where
/// METIS costs less than it saves. (Without it 1.4 times the operations at 750 rows, 2.3 times at 3000.) Matrices of
/// disks have at most four entries in nearly all columns, and so little fill that AMD's order is as good.
[[nodiscard]] constexpr bool worth_dissection(int rows, int entries) {
    return rows >= 1000 && entries / 5 > rows;
}

/// Makes KLU analyse with nested dissection of A + A^T where this is worth its cost; else with AMD on the same pattern,
/// which fills least for some thousands of contacts, above 20 000 rows with COLAMD (AMD against COLAMD: at 40 000
/// rows 1.7 against 1.2 million entries of L + U, and twice the time; at 10 000 rows 205 000 against 235 000), and from
/// 200 000 rows on with `dissection_of_columns` (against COLAMD 0.75 and 0.69 of the operations at 205 000 and 819
/// 000).
void choose_order(klu_common_struct& common, int rows, int entries);

/// Nested dissection of A A^T, A by columns without repeated rows: `order[k]` is row k of the permuted matrix. Throws
/// std::bad_alloc. The same on every run: METIS draws from the random numbers of the C library, one call at a time.
[[nodiscard]] std::vector<int> dissection_of_products(int rows, std::span<const int> start, std::span<const int> row);

/// The same of the columns that share a row, A^T A; rows of very many entries, as those of a cell, are left out.
[[nodiscard]] std::vector<int> dissection_of_columns(int rows, std::span<const int> start, std::span<const int> row);

} // namespace isostat::sparse
