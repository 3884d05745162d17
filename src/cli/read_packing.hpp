#pragma once
/// \file
/// A packing from any file that the program reads, and statements of the user about soft grains for `import` and
/// `snap`.

#include "cli/commands.hpp"
#include "snap/soft_list.hpp"

#include <isostat/foreign/foreign.hpp>

#include <string>
#include <vector>

namespace isostat::cli {

/// States, vertex texts, crafted packings (rounded to doubles) and files of other programs. Throws `Error(usage)` for
/// statements that make no sense, `Error(bad_input)` for the file.
ForeignPacking read_any_packing(const std::string& file, const ForeignArguments& arguments);

/// The words between commas, or another separator.
std::vector<std::string> parse_list(const std::string& text, char at = ',');

/// "A:B" as two finite numbers, A <= B. Throws `Error(usage)` naming the option.
std::array<double, 2> parse_range(const std::string& text, const std::string& option);

/// A positive length of each axis, "L1,L2". Throws `Error(usage)`.
PerAxis<double> parse_lengths(const std::string& text, const char* option, int dimension);
/// The stresses of --stress, as many as there are axes; ones for an empty text.
PerAxis<double> parse_stress(const std::string& text, int dimension = 2);

/// `--cell`: what moves of a periodic cell, "rectangular", "tilted", "isotropic" or "fixed"; empty: the periods, and
/// the tilt if the file has one.
struct CellStatement {
    std::string file, cell;
};
/// Lets the periods move as stated. Throws `Error(usage)` for
/// a statement about walls, or about a channel or a slab.
void take_cell(const CellStatement& statement, Packing& packing);

/// `--contacts` and `--contact-columns`: a file of pairs with forces and its columns, "I,J,FORCE". \p frame: number of
/// the frame in both files. Throws `Error(usage)`.
compare::SoftList stated_list(const std::string& file, const ForeignPacking& packing, const std::string& frame,
                              const std::string& contacts, const std::string& columns);

} // namespace isostat::cli
