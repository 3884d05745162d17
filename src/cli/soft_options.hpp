#pragma once
/// \file
/// What is stated to `import` and `snap` of a packing of soft grains.

#include "cli/read_packing.hpp"
#include "compare/soft_list.hpp"

#include <array>
#include <string>

namespace isostat::cli {

/// Two positive numbers, as in "S1,S2"; `names` is that. Throws `Error(usage)`.
std::array<double, 2> parse_pair(const std::string& text, const char* option, const char* names);
/// Of --stress, as many as there are axes; ones for an empty text.
PerAxis<double> parse_stress(const std::string& text, int dimension = 2);

/// `--cell`: what of a periodic cell moves, "rectangular", "tilted" or "isotropic"; empty: the tilt too if the file has
/// one.
struct CellStatement {
    std::string file, cell;
};
/// The periods move, as stated. Throws `Error(usage)` for a statement about walls, or about a channel
/// or a slab.
void take_cell(const CellStatement& statement, Packing& packing);

/// `--contacts` and `--contact-columns`: a file of pairs with forces and its columns, "I,J,FORCE". \p frame: of both
/// files. Throws `Error(usage)`.
compare::SoftList stated_list(const std::string& file, const ReadPacking& packing, const std::string& frame,
                              const std::string& contacts, const std::string& columns);

} // namespace isostat::cli
