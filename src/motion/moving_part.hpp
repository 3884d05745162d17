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

/// All grains, or only those that the mechanism at the start moves,
/// when as many contacts touch these as they have degrees of freedom.
class MovingPart {
  public:
    MovingPart(const ArcVertex& start, const ArcVertex& end, std::size_t slot, double start_uncertainty,
               double end_uncertainty);
    /// Bound of the distance between the true end vertex and the same vertex with the grains at rest at their places at
    /// the start (C11): 0 in a box.
    [[nodiscard]] static double shift_of_end(const ArcVertex& start, const ArcVertex& end);
    /// Empty, or the reason why the part cannot be certified.
    [[nodiscard]] const std::string& trouble() const { return trouble_; }
    [[nodiscard]] const KeptCurve& curve() const { return *curve_; }
    /// The vertex at an end; the free row is that of its own contact.
    [[nodiscard]] std::unique_ptr<ArcCentre> at_start(InverseBoundCache& cache) const;
    [[nodiscard]] std::unique_ptr<ArcCentre> at_end(InverseBoundCache& cache) const;
    /// The same place with the fastest coordinate there in the free row; `rate`, the rate of the old free row, becomes
    /// the sign of the rate of that coordinate.
    [[nodiscard]] std::unique_ptr<ArcCentre> with_fastest(const ArcCentre& vertex, double& rate,
                                                          InverseBoundCache& cache) const;
    /// A fresh centre with coordinate `held` in the free row.
    [[nodiscard]] std::unique_ptr<ArcCentre> centre(Packing packing, int held, InverseBoundCache& cache) const;
    [[nodiscard]] bool whole() const { return whole_; }
    /// The grains that move, if not all do: disks, then walls.
    [[nodiscard]] std::vector<int> grains() const;

    /// Candidates outside the kept contacts of which a grain moves; the opened contact is among them.
    [[nodiscard]] std::vector<Contact> watched(const CandidateList& list) const;
    /// Candidates outside the kept contacts, moving or not.
    [[nodiscard]] std::vector<Contact> all(const CandidateList& list) const;
    /// Whether the list is complete at every true point of the curve with |s| <= h on the piece.
    [[nodiscard]] bool complete(const CurvePiece& piece, double h, const CandidateList& list) const;

  private:
    [[nodiscard]] bool coordinate_moves(std::size_t coordinate) const;
    [[nodiscard]] bool moves(const Contact& contact) const;
    [[nodiscard]] std::vector<Contact> with_row(const Contact& row) const;
    bool restrict_to(const std::vector<unsigned char>& mechanism);
    void let_rest();
    [[nodiscard]] bool moves_pin_or_cell() const;
    void check_rest(double uncertainty);
    void bring_end_back();

    const ArcVertex& start_;
    const ArcVertex& end_;
    std::size_t slot_;
    bool whole_ = true;
    bool end_moved_ = false; ///< the end used here is not the stored one
    std::vector<unsigned char> disk_moves_;
    std::vector<unsigned char> wall_moves_; ///< walls that move, then coordinates of a cell
    Packing start_packing_;                 ///< grains at rest are marked fixed
    Packing end_packing_;
    std::unique_ptr<KeptCurve> curve_;
    std::string trouble_;
};

} // namespace isostat
