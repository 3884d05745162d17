#pragma once
/// \file
/// Which of the contact directions of a grain can carry forces >= 0 in equilibrium on it; rattlers and carrying
/// contacts for every initial part of a list of contacts at once: private to the library.

#include <isostat/contact/state.hpp>
#include <isostat/core/contact.hpp>
#include <isostat/packing/packing.hpp>

#include <iterator>
#include <vector>

namespace isostat::crafted {

template <class Number> PerAxis<Number> cross(const PerAxis<Number>& a, const PerAxis<Number>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class Number> Number dot(const PerAxis<Number>& a, const PerAxis<Number>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/// The third component of the cross product.
template <class Number> Number turn(const PerAxis<Number>& a, const PerAxis<Number>& b) {
    return a[0] * b[1] - a[1] * b[0];
}

/// The directions that occur in some combination with positive factors that is 0. A direction off a plane through 0
/// that leaves every direction on one side cannot occur; a cone that no such plane bounds is the space that its
/// directions span, and then all directions occur (a facet of a cone is spanned by two of its directions, or in a plane
/// by one). \p flat: the third components are 0.
template <class Direction, class Signs>
std::vector<Direction> able(std::vector<Direction> left, const Signs& signs, bool flat) {
    /// Removes the directions with sign other than 0 if all of these are on one side; whether there were any.
    const auto cut = [&left](auto sign_of) {
        std::vector<int> sign;
        bool above = false, below = false;
        for (const Direction& d : left) {
            sign.push_back(sign_of(d));
            above = above || sign.back() > 0;
            below = below || sign.back() < 0;
            if (above && below) {
                return false;
            }
        }
        std::size_t k = 0;
        return std::erase_if(left, [&](const Direction&) { return sign[k++] != 0; }) > 0;
    };
    const auto by_planes = [&] {
        for (const Direction& a : left) {
            for (const Direction& b : left) {
                if (&a < &b && cut([&](const Direction& d) {
                        return &d == &a || &d == &b ? 0 : signs.template of<3>({a, b, d}, [](const auto& x) {
                            return dot(cross(x[0], x[1]), x[2]);
                        });
                    })) {
                    return true;
                }
            }
        }
        return false;
    };
    const auto by_lines = [&] { // where all directions are in one plane
        for (const Direction& a : left) {
            if (flat && cut([&](const Direction& d) {
                    return &d == &a ? 0 : signs.template of<2>({a, d}, [](const auto& x) { return turn(x[0], x[1]); });
                })) {
                return true;
            }
            for (const Direction& b : left) { // the component across a in the plane of the two
                if (!flat && &a != &b && cut([&](const Direction& d) {
                        return &d == &a ? 0 : signs.template of<3>({a, b, d}, [](const auto& x) {
                            return dot(cross(cross(x[0], x[1]), x[0]), x[2]);
                        });
                    })) {
                    return true;
                }
            }
        }
        return false;
    };
    const auto by_point = [&] { // where all directions are on one line
        return cut([&](const Direction& d) {
            return signs.template of<2>({left.front(), d}, [](const auto& x) { return dot(x[0], x[1]); });
        });
    };
    while ((!flat && by_planes()) || by_lines() || by_point()) {
    }
    return left;
}

/// The result of `exclude_contacts` for the first m contacts of a list, for every m: adding contacts never makes
/// another contact unable to carry, so each contact and each disk has one m from which on it carries.
struct Peeling {
    std::vector<int> contact_from; ///< contact l carries with the first m contacts exactly when m >= contact_from[l]
    std::vector<int> disk_from;    ///< disk i is no rattler exactly when m >= disk_from[i]; 0 for fixed disks
};

/// Removes the contacts from the last to the first. A grain loses its contacts off a line, in space off a plane,
/// through its centre that leaves every contact on one side (`able`); each sign is decided by intervals or in
/// rationals. Bodies are peeled as wholes: in the plane forces and torques are to balance, in space the forces. Throws
/// `Error(bad_input)` when two grains of a contact have the same centre. Cost: for a grain with z contacts O(z^2)
/// signs, in space and of bodies O(z^3), for every contact that it loses.
Peeling peel(const Packing& packing, const std::vector<Contact>& contacts);

} // namespace isostat::crafted
