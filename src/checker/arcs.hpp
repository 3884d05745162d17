#pragma once
/// \file
/// Convex bodies bounded by arcs of circles (proofs/checker.md, K29): by integers, apart from what the prover has.

#include "checker/vertex.hpp"

#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

/// Which members of two bodies are nearest, at places in doubles.
class NearestArcs {
  public:
    /// The three must outlive it.
    NearestArcs(const Packing& packing, const std::vector<double>& q, const std::vector<double>& radius);
    /// Of the members of these bodies, or of a body and a wall, whose normal is in both sectors or so near that doubles
    /// do not tell: whether this pair has the largest gap, or one that doubles do not tell from it. True where no
    /// member is an arc. \pre no length is above 1
    [[nodiscard]] bool contains(const Contact& pair) const;

  private:
    struct Arc {
        int body = -1, before = -1, after = -1;
    };
    [[nodiscard]] bool may_face(int member, double x, double y) const;
    [[nodiscard]] double gap_if_facing(int i, int j) const;
    [[nodiscard]] double gap_if_facing(int i, int axis, double sign) const;
    [[nodiscard]] std::vector<int> members(int of) const;

    const Packing& packing_;
    const std::vector<double>& q_;
    const std::vector<double>& radius_;
    std::vector<Arc> arc_;
};

/// What stands in the way of taking the gaps of a list for those of bodies bounded by arcs, at every true vertex of the
/// evidence: arcs that are not tangent or not convex, a normal that is not inside its sectors, an enclosure that is too
/// wide. Empty: nothing, or there are no arcs.
std::string unfit_arcs(const Problem& problem, const State& state, const TrueVertex& vertex);

/// The distance of two bodies may be below the gap of their nearest members by this: 0 without arcs.
Rational arc_blur(const Packing& packing);

} // namespace isostat::checker
