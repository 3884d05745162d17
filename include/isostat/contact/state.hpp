#pragma once
/// \file
/// Contacts, gaps and their gradients; and a state:
/// packing, load and contacts, as a file stores them.

#include <isostat/core/contact.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// "12-40", "12-40(1,-1)" of the image one period further along x and one back along y, "12-left", "12-top", "held x of
/// disk 3".
std::string to_string(const Contact& contact, int dimension = 2);

/// Derivative of a gap with respect to the coordinates: at most 2 d entries and those of the cell, coordinate indices
/// as in `Packing::q`, components are those of the unit normal, on the cell m_a times them. Column l of H is minus this
/// vector restricted to the degrees of freedom (H = G^T, and G gives approach velocities). For a held coordinate the
/// gradient is +1 on that coordinate.
struct GapGradient {
    static constexpr std::size_t most = most_axes * 2 + most_axes + most_tilts;
    int count = 0;
    std::array<int, most> coordinate{};
    std::array<double, most> value{};

    /// visit(coordinate index, component) for every entry.
    template <class Visit> void for_each(Visit visit) const {
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
            visit(static_cast<std::size_t>(coordinate[k]), value[k]);
        }
    }
    /// visit(degree of freedom, component) for the coordinates that can move.
    template <class Visit> void for_each_dof(const DofMap& dofs, Visit visit) const {
        for_each([&](std::size_t k, double component) {
            if (const int dof = dofs.dof_of(k); dof >= 0) {
                visit(static_cast<std::size_t>(dof), component);
            }
        });
    }
    /// The rate of the gap along a velocity (on coordinates), added to `from`, and the sum of the magnitudes of what
    /// was added, which bounds its rounding.
    struct Rate {
        double value = 0, terms = 0;
    };
    [[nodiscard]] Rate rate(const std::vector<double>& velocity, double from = 0) const;
};

/// Gap h: distance of the surfaces, >= 0 in an admissible packing. For a bar the distance of the centres minus its
/// length, for a held coordinate 0.
/// Error: at most 4 ulp of the distance of the centres beyond the exactly rounded
/// operations, for coordinates on the grid.
double gap(const Packing& packing, const Contact& contact);

/// Gradient of the gap. Each component has relative error <= 4u (u = 2^-53) for coordinates on the grid.
GapGradient gap_gradient(const Packing& packing, const Contact& contact);

/// Second derivative of the gap along a velocity v (on coordinates): |tangential relative
/// velocity|^2 / distance; 0 for walls.
double gap_curvature(const Packing& packing, const Contact& contact, const double* v);

/// What a run under `ties = "choose"` adds to a state: it describes the grains with radii R_i + eps rho_i, eps > 0
/// smaller than every positive number (proofs/perturbation.md).
struct RadiusPerturbation {
    unsigned long long seed = 0;
    std::vector<double> rho; ///< one per disk; short dyadic numbers
    /// i >= 0: the stress is not the stored one but the nearby one at which the force of this contact vanishes, and
    /// `stress_rate` is the first-order term of that stress.
    Contact load_zero{ContactKind::disk_disk, -1, -1};
    Enclosure stress_rate{0, 0};
    /// Results, not input: pairs that touch in the base and are open at first order, with their first-order gaps, and
    /// contacts whose force vanishes in the base, with their first-order forces.
    std::vector<std::pair<Contact, Enclosure>> open;
    std::vector<std::pair<Contact, Enclosure>> zero;
};

/// A vertex: a packing together with N_f contacts (bars and held coordinates included, normally none) whose gaps are 0
/// to rounding. All bars of the packing are in the list. The contact list is part of the state: it is never found again
/// from a gap threshold.
struct State {
    Packing packing;
    Load load;
    std::vector<Contact> contacts;
    int equilibrium = 0;                            ///< its number in the run that made it
    std::optional<RadiusPerturbation> perturbation; ///< absent: the state has the stored radii
    std::string provenance; ///< JSON text: version, command line, seeds, `rounding` of a file; proofs ignore it
};

} // namespace isostat
