#pragma once
/// \file
/// From random disks to an exact equilibrium under isotropic pressure (paper, section 3): damped dynamics, sequential
/// linear programming, Newton.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// Shapes of the law of the diameters d. Shares and densities are by number of disks.
enum class RadiiLaw {
    uniform,    ///< density constant between `smallest` and `largest`
    equal,      ///< d = `diameter`
    bidisperse, ///< the first disks have d = `diameter`, the last floor(`fraction` n + 1/2) have `ratio` x `diameter`
    lognormal,  ///< ln d normal, median `diameter`, standard deviation of ln d `deviation`; cut
    normal,     ///< d normal, mean `diameter`, standard deviation `deviation` x `diameter`; cut
    power       ///< density ~ d^-`exponent` between `smallest` and `largest`
};

/// A law with its parameters, lengths in the user's unit. For a law marked as cut, values are drawn again until
/// `smallest` <= d <= `largest`.
struct DiameterLaw {
    double smallest = 1;
    double largest = 2;
    RadiiLaw kind = RadiiLaw::uniform;
    double diameter = 1;
    double ratio = 1.4;
    double fraction = 0.5;
    double deviation = 0.2;
    double exponent = 3;
};

/// What is wrong with a law, in words; empty: nothing. A law that is cut must have `diameter` inside and an interval at
/// least one deviation wide, so that at least a third of the drawn values is kept.
std::string fault_of(const DiameterLaw& law);

/// `count` radii, independent, from a 64-bit Mersenne twister. Logarithms and exponentials, the only functions used,
/// are rounded correctly (MPFR). Throws `Error(bad_input)` for a law with a fault, or count < 1. Cost: 5 us per disk
/// for laws with logarithms.
std::vector<double> draw_radii(const DiameterLaw& law, int count, std::uint64_t seed);

/// R_i (1 + size rho_i) to the nearest double, rho_i uniform in [-1, 1), independent,
/// from a stream of `seed` other than that of the radii: equal radii of a mixture
/// become different, so that their packings have no ties. \pre 0 <= size < 1
std::vector<double> with_jitter(std::vector<double> radius, double size, std::uint64_t seed);

/// Progress of a preparation. `fraction` in [0, 1] is an estimate within the stage.
struct PreparationProgress {
    std::string stage;
    double fraction = 0;
    std::string text;
};

/// What confines the disks or spheres: a fixed and a movable wall along each axis; a rectangular (orthorhombic) cell
/// whose periods move; such a cell whose tilts move too, without shear stresses on them (triclinic); a rectangle that
/// keeps its shape (`aspect`), under a pressure on its size. Soft grains are always compressed in a rectangle; tilts
/// begin to move with the linear programmes.
enum class PreparedCell { none, rectangular, tilted, isotropic };

/// What to prepare. The defaults of the last group suit sizes 1 ...
/// 10^5; they change the way and the cost, never what is proved.
struct PreparationOptions {
    int dimension = 2;           ///< 3: spheres
    int disks = 0;               ///< n >= 1, disks or spheres; ignored when `radii` is given
    DiameterLaw diameters{};     ///< ignored when `radii` is given
    std::vector<double> radii{}; ///< a given list, in the order of the disks
    double jitter = 0;           ///< `with_jitter`, of drawn radii and of a list
    std::uint64_t seed = 1;      ///< of radii, jitter, positions and infinitesimal loads (derived streams)
    double stress = 1;           ///< sigma_1 > 0
    double ratio = 1;            ///< sigma_2 / sigma_1 > 0 of `find_vertex`; `prepare` takes 1 only
    double aspect = 1;           ///< Ly / Lx, in space Lz / Lx = Lz / Ly, of the loose box; the final box is free
    LoadKind load = LoadKind::nominal;
    /// A cell instead of walls: at most `large_above` disks, periods of at least four diameters (in space one).
    PreparedCell cell = PreparedCell::none;
    /// What the programme will change, as `Load::loaded_axis`: by default
    /// the stress of the last axis; in tilted cells also a shear stress.
    std::optional<int> loaded_axis = {};
    std::optional<StressRates> path = {}; ///< or several stresses, as `Load::follow`

    const std::atomic<bool>* stop = nullptr;                       ///< set by Ctrl-C
    std::function<void(const PreparationProgress&)> progress = {}; ///< called now and then; neither copied nor kept

    double loose_fraction = 0; ///< solid fraction of the random start; 0: 0.6 of disks, 0.4 of spheres
    [[nodiscard]] double start_fraction() const {
        return loose_fraction != 0 ? loose_fraction : dimension == plane ? 0.6 : 0.4;
    }
    double softness = 1e-5;   ///< pressure / contact stiffness at the end of the dynamics: overlap in diameters
    double relaxation = 1e-4; ///< unbalanced force / (pressure x diameter) at the end of the dynamics
    long max_steps = 200000;  ///< of each stage of the dynamics; the next stage starts from what was reached
    double infinitesimal_weight = 1e-7; ///< eps of the linear programmes: weight of g against the mean contact force
    int max_programmes = 200;
    /// Above this number of disks the dynamics presses harder first (1e-2 of the stiffness), in patches, with fewer
    /// steps, and ends at 3 `relaxation`; an interior-point descent comes before the programmes and mostly ends at
    /// their vertex; programmes that are expected to change many contacts are solved by an interior-point method,
    /// because the number of simplex pivots grows as n (13 000 at n = 20 000, 5 ms each), that of interior-point
    /// iterations hardly (24 at 20 000, 28 at 100 000).
    int large_above = 8192;
    /// Above this number, besides, Newton steps follow the dynamics, at `softness` and down to a hundredth of it, and
    /// no programme is first tried with the simplex method (at 100 000 one with 419 changes had not ended after 330 s).
    int newton_above = 50000;
};

/// Figures of one stage of the preparation.
struct PreparationStage {
    std::string name;
    bool completed = false; ///< the stage reached its own goal
    double seconds = 0;     ///< wall clock
    double cpu_seconds = 0; ///< this process
    long iterations = 0;    ///< steps of the dynamics, pivots of the simplex method, Newton iterations
    double solid_fraction = 0;
    int contacts = 0;          ///< overlapping pairs of the dynamics; contacts of the basis
    double residual = 0;       ///< dynamics: largest unbalanced force / (pressure x diameter); Newton: largest |gap|
    double pressure_error = 0; ///< dynamics: largest relative error of the pressure on a wall
    double overlap = 0;        ///< largest overlap / mean diameter
};

/// What was done; filled after a failure too.
struct PreparationReport {
    std::vector<PreparationStage> stages;
    int programmes = 0;                   ///< linear programmes solved
    long pivots = 0;                      ///< simplex iterations in all of them
    std::uint64_t infinitesimal_seed = 0; ///< argument of `generic_infinitesimal` for the loads of the state
    double solid_fraction = 0;            ///< walls included
    int rattlers = 0;                     ///< disks that carry no force
    double min_force = 0;                 ///< smallest backbone force
    double min_gap = 0;                   ///< smallest gap of a pair that is not a contact
    double sigma_min_bound = 0;           ///< proved lower bound of the smallest singular value of H
    /// After the failures `undecided` and `tie` of `find_vertex`: contacts and configuration that are a vertex as far
    /// as rounded numbers say, but could not be proved to be one in double-double. Nothing is proved of this state;
    /// `certify` may prove it, or a run that settles ties.
    std::optional<State> candidate;
    std::optional<Packing> last; ///< after a failure: the last configuration (overlaps of the dynamics included)
};

/// A vertex under isotropic pressure from random disks.
/// 1. Radii; random positions in a loose box; disks pushed apart.
/// 2. Soft disks (pressure / stiffness = 1e-3 first) are compressed
/// by servo-controlled walls with viscous damping, then relaxed by
/// damped dynamics while the stiffness grows to 1 / softness.
/// 3. `find_vertex`.
/// \post On success the state is as described for `find_vertex` and depends on the options alone (same seed, same bits;
/// lengths scaled by a power of two give the state scaled by it). On failure `report.last` holds the last
/// configuration. Throws `Error(bad_input)` for options that make no sense, naming the field and the value. Cost: see
/// tests/bench/preparation.cpp; the dynamics takes most of it.
Result<State> prepare(const PreparationOptions& options, PreparationReport& report);

/// The vertex downhill from a nearly jammed packing in the box with two fixed and two movable walls, or with periods
/// that move instead of walls along one axis (a channel) or both (small overlaps are allowed). In a cell the disk with
/// the most overlaps or contacts is pinned, and N_f = 2n + 1 in a channel, 2n with two periods, 2n + 1 with a tilt that
/// moves (spheres: 3n with three periods, 3n + 3 with three tilts); no shear stress acts on a tilt. A tilt that does
/// not move changes only where overlaps need a dilation of everything.
///
/// Sequential linear programming: minimise F1 dLx + F2 dLy - eps g.dx, with F1 = sigma_1 Ly, F2 = sigma_2 Lx of the
/// current box (in space three forces, on areas), subject to h_l + n_l.(dx_j - dx_i) >= 0 for *all* pairs that a step
/// within the trust bounds can bring into contact. Since |d + dx| >= n.(d + dx), a step never makes an overlap. The
/// contacts are the rows with a multiplier in the basis (Clp, warm starts); once no trust bound is in the basis there
/// are exactly N_f = 2n + 2 of them (3n + 3 of spheres), and Newton solves gaps = 0.
///
/// Below its tolerances of 1e-9 the multipliers of Clp have no meaning: when Newton or the proofs fail at a converged
/// basis, exchanges of one contact at a time at the true vertex (gaps and forces in double-double) go on from this
/// basis, so that radii that differ by 1e-12 are told apart.
///
/// \post On success: N_f contacts, sorted, from the basis; coordinates on the grid; rank proved for the stored
/// coordinates; a true vertex within a proved distance; every other gap proved positive there; every force proved
/// positive, lexicographically in (f0, f1), under options.stress on the first axis and options.ratio times that on the
/// last, with the *final* lengths as reference lengths. Any of these that cannot be proved is a failure (`tie`,
/// `undecided`, `not_isostatic`, `not_converged`), never a state. Uses of `options`: seed, stress, ratio, load, stop,
/// progress, infinitesimal_weight, max_programmes.
Result<State> find_vertex(const Packing& start, const PreparationOptions& options, PreparationReport& report);

} // namespace isostat
