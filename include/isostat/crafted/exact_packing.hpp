#pragma once
/// \file
/// Packings whose coordinates are exact numbers, their contacts, contact matrix and files (TOML, every number exact);
/// and what is proved of such packings: counting, self-stresses, mechanisms, rattlers, forces, stability.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/packing/load.hpp>
#include <isostat/rigidity/counting.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat::crafted {

using exact::Number;

/// Dead external forces, exact.
struct ExactLoad {
    /// Inward force on the upper wall of each axis, or on its period (0 unless the wall or period moves).
    PerAxis<Number> wall{};
    std::vector<Number> disk{}; ///< empty, or d n components
    PerTilt<Number> tilt{};     ///< as `wall`, on the tilts: positive, it makes the tilt smaller (`Load::shear`)
};

/// Disks or spheres, walls, cell and coordinates as in `Packing`, with exact numbers. Lengths are in the user's unit.
/// The dimension is that of the cell.
struct ExactPacking {
    std::vector<Number> radius;
    std::vector<PerAxis<Number>> centre;
    std::vector<unsigned char> fixed; ///< empty, or n flags
    std::vector<Bar> bars;            ///< as in `Packing`; here each length is the distance of the two centres
    Walls walls = Walls::none();
    Cell cell;
    PerAxis<Number> length{}; ///< positions of the upper walls that exist, and periods
    PerTilt<Number> tilt{};   ///< A_xy, A_xz, A_yz of a cell
    std::optional<ExactLoad> load;

    [[nodiscard]] int disk_count() const { return static_cast<int>(radius.size()); }
    [[nodiscard]] int dimension() const { return cell.dimension; }
    [[nodiscard]] std::size_t axes() const { return layout().axes(); }
    [[nodiscard]] Layout layout() const { return {cell.dimension, disk_count()}; }
    /// The coordinate with an index of `Packing::q`.
    [[nodiscard]] const Number& coordinate(std::size_t k) const {
        const std::size_t d = axes(), lengths = d * centre.size();
        return k < lengths ? centre[k / d][k % d] : k < lengths + d ? length[k - lengths] : tilt[k - lengths - d];
    }
    [[nodiscard]] bool is_fixed(int disk) const { return !fixed.empty() && fixed[static_cast<std::size_t>(disk)] != 0; }
};

/// The stored doubles as exact (dyadic) numbers.
ExactPacking exact_copy(const Packing& packing);

/// Nearest doubles, for pictures and for `DofMap`. Nothing is proved of them.
Packing approximate(const ExactPacking& packing);

/// Every pair at gap exactly 0, sorted. The sign of each gap is decided as that of |x_j - x_i|^2 -
/// (R_i + R_j)^2, in the field. Pairs without a degree of freedom (two fixed disks, a fixed disk
/// and a fixed wall, a disk and its own image in a cell that does not move) may touch without
/// being contacts, but not overlap (proofs/definition.md). `overlap` names the first overlapping
/// pair with its squared-distance defect. In a cell: pairs with every image (proofs/cells.md, C3).
/// Pairs come from the grid of the rounded packing; throws `Error(bad_input)` where the grid
/// throws. The bars come behind the contacts. Cost: O(n) pairs for a compact packing.
Result<std::vector<Contact>> exact_contacts(const ExactPacking& packing);

/// r = x_j - x_i + A m. \pre two disks
PerAxis<Number> exact_separation(const ExactPacking& packing, const Contact& pair);

/// The contact matrix H in the field, rows = degrees of freedom, unit normals: at a
/// contact the distance of the centres is R_i + R_j, so the normal needs no root.
/// The column of a bar has x_j - x_i instead, so its force is divided by its length.
/// H f = F_ext as in `contact_matrix`. \pre contacts come from `exact_contacts`
exact::NumberMatrix exact_contact_matrix(const ExactPacking& packing, const DofMap& dofs,
                                         const std::vector<Contact>& contacts);

/// What x_j - x_i is divided by in the column of a pair of disks: R_i + R_j, for a bar 1.
Number scale_of_row(const ExactPacking& packing, const Contact& pair);

/// Counts with the radii as further coordinates: a row for each grain, 1 in its contacts (2 with its own image).
Counting count_with_radii(const ExactPacking& packing, const std::vector<Contact>& contacts);

/// External force on the degrees of freedom. \pre packing.load
std::vector<Number> external_force(const ExactPacking& packing, const DofMap& dofs);

/// One entry of `[expected]`: a property that the author of the file knows. `values` holds one text per element, row by
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
///     bodies = [[0, 1], [2, 3, 5]]                 # optional (above tables): members of rigid bodies, which may
///     overlap
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
/// Spheres: `spheres` with rows x, y, z, r and [[sphere]] with a z in place of `disks` and [[disk]]; then everything
/// per axis has three entries, `tilt` three in the order xy, xz, yz, `moves` those names, and [load] `sphere` in place
/// of `disk`. A TOML float is read from its source text, so `0.1` is one tenth; strings
/// take the form of `Number::parse`.
struct PackingFile {
    std::string title;
    ExactPacking packing;
    std::vector<ExpectedEntry> expected;
};

/// Throws `Error(bad_input)` with file, line, key, the value found and what was expected: syntax, unknown keys, missing
/// keys, wrong types, radii that are not positive, lengths that are not positive, forces on walls that cannot move,
/// disks wider than a period or far outside the cell. Overlaps are found by `exact_contacts`, not here.
PackingFile parse_packing(const std::string& text, const std::string& source);

/// As `parse_packing`, from a file. Throws `Error(bad_input)` when the file cannot be read.
PackingFile read_packing(const std::string& path);

/// How the positions of its contact normals hold a grain (no counting of contacts): contacts that can carry no force
/// are removed until nothing changes. Disks that carry an external force are not judged (`loaded`).
/// - `held`: 0 is in the interior of the convex hull of the normals that are left;
/// - `bridge`: 0 is inside the hull of the normals that are left, which do not span the space: two opposite normals, in
///   space also some in a plane. The grain can carry forces along these normals and is free to first order across;
/// - `rattler`: no contact is left: no force >= 0 can be in equilibrium on it; - `fixed`, `loaded`; - `member`: of a
///   body, not judged.
enum class DiskHold { held, bridge, rattler, fixed, loaded, member };

/// Which forces balance the load.
/// - `positive`: some equilibrium has every force > 0; - `with_zeros`: some equilibrium has every force >= 0, none has
/// all > 0;
/// - `none`: the load is balanced by forces of both signs only; - `unbalanced`: by no forces at all (not in the image
/// of H);
/// - `undecided`: the limits were reached; - `no_load`: the packing has none.
enum class Support { positive, with_zeros, none, unbalanced, undecided, no_load };

/// Second-order test of the mechanisms, the contacts taken as *bars* (kept at gap 0 both ways).
/// - `no_mechanism`: none to test; - `rigid`: a self-stress blocks every mechanism at second order (proved);
/// - `flexes`: some mechanism extends to second order (proved; says nothing of third order); - `undecided`.
/// Gaps of one-sided contacts never block a mechanism: each opens by
/// |tangential velocity|^2 / (2 (R_i + R_j)) >= 0 (see `stable`, T8).
enum class SecondOrder { no_mechanism, rigid, flexes, undecided };

const char* to_string(DiskHold hold);
const char* to_string(Support support);
const char* to_string(SecondOrder answer);
const char* to_string(exact::OneSign sign);

/// Whether a packing in a cell, or in walls none of which moves, is jammed, judged on its disks
/// that are not rattlers by the position of the normals (proofs/cells.md, C12): `collective`:
/// these disks cannot move in the fixed cell, except for a translation of all; `strict`: nor
/// together with the cell, without making its area larger. `undecided`: the limits were reached.
struct Jamming {
    int disks = 0;
    Verdict collective = Verdict::undecided;
    std::optional<Verdict> strict; ///< only in a cell
};

/// Inward forces on one wall, period or tilt, the rest of the load unchanged, that some forces >= 0 balance.
struct LoadRange {
    int dof = 0;                                      ///< of the wall, period or tilt
    std::optional<Number> least, most;                ///< absent: this end is infinite
    std::vector<int> zero_at_least{}, zero_at_most{}; ///< contacts whose force vanishes at this end, where it is unique
};

struct InspectionLimits {
    exact::KernelLimits kernel{};
    long long programme_cells = 20000; ///< (rows + 1) * columns beyond which no system of inequalities is solved
};

/// All numbers are exact. N_f + h = N + k. For clumps N_f, N and all ranks are
/// those of rigid bodies (proofs/clumps.md, U1): bars do not count. Forces and
/// self-stresses have the entries of bars, of any sign, behind those of contacts.
struct Inspection {
    int dof_count = 0;             ///< N_f
    std::vector<Contact> contacts; ///< N of them, then the bars; every other gap was proved positive
    int rank = 0;                  ///< proved lower bound of the rank of H; the rank when `rank_exact` is proved
    Verdict rank_exact = Verdict::undecided;
    int hyperstaticity = 0; ///< h = N - rank: exact or an upper bound, as `rank`
    int mechanisms = 0;     ///< k = N_f - rank, common rigid motions included
    int rigid_motions = 0;  ///< of the whole packing: of a free cluster 3, of spheres 6; 0 in a box
    /// Counts with the radii as coordinates that move: N_f + n and so on. Where its rank is N, a small change of the
    /// radii can change every gap by itself; of spheres it may be lower, as T7 (a) is a theorem of the plane.
    Counting with_radii;
    int generic_rank =
        0; ///< for the same contact graph with random coordinates: a proved lower bound of the generic rank
    /// The actual rank is below the generic one. `proved`; `refuted` when the actual rank is as high as the counts
    /// allow; `undecided` when both ranks agree below that (special with a chance of about N / 2^61 only). Generic
    /// coordinates need not be tangent disks.
    Verdict special_position = Verdict::undecided;

    /// Where every axis is periodic: the same counts for each way to strain the cell, whatever moves of this one, with
    /// every pair that touches as a contact.
    std::optional<StrainCounts> strains;
    std::optional<Jamming> jamming; ///< of `inspect` alone, where every axis is periodic, without bars

    Verdict bases_exact = Verdict::undecided;       ///< `proved`: the two bases are complete and verified in the field
    std::vector<std::vector<Number>> self_stresses; ///< h vectors of N forces (unit normals)
    std::vector<std::vector<Number>> motions;       ///< k vectors of N_f velocities (rigid motions included)

    std::vector<DiskHold> hold; ///< per disk
    std::vector<unsigned char>
        carrying; ///< per contact: 1 = not excluded from carrying a force >= 0 by the position of the normals
    bool one_sign_decided = false;
    exact::OneSignAnswer one_sign; ///< whether some self-stress has only one sign

    std::vector<LoadRange> ranges; ///< of the lengths and tilts that move, where a change of their force is balanced
    Support support = Support::no_load;
    bool forces_unique = false; ///< h = 0 and the load is balanced
    std::vector<Number> forces; ///< one equilibrium (the only one when unique); may have both signs
    /// Disks that can move and carry no force of the load: rattlers by forces, where `hold` says rattlers by the
    /// position of the normals. Filled when the forces are unique and none is negative.
    std::vector<int> without_force;
    /// Per contact, when the forces are unique and generic coordinates balance the load too (else empty): 1 = the force
    /// is 0 here and, under the same load, at random coordinates of the same contact graph (wrong with a chance of
    /// about N / 2^61). A force 0 without this mark is 0 by position: it is proved not to be 0 generically.
    std::vector<unsigned char> structural_zero;
    SecondOrder second_order = SecondOrder::undecided;
    /// Local minimum of the potential of the dead load, strict up to common rigid motions. `proved`: some equilibrium
    /// has all forces > 0 and there is no internal mechanism. `refuted`: no equilibrium with forces >= 0; or h = 0, and
    /// some mechanism opens at second order a contact that carries force (T8; a straight motion along a mechanism never
    /// overlaps and does no work). `undecided` otherwise, for instance with rattlers; of clumps nothing is refuted
    /// where h > 0, as a straight motion changes bars.
    Verdict stable = Verdict::undecided;

    /// N, which counts no bars.
    [[nodiscard]] int contact_count() const { return static_cast<int>(contacts.size()) - bar_count(contacts); }
    /// Internal mechanisms: k minus the common rigid motions.
    [[nodiscard]] int internal_mechanisms() const { return mechanisms - rigid_motions; }
    /// "isostatic", "hyperstatic", "hypostatic" or "hyperstatic and hypostatic", from h and the internal mechanisms;
    /// "undecided" unless the rank is proved.
    [[nodiscard]] std::string verdict() const;
};

/// Failure `overlap` when the disks overlap. Cost: dense, 2^k sign choices of k roots, up to some 100 disks (limits);
/// beyond that rank and verdicts that need no kernel. \pre none: any walls, fixed disks, or neither
Result<Inspection> inspect(const ExactPacking& packing, const InspectionLimits& limits = {});

/// As `inspect`; an `Error` begins with the name of the file.
Result<Inspection> inspect_file(const PackingFile& file, const std::string& source);

/// The same for a given contact list whose gaps need not be 0: stored doubles (`exact_copy`), whose contacts are part
/// of the state. All results are about the *stored* matrix, with columns (x_j - x_i) / (R_i + R_j) in place of unit
/// normals (a force differs from the true one by the factor 1 + gap / (R_i + R_j)), not about a true configuration
/// nearby; gaps and overlaps are not checked. Without a load, full rank costs one elimination; forces of generic 53-bit
/// coordinates have thousands of digits (some 10 s at 100 disks).
Inspection inspect_contacts(const ExactPacking& packing, const std::vector<Contact>& contacts,
                            const InspectionLimits& limits = {});

/// The inspection as lines for a terminal.
std::string to_text(const Inspection& inspection, const ExactPacking& packing);

/// One JSON object, format "isostat-inspection 1", keys named as those of `check_expected`; exact numbers as strings
/// that `Number::parse` reads, vectors as [name, number] pairs of their non-zero entries. `h`, `k` are upper bounds and
/// `rank` a lower one unless `rank_exact` is "proved".
std::string to_json(const Inspection& inspection, const ExactPacking& packing);

/// Compares with `[expected]`; one message per entry that does not hold, empty = all hold. Keys: N_f, N, rank, h, k,
/// rigid_motions, generic_rank, special, verdict, contacts = ["0-1", "0-left", ..], forces = [["0-1", "1/2"], ..] (any
/// subset; they must be unique), strains = [["isotropic", N_f, N, h, k], ..], rattlers = [3], bridges, without_force,
/// jammed_collectively, jammed_strictly, one_sign, support, second_order, stable, rank_with_radii, ranges = [["top
/// wall", least, most], ..] (any subset; "none": no end). Throws `Error(bad_input)` with
/// file and line for an unknown key.
std::vector<std::string> check_expected(const Inspection& inspection, const PackingFile& file,
                                        const std::string& source);

} // namespace isostat::crafted
