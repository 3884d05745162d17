#pragma once
/// \file
/// Packings whose coordinates are exact numbers, their contacts and their contact matrix; and their files: TOML, every
/// number exact.

#include <isostat/contact/contact.hpp>
#include <isostat/core/result.hpp>
#include <isostat/exact/kernel.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/packing/packing.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace isostat::crafted {

using exact::Number;

/// Dead external forces, exact.
struct ExactLoad {
    /// Inward force on the upper wall of each axis, or on its period (0 unless it moves).
    std::array<Number, 2> wall{};
    std::vector<Number> disk{}; ///< empty, or 2 n components
    Number tilt{};              ///< as `wall`, on the tilt: positive, it makes the tilt smaller (`Load::shear`)
};

/// Disks, walls, cell and coordinates as in `Packing`, with exact numbers. Lengths in the user's unit.
struct ExactPacking {
    std::vector<Number> radius;
    std::vector<std::array<Number, 2>> centre;
    std::vector<unsigned char> fixed; ///< empty, or n flags
    Walls walls = Walls::none();
    Cell cell;
    std::array<Number, 2> length{}; ///< positions of the upper walls that exist, and periods
    Number tilt;                    ///< A_xy of a cell
    std::optional<ExactLoad> load;

    [[nodiscard]] int disk_count() const { return static_cast<int>(radius.size()); }
    [[nodiscard]] Layout layout() const { return {plane, disk_count()}; }
    /// What stands at a coordinate index of `Packing`.
    [[nodiscard]] const Number& coordinate(std::size_t k) const {
        const std::size_t lengths = 2 * centre.size();
        return k < lengths ? centre[k / 2][k % 2] : (k < lengths + 2 ? length[k - lengths] : tilt);
    }
    [[nodiscard]] bool is_fixed(int disk) const { return !fixed.empty() && fixed[static_cast<std::size_t>(disk)] != 0; }
};

/// The stored doubles as exact (dyadic) numbers.
ExactPacking exact_copy(const Packing& packing);

/// Nearest doubles: for pictures and for `DofMap`. Proves nothing.
Packing approximate(const ExactPacking& packing);

/// Every pair at gap exactly 0, sorted. The sign of each gap is decided: that of |x_j - x_i|^2 - (R_i + R_j)^2, in
/// the field. Pairs without a degree of freedom (two fixed
/// disks, a fixed disk and a fixed wall, a disk and its own image in a cell that does not move) may touch without being
/// contacts, but not overlap (proofs/definition.md). `overlap` names the first overlapping pair with its
/// squared-distance defect. In a cell: pairs with every image (proofs/cells.md, C3). Pairs are those that the grid
/// finds in the rounded packing; throws `Error(bad_input)` where it does. Cost: O(n) pairs for a compact packing.
Result<std::vector<Contact>> exact_contacts(const ExactPacking& packing);

/// The contact matrix H in the field, rows = degrees of freedom, unit normals: at a contact the distance of the centres
/// is R_i + R_j, so the normal needs no root. H f = F_ext as in `contact_matrix`. \pre contacts come from
/// `exact_contacts`
exact::NumberMatrix exact_contact_matrix(const ExactPacking& packing, const DofMap& dofs,
                                         const std::vector<Contact>& contacts);

/// External force on the degrees of freedom. \pre packing.load
std::vector<Number> external_force(const ExactPacking& packing, const DofMap& dofs);

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
///     [cell]                                       # optional: axes that repeat; along the others [box] has walls
///     period = [2, "sqrt(3)"]                      # "none" along an axis that does not repeat
///     tilt   = 1                                   # optional, 0: x of the second period
///     moves  = ["x", "y", "xy"]                    # the periods and the tilt that are degrees of freedom
///     pin    = 0                                   # optional: the disk that stays where it is
///
///     [load]                                       # optional
///     wall = [1, 1]                                # inward forces on the right and top wall, or on the periods
///     tilt = "1/2"                                 # the same on the tilt
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
/// keys, wrong types, radii that are not positive, lengths that are not positive, forces on walls that cannot move,
/// disks wider than a period or far outside the cell. Overlaps are found by `exact_contacts`, not here.
PackingFile parse_packing(const std::string& text, const std::string& source);

/// The same from a file. Throws `Error(bad_input)` when it cannot be read.
PackingFile read_packing(const std::string& path);

} // namespace isostat::crafted
