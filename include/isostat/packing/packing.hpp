#pragma once
/// \file
/// The grains and where they are: disks (dimension 2) or spheres (3), flat walls normal to the axes, and axes that
/// repeat.

#include <isostat/core/contact.hpp>
#include <isostat/core/machine.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
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
    /// The state of the wall of a contact. \pre the contact is with a wall
    [[nodiscard]] constexpr WallKind of(const Contact& contact) const {
        return (contact.kind == ContactKind::lower_wall ? lower : upper)[static_cast<std::size_t>(contact.j)];
    }
    /// Calls visit(contact) for a disk and every wall that is there, axis after axis.
    template <class Visit> void for_each(int dimension, int disk, Visit visit) const {
        for (int a = 0; a < dimension; ++a) {
            for (const WallFacts& wall : wall_facts) {
                if (const Contact contact(wall.kind, disk, a); of(contact) != WallKind::absent) {
                    visit(contact);
                }
            }
        }
    }
    /// The paper's box: a fixed lower and a movable upper wall on each axis.
    static Walls box(int dimension = 2);
    /// No walls at all (free clusters).
    static Walls none();
    friend bool operator==(const Walls&, const Walls&) = default;
};

/// Two members of one body, i < j, whose centres stay at a distance: |x_j - x_i| = length.
struct Bar {
    int i = 0, j = 0;
    double length = 0;
    friend constexpr auto operator<=>(const Bar&, const Bar&) = default;
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
    /// Clumps: what bars connect is one rigid body, a union of disks. Sorted; a body of K members has as many bars as
    /// make it rigid and no more (in the plane 2K - 3). Members of one body are no pair: they may overlap.
    std::vector<Bar> bars;
    /// Of bodies bounded by arcs their members, in the order in which the arcs follow each other, counterclockwise.
    /// Two neighbours have a bar of the length |R_i - R_j|, without rounding: their circles touch from within, in the
    /// joint of the arcs. Only in the plane, in boxes, and of members that are not fixed.
    std::vector<std::vector<int>> arcs;

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
    /// \pre there is a bar of these disks
    [[nodiscard]] double bar_length(int i, int j) const {
        return std::lower_bound(bars.begin(), bars.end(), Bar{i, j, 0})->length;
    }
    [[nodiscard]] double min_radius() const;
    [[nodiscard]] double max_radius() const;
    /// Sum of the grains' areas (d = 2) or volumes (d = 3) over the product of the lengths, the size of box and cell;
    /// of a body what its union, or its boundary, takes; NaN where more than two spheres of one overlap.
    [[nodiscard]] double solid_fraction() const;
    /// The same without some grains: rattlers.
    [[nodiscard]] double solid_fraction_without(std::span<const int> grains) const;
    friend bool operator==(const Packing&, const Packing&) = default;
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
    [[nodiscard]] std::size_t coordinate_of(std::size_t dof) const {
        return static_cast<std::size_t>(coordinate_of_[dof]);
    }
    /// A velocity on the degrees of freedom, written for all coordinates: 0 where nothing moves.
    [[nodiscard]] std::vector<double> on_coordinates(const std::vector<double>& on_dofs) const;
    /// Moves coordinates by a step on the degrees of freedom.
    template <class Number> void move(std::vector<Number>& coordinates, const std::vector<double>& step) const {
        for (std::size_t mu = 0; mu < step.size(); ++mu) {
            coordinates[coordinate_of(mu)] += step[mu];
        }
    }
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

/// Throws `Error(bad_input)` when there are bars: `what` takes single grains only. "FILE: a packing of clumps ..."
void require_single_grains(const Packing& packing, const std::string& source, const std::string& what);

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

} // namespace isostat
