#pragma once
/// \file
/// Which of the contact directions of a grain can carry forces >= 0 in equilibrium on it: private to the room.

#include <isostat/core/contact.hpp>

#include <algorithm>
#include <iterator>
#include <vector>

namespace isostat::crafted {

template <class Number> PerAxis<Number> cross(const PerAxis<Number>& a, const PerAxis<Number>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class Number> Number dot(const PerAxis<Number>& a, const PerAxis<Number>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The directions that occur in some combination with positive factors that is 0. A direction off a plane through 0
/// that leaves every direction on one side cannot occur; a cone that no such plane bounds is the space that its
/// directions span, and then all directions occur (a facet of a cone is spanned by two of its directions, or in a plane
/// by one). In the plane the third components are 0.
template <class Direction, class Signs> std::vector<Direction> able(std::vector<Direction> left, const Signs& signs) {
    /// Removes the directions with sign other than 0 if all of these are on one side; whether there were any.
    const auto cut = [&left](auto sign_of) {
        std::vector<int> sign;
        std::transform(left.begin(), left.end(), std::back_inserter(sign), sign_of);
        const auto [least, most] = std::minmax_element(sign.begin(), sign.end());
        if (sign.empty() || (*least < 0 && *most > 0) || (*least == 0 && *most == 0)) {
            return false;
        }
        std::size_t k = 0;
        std::erase_if(left, [&](const Direction&) { return sign[k++] != 0; });
        return true;
    };
    const auto once = [&] {
        for (std::size_t a = 0; a < left.size(); ++a) {
            for (std::size_t b = a + 1; b < left.size(); ++b) {
                const Direction first = left[a], second = left[b];
                if (cut([&](const Direction& d) {
                        return signs.template of<3>({first, second, d},
                                                    [](const auto& x) { return dot(cross(x[0], x[1]), x[2]); });
                    })) {
                    return true;
                }
            }
        }
        for (std::size_t a = 0; a < left.size(); ++a) { // no plane found: all directions are in one plane, or all occur
            for (std::size_t b = 0; b < left.size(); ++b) {
                const Direction along = left[a], beside = left[b];
                if (cut([&](const Direction& d) { // the component across `along` in the plane of the two
                        return signs.template of<3>({along, beside, d}, [](const auto& x) {
                            return dot(cross(cross(x[0], x[1]), x[0]), x[2]);
                        });
                    })) {
                    return true;
                }
            }
        }
        const Direction first = left.empty() ? Direction{} : left.front();
        return cut([&](const Direction& d) {
            return signs.template of<2>({first, d}, [](const auto& x) { return dot(x[0], x[1]); });
        });
    };
    while (once()) {
    }
    return left;
}

} // namespace isostat::crafted
