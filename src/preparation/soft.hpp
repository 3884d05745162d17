#pragma once
/// \file
/// Damped dynamics of soft disks in a box whose upper walls are servo-controlled: from a loose random state to a
/// packing under isotropic pressure, relaxed well enough for the linear programmes.
///
/// Units: lengths of order the radii, contact stiffness 1 (force = overlap), so that pressure / stiffness is the
/// overlap in units of the diameter. Every disk has mass 1: only the path depends on it. A wall carries the disks with
/// it affinely: velocities are measured relative to the homogeneous deformation of the box, and the force on a wall is
/// the derivative of the energy with respect to its position at fixed relative coordinates (the virial). Equilibrium is
/// the same as with walls that push only what they touch.

#include "preparation/neighbours.hpp"

#include <isostat/packing/packing.hpp>

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

namespace isostat::preparation {

/// What a phase of the dynamics reached.
struct SoftMeasures {
    bool converged = false;
    bool interrupted = false;
    long steps = 0;
    double residual = 0;       ///< largest unbalanced force on a disk / (pressure x mean diameter)
    double pressure_error = 0; ///< largest relative error of the pressure on a wall
    double overlap = 0;        ///< largest overlap / mean diameter
    int contacts = 0;          ///< overlapping pairs, walls included
};

/// The soft packing: positions and velocities of disks and walls, and its neighbour list.
template <int Dim> class SoftDynamics {
  public:
    /// Takes the packing as it is; overlaps are allowed.
    SoftDynamics(Packing<Dim>& packing, const std::atomic<bool>* stop, std::function<void(double)> progress);

    /// Fixed box: pushes overlapping disks apart until no overlap exceeds `overlap` mean diameters (or `max_steps`).
    SoftMeasures separate(double overlap, long max_steps);
    /// Servo-controlled walls: rate of strain = `rate` x (pressure felt / pressure wanted - 1), at most `rate`; viscous
    /// damping of the disks. Until both walls feel `pressure` to 10 %.
    SoftMeasures compress(double pressure, double rate, long max_steps);
    /// Damped dynamics with adaptive step (velocities turned towards the forces, stopped when they work against them:
    /// Bitzek et al., Phys. Rev. Lett. 97, 170201) until residual and pressure error are below `tolerance`.
    /// A wall has the mass n / 3 of what it drags.
    SoftMeasures relax(double pressure, double tolerance, long max_steps);

  private:
    void compute_forces(double pressure);
    void advance(double dt, bool walls);
    void refresh_pairs();
    [[nodiscard]] SoftMeasures measure(double pressure) const;
    [[nodiscard]] bool stopped() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }

    Packing<Dim>& packing_;
    std::size_t n_;
    double mean_diameter_ = 0;
    double wall_mass_ = 0;
    std::vector<double> velocity_; ///< Dim*n peculiar velocities, then the walls'
    std::vector<double> force_;    ///< the same layout
    PairList pairs_;
    double skin_ = 0;
    double allowance_ = 0; ///< relative approach of two disks that the pair list still covers
    double overlap_ = 0;
    double force_sum_ = 0;
    int contacts_ = 0;
    const std::atomic<bool>* stop_;
    std::function<void(double)> progress_;
};

extern template class SoftDynamics<2>;

} // namespace isostat::preparation
