#pragma once
/// \file
/// The names of what a packing consists of: the dimension, disks by number, contacts. The geometry of a contact is in
/// the room contact.

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace isostat {

/// The largest number of axes, and of tilts of a cell. Arrays over axes and tilts have an entry for each; entries that
/// the dimension does not use hold 0.
inline constexpr std::size_t most_axes = 3; // 3: exact: axes, tilts and coordinates of an image in three dimensions
inline constexpr std::size_t most_tilts = 3;
/// The dimension of statements that hold in the plane only; files that use this constant never get spheres.
inline constexpr int plane = 2;
template <class T> using PerAxis = std::array<T, most_axes>;
template <class T> using PerTilt = std::array<T, most_tilts>;

/// Where `Packing::q` has each coordinate: disk i
/// from d i on, L_a at d n + a, the tilts last.
struct Layout {
    int dimension = 2; ///< d
    int disks = 0;     ///< n
    [[nodiscard]] constexpr std::size_t axes() const { return static_cast<std::size_t>(dimension); }
    [[nodiscard]] constexpr std::size_t tilts() const { return axes() * (axes() - 1) / 2; }
    [[nodiscard]] constexpr std::size_t of_disk(int disk) const { return axes() * static_cast<std::size_t>(disk); }
    [[nodiscard]] constexpr std::size_t of_length(std::size_t axis) const { return of_disk(disks) + axis; }
    /// The index of A_ab, a < b.
    [[nodiscard]] constexpr std::size_t of_tilt(std::size_t a, std::size_t b) const {
        return of_length(axes()) + a + b * (b - 1) / 2;
    }
};

/// An index with a meaning. `Tag` is never defined; it only keeps index types apart. Cost: that of an int.
template <class Tag> class Id {
  public:
    constexpr Id() = default;
    constexpr explicit Id(int value) : value_(value) {}
    constexpr explicit Id(std::size_t value) : value_(static_cast<int>(value)) {}
    /// The number, from 0; -1 means "none".
    [[nodiscard]] constexpr int value() const { return value_; }
    /// The number as a container index. \pre `valid()`.
    [[nodiscard]] constexpr std::size_t index() const { return static_cast<std::size_t>(value_); }
    [[nodiscard]] constexpr bool valid() const { return value_ >= 0; }
    friend constexpr auto operator<=>(Id, Id) = default;

  private:
    int value_ = -1;
};

/// A disk of a packing.
using DiskId = Id<struct DiskTag>;
/// A position in a contact list, and the column of that contact in H.
using ContactId = Id<struct ContactTag>;

/// What touches what. Two kinds are no contacts: `bar` keeps two members of one body at a distance (`Packing::bars`),
/// whatever the sign of its force; `held` keeps a coordinate at its value, because the power of the load changed sign
/// there (proofs/stability.md, S3) or because a free motion begins there (proofs/clumps.md).
enum class ContactKind : std::uint8_t { disk_disk, bar, lower_wall, upper_wall, held };

/// What is true of all walls of a kind: all of them are flat, normal to an axis, and stand at 0 or at L of that axis.
struct WallFacts {
    ContactKind kind;
    int side;                  ///< -1: the grains that touch the wall are above, +1: they are below
    bool at_length;            ///< the wall stands at L
    PerAxis<const char*> name; ///< of the wall normal to an axis, in files, options and messages
    PerAxis<int> column;       ///< the same wall in the second column of a contact in equilibria.csv
};
/// In the order of the kinds.
inline constexpr std::array wall_facts{
    // exact: columns
    WallFacts{ContactKind::lower_wall, -1, false, {"left", "bottom", "back"}, {-1, -2, -5}},
    // exact: columns
    WallFacts{ContactKind::upper_wall, +1, true, {"right", "top", "front"}, {-3, -4, -6}},
};
static_assert(static_cast<std::size_t>(ContactKind::held) - static_cast<std::size_t>(ContactKind::lower_wall) ==
              wall_facts.size());

/// Which image of a disk in a periodic cell: m_a periods further along the period vector a. All 0 in a box.
struct Image {
    std::array<std::int8_t, 3> m{}; // exact: axes, tilts and coordinates of an image in three dimensions
    [[nodiscard]] constexpr bool is_here() const { return m[0] == 0 && m[1] == 0 && m[2] == 0; }
    [[nodiscard]] constexpr Image opposite() const {
        return {{static_cast<std::int8_t>(-m[0]), static_cast<std::int8_t>(-m[1]), static_cast<std::int8_t>(-m[2])}};
    }
    friend constexpr auto operator<=>(const Image&, const Image&) = default;
    /// Written out: the equality of arrays calls a function for three bytes, and lists of contacts are compared often.
    friend constexpr bool operator==(const Image& a, const Image& b) {
        return a.m[0] == b.m[0] && a.m[1] == b.m[1] && a.m[2] == b.m[2];
    }
};

/// One contact, or one candidate.
/// - disk_disk: disk i and the image of disk j, i < j; or i = j and an image that comes after {0, 0, 0} in the order:
///   (i, j, m) and (j, i, -m) are one contact, (i, j, m) and (i, j, m') are two;
/// - bar: disks i < j, two members of one body;
/// - lower_wall, upper_wall: disk i and the wall of axis j;
/// - held: coordinate index i, j = 0.
struct Contact {
    ContactKind kind = ContactKind::disk_disk;
    Image image{};
    int i = 0;
    int j = 0;
    constexpr Contact() = default;
    constexpr Contact(ContactKind what, int first, int second, Image of_second = {})
        : kind(what), image(of_second), i(first), j(second) {}
    /// The contact or bar joins two disks, and j is a disk.
    [[nodiscard]] constexpr bool of_disks() const { return kind <= ContactKind::bar; }
    /// The contact is with a wall, and j is the axis of the wall.
    [[nodiscard]] constexpr bool is_wall() const { return kind > ContactKind::bar && kind < ContactKind::held; }
    /// \pre `is_wall()`
    [[nodiscard]] constexpr const WallFacts& wall() const {
        return wall_facts[static_cast<std::size_t>(kind) - static_cast<std::size_t>(ContactKind::lower_wall)];
    }
    /// The number of the body that the wall belongs to: 2 j of what stands at 0, 2 j + 1 of what stands at L_j.
    /// \pre `is_wall()`
    [[nodiscard]] constexpr std::size_t wall_number() const {
        return 2 * static_cast<std::size_t>(j) + (wall().at_length ? 1 : 0);
    }
    /// A row of which the force is not negative and which may open.
    [[nodiscard]] constexpr bool is_unilateral() const { return kind != ContactKind::bar && kind != ContactKind::held; }
    friend constexpr bool operator==(const Contact& a, const Contact& b) {
        return a.i == b.i && a.j == b.j && a.kind == b.kind && a.image == b.image;
    }
    friend constexpr std::strong_ordering operator<=>(const Contact& a, const Contact& b) {
        if (const auto kinds = a.kind <=> b.kind; kinds != 0) {
            return kinds;
        }
        if (const auto first = a.i <=> b.i; first != 0) {
            return first;
        }
        const auto second = a.j <=> b.j;
        return second != 0 ? second : a.image <=> b.image;
    }
};

/// The coordinate at which the wall of a contact stands; none: the wall stands at 0, or there is no wall.
constexpr std::optional<std::size_t> wall_coordinate(const Contact& contact, const Layout& layout) {
    return contact.is_wall() && contact.wall().at_length
               ? std::optional(layout.of_length(static_cast<std::size_t>(contact.j)))
               : std::nullopt;
}

/// Two disks in the canonical order of a pair.
constexpr Contact pair_of(int i, int j, Image image = {}) {
    return i < j || (i == j && image > Image{}) ? Contact(ContactKind::disk_disk, i, j, image)
                                                : Contact(ContactKind::disk_disk, j, i, image.opposite());
}

} // namespace isostat
