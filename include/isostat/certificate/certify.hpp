#pragma once
/// \file
/// What a certificate claims of one state, each claim proved;
/// and what `inspect` says of a state, which it never moves.

#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/counting.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// Options of `certify`.
struct CertifyOptions {
    /// The last arithmetic that is tried for a sign: `double_bound`, `double_double` or `multiprecision` (100 digits).
    Rung highest = Rung::multiprecision;
};

/// Numbers of finite forces of contacts at the true vertex by their proved sign; bars and held coordinates do not
/// count. All are 0 when no true vertex was found.
struct ForceSigns {
    int positive = 0;
    int structural_zero = 0; ///< exactly 0
    int negative = 0;
    int undecided = 0;
};

/// The claims that were proved, and why the other claims were not.
struct Certification {
    int dimension = 2; ///< of the grains
    CertificateClaims claims;
    /// `proved`: every claim is proved, so the true vertex is an isostatic, stable equilibrium without overlap; or the
    /// claim of a minimum is proved (`MinimumClaim`): an equilibrium that is stable and not isostatic. `refuted`: a
    /// claim is proved to be wrong (`refuted` says which). `undecided`: neither was shown.
    Verdict verdict = Verdict::undecided;
    std::vector<std::string> refuted; ///< one sentence each, which `claims.undecided` has too
    Counting counting;                ///< of the stored coordinates; `rank_exact` undecided: the rank is a lower bound
    ForceSigns signs;
    /// Finite forces at the true vertex, one per contact, as well as they are known, also where a sign is not proved;
    /// empty without a true vertex. 1 in `structural_zero`: this force is exactly 0.
    std::vector<Interval> finite;
    std::vector<unsigned char> structural_zero;
    std::string potential;     ///< in words: the potential that has a strict local minimum where `claims.stable`
    double stored_gap = 0;     ///< largest |gap| of a contact at the stored coordinates, rounded up
    double smallest_sigma = 0; ///< proved lower bound of the smallest singular value of
                               ///< the contact matrix at the true vertex; 0: no bound
};

/// For disks and for spheres. Where a statement counts roundings or axes differently in space, its page says so for
/// both dimensions (proofs/status.md).
///
/// Proves what can be proved of `state` with its coordinates exactly as they are stored (they are not put on the grid):
/// 1. counting: exact rank of the contact matrix of the stored coordinates (T4; where the rank mod p is not full and
///    the matrix is small, a kernel checked in rationals);
/// 2. vertex: Newton-Kantorovich (T9, V4, V5) at the stored coordinates, or, when these are too far from a vertex, at
/// the end of a Newton iteration from them; the claimed radii are distances from the stored coordinates;
/// 3. the smallest singular value at the true vertex, from the same theorem (V5): its rank is N_f;
/// 4. forces at the true vertex (V6): finite forces, structural zeros by the pattern of all entries that a contact can
/// have (T11), and the infinitesimal forces of these zeros;
/// 5. gaps of all other pairs at the true vertex, complete by T5 and T6; pairs that cannot move relative to each other
///    must not overlap either (exactly), but do not count among the gaps claimed;
/// 6. ends of the supported interval at the true vertex (V7);
/// 7. stability (T8): forces positive in the lexicographic order, no mechanism; dead loads, or true stresses without
///    forces on disks (their potential: sum sigma_a ln L_a, S5).
/// Every sign is tried in double, then with a corrected vertex in double-double, then in MPFR;
/// `rung` of a claim is the arithmetic that proved it. States that are not isostatic, that hold
/// coordinates, or whose true stresses act together with forces on disks (no potential: no claim of
/// stability) get the other claims. Load, pattern, pairs and point: proofs/definition.md. No claim
/// is made for lengths or loads beyond 1e-100 and 1e100. Deterministic. Cost: a rank proof, two
/// factorisations, a candidate list and ten solves in the usual case; each climb adds some solves.
///
/// Clumps: bars are rows of either sign that never open; N_f, N and rank are counted without them. Coordinates may be
/// held where the load acts on none of them, by the pattern: k is their number, each is a free motion (a rattler, or a
/// body that turns about the one member through which it is held), and all claims hold for the place where they are
/// held; the minimum is strict but for these motions (proofs/clumps.md).
///
/// `proved`: the structure as a run has proved it, which saves this proof, the factors and the bound of the inverse;
/// used where it is of this state, by the same proofs, so that the answer is the same without it.
Certification certify(const State& state, const CertifyOptions& options = {}, const ProvedStructure* proved = nullptr);

/// Holds coordinates of a packing with bars until no mechanism is left, when its list holds none and has too few
/// contacts (h = 0). Other states are returned unchanged. Cost: a rank.
State with_free_motions_held(State state);

/// How an equilibrium with mechanisms follows the loaded stress while its contacts stay as they are (proofs/clumps.md,
/// U10): it moves continuously towards the load.
struct Yielding {
    PerAxis<Enclosure> length_rate{}; ///< dL_a per unit of the loaded stress
    /// Eigenvalues of d2W at the minimum on the mechanisms that the load reaches (it is 0 on all others), ascending:
    /// bodies in (X, Y, angle), X and Y of the mean of the centres of their members, along periodic axes without the
    /// mean of all bodies, and lengths and tilt. Empty above 256 mechanisms, in space, and where no bound was proved.
    std::vector<Enclosure> second_variation;
    /// Where the stress rises, and where it falls: what happens first if forces, gaps and the least eigenvalue of d2W
    /// on the held coordinates went on changing at the rates that they have, in double. Not proved, and not where it
    /// will happen. Contact i = -1: none, and nothing unless the minimum flattens.
    struct Event {
        Contact contact{ContactKind::disk_disk, -1, -1};
        bool opens = false;    ///< the force vanishes; else the gap closes
        bool flattens = false; ///< d2W vanishes along a mechanism; looked at under dead loads
        double stress = 0;
    };
    Event up, down;
};

/// What is known of a state with mechanisms. Coordinates are held until the structure is isostatic (or the state holds
/// them already); when every force is positive and the multipliers of the held coordinates cannot be told from 0, the
/// state is an equilibrium *up to the rounding of the stored numbers*, and `stable` says what the potential does along
/// the mechanism (k = 1; statement T8).
struct MechanismInspection {
    EquilibriumRecord record;                   ///< `verdict` is `refuted`: not isostatic; `min_gap` as in `Inspection`
    std::vector<Contact> contacts;              ///< those of the state, then the held coordinates
    std::vector<double> forces;                 ///< f0, one per entry of `contacts`
    std::vector<unsigned char> structural_zero; ///< 1: f0 vanishes for every load on the walls
    std::vector<int> rattlers;                  ///< disks without a force-carrying contact
    /// refuted: the potential has a maximum along the mechanism, the equilibrium is not stable; proved: an equilibrium
    /// next to the stored place is a strict local minimum; undecided: not shown.
    Verdict stable = Verdict::undecided;
    /// d2W/ds2 along the mechanism (k = 1), s = the fastest coordinate; under true stresses of the area times Phi.
    Enclosure second_order;
    /// `stable` is proved: how far the minimum is from the stored configuration, at most, and a lower bound of d2W on
    /// the held coordinates (U8).
    double away = 0, curvature = 0;
    std::vector<Contact> held{};      ///< then: the coordinates of that form, as in `MinimumClaim`
    std::vector<Interval> form{};     ///< and the form
    std::optional<Yielding> yielding; ///< where `stable` is proved
    std::string remark;               ///< when not an equilibrium: which contact and by how much
};
/// \pre h = 0 in `counting`, of this state. Failure: `not_isostatic` when the completed structure is not proved
/// regular, `undecided` when no bound of the inverse or no true vertex near the stored one was proved.
Result<MechanismInspection> inspect_mechanism(const State& state, const Counting& counting);

/// What `certify` proves about the state as it is given, with the numbers that people ask for. With fewer contacts than
/// degrees of freedom (h = 0, k > 0), or with held coordinates, what `inspect_mechanism` finds. Free motions of clumps
/// have to be held before (`with_free_motions_held`).
struct Inspection {
    Certification truth;
    Counting counting; ///< N_f, N, rank, h, k
    /// `record.verdict`: whether the state is an isostatic equilibrium without overlap. Forces and ends of the interval
    /// are middles of the intervals of `truth`; `record.force_bound` bounds the error of every force; undecided ends
    /// are NaN. `min_gap`: lower bound, NaN without one. Not computed (0): `balance`, `virtual_power`.
    EquilibriumRecord record;
    std::vector<Contact> contacts;              ///< those of the state, then the held coordinates
    std::vector<double> forces;                 ///< f0, one per entry of `contacts`
    std::vector<unsigned char> structural_zero; ///< 1: f0 vanishes for every load on the walls
    std::vector<int> rattlers;                  ///< disks without a force-carrying contact; members of such bodies
    std::vector<int> rotational_rattlers;       ///< first members of bodies that bear forces at one member only
    bool equilibrium = false;                   ///< `record.verdict` is `proved`
    /// proved: strict local minimum of the potential of the load (isostatic equilibrium); refuted: it has a maximum
    /// along the mechanism; undecided: neither was shown.
    Verdict stable = Verdict::undecided;
    Enclosure second_order;           ///< as in `MechanismInspection`
    std::optional<Yielding> yielding; ///< as there
    std::string remark;               ///< when not an equilibrium: which contact and by how much
};

/// Failure: `not_isostatic` when h > 0, or when the rank is not proved (the message gives N_f, N, rank, h, k),
/// `undecided` when no bound of the inverse or no true vertex near the stored place was proved. Cost: as `certify`.
Result<Inspection> inspect_vertex(const State& state);

/// Finite forces at the true vertex of the state under the loaded stress `sigma` instead of its own, one per contact in
/// its order: enclosures from `certify`, structural zeros [0, 0]. Beyond the supported interval some forces are
/// negative: no equilibrium has such forces. Failure: `not_isostatic` when the counting is not proved, `undecided` when
/// no true vertex near the stored place was proved. Cost: as `certify`.
Result<std::vector<Interval>> forces_at(State state, double sigma);

/// A statement about every packing in which the listed contacts all close and whose grains, and cell or box, are within
/// `within` of the stored coordinates (2-norm), whatever its radii: `proved`: every such packing is jammed; `refuted`:
/// every one without further touching pairs is not (proofs/cells.md, C14). Whether such a packing exists stays open.
struct JammedIfClosed {
    Verdict verdict = Verdict::undecided;
    int contacts = 0; ///< of the list, without the contacts of rattlers by coordination
    double within = 0;
};

/// Whether a packing is jammed, and the reason in words.
struct JammingAnswer {
    Verdict verdict = Verdict::undecided;
    std::string reason;
    std::optional<JammedIfClosed> if_closed = {}; ///< when `verdict` is undecided
};

/// `counts` are of the stored coordinates, in the order of `strains`; the other members are of the true vertex.
///
/// *Backbone*: disks and contacts with finite force, when the forces are known. On it (proofs/cells.md, C6 and C7):
/// - locally jammed: no disk of the backbone can move alone while the others stay;
/// - collectively jammed: no motion of its disks in the fixed cell keeps all gaps >= 0, except translations of all;
/// - strictly jammed: no motion of its disks and of the cell with a volume that does not grow, with the same exception.
/// `proved` and `refuted` need a proved equilibrium, because its positive forces are the self-stress in such proofs.
/// Without one all three are `undecided`, whatever the counts. Strict jamming is decided, where every strain of the
/// cell moves or closes an own image, by the forces under an isotropic pressure. Touching own images count in all rows,
/// also in rows where nothing moves between them.
struct CellInspection {
    int dimension = 2;
    StrainCounts all;
    std::optional<StrainCounts> backbone; ///< absent when the forces are not known
    int backbone_disks = 0;
    JammingAnswer local, collective, strict;
};

/// \pre every axis is periodic; `truth` is of this state. Cost: up to two ranks and a certificate.
CellInspection inspect_cell(const State& state, const Certification& truth);

} // namespace isostat
