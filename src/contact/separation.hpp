#pragma once
/// \file
/// Relative positions of the grains of a contact: the only code that forms r = x_j - x_i + A m; the exact sign of a
/// gap.

#include <isostat/contact/state.hpp>

#include <cstddef>
#include <cstdlib>
#include <type_traits>

namespace isostat {

/// The separation of two grains as a function of the coordinates: r = x_j - x_i + A m of a disk and the image of
/// another; x_i of a disk and a wall that stands at 0, L - x_i of a wall that stands at L, along the axis of the wall.
/// It is linear in the coordinates, with coefficients -1 and +1, and m_a on those of the cell: applied to velocities it
/// gives relative velocities, applied to derivatives the derivative of r.
///
/// Arithmetic: at(k) is the number for coordinate k (as in `Packing::q`), minus(a, b) a difference of two. In double r
/// is exact where the coordinates are on the grid; elsewhere r without an image is correctly rounded.
/// In the plane the third component of r is 0.
class Separation {
  public:
    /// \pre of a contact through an image or with a wall: `layout` has the number of disks
    Separation(const Contact& contact, const Layout& layout) : contact_(contact), layout_(layout) {}

    /// \pre two disks
    template <class At, class Minus> [[nodiscard]] auto of_disks(At at, Minus minus) const {
        auto r = of_centres(at, minus);
        using Number = std::remove_cvref_t<decltype(r[0])>;
        static_assert(std::is_same_v<Number, std::remove_cvref_t<decltype(at(std::size_t{0}))>>);
        if (!contact_.image.is_here()) [[unlikely]] {
            add_periods(r, at, minus);
        }
        return r;
    }
    /// x_j - x_i alone, which is r without an image.
    template <class At, class Minus> [[nodiscard]] auto of_centres(At at, Minus minus) const {
        const std::size_t i = layout_.of_disk(contact_.i);
        const std::size_t j = layout_.of_disk(contact_.j);
        using Number = std::remove_cvref_t<decltype(minus(at(j), at(i)))>;
        const auto third = [&]() -> Number {
            if (layout_.dimension > plane) [[unlikely]] {
                return minus(at(j + 2), at(i + 2));
            }
            if constexpr (std::is_convertible_v<int, Number>) {
                return 0; // explicit, because a default interval of CGAL is not 0
            } else {
                return Number{};
            }
        };
        return PerAxis<Number>{minus(at(j), at(i)), minus(at(j + 1), at(i + 1)), third()};
    }
    /// r += A m, with the values of `at` for the coordinates of the cell.
    template <class Number, class At, class Minus> void add_periods(PerAxis<Number>& r, At at, Minus minus) const {
        for_each_period([&](std::size_t coordinate, std::size_t axis, int m) {
            const Number period = at(coordinate);
            const Number back = minus(minus(period, period), period); // -period
            for (; m > 0; --m) {
                r[axis] = minus(r[axis], back);
            }
            for (; m < 0; ++m) {
                r[axis] = minus(r[axis], period);
            }
        });
    }
    /// \pre a disk and a wall
    template <class At, class Minus> [[nodiscard]] auto of_wall(At at, Minus minus) const {
        const std::size_t x = along_axis();
        using Number = std::remove_cvref_t<decltype(minus(at(x), at(x)))>;
        return contact_.wall().at_length ? of_wall_at_length(at, minus) : Number(at(x));
    }
    /// \pre a disk and a wall that stands at L
    template <class At, class Minus> [[nodiscard]] auto of_wall_at_length(At at, Minus minus) const {
        const std::size_t x = along_axis();
        const std::size_t wall = layout_.of_length(static_cast<std::size_t>(contact_.j));
        return contact_.wall().side > 0 ? minus(at(wall), at(x)) : minus(at(x), at(wall));
    }

    /// Calls visit(coordinate, component, coefficient) for every coordinate that the gap depends on, in ascending
    /// order: the coefficient is the derivative of that component of r (of a held coordinate: 0, +1): -1 or +1, and m_a
    /// for coordinates of the cell. A disk and its own image depend on the cell alone. \pre i <= j
    template <class Visit> void for_each_coordinate(Visit visit) const {
        if (contact_.of_disks()) {
            const std::size_t x = layout_.of_disk(contact_.i);
            for (std::size_t a = 0; a < layout_.axes() && contact_.i != contact_.j; ++a) {
                visit(x + a, a, -1);
            }
            for (std::size_t a = 0; a < layout_.axes() && contact_.i != contact_.j; ++a) {
                visit(layout_.of_disk(contact_.j) + a, a, 1);
            }
            if (!contact_.image.is_here()) [[unlikely]] {
                for_each_period(visit);
            }
        } else if (contact_.is_wall()) {
            const auto axis = static_cast<std::size_t>(contact_.j);
            const int side = contact_.wall().side;
            visit(along_axis(), axis, -side);
            if (contact_.wall().at_length) {
                visit(layout_.of_length(axis), axis, side);
            }
        } else {
            visit(static_cast<std::size_t>(contact_.i), std::size_t{0}, 1);
        }
    }

    /// The column of H (minus the gradient of the gap): visit(dof, entry) in ascending order. `normal`: the unit normal
    /// from disk to disk, or any multiple of it, in any arithmetic; unused for other contacts, whose entries are -1 and
    /// +1. On the rows of the cell the normal is multiplied by -m_a, by sums of up to three.
    template <class Number, class Visit>
    void for_each_entry(const DofMap& dofs, const PerAxis<Number>& normal, Visit visit) const {
        for_each_coordinate([&](std::size_t coordinate, std::size_t component, int sign) {
            const int dof = dofs.dof_of(coordinate);
            if (dof >= 0) {
                Number entry = !contact_.of_disks() ? Number(-sign)
                               : sign > 0           ? Number(-normal[component])
                                                    : normal[component];
                for (int times = std::abs(sign); times > 1; --times) {
                    entry = sign > 0 ? Number(entry - normal[component]) : Number(entry + normal[component]);
                }
                visit(dof, entry);
            }
        });
    }

  private:
    /// The coordinate of the disk along the axis of the wall.
    [[nodiscard]] std::size_t along_axis() const {
        return layout_.of_disk(contact_.i) + static_cast<std::size_t>(contact_.j);
    }
    /// visit(coordinate, component of r, multiple) for the coordinates of the cell that A m depends on, ascending.
    template <class Visit> void for_each_period(Visit visit) const {
        for (std::size_t a = 0; a < layout_.axes(); ++a) {
            if (contact_.image.m[a] != 0) {
                visit(layout_.of_length(a), a, static_cast<int>(contact_.image.m[a]));
            }
        }
        for (std::size_t b = 1; b < layout_.axes(); ++b) {
            for (std::size_t a = 0; a < b && contact_.image.m[b] != 0; ++a) {
                visit(layout_.of_tilt(a, b), a, static_cast<int>(contact_.image.m[b]));
            }
        }
    }

    Contact contact_;
    Layout layout_;
};

/// The unit vector along d, for any length: defined in contact.cpp.
PerAxis<double> direction(PerAxis<double> d);

/// r of two disks for a vector on all coordinates, of numbers of any kind. \pre two disks
template <class Vector> inline auto separation(const Layout& layout, const Vector& x, const Contact& pair) {
    using Number = std::remove_cvref_t<decltype(x[0])>;
    const auto at = [&x](std::size_t k) -> decltype(auto) { return x[k]; };
    const auto minus = [](const Number& a, const Number& b) -> Number { return a - b; };
    return Separation(pair, layout).of_disks(at, minus);
}

/// Separation from a wall. \pre a disk and a wall
template <class Vector> inline auto wall_distance(const Layout& layout, const Vector& x, const Contact& contact) {
    using Number = std::remove_cvref_t<decltype(x[0])>;
    return Separation(contact, layout)
        .of_wall([&x](std::size_t k) -> decltype(auto) { return x[k]; },
                 [](const Number& a, const Number& b) -> Number { return a - b; });
}

/// The unit vector from a disk to a wall. \pre a disk and a wall
template <class Number> PerAxis<Number> wall_normal(const Contact& contact) {
    PerAxis<Number> normal{Number(0), Number(0), Number(0)};
    normal[static_cast<std::size_t>(contact.j)] = Number(contact.wall().side);
    return normal;
}

/// Separation at which the grains touch: R_i + R_j, R_i at a wall, 0 for a held coordinate. `radius`: a number of any
/// type for each disk. \pre no bar
template <class Radii> inline auto touching_distance(const Radii& radius, const Contact& contact) {
    using Number = std::remove_cvref_t<decltype(radius[0])>;
    if (contact.kind == ContactKind::disk_disk) {
        return Number(radius[static_cast<std::size_t>(contact.i)] + radius[static_cast<std::size_t>(contact.j)]);
    }
    return contact.is_wall() ? Number(radius[static_cast<std::size_t>(contact.i)]) : Number(0);
}

/// `touching_distance` in double, and the length of a bar: where the row of any contact has its zero.
inline double zero_distance(const Packing& packing, const Contact& contact) {
    return contact.kind == ContactKind::bar ? packing.bar_length(contact.i, contact.j)
                                            : touching_distance(packing.radius, contact);
}

/// Sign (-1, 0, 1) of gap + allowance over the reals, for the stored doubles: by an interval (CGAL::Interval_nt), and
/// where that contains 0 by rationals (CGAL::Exact_rational). \pre finite coordinates and radii; not a
/// held coordinate.
int gap_sign(const Packing& packing, const Contact& contact, double allowance);

} // namespace isostat
