#pragma once
/// \file
/// Rows of a contact programme: linearised gaps of a list of contacts.

#include "contact/separation.hpp"
#include "preparation/programme.hpp"

#include <isostat/contact/contact.hpp>

#include <cstddef>
#include <numeric>
#include <vector>

namespace isostat::preparation {

/// Of the objective against stress 1.
inline constexpr double objective_scale = 256;
/// Contacts that change from one programme to the next: as many pivots of the simplex method (5 ms each at n = 20 000)
/// are cheaper below this than some 25 iterations of the other (1.5 to 2 s there).
inline constexpr long few_changes = 200;

template <int Dim> struct ContactProgramme<Dim>::Rows {
    explicit Rows(const Packing<Dim>& packing) : dofs(packing) {}
    DofMap<Dim> dofs; ///< the columns
    std::vector<Contact> contact;
    std::vector<double> gap;
    std::vector<int> row, column;
    std::vector<double> value;

    void add(const Packing<Dim>& packing, const Contact& c) {
        const GapGradient<Dim> g = gap_gradient(packing, c);
        for (std::size_t k = 0; k < static_cast<std::size_t>(g.count); ++k) {
            if (const int dof = dofs.dof_of(static_cast<std::size_t>(g.coordinate[k])); dof >= 0) {
                row.push_back(static_cast<int>(contact.size()));
                column.push_back(dof);
                value.push_back(g.value[k]);
            }
        }
        contact.push_back(c);
        gap.push_back(isostat::gap(packing, c));
    }

    [[nodiscard]] std::size_t columns() const { return static_cast<std::size_t>(dofs.dof_count()); }
    /// A displacement of the columns as one of all coordinates.
    [[nodiscard]] std::vector<double> on_coordinates(const double* x) const {
        std::vector<double> all(static_cast<std::size_t>(dofs.coordinate_count()), 0.0);
        for (std::size_t c = 0; c < columns(); ++c) {
            all[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(c)))] = x[c];
        }
        return all;
    }

    /// Distance of the centres, or of the centre from the wall, at contact.
    [[nodiscard]] double range(const Packing<Dim>& packing, std::size_t k) const {
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
