#pragma once
/// \file
/// Claims about one state, each of them proved: what a certificate says; and what is known of a state without moving
/// it.

#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/counting.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// What is asked for.
struct CertifyOptions {
    /// The last arithmetic that is tried for a sign: `double_bound`, `double_double` or `multiprecision` (100 digits).
    Rung highest = Rung::multiprecision;
};

/// How many finite forces of contacts at the true vertex are proved to be what; bars and held coordinates do not count.
/// All 0 when no true vertex was found.
struct ForceSigns {
    int positive = 0;
    int structural_zero = 0; ///< exactly 0
    int negative = 0;
    int undecided = 0;
};

/// Claims, and what became of the others.
struct Certification {
    int dimension = 2; ///< of the grains
    CertificateClaims claims;
    /// `proved`: every claim is there, so the true vertex is an isostatic, stable equilibrium without overlap; or the
    /// one of a minimum is (`MinimumClaim`): an equilibrium that is stable and not isostatic.
    /// `refuted`: one of them is proved to be wrong (`refuted` says which). `undecided`: neither.
    Verdict verdict = Verdict::undecided;
    std::vector<std::string> refuted; ///< one sentence each; they are among `claims.undecided` too
    Counting counting;                ///< of the stored coordinates; `rank_exact` undecided: the rank is a lower bound
    ForceSigns signs;
    /// Finite forces at the true vertex, one per contact, as far as they are known, also where a sign is not proved;
    /// empty without a true vertex. 1 in `structural_zero`: exactly 0.
    std::vector<Interval> finite;
    std::vector<unsigned char> structural_zero;
    std::string potential;     ///< words: what has a strict local minimum where `claims.stable`
    double stored_gap = 0;     ///< largest |gap| of a contact at the stored coordinates, rounded up
    double smallest_sigma = 0; ///< proved lower bound of the smallest singular value of the contact matrix at the true
                               ///< vertex; 0: none
};

/// Of disks and of spheres: where a statement counts roundings or axes differently in space, its page says both
/// (proofs/status.md).
///
/// Proves what it can of `state` with its coordinates exactly as they are stored (they are not put on the grid):
/// 1. counting: exact rank of the contact matrix of the stored coordinates (T4; where the rank mod p is not full and
///    the matrix is small, a kernel checked in rationals);
/// 2. vertex: Newton-Kantorovich (T9, V4, V5) at the stored coordinates, or, when they are too far from a vertex for
///    that, at the end of a Newton iteration that starts there; the claims of radii are about the stored ones;
/// 3. the smallest singular value at the true vertex, from the same theorem (V5): its rank is N_f;
/// 4. forces at the true vertex (V6): finite ones, structural zeros by the pattern of all entries that a contact can
///    have (T11), their infinitesimal forces;
/// 5. gaps of all other pairs at the true vertex, complete by T5 and T6; pairs that cannot move relative to each other
///    must not overlap either (exactly), but do not count among the gaps claimed;
/// 6. ends of the supported interval at the true vertex (V7);
/// 7. stability (T8): forces positive in the lexicographic order, no mechanism; dead loads, or true stresses without
///    forces on disks (their potential: sum sigma_a ln L_a, S5).
/// Every sign is tried in double, then with a corrected vertex in double-double, then in MPFR; `rung` of a claim is the
/// arithmetic that proved it. States that are not isostatic, that hold coordinates, or whose true stresses act
/// together with forces on disks (no potential: no claim of stability) get the claims that can be made. Load, pattern,
/// pairs and point: proofs/definition.md. Lengths or
/// loads beyond 1e-100 and 1e100: no claim. Deterministic. Cost: a rank proof, two
/// factorisations, a candidate list and ten solves in the usual case; each climb adds some solves.
///
/// Clumps: bars are rows of either sign that never open; N_f, N and rank are counted without them. Coordinates may be
/// held where the load acts on none of them, by the pattern: k is their number, each is a free motion (a rattler, or a
/// body that turns about the one member through which it is held), and all claims speak of the place where they are
/// held; the minimum is strict but for these motions (proofs/clumps.md).
Certification certify(const State& state, const CertifyOptions& options = {});

/// Of a packing with bars: holds the coordinates that leave no mechanism, where the list has no held one and is short
/// of contacts (h = 0). Other states are returned as they are. Cost: a rank.
State with_free_motions_held(State state);

/// What is known of a state with mechanisms. Coordinates are held until the structure is isostatic (or already in the
/// state); when every force is positive and the multipliers of the held coordinates cannot be told from 0, the state is
/// an equilibrium *as far as the stored numbers say*, and `stable` tells what the potential does along the mechanism
/// (k = 1; statement T8).
/// How an equilibrium with mechanisms follows the loaded stress while its contacts stay as they are (proofs/clumps.md,
/// U10): it moves continuously towards the load.
struct Yielding {
    PerAxis<Enclosure> length_rate{}; ///< dL_a per unit of the loaded stress
    /// Where the stress rises, and where it falls: what happens first if forces and gaps went on changing at the rates
    /// that they have, in double. Not proved, and not where it will happen. Contact i = -1: nothing.
    struct Event {
        Contact contact{ContactKind::disk_disk, -1, -1};
        bool opens = false; ///< the force vanishes; else the gap closes
        double stress = 0;
    };
    Event up, down;
};

struct MechanismInspection {
    EquilibriumRecord record;                   ///< `record.verdict` is `refuted`: not isostatic
    std::vector<Contact> contacts;              ///< those of the state, then the held coordinates
    std::vector<double> forces;                 ///< f0, one per entry of `contacts`
    std::vector<unsigned char> structural_zero; ///< 1: f0 vanishes for every load on the walls
    std::vector<int> rattlers;                  ///< disks without a force-carrying contact
    /// refuted: the potential has a maximum along the mechanism, the equilibrium is not stable; proved: an equilibrium
    /// next to the stored place is a strict local minimum; undecided: not shown.
    Verdict stable = Verdict::undecided;
    Enclosure second_order; ///< d2W/ds2 along the mechanism (k = 1, dead loads), s = the fastest coordinate
    /// `stable` is proved: how far the minimum is from the stored configuration, at most, and a lower bound of d2W on
    /// the held coordinates (U8).
    double away = 0, curvature = 0;
    std::optional<Yielding> yielding; ///< where `stable` is proved
    std::string remark;               ///< when not an equilibrium: which contact and by how much
};
/// \pre h = 0 in `counting`, of this state. Failure: `not_isostatic` when the completed structure is not proved
/// regular, `undecided` when no bound of the inverse or no true vertex near the stored one was proved.
Result<MechanismInspection> inspect_mechanism(const State& state, const Counting& counting);

/// The answers of `certify` about the state as it is given, with the numbers that people ask for. With fewer contacts
/// than degrees of freedom (h = 0, k > 0), or with held coordinates, those of `inspect_mechanism`. Of clumps free
/// motions are to be held first (`with_free_motions_held`).
struct Inspection {
    Certification truth;
    Counting counting; ///< N_f, N, rank, h, k
    /// `record.verdict`: is it an isostatic equilibrium without overlap. Forces, ends of the interval: middles of the
    /// intervals of `truth`; `record.force_bound`: of every force; ends that are not decided are NaN. `min_gap`: lower
    /// bound, NaN when there is none. Not computed (0): `balance`, `virtual_power`.
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
/// `undecided` when no bound of the inverse or no true vertex near the given place was proved. Cost: as `certify`.
Result<Inspection> inspect_vertex(const State& state);

/// Finite forces at the true vertex of the state under the loaded stress `sigma` instead of its own, one per contact in
/// its order: enclosures from `certify`, structural zeros [0, 0]. Also beyond the supported interval, where some are
/// negative: then no equilibrium has them. Failure: `not_isostatic` when the counting is not proved, `undecided` when
/// no true vertex near the given place was. Cost: as `certify`.
Result<std::vector<Interval>> forces_at(State state, double sigma);

/// Of every packing whose grains, and cell or box, are within `within` of the stored coordinates (2-norm), with
/// whatever radii, in which the listed contacts all close: `proved`, each is jammed; `refuted`, each in which no other
/// pair touches is not (proofs/cells.md, C14). Whether there is such a packing is not asked: doubles alone do not tell.
struct JammedIfClosed {
    Verdict verdict = Verdict::undecided;
    int contacts = 0; ///< those of the list, without those of rattlers by coordination
    double within = 0;
};

/// Whether a packing is jammed, and the words why.
struct JammingAnswer {
    Verdict verdict = Verdict::undecided;
    std::string reason;
    std::optional<JammedIfClosed> if_closed = {}; ///< where `verdict` is undecided
};

/// Counts of the stored coordinates, in the order of `strains`; the rest speaks of the true vertex.
///
/// *Backbone*: disks and contacts with finite force, known where the forces are. Of it (proofs/cells.md, C6 and C7):
/// - locally jammed: no disk of it can move alone while the others stay;
/// - collectively jammed: no motion of its disks in the fixed cell keeps all gaps >= 0, but for translations of all;
/// - strictly jammed: no motion of its disks and of the cell with a volume that does not grow, but for the same.
/// `proved` and `refuted` need an equilibrium that is proved: positive forces are the self-stress that such proofs ask
/// for. Without one all are `undecided`, whatever the counts. Strictly, where every strain of the cell moves or closes
/// an own image: by the forces under an isotropic pressure. Own images that touch are counted in all rows, also those
/// between which nothing moves.
struct CellInspection {
    int dimension = 2;
    StrainCounts all;
    std::optional<StrainCounts> backbone; ///< none: the forces are not known
    int backbone_disks = 0;
    JammingAnswer local, collective, strict;
};

/// \pre every axis is periodic; `truth` is of this state. Cost: up to two ranks and a certificate.
CellInspection inspect_cell(const State& state, const Certification& truth);

} // namespace isostat
