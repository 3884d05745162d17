#pragma once
/// \file
/// Damped dynamics of soft grains: the usual shortcut around rigid contacts, here to measure how wrong it is. Nothing
/// in the program relies on it.

#include "contact/candidates.hpp"

#include <isostat/packing/load.hpp>

#include <vector>

namespace isostat {

/// Choices of the dynamics. Every default is derived from the packing and the load.
struct SoftGrainOptions {
    double stiffness_ratio = 1e4; ///< kappa = K / P, P = mean of the |stresses| on the walls
    double tolerance = 0;         ///< stop at this residual; 0: 1e-2 / kappa, at least 1e-9
    double step_fraction = 0.8;   ///< time step x (proved bound of the highest frequency), stable below about 1
    double drag = 0;              ///< per unit of mass and time sqrt(m / K); 0: 1 / sqrt(kappa)
    long max_steps = 20'000'000;  ///< of one `relax`
};

/// Soft contact: an overlapping pair and its elastic force K x overlap > 0.
struct SoftContact {
    Contact contact;
    double force = 0;
};

/// Disks and walls with linear repulsive springs: E = sum K overlap^2 / 2 - F_ext . q + kinetic energy, viscous damping
/// in the contacts (a fifth of critical) and a weak drag on everything that moves. Every disk has the same mass, a
/// movable wall that of the disks along it. The load is dead (`LoadKind::nominal`): F_ext is that of the packing given
/// to the constructor, and infinitesimal loads are left out, so rattlers float.
///
/// Which of several equilibria is reached depends on the damping. Equilibria converge to those of rigid grains as K
/// grows: overlap / diameter and the relative change of the forces are of order 1 / kappa. Which pairs touch is a
/// matter of overlap > 0; a pair whose rigid force is below K x (the error of positions, of order 1 / kappa) can be
/// missed, and pairs with gaps of that order can be found in excess.
class SoftGrains {
  public:
    /// \pre no held coordinates matter: only grains. Throws `Error(bad_input)` when no wall is under stress or an
    /// option is not positive and finite.
    SoftGrains(const Packing& packing, const Load& load, const SoftGrainOptions& options = {});

    /// New stresses of the same dead load. The stiffness K stays what it was.
    void set_load(const Load& load);
    /// Velocity-Verlet steps. Cost: O(n) each.
    void advance(long steps);
    /// Steps until the residual is below the tolerance and the velocities, times sqrt(m / K), are below the tolerance x
    /// a typical overlap (diameter / kappa); true when that was reached within `max_steps`.
    bool relax();

    /// Largest unbalanced force on a degree of freedom / (P x mean diameter); on walls / (P x length of the wall).
    [[nodiscard]] double residual() const;
    /// Elastic + load + kinetic energy, relative to the start: never grows but for the error of the steps.
    [[nodiscard]] double energy() const;
    [[nodiscard]] const Packing& packing() const { return packing_; }
    /// Overlapping pairs, sorted.
    [[nodiscard]] std::vector<SoftContact> contacts() const;
    [[nodiscard]] double stiffness() const { return stiffness_; }
    /// Chosen by the code: min(step_fraction / omega, 1.4 / (c omega^2)), c the damping of a contact; omega^2 = max
    /// over candidates of (z_i + z_j) K / m, z the number of candidates of a grain, is a bound of the largest
    /// eigenvalue of the spring matrix (Gershgorin on A M^-1 A^T). In units of sqrt(m / K); changes with the
    /// candidates.
    [[nodiscard]] double time_step() const { return time_step_; }
    [[nodiscard]] long steps() const { return steps_; }

  private:
    struct Pair {
        int i, j;
        double range;
    };
    struct Wall {
        int coordinate; ///< of the disk
        int wall;       ///< coordinate of the upper wall, -1: lower wall
        double radius;
    };
    void find_pairs();
    void compute_forces(bool damped);
    void look_around(double displacement);
    [[nodiscard]] bool at_rest() const;

    Packing packing_;
    std::vector<double> origin_; ///< q at the start: energies of the load are relative to it
    std::vector<double> external_;
    std::vector<double> inverse_mass_; ///< 0: cannot move
    std::vector<double> velocity_;
    std::vector<double> force_;
    CandidateList candidates_;
    std::vector<Pair> pairs_;
    std::vector<Wall> walls_;
    SoftGrainOptions options_;
    double pressure_ = 0;
    double stiffness_ = 0;
    double drag_ = 0;
    double dashpot_ = 0; ///< in units of K
    double time_step_ = 0;
    double moved_ = 0; ///< bound of the largest displacement since the candidates were found
    double mean_diameter_ = 0;
    long steps_ = 0;
};

} // namespace isostat
