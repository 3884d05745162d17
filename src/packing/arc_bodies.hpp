#pragma once
/// \file
/// Convex bodies bounded by arcs of circles (proofs/clumps.md, U9): which members of two bodies are nearest.

#include <isostat/packing/packing.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// The sectors of a packing's arcs at its coordinates. A joint is the direction of the outward normal where two arcs
/// meet, from the centre of the larger circle to that of the smaller one; an arc reaches from one joint to the next.
class ArcBodies {
  public:
    explicit ArcBodies(const Packing& packing);
    [[nodiscard]] bool any() const { return !packing_.arcs.empty(); }

    /// Of all pairs of members of these two bodies whose normal is in the sectors of both (to `slack`) the one with the
    /// largest gap, which is the distance of the bodies; of a body and a wall the arc that is nearest. True of a pair
    /// of single grains. Members that are not nearest may overlap. Cost: the product of the numbers of arcs.
    [[nodiscard]] bool is_nearest(const Contact& pair) const;

    /// That the normal of a contact is inside the sectors of both members, wherever the centres are within `moved`
    /// (2-norm) of the packing's.
    [[nodiscard]] bool faces(const Contact& contact, double moved) const;

    /// Displacements up to this length change the distance of two bodies by less than twice as much (U9).
    [[nodiscard]] double farthest() const { return farthest_; }
    /// Where the packing is known to this length, no pair is taken for the nearest one but that which is, or one whose
    /// gap differs by less than what `below` leaves open. 0 where the arcs of a body are no convex curve at these
    /// coordinates, which need not be those of a file.
    [[nodiscard]] double known_to() const { return known_to_; }
    /// The distance of two bodies is not below this, where the gap of their nearest members is not below `gap`: sectors
    /// are known to `slack`. Without arcs `gap` itself.
    [[nodiscard]] double below(double gap) const;
    /// The sector of a member as two angles, the first in [-pi, pi], the second above it; nothing: a full circle.
    [[nodiscard]] std::optional<std::array<double, 2>> angles(int member) const;
    /// By how much the arcs of a body turn, all together; each of them is to be narrower than pi.
    struct Turn {
        double together = 0;
        bool convex = true;
        [[nodiscard]] bool is_once() const;
    };
    [[nodiscard]] Turn turn(const std::vector<int>& ring) const;

  private:
    struct Vector {
        double x, y;
    };
    struct Neighbours {
        int before = -1, after = -1; ///< in the order of the arcs; -1: a full circle
        std::size_t body = 0;
    };
    [[nodiscard]] Vector between(int from, int to) const;
    [[nodiscard]] Vector joint(int one, int other) const;
    [[nodiscard]] Vector normal(const Contact& contact) const;
    [[nodiscard]] double inside(int member, Vector n, double moved) const;
    [[nodiscard]] double inside(const Contact& contact, double moved) const;
    [[nodiscard]] std::vector<int> shape(int member) const;
    [[nodiscard]] double gap(const Contact& pair) const;

    const Packing& packing_;
    std::vector<Neighbours> neighbours_;
    double farthest_ = 0;
    double known_to_ = 0;
    double blur_ = 0;
};

/// Throws `Error(bad_input)` naming the body: arcs are of at least four members of one body, each in one list, that
/// close to a convex curve, with bars between neighbours whose length is the difference of the radii.
void validate_arcs(const Packing& packing, const std::string& source);

/// Throws `Error(bad_input)` when there are bodies bounded by arcs, which `what` does not take.
void require_no_arcs(const Packing& packing, const std::string& source, const std::string& what);

} // namespace isostat
