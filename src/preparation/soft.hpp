#pragma once
/// \file
/// Damped dynamics of soft disks in a box whose upper walls are servo-controlled: from a loose random state to a
/// packing under isotropic pressure, relaxed well enough for the linear programmes.
///
/// Units: lengths of order the radii, contact stiffness 1 (force = overlap), so that pressure / stiffness is the
/// overlap in units of the diameter. Every disk has mass 1, which changes only the path. A wall moves all disks
/// affinely: velocities are measured relative to the homogeneous deformation of the box, and the force on a wall is the
/// derivative of the energy with respect to its position at fixed relative coordinates (the virial). Equilibrium is the
/// same as with walls that push only the disks that they touch.

#include "contact/near_pairs.hpp"

#include <isostat/packing/packing.hpp>

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

namespace isostat::preparation {

/// Measures at the end of a phase of the dynamics.
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
///
/// Sums over disks and pairs are taken in blocks of 8192 disks, in order, on any thread: the result has the same bits
/// for any number of threads.
///
/// In patches, for large packings: the disks are divided by the squares of a grid, 30 diameters wide, in which they
/// start, and renumbered square by square, so that neighbours are near each other in memory too; `relax` then judges
/// the power of the forces patch by patch, because over a whole large packing this power stays positive for thousands
/// of steps, which keeps the damping at 1e-5 and less. One sample of 10 000 disks: 32 000 steps instead of 68 000 to
/// the residual 1e-4 at the pressure 1e-4; at 1e-5 50 000 to 1e-3, but 135 000 instead of 85 000 to 1e-4.
class SoftDynamics {
  public:
    /// Takes the packing as it is; overlaps are allowed. The packing is
    /// up to date after each phase; during a phase only its lengths are.
    SoftDynamics(Packing& packing, bool in_patches, const std::atomic<bool>* stop,
                 std::function<void(double)> progress);

    /// Fixed box: pushes overlapping disks apart until no overlap exceeds `overlap` mean diameters (or `max_steps`).
    SoftMeasures separate(double overlap, long max_steps);
    /// Servo-controlled walls: rate of strain = `rate` x (measured / wanted pressure - 1), at most `rate`; viscous
    /// damping of the disks. Ends when both walls bear `pressure` to 10 %.
    SoftMeasures compress(double pressure, double rate, long max_steps);
    /// Damped dynamics with adaptive step (velocities turned towards the forces, stopped when they work against them:
    /// Bitzek et al., Phys. Rev. Lett. 97, 170201) until residual and pressure error are below `tolerance` (in patches:
    /// 100 `tolerance` for the pressure, which the linear programmes do not need). A wall has
    /// the mass n / 3 of what it drags.
    SoftMeasures relax(double pressure, double tolerance, long max_steps);

  private:
    /// The contribution of a block of disks to the sums over all disks.
    struct Sums {
        double power = 0, vv = 0, ff = 0; ///< force.velocity, velocity^2, force^2
    };
    /// Disks whose velocities are turned and stopped together, and the progress of their descent.
    struct Patch {
        std::size_t first = 0, last = 0; ///< range of `velocity_`
        double alpha = 0;
        int downhill = 0; ///< steps downhill
    };
    /// A disk that a wall may reach before the next search.
    struct WallDisk {
        std::size_t disk = 0;
        PerAxis<double> force{};
        PerAxis<double> lower_virial{}, upper_virial{};
        std::array<double, 2 * most_axes> overlap{}; ///< lower and upper wall of each axis
    };

    void compute_forces(double pressure);
    void wall_forces();
    /// Sums over the pairs whose first disk is in [first, last): forces on disks; returns virials.
    template <std::size_t Axes> PerAxis<double> spread(std::size_t first, std::size_t last, std::size_t piece);
    Sums add_up(std::size_t first, std::size_t last);
    void advance(double dt, bool walls);
    /// The largest square of a velocity.
    template <std::size_t Axes> double move(std::size_t first, std::size_t last, double dt, PerAxis<double> stretch);
    void refresh_pairs();
    void place_images();
    void follow_images();
    void find_pairs_in_cell();
    void renumber(bool in_patches);
    [[nodiscard]] Sums sums_of(const Patch& patch) const;
    void turn(Patch& patch, Sums sums, double dt);
    void count_contacts();
    /// Force on a wall or period over that of the pressure, minus 1; in a cell that keeps its shape: on its size.
    [[nodiscard]] double out_of_balance(std::size_t axis, double pressure) const;
    void publish_lengths();
    SoftMeasures finish(SoftMeasures result, long steps, bool converged);
    [[nodiscard]] SoftMeasures measure(double pressure);
    [[nodiscard]] bool stopped() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }

    Packing& packing_;
    std::size_t axes_, n_;
    std::vector<Patch> patches_; ///< patches of disks, then one of the walls; empty: all in one
    std::vector<int> order_;     ///< disk of the packing for each index used here
    std::vector<double> q_, radius_;
    double max_radius_ = 0;
    double mean_diameter_ = 0;
    double wall_mass_ = 0;
    std::vector<double> velocity_; ///< d n peculiar velocities, then the walls'
    std::vector<double> force_;    ///< the same layout
    Sums sums_;                    ///< of the disks
    PairList pairs_;
    /// In a rectangular cell: copies of the disks near a side, behind the lengths in `q_`.
    struct GhostImage {
        std::size_t disk = 0;
        PerAxis<int> periods{};
    };
    std::vector<GhostImage> images_;
    std::vector<int> pair_second_;   ///< index in `q_` of the second of each pair: `pairs_.partner`, or an image of it
    std::vector<int> pair_first_;    ///< the other index of each pair
    std::vector<double> pair_range_; ///< sum of the radii
    std::vector<int> pair_target_;   ///< partner, or where a block stores the force on a disk of another block
    std::vector<int> pairs_across_;  ///< pairs with disks in two blocks
    std::vector<double> from_below_; ///< force on each disk by partners of lower number
    std::vector<double> from_above_; ///< the same by walls and partners of higher number
    std::vector<double> overlap_of_; ///< of each pair
    std::vector<double> push_;       ///< force on the second of each pair
    std::vector<double> virial_;     ///< share of each pair
    std::vector<WallDisk> wall_disks_;
    double skin_ = 0;
    double allowance_ = 0; ///< relative approach of two disks that the pair list still covers
    long age_ = 0;         ///< age of the list, in steps
    double overlap_ = 0;
    int contacts_ = 0;
    const std::atomic<bool>* stop_;
    std::function<void(double)> progress_;
};

/// A contiguous part of the pair list.
struct PairStretch {
    std::size_t count = 0;
    const int* first = nullptr;    ///< grain i of each pair
    const int* second = nullptr;   ///< grain j
    const double* range = nullptr; ///< R_i + R_j
};

/// For each pair: overlap f = max(0, R_i + R_j - |d|) with d = x_j - x_i (0 also for d = 0), push = f d / |d|, and its
/// share of the virials, push_a d_a / length_a. `push` and `virial` hold one number per pair and axis, `q` one per
/// grain and axis. Every pair is computed, in contact or not: there is no branch, and every instruction set gives the
/// same bits, because each lane does the same roundings as scalar code.
void pair_forces(int dimension, const PairStretch& pairs, const double* q, const double* length, double* overlap,
                 double* push, double* virial);

} // namespace isostat::preparation
