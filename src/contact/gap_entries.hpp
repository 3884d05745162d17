#pragma once
/// \file
/// The entries of the gradient of a gap.

#include <isostat/contact/state.hpp>

#include <cstddef>

namespace isostat {

/// Calls visit(coordinate, value) for each entry, coordinates ascending.
template <class Visit> void for_each_entry(const GapGradient& gradient, Visit visit) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(gradient.count); ++k) {
        visit(static_cast<std::size_t>(gradient.coordinate[k]), gradient.value[k]);
    }
}

/// Calls visit(dof, value) for the entries on degrees of freedom.
template <class Visit> void for_each_entry(const GapGradient& gradient, const DofMap& dofs, Visit visit) {
    for_each_entry(gradient, [&](std::size_t coordinate, double value) {
        if (const int dof = dofs.dof_of(coordinate); dof >= 0) {
            visit(static_cast<std::size_t>(dof), value);
        }
    });
}

} // namespace isostat
