#pragma once
/// \file
/// What can be proved of an exact packing: counting, self-stresses, mechanisms, rattlers, forces, stability.

#include <isostat/core/verdict.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/exact/kernel.hpp>
#include <isostat/rigidity/counting.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat::crafted {

/// Where a disk stands, by the positions of its contact normals alone (no counting of contacts): contacts that can
/// carry no force are removed until nothing changes. Disks that carry an external force are not judged (`loaded`).
/// - `held`: 0 is in the interior of the convex hull of the normals that are left;
/// - `bridge`: only two opposite normals are left: it can carry a force along one line and is free to first order
/// across it;
/// - `rattler`: no contact is left: no force >= 0 can be in equilibrium on it; - `fixed`, `loaded`.
enum class DiskHold { held, bridge, rattler, fixed, loaded };

/// What the load meets.
/// - `positive`: some equilibrium has every force > 0; - `with_zeros`: some equilibrium has every force >= 0, none has
/// all > 0;
/// - `none`: the load is balanced by forces of both signs only; - `unbalanced`: by no forces at all (not in the image
/// of H);
/// - `undecided`: the limits were reached; - `no_load`: the packing has none.
enum class Support { positive, with_zeros, none, unbalanced, undecided, no_load };

/// Second-order test of the mechanisms, the contacts taken as *bars* (kept at gap 0 both ways).
/// - `no_mechanism`: nothing to test; - `rigid`: a self-stress blocks every mechanism at second order (proved);
/// - `flexes`: some mechanism extends to second order (proved; says nothing of third order); - `undecided`.
/// As one-sided contacts a mechanism is never blocked: each gap opens by |tangential velocity|^2 / (2 (R_i + R_j)) >= 0
/// (see `stable`, T8).
enum class SecondOrder { no_mechanism, rigid, flexes, undecided };

const char* to_string(DiskHold hold);
const char* to_string(Support support);
const char* to_string(SecondOrder answer);
const char* to_string(exact::OneSign sign);

/// Whether a packing in a cell is jammed, of its disks that are not rattlers by the position of the normals
/// (proofs/cells.md, C12): `collective`: they cannot move in the fixed cell, but for a translation of all; `strict`:
/// nor together with the cell, without making its area larger. `undecided`: the limits were reached.
struct Jamming {
    int disks = 0;
    Verdict collective = Verdict::undecided;
    Verdict strict = Verdict::undecided;
};

struct InspectionLimits {
    exact::KernelLimits kernel{};
    long long programme_cells = 20000; ///< (rows + 1) * columns beyond which no system of inequalities is solved
};

/// All in exact arithmetic. N_f + h = N + k.
struct Inspection {
    int dof_count = 0;             ///< N_f
    std::vector<Contact> contacts; ///< N of them; every other gap was proved positive
    int rank = 0;                  ///< proved lower bound of the rank of H; the rank when `rank_exact` is proved
    Verdict rank_exact = Verdict::undecided;
    int hyperstaticity = 0; ///< h = N - rank: exact or an upper bound, as `rank`
    int mechanisms = 0;     ///< k = N_f - rank, common rigid motions included
    int rigid_motions = 0;  ///< of the whole packing: 3 for a free cluster, 0 in a box
    int generic_rank =
        0; ///< for the same contact graph with random coordinates: a proved lower bound of the generic rank
    /// The actual rank is below the generic one. `proved`; `refuted` when the actual rank is as high as the counts
    /// allow; `undecided` when both ranks agree below that (special with a chance of about N / 2^61 only). Generic
    /// coordinates need not be tangent disks.
    Verdict special_position = Verdict::undecided;

    /// Where every axis is periodic: the same counts for each way to strain the cell, whatever moves of this one, with
    /// every pair that touches as a contact.
    std::optional<StrainCounts> strains;
    std::optional<Jamming> jamming; ///< there too, of `inspect` (not `inspect_contacts`)

    Verdict bases_exact = Verdict::undecided;       ///< `proved`: the two bases are complete and verified in the field
    std::vector<std::vector<Number>> self_stresses; ///< h vectors of N forces (unit normals)
    std::vector<std::vector<Number>> motions;       ///< k vectors of N_f velocities (rigid motions included)

    std::vector<DiskHold> hold; ///< per disk
    std::vector<unsigned char>
        carrying; ///< per contact: 1 = not excluded from carrying a force >= 0 by the position of the normals
    bool one_sign_decided = false;
    exact::OneSignAnswer one_sign; ///< self-stresses of one sign

    Support support = Support::no_load;
    bool forces_unique = false; ///< h = 0 and the load is balanced
    std::vector<Number> forces; ///< one equilibrium (the only one when unique); may have both signs
    /// Disks that can move and carry no force of the load: rattlers by forces, where `hold` says rattlers by the
    /// position of the normals. Filled when the forces are unique and none is negative.
    std::vector<int> without_force;
    /// Per contact, when the forces are unique and generic coordinates balance the load too (else empty): 1 = the force
    /// is 0 here and, under the same load, for random coordinates of the same contact graph too (wrong with a chance of
    /// about N / 2^61). A force 0 without this mark is 0 by position: generic coordinates, proved, give it a value.
    std::vector<unsigned char> structural_zero;
    SecondOrder second_order = SecondOrder::undecided;
    /// Local minimum of the potential of the dead load, strict up to common rigid motions. `proved`: some equilibrium
    /// has all forces > 0 and there is no internal mechanism. `refuted`: no equilibrium with forces >= 0; or h = 0, and
    /// some mechanism opens at second order a contact that carries force (T8; a straight motion along a mechanism never
    /// overlaps and does no work). `undecided` otherwise, for instance with rattlers.
    Verdict stable = Verdict::undecided;

    /// Internal mechanisms: k minus the common rigid motions.
    [[nodiscard]] int internal_mechanisms() const { return mechanisms - rigid_motions; }
    /// "isostatic", "hyperstatic", "hypostatic" or "hyperstatic and hypostatic", from h and the internal mechanisms;
    /// "undecided" unless the rank is proved.
    [[nodiscard]] std::string verdict() const;
};

/// Failure `overlap` when the disks overlap. Cost: dense, 2^k sign choices of k roots, up to some 100 disks (limits);
/// beyond that rank and verdicts that need no kernel. \pre none: any walls, fixed disks, or neither
Result<Inspection> inspect(const ExactPacking& packing, const InspectionLimits& limits = {});

/// The same for a given contact list, whose gaps need not be 0: stored doubles (`exact_copy`), whose contacts are part
/// of the state. It speaks of the *stored* matrix, with columns (x_j - x_i) / (R_i + R_j) in place of unit normals (a
/// force differs from the true one by the factor 1 + gap / (R_i + R_j)), and says nothing of a true configuration near
/// it; gaps and overlaps are not looked at. Without a load, full rank costs one elimination; forces of generic 53-bit
/// coordinates have thousands of digits (some 10 s at 100 disks).
Inspection inspect_contacts(const ExactPacking& packing, const std::vector<Contact>& contacts,
                            const InspectionLimits& limits = {});

/// Lines for a terminal.
std::string to_text(const Inspection& inspection, const ExactPacking& packing);

/// One JSON object, format "isostat-inspection 1", keys named as those of `check_expected`; exact numbers as strings
/// that `Number::parse` reads, vectors as [name, number] pairs of their non-zero entries. `h`, `k` are upper bounds and
/// `rank` a lower one unless `rank_exact` is "proved".
std::string to_json(const Inspection& inspection, const ExactPacking& packing);

/// Compares with `[expected]`; one message per entry that does not hold, empty = all hold. Keys: N_f, N, rank, h, k,
/// rigid_motions, generic_rank, special, verdict, contacts = ["0-1", "0-left", ..], forces = [["0-1", "1/2"], ..] (any
/// subset; they must be unique), strains = [["isotropic", N_f, N, h, k], ..], rattlers = [3], bridges, without_force,
/// jammed_collectively, jammed_strictly, one_sign, support, second_order, stable.
/// Throws `Error(bad_input)` with file and line for an unknown key.
std::vector<std::string> check_expected(const Inspection& inspection, const PackingFile& file,
                                        const std::string& source);

} // namespace isostat::crafted
