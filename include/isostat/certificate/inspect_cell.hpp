#pragma once
/// \file
/// What the field asks of a periodic packing: counts for every way to strain the cell, and what they prove of jamming.

#include <isostat/certificate/certify.hpp>
#include <isostat/rigidity/cell_counting.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// An answer, and the words why.
struct Answer {
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
/// for. Without one all are `undecided`, whatever the counts. Strictly, where every strain of the cell moves: by the
/// forces under an isotropic pressure, which are known when the tilt bears no shear stress.
struct CellInspection {
    StrainCounts all;
    std::optional<StrainCounts> backbone; ///< none: the forces are not known
    int backbone_disks = 0;
    Answer local, collective, strict;
};

/// \pre every axis is periodic; `truth` is of this state. Cost: up to eight ranks.
template <int Dim> CellInspection inspect_cell(const State<Dim>& state, const Certification& truth);

extern template CellInspection inspect_cell<2>(const State<2>&, const Certification&);

} // namespace isostat
