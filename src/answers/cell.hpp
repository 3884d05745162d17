#pragma once
/// \file
/// The output of `inspect` for a periodic cell.

#include "certificate/jammed_box.hpp"
#include "io/json.hpp"

#include <isostat/certificate/certify.hpp>

namespace isostat::answers {

/// "15.4 x 14.8, tilt 0; x, y move, disk 0 is pinned".
std::string cell_words(const Packing& packing);

/// Counts of the stored coordinates, one row for each way to strain the cell.
void print_counts(std::string& out, const std::string& title, const StrainCounts& counts);
json::Json strains_json(const StrainCounts& counts);

void print_box(std::string& out, const Packing& packing, const BoxInspection& box);
json::Json box_json(const BoxInspection& box);

/// Prints the counts side by side, the words of jamming, and the count of contacts that elastic moduli need.
void print_cell(std::string& out, const CellInspection& cell);
json::Json cell_json(const Packing& packing, const CellInspection& cell);

} // namespace isostat::answers
