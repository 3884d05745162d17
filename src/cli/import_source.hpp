#pragma once
/// \file
/// `isostat import`: from a file to a state.

#include "cli/commands.hpp"
#include "cli/read_packing.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <string>
#include <vector>

namespace isostat::cli {

/// What was found, or why nothing was.
struct Imported {
    State<2> state;
    std::vector<double> from; ///< coordinates of the file
    std::string contacts;     ///< words
    Certification truth;
};

/// The file is refused: bad input.
[[noreturn]] void refuse(const std::string& file, const std::string& what);

/// Stresses and kind of load of a state, which were not stated anew.
void keep_load(ImportArguments& a);

/// The vertex downhill of a packing of another program.
Result<Imported> from_foreign(const ImportArguments& a, ReadPacking& file);

/// A crafted packing as it is: exact contacts, doubles next to its numbers, its load.
Result<Imported> from_crafted(const ImportArguments& a, const std::string& text);

} // namespace isostat::cli
