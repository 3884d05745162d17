#pragma once
// Gaps and their gradients at coordinates of any number type: what every reference of the tests begins with. Nothing of
// the library is used but its data structures.

#include <isostat/contact/state.hpp>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace isostat::oracle {

using std::abs;
using std::sqrt;

/// The packing is kept by reference. Rational numbers do for all but `gap` and `gradient` of pairs, which take a root.
template <class Real> class Geometry {
  public:
    using Way = std::array<Real, most_axes>;

    explicit Geometry(const Packing& packing)
        : Geometry(packing, std::vector<Real>(packing.q.begin(), packing.q.end())) {}
    Geometry(const Packing& packing, std::vector<Real> coordinates) : q(std::move(coordinates)), packing_(&packing) {}

    std::vector<Real> q;

    [[nodiscard]] std::size_t axes() const { return static_cast<std::size_t>(packing_->dimension); }
    [[nodiscard]] std::size_t of_disk(int i) const { return axes() * static_cast<std::size_t>(i); }
    /// The lengths, then the tilts xy, xz, yz.
    [[nodiscard]] std::size_t wall(int axis) const {
        return axes() * packing_->radius.size() + static_cast<std::size_t>(axis);
    }
    [[nodiscard]] std::size_t tilt(std::size_t a, std::size_t b) const {
        return wall(static_cast<int>(axes())) + a + b * (b - 1) / 2;
    }
    [[nodiscard]] Real radius(int i) const { return Real(packing_->radius[static_cast<std::size_t>(i)]); }
    /// From disk i to disk j, or to the image of it that the contact names; 0 along axes that are not there.
    [[nodiscard]] Way between(const Contact& c) const {
        Way r{0, 0, 0};
        for (std::size_t a = 0; a < axes(); ++a) {
            r[a] = q[of_disk(c.j) + a] - q[of_disk(c.i) + a];
            if (c.image.m[a] != 0) {
                r[a] += c.image.m[a] * q[wall(static_cast<int>(a))];
            }
            for (std::size_t b = a + 1; b < axes(); ++b) {
                if (c.image.m[b] != 0) {
                    r[a] += c.image.m[b] * q[tilt(a, b)];
                }
            }
        }
        return r;
    }
    [[nodiscard]] static Real square(const Way& r) { return r[0] * r[0] + r[1] * r[1] + r[2] * r[2]; }
    /// Distance of the centres at which the gap is 0.
    [[nodiscard]] Real target(const Contact& c) const {
        return c.kind == ContactKind::bar ? Real(packing_->bar_length(c.i, c.j)) : Real(radius(c.i) + radius(c.j));
    }
    /// Of a wall, which is linear in the coordinates, or of a held coordinate to its stored value.
    [[nodiscard]] Real linear_gap(const Contact& c) const {
        const auto i = static_cast<std::size_t>(c.i);
        switch (c.kind) {
        case ContactKind::lower_wall: return q[of_disk(c.i) + static_cast<std::size_t>(c.j)] - radius(c.i);
        case ContactKind::upper_wall:
            return q[wall(c.j)] - q[of_disk(c.i) + static_cast<std::size_t>(c.j)] - radius(c.i);
        case ContactKind::held: return q[i] - Real(packing_->q[i]);
        case ContactKind::disk_disk:
        case ContactKind::bar: break;
        }
        throw std::logic_error("a pair has no linear gap");
    }
    [[nodiscard]] Real gap(const Contact& c) const {
        return is_pair(c) ? Real(sqrt(square(between(c))) - target(c)) : linear_gap(c);
    }
    /// visit(coordinate, derivative of the gap).
    template <class Visit> void gradient(const Contact& c, Visit visit) const {
        gradient(c, is_pair(c) ? Real(sqrt(square(between(c)))) : Real(1), visit);
    }
    /// The same with the way between the centres divided by `length` in place of its own one.
    template <class Visit> void gradient(const Contact& c, const Real& length, Visit visit) const {
        switch (c.kind) {
        case ContactKind::disk_disk:
        case ContactKind::bar: {
            const Way r = between(c);
            for (std::size_t a = 0; a < axes(); ++a) {
                const Real n = r[a] / length;
                if (c.i != c.j) {
                    visit(of_disk(c.i) + a, Real(-n));
                    visit(of_disk(c.j) + a, n);
                }
                if (c.image.m[a] != 0) {
                    visit(wall(static_cast<int>(a)), Real(c.image.m[a] * n));
                }
                for (std::size_t b = a + 1; b < axes(); ++b) {
                    if (c.image.m[b] != 0) {
                        visit(tilt(a, b), Real(c.image.m[b] * n));
                    }
                }
            }
            break;
        }
        case ContactKind::lower_wall: visit(of_disk(c.i) + static_cast<std::size_t>(c.j), Real(1)); break;
        case ContactKind::upper_wall:
            visit(of_disk(c.i) + static_cast<std::size_t>(c.j), Real(-1));
            visit(wall(c.j), Real(1));
            break;
        case ContactKind::held: visit(static_cast<std::size_t>(c.i), Real(1)); break;
        }
    }
    [[nodiscard]] static bool is_pair(const Contact& c) {
        return c.kind == ContactKind::disk_disk || c.kind == ContactKind::bar;
    }

  private:
    const Packing* packing_;
};

} // namespace isostat::oracle
