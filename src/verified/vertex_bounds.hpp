#pragma once
// Bounds that several proofs of the true vertex use (statement V4): private to the room.

#include "contact/separation.hpp"
#include "core/roundoff.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

namespace isostat {

/// Sum of the radii of a contact, or the length of a bar: the length D that scales the rounding of the gap.
inline double target(const Packing& packing, const Contact& contact) {
    return zero_distance(packing, contact);
}

/// Whether products of such doubles, and their rounding errors, keep all digits (V0).
inline bool in_range_of_products(double size) {
    return size > 1e-100 && size < 1e100; // precision.md B2 (e)
}
/// Whether this holds for all lengths of a packing.
inline bool in_range_of_products(const Packing& packing) {
    const auto longer = [](double a, double b) { return std::abs(a) < std::abs(b); };
    return in_range_of_products(packing.min_radius()) &&
           std::abs(*std::max_element(packing.q.begin(), packing.q.end(), longer)) < 1e100; // precision.md B2 (e)
}

/// |m| of a contact, which bounds the change of r per change of the cell. 0 without an image.
inline double cell_weight(const Contact& contact) {
    const auto& m = contact.image.m;
    return contact.image.is_here() ? 0.0 : std::sqrt(static_cast<double>(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]));
}

/// w_l^2 of proofs/cells.md: |delta r| <= w_l |delta q|, and so |delta gap|. 2 without an image.
inline double separation_weight_square(const Contact& contact) {
    const double a = cell_weight(contact);
    return (contact.i == contact.j ? 0.0 : 2.0) + a * a;
}
inline double separation_weight(const Contact& contact) {
    using roundoff::root2;
    // precision.md B1 (last operations)
    return contact.image.is_here() ? root2 : std::sqrt(separation_weight_square(contact)) * (1 + 0x1p-50);
}

/// Bound of the factors of unit normals in the matrix: 1 without images.
inline double largest_multiple(const std::vector<Contact>& contacts) {
    int most = 1;
    for (const Contact& contact : contacts) {
        for (const std::int8_t m : contact.image.m) {
            most = std::max(most, std::abs(m));
        }
    }
    return most;
}

/// Largest sum of the parts that contacts add to a disk or, for contacts with an image, to the cell.
class HeaviestSum {
  public:
    explicit HeaviestSum(std::size_t disks) : at_disk_(disks, 0.0) {}
    void add(const Contact& contact, double to_disks, double to_cell) {
        if (contact.i != contact.j) { // a disk and its own image depend on the cell alone
            at_disk_[static_cast<std::size_t>(contact.i)] += to_disks;
            at_disk_[static_cast<std::size_t>(contact.j)] += to_disks;
        }
        cell_ += to_cell;
    }
    /// Adds the turn of a force (C5), `part` = |f_l| / D_l.
    void add_turn(const Contact& contact, double part) {
        const double w = cell_weight(contact);
        add(contact, part * (2 + w), part * w * (contact.i == contact.j ? w : 2 + w));
    }
    /// The largest sum, including roundings of its terms (B1).
    [[nodiscard]] double largest() const {
        return std::max(cell_, *std::max_element(at_disk_.begin(), at_disk_.end())) * (1 + 1e-9); // precision.md B1
    }

  private:
    std::vector<double> at_disk_;
    double cell_ = 0;
};

/// K of proofs/cells.md: the root of the largest sum of w_l^4 / D_l^2 at a disk, or over the contacts with images.
inline double lipschitz_in_cell(const Packing& packing, const std::vector<Contact>& contacts) {
    HeaviestSum sum(packing.radius.size());
    for (const Contact& contact : contacts) {
        if (contact.of_disks()) {
            const double part = separation_weight_square(contact) / target(packing, contact);
            sum.add(contact, part * part, contact.image.is_here() ? 0.0 : part * part);
        }
    }
    return std::sqrt(sum.largest());
}

/// Lipschitz constant of the derivative of F_l = (|r|^2 - D^2) / (2 D): 2 sqrt(z) / D_min, z the largest number
/// of disk contacts of one disk (V4). 0 when there are only walls.
inline double lipschitz(const Packing& packing, const std::vector<Contact>& contacts) {
    if (packing.cell.any()) {
        return lipschitz_in_cell(packing, contacts);
    }
    std::vector<int> count(packing.radius.size(), 0);
    double smallest = std::numeric_limits<double>::infinity();
    for (const Contact& contact : contacts) {
        if (contact.of_disks()) {
            ++count[static_cast<std::size_t>(contact.i)];
            ++count[static_cast<std::size_t>(contact.j)];
            smallest = std::min(smallest, target(packing, contact));
        }
    }
    const double most = *std::max_element(count.begin(), count.end());
    return most == 0 ? 0 : 2 * std::sqrt(most) / smallest * (1 + 0x1p-50); // precision.md B1 (last operations)
}

/// Largest |gap| / D over the disk contacts.
inline double worst_gap_ratio(const Packing& packing, const std::vector<Contact>& contacts) {
    double worst = 0;
    for (const Contact& contact : contacts) {
        const double d = target(packing, contact);
        worst = d > 0 ? std::max(worst, std::abs(gap(packing, contact)) / d) : worst;
    }
    return worst;
}

/// |H(q) - H(q')|_2 <= normal_rate |q - q'| for the unit normals between the stored configuration and the true vertex:
/// unit vectors of d and d' differ by at most |d - d'| / min(|d|, |d'|), and every distance there is above 0.99 D (\pre
/// worst_gap_ratio below 1e-3 and |q - q'| below D_min / 1000, as V4 checks); then as in V4 (a).
inline double normal_rate(double lipschitz_constant) {
    return 1.02 * lipschitz_constant; // bounds.md turn_of_forces
}
inline double normal_rate(const Packing& packing, const std::vector<Contact>& contacts) {
    return normal_rate(lipschitz(packing, contacts));
}

/// |(H(q) - H(q')) x|_2 <= turn_of_forces |q - q'| for the same normals as in `normal_rate`:
/// 2 max_i sum_{l at i} |x_l| / D_l as in V6, in a cell the sums of C5. This bound is
/// smaller than normal_rate |x|_2 by about the square root of the number of contacts.
inline double turn_of_forces(const Packing& packing, const std::vector<Contact>& contacts,
                             const std::vector<double>& x) {
    if (packing.cell.any()) {
        HeaviestSum heaviest(packing.radius.size());
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (contacts[l].of_disks()) {
                heaviest.add_turn(contacts[l], std::abs(x[l]) / target(packing, contacts[l]));
            }
        }
        return 1.03 * heaviest.largest(); // cells.md C5 (turn of forces, roundings)
    }
    std::vector<double> sum(packing.radius.size(), 0.0);
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& contact = contacts[l];
        if (contact.of_disks()) {
            const double part = std::abs(x[l]) / target(packing, contact);
            sum[static_cast<std::size_t>(contact.i)] += part;
            sum[static_cast<std::size_t>(contact.j)] += part;
        }
    }
    return 2.05 * *std::max_element(sum.begin(), sum.end()); // bounds.md turn_of_forces
}

} // namespace isostat
