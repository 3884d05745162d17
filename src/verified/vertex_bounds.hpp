#pragma once
// What the bounds of the true vertex share (statement V4): private to the room.

#include "contact/separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace isostat {

/// Sum of the radii of a contact: the length that scales the rounding of its gap.
template <int Dim> double target(const Packing<Dim>& packing, const Contact& contact) {
    return touching_distance(packing.radius, contact);
}

/// Products of such doubles, and what rounding leaves of them, keep all digits (V0).
inline bool in_range_of_products(double size) {
    return size > 1e-100 && size < 1e100;
}
/// Of all lengths.
template <int Dim> bool in_range_of_products(const Packing<Dim>& packing) {
    const auto longer = [](double a, double b) { return std::abs(a) < std::abs(b); };
    return in_range_of_products(packing.min_radius()) &&
           std::abs(*std::max_element(packing.q.begin(), packing.q.end(), longer)) < 1e100;
}

/// Lipschitz constant of the derivative of F_l = (|x_i - x_j|^2 - D^2) / (2 D): 2 sqrt(z) / D_min, z the largest number
/// of disk contacts of one disk (V4). 0 when there are only walls.
template <int Dim> double lipschitz(const Packing<Dim>& packing, const std::vector<Contact>& contacts) {
    std::vector<int> count(packing.radius.size(), 0);
    double smallest = std::numeric_limits<double>::infinity();
    for (const Contact& contact : contacts) {
        if (contact.kind == ContactKind::disk_disk) {
            ++count[static_cast<std::size_t>(contact.i)];
            ++count[static_cast<std::size_t>(contact.j)];
            smallest = std::min(smallest, target(packing, contact));
        }
    }
    const double most = *std::max_element(count.begin(), count.end());
    return most == 0 ? 0 : 2 * std::sqrt(most) / smallest * (1 + 0x1p-50);
}

/// Largest |gap| / D over the disk contacts.
template <int Dim> double worst_gap_ratio(const Packing<Dim>& packing, const std::vector<Contact>& contacts) {
    double worst = 0;
    for (const Contact& contact : contacts) {
        const double d = target(packing, contact);
        worst = d > 0 ? std::max(worst, std::abs(gap(packing, contact)) / d) : worst;
    }
    return worst;
}

/// |H(q) - H(q')|_2 <= normal_rate |q - q'| for the unit normals between the stored configuration and the true vertex:
/// unit vectors of d and d' differ by at most |d - d'| / min(|d|, |d'|), and every distance there is above 0.99 D
/// (\pre worst_gap_ratio below 1e-3 and |q - q'| below D_min / 1000, as V4 checks); then as in V4 (a).
inline double normal_rate(double lipschitz_constant) {
    return 1.02 * lipschitz_constant;
}
template <int Dim> double normal_rate(const Packing<Dim>& packing, const std::vector<Contact>& contacts) {
    return normal_rate(lipschitz(packing, contacts));
}

/// |(H(q) - H(q')) x|_2 <= turn_of_forces |q - q'| for the same normals as in `normal_rate`: 2 max_i sum_{l at i} |x_l|
/// / D_l as in V6, which is smaller than normal_rate |x|_2 by about the square root of the number of contacts.
template <int Dim>
double turn_of_forces(const Packing<Dim>& packing, const std::vector<Contact>& contacts, const std::vector<double>& x) {
    std::vector<double> sum(packing.radius.size(), 0.0);
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& contact = contacts[l];
        if (contact.kind == ContactKind::disk_disk) {
            const double part = std::abs(x[l]) / target(packing, contact);
            sum[static_cast<std::size_t>(contact.i)] += part;
            sum[static_cast<std::size_t>(contact.j)] += part;
        }
    }
    return 2.05 * *std::max_element(sum.begin(), sum.end());
}

} // namespace isostat
