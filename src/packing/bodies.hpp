#pragma once
/// \file
/// Rigid bodies of several disks: what the bars of a packing connect.

#include <isostat/core/contact.hpp>
#include <isostat/packing/packing.hpp>

#include <span>
#include <string>
#include <vector>

namespace isostat {

/// Which disks are members of one body. Without bars every disk is one. Cost: linear in disks and bars.
class Bodies {
  public:
    explicit Bodies(const Packing& packing);
    /// The first member of the body of a disk, which stands for the body.
    [[nodiscard]] int of(int disk) const { return first_[static_cast<std::size_t>(disk)]; }
    /// How many there are, single disks among them.
    [[nodiscard]] int count() const { return static_cast<int>(members(1).size()); }
    /// Those of more than one member, or of as many as that, each ascending.
    [[nodiscard]] std::vector<std::vector<int>> members(std::size_t at_least = 2) const;

  private:
    std::vector<int> first_;
};

/// How many bars make a body of some members rigid, and no more: d K - d (d + 1) / 2, between two members 1.
constexpr int bars_of_rigid_body(int members, int dimension) {
    return members <= dimension ? members * (members - 1) / 2 : dimension * members - dimension * (dimension + 1) / 2;
}
/// The degrees of freedom that are left: in the plane 3 of two members or more.
constexpr int body_freedoms(int members, int dimension) {
    return dimension * members - bars_of_rigid_body(members, dimension);
}

/// The list without bars and held coordinates.
std::vector<Contact> unilateral(std::vector<Contact> contacts);

/// The list and behind it the bars of bodies that can move.
std::vector<Contact> with_bars(std::vector<Contact> contacts, const Packing& packing);

/// Bars that make each of these bodies of a packing rigid, as many as that takes: between d + 1 members that span the
/// space well, and from every other member to d of these. Lengths are the distances in doubles. Of two and of three
/// members all pairs. Throws `Error(bad_input)` for members in one place, on a line (K > 2) or in a plane (K > 3)
/// where their distances from there are not above `known`. Cost: linear in the members.
std::vector<Bar> bars_of_bodies(const Packing& packing, const std::vector<std::vector<int>>& bodies,
                                const std::string& source, double known = 0);

/// What members of one body have in common, counted once too often by the sum of their areas: that sum less the area of
/// the union. NaN in space where members overlap of a body of more than two. Bodies of the disks `left_out` do not
/// count.
double shared_by_members(const Packing& packing, std::span<const int> left_out);

/// Throws `Error(bad_input)` naming the bar or the body: bars are of two different disks in increasing order, each
/// once, their lengths from `shortest_length` to `longest_length`, and as many as `bars_of_rigid_body` in each body.
/// That they are independent is told by the rank of the contacts (proofs/clumps.md, U1).
void validate_bars(const Packing& packing, const std::string& source);

} // namespace isostat
