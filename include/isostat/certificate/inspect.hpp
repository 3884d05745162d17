#pragma once
/// \file
/// What is known of a state without moving it.

#include <isostat/certificate/certify.hpp>
#include <isostat/core/result.hpp>
#include <isostat/rigidity/counting.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// The answers of `certify` about the state as it is given, with the numbers that people ask for. With fewer contacts
/// than degrees of freedom (h = 0, k > 0), or with held coordinates, those of `inspect_mechanism`.
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
    std::vector<int> rattlers;                  ///< disks without a force-carrying contact
    bool equilibrium = false;                   ///< `record.verdict` is `proved`
    /// proved: strict local minimum of the potential of the load (isostatic equilibrium); refuted: it has a maximum
    /// along the mechanism; undecided: neither was shown.
    Verdict stable = Verdict::undecided;
    Enclosure second_order; ///< as in `MechanismInspection`
    std::string remark;     ///< when not an equilibrium: which contact and by how much
};

/// Failure: `not_isostatic` when h > 0, or when the rank is not proved (the message gives N_f, N, rank, h, k),
/// `undecided` when no bound of the inverse or no true vertex near the given place was proved. Cost: as `certify`.
Result<Inspection> inspect_vertex(const State& state);

/// Finite forces at the true vertex of the state under the loaded stress `sigma` instead of its own, one per contact in
/// its order: enclosures from `certify`, structural zeros [0, 0]. Also beyond the supported interval, where some are
/// negative: then no equilibrium has them. Failure: `not_isostatic` when the counting is not proved, `undecided` when
/// no true vertex near the given place was. Cost: as `certify`.
Result<std::vector<Interval>> forces_at(State state, double sigma);

/// Whether a packing is jammed, and the words why.
struct JammingAnswer {
    Verdict verdict = Verdict::undecided;
    std::string reason;
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

/// \pre every axis is periodic; `truth` is of this state. Cost: up to eight ranks and two certificates.
CellInspection inspect_cell(const State& state, const Certification& truth);

} // namespace isostat
