#pragma once
/// \file
/// The output of `plateau`.

#include "answers/answer.hpp"

#include <isostat/crafted/plateau.hpp>
#include <isostat/foreign/foreign.hpp>

#include <array>
#include <string>

namespace isostat::answers {

/// The isostatic ranges worth reporting.
struct Told {
    std::vector<crafted::PlateauRange> backbone, all; ///< inside the widest range: the result
    std::vector<crafted::PlateauRange> elsewhere;     ///< other ranges of the backbone
    int noise = 0;                                    ///< ranges of the backbone left out as narrower than the rounding
    bool special = false;                             ///< the widest range has N = N_f and no full rank
};
Told told_of(const crafted::Plateau& plateau);

struct PlateauAnswer {
    const std::string& name; ///< of the file
    const std::string& strain;
    const ForeignPacking& file;
    const crafted::Plateau& plateau;
    const Told& told;
    std::array<double, 2> thresholds;
};

/// \p lists: as in `Answer`.
Answer to_answer(const PlateauAnswer& answer, bool lists);

inline constexpr const char* plateau_head =
    "threshold,candidates,rattlers,N_f,N,rank,h,k,rank_exact,isostatic,all_N_f,all_N,"
    "all_rank,all_h,all_k,all_rank_exact,all_isostatic,turns,all_turns\n";
/// One row per threshold.
std::string to_csv(const crafted::Plateau& plateau);

} // namespace isostat::answers
