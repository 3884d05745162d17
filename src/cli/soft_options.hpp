#pragma once
/// \file
/// What is stated to `import` and `snap` of a packing of soft grains.

#include "cli/read_packing.hpp"
#include "snap/soft_list.hpp"

#include <string>

namespace isostat::cli {

/// A positive length of each axis, "L1,L2". Throws `Error(usage)`.
PerAxis<double> parse_lengths(const std::string& text, const char* option, int dimension);
/// Of --stress, as many as there are axes; ones for an empty text.
PerAxis<double> parse_stress(const std::string& text, int dimension = 2);

/// `--cell`: what of a periodic cell moves, "rectangular", "tilted", "isotropic" or "fixed"; empty: the tilt too if the
/// file has one.
struct CellStatement {
    std::string file, cell;
};
/// The periods move, as stated. Throws `Error(usage)` for a statement about walls, or about a channel
/// or a slab.
void take_cell(const CellStatement& statement, Packing& packing);

/// `--contacts` and `--contact-columns`: a file of pairs with forces and its columns, "I,J,FORCE". \p frame: of both
/// files. Throws `Error(usage)`.
compare::SoftList stated_list(const std::string& file, const ForeignPacking& packing, const std::string& frame,
                              const std::string& contacts, const std::string& columns);

} // namespace isostat::cli
