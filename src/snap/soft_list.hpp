#pragma once
/// \file
/// Soft grains, their given forces, and the list of their contacts.

#include "snap/frame_file.hpp"

#include <isostat/crafted/plateau.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/snap/snap.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace isostat::compare {

/// The largest overlap, and the largest gap at a wall, of a packing close to touching, in smallest radii.
inline constexpr double nearly_touching = 0.1;

/// Words on a wall without a near disk; empty: every wall has one.
std::string far_wall(const Packing& packing);

/// Words where the sizes seem to be wrong by a factor; else empty. \p largest: threshold of the plateau.
std::string far_disks(const Packing& packing, double largest, const crafted::Plateau& plateau);

/// Throws `Error(bad_input)` when a wall has no near disk or an overlap is deep: then the file is no packing of nearly
/// rigid disks in these walls.
void check_nearness(const std::string& file, const Packing& packing);

/// A list of contacts, and its origin in words.
struct SoftList {
    std::vector<Contact> contacts; ///< sorted
    std::string words;
    std::vector<double> forces{}; ///< of the contacts in the file; NaN: not given. Empty: none given
};

/// A force given as a vector, on one grain of a contact from the other.
struct VectorForce {
    Contact contact;
    PerAxis<double> force{};
};
/// The normal parts, positive; \p words tells how large the tangential parts are. Throws `Error(bad_input)` where some
/// pull and others push, and where a tangential part is more than `force_agreement` mean forces, which means friction.
std::vector<double> normal_parts(const Packing& packing, const std::vector<VectorForce>& rows, const std::string& file,
                                 std::string& words);

/// The pairs with a force in a LAMMPS dump of style local or a table (`read_local_dump`), and the walls that a disk
/// overlaps, without rattlers. \p ids: of the disks.
SoftList list_by_forces(const std::string& file, const Packing& packing, const std::vector<long>& ids,
                        std::optional<long> frame, const std::string& contacts, const PairColumns& columns);

/// Pairs and walls with gaps up to half the smallest radius, and all overlaps, however deep. Sorted.
std::vector<Contact> near_contacts(const Packing& packing);
/// The overlapping pairs of `near_contacts`.
std::vector<Contact> overlaps_of(const Packing& packing);

/// The overlaps as a list, without rattlers.
SoftList list_by_overlaps(const Packing& packing);

/// Pairs of grains by number, as other programs list them, and the images that these pairs stand for.
class PairImages {
  public:
    /// Finds all images that overlap or are near. \pre the packing outlives the object
    explicit PairImages(const Packing& packing);
    /// The contact of the next row with these two grains: the deepest overlap of their images that no earlier row used;
    /// the nearest images when all are used, so that a surplus row repeats a contact. In a box the pair.
    Contact next(int i, int j);

  private:
    struct Images {
        std::vector<std::pair<double, Contact>> by_gap;
        std::size_t rows = 0;
    };
    std::map<std::pair<int, int>, Images> images_;
};

struct SoftForces {
    SoftState soft;
    std::vector<double> forces; ///< one per contact; NaN, or an empty list: not given
};

/// A law with its stiffness.
struct ContactLaw {
    ForceLaw kind = ForceLaw::none;
    double stiffness = 0;
    /// The force; 0 without overlap.
    [[nodiscard]] double force(const Packing& packing, const Contact& contact) const;
    /// Bound of the error of that force from the rounding of a gap.
    [[nodiscard]] double rounding(const Packing& packing, const Contact& contact, double of_gap) const;
};

/// The contacts of a state that can carry a force, with its load. Throws
/// `Error(bad_input)`, beginning with `source`, unless each axis that is not periodic has
/// a fixed lower and a movable upper wall, no grain is fixed and no force acts on a grain.
SoftForces soft_grains(const StateFile& file, const std::string& source);

/// Adds forces of the law where none are given.
void add_law(SoftForces& grains, const ContactLaw& law);

} // namespace isostat::compare
