#pragma once
/// \file
/// The output of `plateau`.

#include "crafted/told_ranges.hpp"
#include "io/json.hpp"

#include <isostat/crafted/plateau.hpp>
#include <isostat/foreign/foreign.hpp>

#include <array>
#include <string>

namespace isostat::answers {

struct PlateauAnswer {
    const std::string& name; ///< of the file
    const std::string& strain;
    const ForeignPacking& file;
    const crafted::Plateau& plateau;
    const crafted::Told& told;
    std::array<double, 2> thresholds;
};

std::string to_text(const PlateauAnswer& answer);
void add_plateau(json::Json& object, const PlateauAnswer& answer);

inline constexpr const char* plateau_head =
    "threshold,candidates,rattlers,N_f,N,rank,h,k,rank_exact,isostatic,all_N_f,all_N,"
    "all_rank,all_h,all_k,all_rank_exact,all_isostatic,turns,all_turns\n";
/// One row per threshold.
std::string to_csv(const crafted::Plateau& plateau);

} // namespace isostat::answers
