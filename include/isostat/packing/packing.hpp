#pragma once
/// \file
/// The grains and where they are: disks (dimension 2) or spheres (3), flat walls normal to the axes, and axes that
/// repeat; and the load: F_ext = F_fixed + sigma_loaded * F_unit, plus infinitesimal loads eps*g.

#include <isostat/core/contact.hpp>
#include <isostat/core/machine.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace isostat {

/// Axes that have no walls but repeat: whatever is at x is at x + A m too, m integers, 0 along the axes with walls.
/// A is upper triangular: column a is the period vector a, A_aa = L_a the period, A_ab (a < b, both periodic) a tilt.
/// They are coordinates (`Packing::q`), and r = x_j - x_i + A m is linear in all coordinates (proofs/cells.md).
///
/// One grain is pinned along the periodic axes, as a translation of everything changes nothing: N_f = d n + (moving
/// coordinates of cell and walls) - (periodic axes). Which one is a matter of gauge, and so are the representatives.
struct Cell {
    PerAxis<bool> periodic{};
    PerAxis<bool> period_moves{}; ///< L_a of a periodic axis is a degree of freedom
    PerTilt<bool> tilt_moves{};   ///< in the order xy, xz, yz
    int pin = 0;                  ///< the grain that stays where it is along the periodic axes
    /// An isotropic cell: its one degree of freedom is its size. It is written as the last period, the only one that
    /// moves then: where all forces are positive they are the same up to a factor, and so are N_f, h and k; the shape
    /// of the cell is that of the true vertex (proofs/cells.md, C13).
    bool keeps_shape = false;
    int dimension = 2; ///< that of the packing

    /// False in a box, and where there is nothing at all: then there are no tilts in `Packing::q`.
    [[nodiscard]] bool any() const { return std::find(periodic.begin(), periodic.end(), true) != periodic.end(); }
    /// Every axis repeats.
    [[nodiscard]] bool all() const { return periodic_axes() == static_cast<std::size_t>(dimension); }
    [[nodiscard]] std::size_t periodic_axes() const {
        return static_cast<std::size_t>(std::count(periodic.begin(), periodic.end(), true));
    }
    /// Nothing moves but the size. \pre every axis is periodic
    void keep_shape() {
        keeps_shape = true;
        move(false, false);
        period_moves[static_cast<std::size_t>(dimension) - 1] = true;
    }
    /// Every axis repeats.
    void repeat() { std::fill_n(periodic.begin(), dimension, true); }
    /// Every period moves, or none does, and so do the tilts.
    void move(bool periods, bool tilts) {
        std::fill_n(period_moves.begin(), dimension, periods);
        std::fill_n(tilt_moves.begin(), Layout{dimension}.tilts(), tilts);
    }
    /// Place of the tilt A_ab, a < b, among the tilts.
    static constexpr std::size_t tilt(std::size_t a, std::size_t b) { return a + b * (b - 1) / 2; }
    /// a and b of a tilt A_ab.
    static constexpr std::array<int, 2> axes_of_tilt(std::size_t tilt) {
        return {tilt == 2 ? 1 : 0, tilt == 0 ? 1 : 2};
    }
    /// Some tilt is a degree of freedom.
    [[nodiscard]] bool shears() const {
        return any() && std::find(tilt_moves.begin(), tilt_moves.end(), true) != tilt_moves.end();
    }
    friend bool operator==(const Cell&, const Cell&) = default;
};

/// Radii are between these, in any unit, and no coordinate is larger: squares of lengths are then far inside the range
/// of double, and so are areas and their quotients.
inline constexpr double shortest_length = 1e-150;
inline constexpr double longest_length = 1e150;

/// State of one wall. A movable wall is a grain with one degree of freedom, its position along its axis.
enum class WallKind : unsigned char { absent, fixed, movable };

/// The walls: `lower[a]` at coordinate 0 of axis a (never movable), `upper[a]` at L_a.
struct Walls {
    PerAxis<WallKind> lower{};
    PerAxis<WallKind> upper{};
    /// The paper's box: a fixed lower and a movable upper wall on each axis.
    static Walls box(int dimension = 2);
    /// No walls at all (free clusters).
    static Walls none();
    friend bool operator==(const Walls&, const Walls&) = default;
};

/// Radii, walls and configuration. Lengths are in the user's unit.
///
/// Coordinates are stored flat: `q[d i + a]` is coordinate a of disk i, `q[d n + a]` is L_a, the position of the
/// upper wall of axis a, or its period where it is periodic (present in q even when that wall is absent, then
/// meaningless and 0). With periodic axes the tilts of the cell follow. A *coordinate index* is an index into q.
/// Invariant (checked by `validate`): every radius from `shortest_length` to `longest_length`, every coordinate finite,
/// those of disks, walls and cell at most `longest_length`; a periodic axis has no walls and no disk is fixed then.
struct Packing {
    int dimension = 2;          ///< d: how many axes there are
    std::vector<double> radius; ///< n radii
    std::vector<double> q;      ///< d (n + 1) coordinates, and the tilts of a cell
    Walls walls = Walls::box();
    Cell cell;                        ///< which axes repeat; none in a box
    std::vector<unsigned char> fixed; ///< empty, or n flags: 1 = this disk cannot move

    [[nodiscard]] int disk_count() const { return static_cast<int>(radius.size()); }
    [[nodiscard]] Layout layout() const { return {dimension, disk_count()}; }
    [[nodiscard]] std::size_t axes() const { return static_cast<std::size_t>(dimension); }
    [[nodiscard]] std::size_t tilts() const { return layout().tilts(); }
    [[nodiscard]] double coordinate(DiskId disk, int axis) const {
        return q[axes() * disk.index() + static_cast<std::size_t>(axis)];
    }
    /// Position L_a of the upper wall of an axis.
    [[nodiscard]] double length(int axis) const { return q[length_at(static_cast<std::size_t>(axis))]; }
    [[nodiscard]] double& length(int axis) { return q[length_at(static_cast<std::size_t>(axis))]; }
    /// Coordinate index of L_a, and of the tilt A_ab, a < b. \pre of the tilt: there are periodic axes
    [[nodiscard]] std::size_t length_at(std::size_t axis) const { return axes() * radius.size() + axis; }
    [[nodiscard]] std::size_t tilt_at(std::size_t a, std::size_t b) const {
        return length_at(axes() + Cell::tilt(a, b));
    }
    /// A_ab, a <= b: the cell as it is stored. \pre there are periodic axes
    [[nodiscard]] double lattice(std::size_t a, std::size_t b) const {
        return a == b ? q[length_at(a)] : q[tilt_at(a, b)];
    }
    /// How many coordinates q has.
    [[nodiscard]] std::size_t coordinate_count() const {
        return length_at(axes()) + (cell.any() ? tilts() : std::size_t{0});
    }
    [[nodiscard]] bool is_fixed(DiskId disk) const { return !fixed.empty() && fixed[disk.index()] != 0; }
    [[nodiscard]] double min_radius() const;
    [[nodiscard]] double max_radius() const;
    /// Sum of the grains' areas (d = 2) or volumes (d = 3) over the product of the lengths, the size of box and cell.
    [[nodiscard]] double solid_fraction() const;
    /// The same without some grains: rattlers.
    [[nodiscard]] double solid_fraction_without(std::span<const int> grains) const;
};

/// Which coordinates of a packing are degrees of freedom, numbered 0 .. N_f-1 in the order of q.
/// In the paper's box without fixed disks the numbering is the identity and N_f = 2n + 2. Along periodic axes the
/// pinned grain has none (the first one that is not fixed, where `Cell::pin` is fixed).
class DofMap {
  public:
    explicit DofMap(const Packing& packing);
    /// N_f.
    [[nodiscard]] int dof_count() const { return static_cast<int>(coordinate_of_.size()); }
    /// Coordinates of the packing, those that cannot move included.
    [[nodiscard]] int coordinate_count() const { return static_cast<int>(dof_of_.size()); }
    /// Degree of freedom of a coordinate index, or -1 when that coordinate cannot move.
    [[nodiscard]] int dof_of(std::size_t coordinate) const { return dof_of_[coordinate]; }
    /// Coordinate index of a degree of freedom.
    [[nodiscard]] int coordinate_of(int dof) const { return coordinate_of_[static_cast<std::size_t>(dof)]; }
    /// "x of disk 12", "right wall", "period along x", "tilt xy": for messages.
    [[nodiscard]] std::string name(int dof) const;
    [[nodiscard]] const Layout& layout() const { return layout_; }
    [[nodiscard]] int disk_count() const { return layout_.disks; }
    /// Along a periodic axis one disk is pinned, whichever.
    [[nodiscard]] bool is_periodic(std::size_t axis) const { return periodic_[axis]; }

  private:
    Layout layout_;
    PerAxis<bool> periodic_;
    std::vector<int> dof_of_;
    std::vector<int> coordinate_of_;
};

/// Throws `Error(bad_input)` naming the disk or wall and the value when the invariant of `Packing` does not hold, a
/// disk is larger than the box, or overlaps its own image (its diameter may be anything up to the shortest period: two
/// disks that touch through several images are no trouble). `source` (a file name) starts the message.
void validate(const Packing& packing, const std::string& source);

/// Throws `Error(bad_input)` when the grains are spheres: `what` takes disks only. "FILE: a packing of spheres ..."
void require_plane(const Packing& packing, const std::string& source, const std::string& what);

/// Throws `Error(bad_input)` when an axis is periodic: `what` takes boxes only. "FILE: a periodic cell; ..."
void require_box(const Packing& packing, const std::string& source, const std::string& what);

/// Rounds what can move to the common dyadic grid of the packing: multiples of 2^(e-52), 2^e the smallest power of two
/// that is not below any coordinate of a disk or of a wall that is there. Fixed disks and walls stay where they are, on
/// the grid or not; where all coordinates are on it, their differences are exact. Moves a coordinate by at most half a
/// grid step (2^-53 of the box); returns the largest such move. Idempotent; commutes with scaling by powers of two.
/// With periodic axes the grid is four times as coarse, of spheres eight times, so that x_j - x_i + A m is exact too
/// for |m_a| <= 3, and every coordinate is rounded: of the pinned grain, and of a cell that does not move.
double snap_to_grid(Packing& packing);

/// Whether `snap_to_grid` would leave every coordinate where it is.
bool is_on_grid(const Packing& packing);

/// The grid step that `snap_to_grid` uses.
double grid_step(const Packing& packing);

/// How a stress on a movable wall becomes a force.
/// - `nominal` (default): force = stress x *reference* length of the other axis: dead forces, W is a potential;
/// - `true_stress`: force = stress x current length: W is no potential; sum sigma_a ln L_a is one up to a factor, where
/// no disk carries a force of its own (proofs/stability.md, S5).
enum class LoadKind : unsigned char { nominal, true_stress };

/// The force on the movable wall of one axis, on a moving period or on a moving tilt, in the real numbers: minus
/// `stress` times `length` times `other`, stored numbers (proofs/definition.md). `external_force` rounds the product;
/// what decides a sign must not.
struct WallForce {
    int coordinate = 0;           ///< of the wall
    int axis = 0;                 ///< of a tilt: the one that it moves along
    double stress = 0;            ///< and `rest`: what that double lacks
    std::array<double, 2> rest{}; ///< 0 but on a `StressPath`
    double length = 0;            ///< of the other axis: the reference length, or under true stresses the present one
    int length_at = -1;           ///< true stresses: the coordinate that is that length; -1: it does not change
    double other = 1;             ///< in space the length of the third axis: the stress presses on an area
    int other_at = -1;            ///< as `length_at`
    double rate = 0;              ///< of the stress with the loaded one: 1 where it is that one, 0 where it stays
};

/// A number for each axis, then for each tilt.
using StressRates = std::array<double, most_axes + most_tilts>;

/// A path in stress space: the stresses `at` + t `rate`, in the real numbers, t the loaded stress of the programme. A
/// triaxial test at constant mean stress has the rates (-1, -1, 2).
struct StressPath {
    StressRates at{}, rate{};
    double t = 0;
    friend bool operator==(const StressPath&, const StressPath&) = default;
};

/// A stress in the real numbers: `nearest` + rest[0] + rest[1].
struct ExactStress {
    double nearest = 0;
    std::array<double, 2> rest{};
};

/// Load of a packing. Forces in the unit (stress unit x length unit); a compressive stress is positive and pushes the
/// upper wall inwards. Coordinates are indexed as in `Packing::q`.
struct Load {
    int dimension = 2; ///< that of the packing
    LoadKind kind = LoadKind::nominal;
    PerAxis<double> stress{};           ///< sigma_1, sigma_2 (axis 0, axis 1), in space sigma_3
    PerAxis<double> reference_length{}; ///< L_a at which nominal stress and strain are defined
    /// Nominal shear stresses on the tilts of a cell that move: the dead force on A_ab, a < b, is - shear times the
    /// reference lengths of all axes but b.
    PerTilt<double> shear{};
    /// A_ab of the cell at which the strain of a tilt is 0.
    PerTilt<double> reference_tilt{};
    /// The axis whose stress the programme changes (sigma_2). From `dimension` on: the shear stress on that tilt. \pre
    /// it moves.
    int loaded_axis = 1;
    /// Several stresses change together: then `stress` and `shear` are the nearest doubles, the loaded stress is t, and
    /// `loaded_axis` is the last one, the axial one of a triaxial test.
    std::optional<StressPath> path;
    std::vector<double> disk_force;    ///< empty, or d n external forces on the disks
    std::vector<double> infinitesimal; ///< empty, or d n infinitesimal loads g (the eps part)

    [[nodiscard]] bool loads_tilt() const { return loaded_axis >= dimension; }
    /// The stress that the programme changes.
    [[nodiscard]] double loaded_stress() const {
        return path ? path->t : stress_of(static_cast<std::size_t>(loaded_axis));
    }
    void set_loaded_stress(double value);
    /// From now on the programme changes the present stresses at these rates, of the axes and then of the tilts. A
    /// single one of 1 is a `loaded_axis`. \pre some rate is not 0
    void follow(const StressRates& rate);
    /// Of axis or tilt: \p place counts the axes, then the tilts.
    [[nodiscard]] double stress_of(std::size_t place) const {
        const auto axes = static_cast<std::size_t>(dimension);
        return place < axes ? stress[place] : shear[place - axes];
    }
    [[nodiscard]] ExactStress exact_stress(std::size_t place) const;
    /// By how much that stress changes with the loaded one.
    [[nodiscard]] double rate_of(std::size_t place) const {
        return path ? path->rate[place] : place == static_cast<std::size_t>(loaded_axis) ? 1 : 0;
    }
    /// Mean stress p of the axes, and deviator q: that of the last axis less the mean of the others.
    [[nodiscard]] double mean_stress() const;
    [[nodiscard]] double deviator() const;
    /// \pre `loads_tilt()`
    [[nodiscard]] std::size_t loaded_tilt() const { return static_cast<std::size_t>(loaded_axis - dimension); }
    /// The axis whose stress the ratio of a programme is taken over. Of a shear on A_ab that is b: both stresses act
    /// over the same reference area, and their ratio is that of the forces.
    [[nodiscard]] int other_axis() const {
        return loads_tilt() ? Cell::axes_of_tilt(loaded_tilt())[1] : loaded_axis == 0 ? dimension - 1 : 0;
    }
    /// On a path: the mean stress at t = 0.
    [[nodiscard]] double other_stress() const;
    [[nodiscard]] double ratio() const { return loaded_stress() / other_stress(); }
    /// What the programme changes: in the plane "sigma2" or "shear", whichever axis that is; in space by axis,
    /// "sigma3", "shear_xy", and "t" on a path. And the ratio, "sigma2/sigma1", and the strain that belongs to it,
    /// "eps2": for messages and tables.
    [[nodiscard]] std::string stress_name() const;
    [[nodiscard]] std::string ratio_name() const;
    [[nodiscard]] std::string strain_name() const;
    /// Stresses are nominal, and strains count, from where box or cell are now.
    void refer_to(const Packing& packing);
    /// Strain of an axis, or of a tilt (axes from `dimension` on): (`at_rest` - coordinate) / `strain_length`. That of
    /// A_ab is what it fell by over the reference length of b: it grows as a positive shear stress does work.
    [[nodiscard]] double at_rest(int axis) const {
        return axis >= dimension ? reference_tilt[static_cast<std::size_t>(axis - dimension)]
                                 : reference_length[static_cast<std::size_t>(axis)];
    }
    [[nodiscard]] double strain_length(int axis) const {
        return reference_length[static_cast<std::size_t>(
            axis >= dimension ? Cell::axes_of_tilt(static_cast<std::size_t>(axis - dimension))[1] : axis)];
    }

    /// What presses on the walls and on the coordinates of the cell that can move. With `disk_force` this is the load,
    /// exactly. A period takes the force of the wall that would stand there: dead forces, so W is linear in the cell.
    [[nodiscard]] std::vector<WallForce> wall_forces(const Packing& packing) const;
    /// Degrees of freedom that carry a finite load whatever the loaded stress is, ascending; and those that the loaded
    /// stress presses on (none: they cannot move, or it presses on nothing).
    [[nodiscard]] std::vector<int> loaded_rows(const Packing& packing, const DofMap& dofs) const;
    [[nodiscard]] std::vector<int> changing_rows(const Packing& packing, const DofMap& dofs) const;
    /// Calls `visit(coordinate, force)` for every external force under the current stresses, each rounded to the
    /// nearest, coordinates ascending; those that are not visited have none.
    template <class Visit> void for_each_force(const Packing& packing, const Visit& visit) const {
        for (std::size_t k = 0; k < disk_force.size(); ++k) {
            visit(k, disk_force[k]);
        }
        for (const WallForce& wall : wall_forces(packing)) {
            visit(static_cast<std::size_t>(wall.coordinate), -(wall.stress * wall.length * wall.other));
        }
    }
    /// External force on every coordinate (as many as `Packing::q` has): the same, none left out.
    [[nodiscard]] std::vector<double> external_force(const Packing& packing) const;
    /// Its derivative with respect to the loaded stress: entries on the loaded walls.
    [[nodiscard]] std::vector<double> unit_force(const Packing& packing) const;
    /// External force with the loaded stress set to 0.
    [[nodiscard]] std::vector<double> fixed_force(const Packing& packing) const;
};

/// Why stresses of this packing cannot change at these rates, of the axes and then of the tilts, in the words of a
/// user; empty: they can.
std::string fault_of_path(const Packing& packing, std::span<const double> rate);

/// Potential W = -sum F_ext . q of dead loads (nominal): decreases along every arc. Meaningless for `true_stress`.
double potential(const Packing& packing, const Load& load);

/// Generic infinitesimal loads: g_i = R_i^2 (direction + amplitude * noise), noise uniform in [-1,1]^d from `seed`,
/// direction fixed and off the walls' normals. Every disk gets one, so that rattlers rest on d contacts.
std::vector<double> generic_infinitesimal(const std::vector<double>& radius, unsigned long long seed,
                                          int dimension = 2);

/// Such loads for a cell: along periodic axes they must sum to zero, or the pinned grain would bear the rest and its
/// choice would matter. Every g is rounded to a common dyadic grid of 30 bits, and the pinned grain takes minus the sum
/// of the others, so that the sum is exactly 0. Nothing changes in a box.
void balance(std::vector<double>& infinitesimal, const Cell& cell);

/// Forces on coordinates (as above, or on the disks only) as forces on degrees of freedom: what the contacts carry.
std::vector<double> on_dofs(const std::vector<double>& on_coordinates, const DofMap& dofs);

} // namespace isostat
