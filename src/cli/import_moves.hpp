#pragma once
/// \file
/// `isostat import`: how far the grains moved.

#include "cli/import_source.hpp"

#include <string>
#include <vector>

namespace isostat::cli {

/// How far the true vertex may be from a place in the file: per disk, and at most for walls, backbone and rattlers.
struct Moves {
    std::vector<double> disk;
    std::vector<unsigned char> rattler;
    double walls = 0, backbone = 0, rattlers = 0;
};

Moves moves_of(const Imported& found);

/// A table with a row for each disk.
std::string moves_csv(const Imported& found, const Moves& moves);

} // namespace isostat::cli
