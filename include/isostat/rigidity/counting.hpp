#pragma once
/// \file
/// Counting for any contact list: rank, hyperstaticity h, mechanisms k (statement T1).

#include <isostat/contact/contact.hpp>
#include <isostat/core/verdict.hpp>
#include <isostat/packing/packing.hpp>

#include <string>
#include <vector>

namespace isostat {

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
    std::vector<int> free_dofs; ///< k degrees of freedom that, when held, leave no mechanism (rank N_f is then proved)
};

/// Any number of contacts, walls, fixed disks. Cost: an exact rank when the matrix is square and regular mod p; else
/// also an elimination in natural column order, O(n^2) for packings: meant for inspection, not for the path.
template <int Dim> Counting count_contacts(const Packing<Dim>& packing, const std::vector<Contact>& contacts);

extern template Counting count_contacts<2>(const Packing<2>&, const std::vector<Contact>&);

} // namespace isostat
