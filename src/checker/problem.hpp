#pragma once
/// \file
/// A state as a square polynomial system with integer data (proofs/checker.md, notation and K1).

#include "checker/wide.hpp"

#include <isostat/contact/state.hpp>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace isostat::checker {

/// One row of the derivative: the coordinates that the contact depends on, and how. Of two disks the separation d = x_i
/// - x_j - A m has d_a = sum of `sign` times coordinate over the entries of axis a, and the entries of the row are
/// `sign` times d_axis; for walls they are +-weight on the coordinates, independent of the configuration.
struct Row {
    static constexpr std::size_t most =
        2 * most_axes + most_axes + most_tilts; ///< two grains and the entries of a cell
    bool quadratic = false;
    std::uint8_t apart = 0; ///< of two disks: how many entries those of j come after those of i
    int count = 0;
    std::array<int, most> coordinate{}; ///< quadratic: those of i, of j, then the cell; of an own image the cell alone
    std::array<int, most> sign{};       ///< of the cell -m_b
    std::array<std::uint8_t, most> axis{};

    Row(const Contact& contact, const Layout& layout);
    /// d_a of anything that has one number per coordinate. \pre quadratic
    template <class Numbers, class Number> void separate(const Numbers& of, std::size_t a, Number& d) const {
        const auto at = [this](std::size_t k) { return static_cast<std::size_t>(coordinate[k]); };
        d = 0;
        if (apart > 0) {
            d += of[at(a)];
            d -= of[at(apart + a)];
        }
        for (std::size_t k = 2 * std::size_t{apart}; k < static_cast<std::size_t>(count); ++k) {
            if (axis[k] == a) {
                d += sign[k] * of[at(k)];
            }
        }
    }
    /// The most by which d_a changes when no coordinate does by more than 1.
    [[nodiscard]] int spread(std::size_t a) const {
        int sum = apart > 0 && a < apart ? 2 : 0;
        for (std::size_t k = 2 * std::size_t{apart}; k < static_cast<std::size_t>(count); ++k) {
            sum += axis[k] == a ? std::abs(sign[k]) : 0;
        }
        return sum;
    }
    [[nodiscard]] int spread() const { return std::max({spread(0), spread(1), spread(2)}); }
    /// |d|^2: of anything as `separate`.
    template <class Numbers> [[nodiscard]] auto square(const Numbers& of, std::size_t axes) const {
        using Number = std::decay_t<decltype(of[0])>;
        Number sum = 0;
        Number d;
        for (std::size_t a = 0; a < axes; ++a) {
            separate(of, a, d);
            sum += d * d;
        }
        return sum;
    }
};

/// `Problem::digits` of the vertices of a run, most of which are passed on the way.
inline constexpr int few_digits = 56; // checker.md K4 (56 bits finer on the way)
/// The same when more are not asked for.
inline constexpr int usual_digits = 80; // checker.md K4 (80 bits finer)
/// Asked next where those do not tell, and from the beginning where radii are R_i + eps rho_i: records of such runs
/// call a number 0 only below 2^-1000, and bounds of others may end next to the number.
inline constexpr int more_digits = 320; // cost: digits with which a check is asked again
/// Of a question that stays open with fewer.
inline constexpr int most_digits = 1280; // cost: digits with which a check is asked again

/// Two lengths whose sum is the distance at which a contact, a bar or a pair is closed: radii, or the length of the bar
/// and 0; of a held coordinate zeros. \pre a bar is one of the packing
std::array<double, 2> closed_at(const Packing& packing, const Contact& contact);

/// Per disk the smallest number of a disk that bars connect with it, in one step or several.
std::vector<int> bodies_of(const Packing& packing);

/// Two members of one body, which may overlap. `body`: of `bodies_of`.
bool are_members(const std::vector<int>& body, const Contact& pair);

/// Lists of numbers in one piece of memory.
class Lists {
  public:
    Lists() = default;
    /// `entries`: the list and the number.
    Lists(std::size_t lists, const std::vector<std::pair<int, int>>& entries);
    [[nodiscard]] std::size_t size() const { return start_.size() - 1; }
    [[nodiscard]] std::span<const int> operator[](std::size_t k) const {
        return std::span(numbers_).subspan(start_[k], start_[k + 1] - start_[k]);
    }
    /// How many numbers the shortest and the longest have.
    [[nodiscard]] std::pair<std::size_t, std::size_t> lengths() const;

  private:
    std::vector<std::size_t> start_{0};
    std::vector<int> numbers_;
};

/// Which coordinates move, and what each contact depends on.
struct Structure {
    Structure(const Packing& packing, const std::vector<Contact>& contacts);
    Layout layout;                  ///< of the coordinates
    std::vector<int> dof_of;        ///< per coordinate: its degree of freedom, or -1
    std::vector<int> coordinate_of; ///< per degree of freedom
    std::vector<Row> rows;          ///< per contact
    int wall_exponent = 0;          ///< the weight of walls is 2^wall_exponent as a length
};

/// Lengths are integers in units of 2^fine: stored numbers are multiples of 2^(fine + spare), so that `spare` bits are
/// left for corrections.
class Problem : public Structure {
  public:
    /// `held_allowed`: a held coordinate is a row like that of a wall, its residual the weight times the way from its
    /// stored value.
    explicit Problem(const State& state, bool held_allowed = false, int asked = usual_digits);

    /// Empty, or why this state is outside what the checker handles.
    std::string unsupported;
    Lengths sum;    ///< per contact: R_i + R_j, R of the disk at a wall, the length of a bar
    Lengths stored; ///< coordinates
    Lengths radius;
    Lists contacts_of; ///< per degree of freedom: the contacts that touch it
    /// The same without those whose entry is 0 at every true vertex: two disks that walls, holds or being fixed keep at
    /// one coordinate (proofs/definition.md).
    Lists acting_on;
    /// Per axis: what cannot move along it, that is walls, fixed disks, or in a cell the pinned disk; and what holds
    /// coordinates. Its balance is minus the sum of all that can (K7).
    struct Immovable {
        bool periodic = false;
        std::vector<int> acting; ///< contacts with what cannot move
    };
    std::vector<Immovable> immovable;
    /// The axis along which a degree of freedom moves a disk or a wall; -1: a period or a tilt.
    [[nodiscard]] int axis_of(std::size_t dof) const;
    int most_touched = -1; ///< in a cell: the disk with the most contacts, the first of them (C9 in proofs/cells.md)
    long fine = 0;
    long spare = 0;
    int digits;           ///< bits beyond the stored ones in which the true vertex is sought
    long weight_bits = 0; ///< the weight of walls is 2^weight_bits units
    long length_bits = 0; ///< of the largest length

    [[nodiscard]] bool of_disk(int coordinate) const {
        return static_cast<std::size_t>(coordinate) < layout.of_length(0);
    }
    [[nodiscard]] int dofs() const { return static_cast<int>(coordinate_of.size()); }
    [[nodiscard]] int contacts() const { return static_cast<int>(rows.size()); }
    /// K1 (b): a row times a vector changes by at most this, times the distance, times the largest component. 8 in a
    /// box, of spheres 12.
    [[nodiscard]] unsigned long row_curvature() const { return row_curvature_; }
    /// K2: the magnitudes of a column change together by at most this times the distance: in a box twice the most
    /// contacts of two disks that touch one degree of freedom.
    [[nodiscard]] unsigned long column_curvature() const { return column_curvature_; }
    [[nodiscard]] Integer weight() const { return shifted_left(1, weight_bits); }
    /// Entry k of row l of A at a configuration, k < row.count.
    [[nodiscard]] Integer entry(int contact, int k, const Lengths& q) const;
    /// 2 F_l in squares of the unit: |x_i - x_j|^2 - (R_i + R_j)^2, or 2 weight gap; of all contacts. The memory of
    /// `residuals` is used again. `Number`: that of the lengths.
    template <class Number>
    [[nodiscard]] std::vector<Product<Number>> twice_residuals(const std::vector<Number>& q,
                                                               std::vector<Product<Number>> residuals = {}) const;
    /// A force per length g_l as a force: times R_i + R_j at the true vertex, times the weight at a wall.
    [[nodiscard]] Rational force_factor(int contact) const { return length(force_units(contact)); }
    [[nodiscard]] Integer force_units(int contact) const;
    /// A length in units as a rational.
    [[nodiscard]] Rational length(const Integer& units) const { return Rational(units) * power_of_two(fine); }

  private:
    /// \pre `fine` is known.
    template <class Number> void find_lengths(const State& state);
    void find_contacts_of(const State& state);
    void find_immovable(const State& state);
    unsigned long row_curvature_ = 0;
    unsigned long column_curvature_ = 0;
};

} // namespace isostat::checker
