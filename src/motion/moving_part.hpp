#pragma once
/// \file
/// The grains that move during an arc and their equations: private to the room (statement A7, proofs/arcs.md).

#include "contact/candidates.hpp"
#include "motion/arc_centre.hpp"
#include "motion/certify_arc.hpp"
#include "motion/curve_piece.hpp"

#include <memory>
#include <string>

namespace isostat {

/// All grains, or the few that the mechanism at the start moves when the contacts that touch them are as many as their
/// degrees of freedom.
class MovingPart {
  public:
    MovingPart(const ArcVertex& start, const ArcVertex& end, std::size_t slot, double start_uncertainty,
               double end_uncertainty);
    /// How much farther the true end vertex may be from the stored one when what does not move stands where it does at
    /// the start (C11): 0 in a box.
    [[nodiscard]] static double shift_of_end(const ArcVertex& start, const ArcVertex& end);
    /// Empty, or why the part cannot be certified.
    [[nodiscard]] const std::string& trouble() const { return trouble_; }
    [[nodiscard]] const KeptCurve& curve() const { return *curve_; }
    /// The vertex at an end, with its own contact in the free row.
    [[nodiscard]] std::unique_ptr<ArcCentre> at_start(InverseBoundCache& cache) const;
    [[nodiscard]] std::unique_ptr<ArcCentre> at_end(InverseBoundCache& cache) const;
    /// The same place with the coordinate that is fastest there in the free row, `rate` (of the present free row) made
    /// the sign of that coordinate's rate.
    [[nodiscard]] std::unique_ptr<ArcCentre> with_fastest(const ArcCentre& vertex, double& rate,
                                                          InverseBoundCache& cache) const;
    /// Fresh centre with coordinate `held` in the free row.
    [[nodiscard]] std::unique_ptr<ArcCentre> centre(Packing packing, int held, InverseBoundCache& cache) const;
    [[nodiscard]] bool whole() const { return whole_; }
    /// The grains that move, when they are not all: disks, then walls.
    [[nodiscard]] std::vector<int> grains() const;

    /// Candidates with a grain that moves and that are not kept; the opened contact is among them.
    [[nodiscard]] std::vector<Contact> watched(const CandidateList& list) const;
    /// Candidates that are not kept, moving or not.
    [[nodiscard]] std::vector<Contact> all(const CandidateList& list) const;
    /// Whether the list is complete at every true point of the curve with |s| <= h on the piece.
    [[nodiscard]] bool complete(const CurvePiece& piece, double h, const CandidateList& list) const;

  private:
    [[nodiscard]] bool coordinate_moves(std::size_t coordinate) const;
    [[nodiscard]] bool moves(const Contact& contact) const;
    [[nodiscard]] std::vector<Contact> with_row(const Contact& row) const;
    bool restrict_to(const std::vector<double>& mechanism);
    void let_rest();
    [[nodiscard]] bool moves_pin_or_cell() const;
    void check_rest(double uncertainty);
    void bring_end_back();

    const ArcVertex& start_;
    const ArcVertex& end_;
    std::size_t slot_;
    bool whole_ = true;
    bool end_moved_ = false; ///< the end is not stored as it is taken
    std::vector<unsigned char> disk_moves_;
    std::vector<unsigned char> wall_moves_; ///< and the coordinates of a cell
    Packing start_packing_;                 ///< grains at rest are marked fixed
    Packing end_packing_;
    std::unique_ptr<KeptCurve> curve_;
    std::string trouble_;
};

} // namespace isostat
