#pragma once
/// \file
/// Typed indices: a disk, a contact and a degree of freedom are numbered from 0 and never mixed up.

#include <compare>
#include <cstddef>
#include <functional>

namespace isostat {

/// An index with a meaning. `Tag` is never defined; it only keeps the families apart. Cost: that of an int.
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
/// A degree of freedom: a row of H.
using DofId = Id<struct DofTag>;

} // namespace isostat

/// \cond
template <class Tag> struct std::hash<isostat::Id<Tag>> {
    std::size_t operator()(isostat::Id<Tag> id) const noexcept { return std::hash<int>{}(id.value()); }
};
/// \endcond
