#pragma once
/// \file
/// Rows of a contact programme: linearised gaps of a list of contacts.

#include "contact/separation.hpp"
#include "preparation/programme.hpp"

#include <isostat/contact/state.hpp>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

namespace isostat::preparation {

/// The cost of a length in the objective under stress 1.
inline constexpr double objective_scale = 256;
/// Below this number of changed contacts between programmes the simplex method is faster: as many pivots (5 ms each at
/// n = 20 000) cost less than some 25 iterations of the interior-point method (1.5 to 2 s there).
inline constexpr long few_changes = 200;

/// The trust bound of walls, which collect the displacements of all disks before them. In space these are few, and all
/// images that a motion of a cell within the bound brings near are listed: 250 spheres (triclinic) take 14 s with 10.
inline double wall_trust(const Packing& packing) {
    return packing.dimension == plane ? 10 : 3;
}

/// Walks through a sorted list `old` and finds the place of each requested contact, which must come in order.
class Matching {
  public:
    explicit Matching(const std::vector<Contact>& old) : old_(old) {}
    std::optional<std::size_t> find(const Contact& contact) {
        while (next_ < old_.size() && old_[next_] < contact) {
            ++next_;
        }
        return next_ < old_.size() && old_[next_] == contact ? std::optional(next_) : std::nullopt;
    }

  private:
    const std::vector<Contact>& old_;
    std::size_t next_ = 0;
};

struct ContactProgramme::Rows {
    explicit Rows(const Packing& packing) : dofs(packing) {}
    DofMap dofs; ///< the columns
    std::vector<Contact> contact;
    std::vector<double> gap;
    std::vector<int> row, column;
    std::vector<double> value;
    /// In a cell that keeps its shape: change of its coordinates when the last period changes by 1.
    std::vector<double> follows;

    GapGradient gradient(const Packing& packing, const Contact& c) {
        GapGradient g = gap_gradient(packing, c);
        if (packing.cell.keeps_shape) {
            keep_shape(packing, g);
        }
        return g;
    }

    /// Whether the linear gap can reach 0 within the trust bounds; no real gap is smaller than the linear one.
    bool can_close(const Packing& packing, const Contact& c, double trust) {
        double closing = 0;
        gradient(packing, c).for_each([&](std::size_t k, double slope) {
            const bool of_grain = k < packing.length_at(0);
            closing += std::abs(slope) * (of_grain ? trust : wall_trust(packing) * trust);
        });
        return isostat::gap(packing, c) < closing * (1 + 1e-9);
    }

    void add(const Packing& packing, const Contact& c) {
        gradient(packing, c).for_each_dof(dofs, [&](std::size_t dof, double component) {
            row.push_back(static_cast<int>(contact.size()));
            column.push_back(static_cast<int>(dof));
            value.push_back(component);
        });
        contact.push_back(c);
        gap.push_back(isostat::gap(packing, c));
    }

    [[nodiscard]] std::size_t columns() const { return static_cast<std::size_t>(dofs.dof_count()); }
    /// A displacement of the columns, written for all coordinates.
    [[nodiscard]] std::vector<double> on_coordinates(const double* x) const {
        std::vector<double> all = dofs.on_coordinates({x, x + columns()});
        for (std::size_t k = 0; k < follows.size(); ++k) {
            const std::size_t first = all.size() - follows.size();
            all[first + k] = follows[k] * x[columns() - 1];
        }
        return all;
    }

    /// The gradient of a gap where the whole cell follows its last period.
    void keep_shape(const Packing& packing, GapGradient& g) {
        const std::size_t first = packing.length_at(0);
        const std::size_t leads = packing.length_at(packing.axes() - 1);
        if (follows.empty()) {
            for (std::size_t k = first; k < packing.q.size(); ++k) {
                follows.push_back(packing.q[k] / packing.q[leads]);
            }
        }
        int disks = 0;
        double along = 0;
        g.for_each([&](std::size_t k, double component) {
            disks += k < first ? 1 : 0;
            along += k < first ? 0 : component * follows[k - first];
        });
        if (disks < g.count) { // entries of the cell come last
            g.coordinate[static_cast<std::size_t>(disks)] = static_cast<int>(leads);
            g.value[static_cast<std::size_t>(disks)] = along;
            g.count = disks + 1;
        }
    }

    /// Distance of the centres, or of the centre from the wall, at contact.
    [[nodiscard]] double range(const Packing& packing, std::size_t k) const {
        return touching_distance(packing.radius, contact[k]);
    }

    /// First entry of each row, and the end.
    [[nodiscard]] std::vector<int> starts() const {
        std::vector<int> start(contact.size() + 1, 0);
        for (const int r : row) {
            ++start[static_cast<std::size_t>(r) + 1];
        }
        std::partial_sum(start.begin(), start.end(), start.begin());
        return start;
    }
};

} // namespace isostat::preparation
