#pragma once
/// \file
/// Packing files: TOML, every number exact.

#include <isostat/crafted/exact_packing.hpp>

#include <string>
#include <vector>

namespace isostat::crafted {

/// One entry of `[expected]`: an answer that the author of the file knows. `values` holds one text per element, row by
/// row for arrays of arrays.
struct ExpectedEntry {
    std::string key;
    std::vector<std::vector<std::string>> values;
    int line = 0;
};

/// A packing file. Format (version 1):
///
///     format = "isostat-packing 1"
///     title  = "two disks in a box"                # optional, also: source, note
///     disks  = [[1, 1, 1], ["1 + 2*sqrt(2)", 2, 2]]  # x, y, r; disks are numbered from 0
///
///     [[disk]]                                     # instead of or after `disks`
///     x = 0.5                                      # one half, exactly
///     y = "1/2*sqrt(3)"
///     r = "1/3"
///     fixed = true                                 # optional
///
///     [box]                                        # optional; without it there are no walls
///     length = ["3 + 2*sqrt(2)", 4]                # positions of the upper walls ("none" allowed when absent)
///     lower  = ["fixed", "fixed"]                  # or "absent"
///     upper  = ["movable", "movable"]              # or "fixed", "absent"
///
///     [load]                                       # optional
///     wall = [1, 1]                                # inward forces on the right and top wall
///     disk = [[0, 0, -1]]                          # disk, F_x, F_y
///
///     [expected]                                   # optional: see `check_expected`
///
/// A TOML float is read from its source text, so `0.1` is one tenth; strings take the form of `Number::parse`.
struct PackingFile {
    std::string title;
    ExactPacking packing;
    std::vector<ExpectedEntry> expected;
};

/// Throws `Error(bad_input)` with file, line, key, the value found and what was expected: syntax, unknown keys, missing
/// keys, wrong types, radii that are not positive, lengths that are not positive, forces on walls that cannot move.
/// Overlaps are found by `exact_contacts`, not here.
PackingFile parse_packing(const std::string& text, const std::string& source);

/// The same from a file. Throws `Error(bad_input)` when it cannot be read.
PackingFile read_packing(const std::string& path);

} // namespace isostat::crafted
