#pragma once
// What is true of a state, to the digits of a number type: Newton to the vertex, dense elimination, brute force over
// all pairs, in a periodic cell over all images that can be the nearest. A number below `negligible` of its scale is
// taken for 0.

#include "oracle/geometry.hpp"

#include <Eigen/Dense>
#include <boost/multiprecision/mpfr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace isostat::oracle {

template <unsigned Digits>
using Decimal = boost::multiprecision::number<
    boost::multiprecision::mpfr_float_backend<Digits, boost::multiprecision::allocate_stack>,
    boost::multiprecision::et_off>;

/// 10 to minus a share of the digits of the type.
template <class Real> Real power_of_ten(double share) {
    using std::pow;
    return pow(Real(10), -static_cast<int>(share * std::numeric_limits<Real>::digits10));
}

template <class Real> inline const Real negligible = power_of_ten<Real>(0.75);

/// -1, 0, +1.
template <class Real> int sign_of(const Real& x, const Real& scale) {
    return abs(x) <= negligible<Real> * scale ? 0 : x > 0 ? 1 : -1;
}

/// Square, row by row, with LU factors made by partial pivoting.
template <class Real> class SquareMatrix {
  public:
    explicit SquareMatrix(std::size_t n) : n_(n), entry_(n * n, Real(0)), order_(n) {}
    Real& operator()(std::size_t i, std::size_t j) { return entry_[i * n_ + j]; }
    const Real& operator()(std::size_t i, std::size_t j) const { return entry_[i * n_ + j]; }
    [[nodiscard]] std::size_t size() const { return n_; }

    /// False: singular to two thirds of the digits.
    bool factorise() {
        const Real singular = power_of_ten<Real>(2.0 / 3);
        for (std::size_t k = 0; k < n_; ++k) {
            order_[k] = k;
        }
        for (std::size_t k = 0; k < n_; ++k) {
            std::size_t pivot = k;
            for (std::size_t i = k + 1; i < n_; ++i) {
                pivot = abs((*this)(i, k)) > abs((*this)(pivot, k)) ? i : pivot;
            }
            if (abs((*this)(pivot, k)) < singular) {
                return false;
            }
            if (pivot != k) {
                std::swap_ranges(entry_.begin() + static_cast<std::ptrdiff_t>(k * n_),
                                 entry_.begin() + static_cast<std::ptrdiff_t>((k + 1) * n_),
                                 entry_.begin() + static_cast<std::ptrdiff_t>(pivot * n_));
                std::swap(order_[k], order_[pivot]);
            }
            for (std::size_t i = k + 1; i < n_; ++i) {
                if ((*this)(i, k) == 0) {
                    continue;
                }
                const Real factor = (*this)(i, k) /= (*this)(k, k);
                for (std::size_t j = k + 1; j < n_; ++j) {
                    if ((*this)(k, j) != 0) {
                        (*this)(i, j) -= factor * (*this)(k, j);
                    }
                }
            }
        }
        return true;
    }
    [[nodiscard]] std::vector<Real> solve(const std::vector<Real>& right) const {
        std::vector<Real> x(n_);
        for (std::size_t i = 0; i < n_; ++i) {
            x[i] = right[order_[i]];
            for (std::size_t j = 0; j < i; ++j) {
                x[i] -= (*this)(i, j) * x[j];
            }
        }
        for (std::size_t i = n_; i-- > 0;) {
            for (std::size_t j = i + 1; j < n_; ++j) {
                x[i] -= (*this)(i, j) * x[j];
            }
            x[i] /= (*this)(i, i);
        }
        return x;
    }

  private:
    std::size_t n_;
    std::vector<Real> entry_;
    std::vector<std::size_t> order_;
};

/// One end of the interval of the loaded stress in which no finite force is negative.
template <class Real> struct LoadEnd {
    bool unbounded = true;
    Real stress = 0;
    std::vector<int> opens; ///< contacts whose force vanishes there and decreases beyond
};

/// A pair that is not a contact of the list.
template <class Real> struct NearPair {
    Contact pair;
    Real gap;
    bool can_move = false; ///< relative to each other
};

enum class At { vertex, stored };

/// Everything below is of the true vertex, or of the stored coordinates; \pre `known`, but for `gap`.
template <class Real> class TruthIn : public Geometry<Real> {
  public:
    using Geometry<Real>::axes, Geometry<Real>::gap, Geometry<Real>::of_disk, Geometry<Real>::q, Geometry<Real>::tilt,
        Geometry<Real>::wall;
    using Vector = std::vector<Real>;
    using End = LoadEnd<Real>;
    using OtherPair = NearPair<Real>;

    explicit TruthIn(const State& state, At where = At::vertex);

    bool known = false;  ///< Newton converged nearby, and the matrix is regular there
    std::string why;     ///< when not
    Real moved = 0;      ///< largest difference of a coordinate from the stored one
    Real stored_gap = 0; ///< largest |gap| of a contact at the stored coordinates
    Vector force, rate;  ///< at the stored load, and per unit of the loaded stress of axes
    Vector infinitesimal;
    Real force_scale = 0;
    std::vector<OtherPair> others; ///< by increasing gap
    End low, high;                 ///< of an equilibrium

    /// +1: positive in the lexicographic order of (finite, infinitesimal); -1: negative; 0: both are 0.
    [[nodiscard]] int sign(std::size_t contact) const;
    /// Smallest gap of a pair that can move relative to each other.
    [[nodiscard]] const OtherPair* nearest() const;
    /// +1: every force positive, every other gap positive; -1: a force is negative, a pair overlaps, or a coordinate is
    /// held, which is no contact; 0: neither.
    [[nodiscard]] int equilibrium() const;
    /// The same where a held coordinate counts as at rest when its multiplier is 0: what a run may start from.
    [[nodiscard]] int at_rest() const;
    /// Contacts that the rule `most_negative` may open: those with the smallest force below 0, held ones counting with
    /// minus the magnitude; of the infinitesimal forces where no finite one is negative. Empty: none is negative.
    [[nodiscard]] std::vector<Contact> most_negative() const;
    [[nodiscard]] int dof_count() const { return static_cast<int>(coordinate_.size()); }
    /// Smallest singular value of the contact matrix, to 10 digits or so.
    [[nodiscard]] double singular_value() const;
    /// H, one column per contact.
    [[nodiscard]] SquareMatrix<Real> contact_matrix() const;

  private:
    [[nodiscard]] bool moves(std::size_t coordinate) const;
    [[nodiscard]] bool can_move(const Contact& pair) const;
    /// Images of all pairs that can be the nearest, those that overlap among them.
    [[nodiscard]] std::vector<Contact> near_images() const;
    void find_dofs();
    bool newton();
    void find_forces();
    void find_other_pairs();
    void find_interval();
    /// Of the degrees of freedom alone: visit(dof, value).
    template <class Visit> void gradient(const Contact& c, Visit visit) const {
        Geometry<Real>::gradient(c, [&](std::size_t coordinate, const Real& value) {
            if (dof_[coordinate] >= 0) {
                visit(static_cast<std::size_t>(dof_[coordinate]), value);
            }
        });
    }

    const State* state_;
    std::vector<int> dof_;        ///< per coordinate, or -1
    std::vector<int> coordinate_; ///< per degree of freedom
};

template <class Real> bool TruthIn<Real>::moves(std::size_t coordinate) const {
    const auto& p = state_->packing;
    const std::size_t disk = coordinate / axes();
    if (disk < p.radius.size()) {
        const bool pinned = p.cell.periodic[coordinate % axes()] && static_cast<int>(disk) == p.cell.pin;
        return !pinned && (p.fixed.empty() || p.fixed[disk] == 0);
    }
    const std::size_t number = coordinate - wall(0);
    return number < axes() ? p.walls.upper[number] == WallKind::movable || p.cell.period_moves[number]
                           : p.cell.tilt_moves[number - axes()];
}

/// A disk and its own image move with the cell alone.
template <class Real> bool TruthIn<Real>::can_move(const Contact& pair) const {
    const auto& p = state_->packing;
    if (pair.i == pair.j) {
        for (std::size_t b = 0; b < axes(); ++b) {
            bool period = moves(wall(static_cast<int>(b)));
            for (std::size_t a = 0; a < b; ++a) {
                period = period || moves(tilt(a, b));
            }
            if (pair.image.m[b] != 0 && period) {
                return true;
            }
        }
        return false;
    }
    const auto free = [&p](int i) { return p.fixed.empty() || p.fixed[static_cast<std::size_t>(i)] == 0; };
    return free(pair.i) || free(pair.j);
}

template <class Real> void TruthIn<Real>::find_dofs() {
    const auto& p = state_->packing;
    for (std::size_t k = 0; k < p.q.size(); ++k) {
        dof_.push_back(moves(k) ? static_cast<int>(coordinate_.size()) : -1);
        if (moves(k)) {
            coordinate_.push_back(static_cast<int>(k));
        }
    }
}

template <class Real> SquareMatrix<Real> TruthIn<Real>::contact_matrix() const {
    SquareMatrix<Real> h(coordinate_.size());
    for (std::size_t l = 0; l < state_->contacts.size(); ++l) {
        gradient(state_->contacts[l], [&](std::size_t dof, const Real& value) { h(dof, l) = -value; });
    }
    return h;
}

template <class Real> bool TruthIn<Real>::newton() {
    const std::size_t n = coordinate_.size();
    const Real unit = state_->packing.min_radius();
    for (int iteration = 0; iteration < 14; ++iteration) {
        Vector residual(n);
        Real worst = 0;
        SquareMatrix<Real> rows(n);
        for (std::size_t l = 0; l < n; ++l) {
            residual[l] = gap(state_->contacts[l]);
            worst = std::max(worst, Real(abs(residual[l])));
            gradient(state_->contacts[l], [&](std::size_t dof, const Real& value) { rows(l, dof) = value; });
        }
        stored_gap = iteration == 0 ? worst : stored_gap;
        if (worst < unit * power_of_ten<Real>(0.9)) {
            return true;
        }
        if (!(worst < unit) || !rows.factorise()) {
            why = "no Newton step";
            return false;
        }
        const Vector step = rows.solve(residual);
        for (std::size_t mu = 0; mu < n; ++mu) {
            q[static_cast<std::size_t>(coordinate_[mu])] -= step[mu];
        }
    }
    why = "Newton does not converge";
    return false;
}

template <class Real> void TruthIn<Real>::find_forces() {
    const auto& load = state_->load;
    const std::size_t n = coordinate_.size();
    SquareMatrix<Real> h = contact_matrix();
    if (!h.factorise()) {
        known = false;
        why = "singular";
        return;
    }
    Vector finite(n, Real(0)), unit(n, Real(0)), small(n, Real(0));
    const auto add = [this](Vector& to, std::size_t coordinate, const Real& value) {
        if (dof_[coordinate] >= 0) {
            to[static_cast<std::size_t>(dof_[coordinate])] += value;
        }
    };
    for (std::size_t k = 0; k < load.disk_force.size(); ++k) {
        add(finite, k, Real(load.disk_force[k]));
    }
    for (std::size_t k = 0; k < load.infinitesimal.size(); ++k) {
        add(small, k, Real(load.infinitesimal[k]));
    }
    // The size of a wall, or of the sides that a tilt shears: all lengths but one.
    const auto without = [&](std::size_t axis, bool now) {
        Real size = 1;
        for (std::size_t a = 0; a < axes(); ++a) {
            size *= a == axis ? Real(1) : now ? q[wall(static_cast<int>(a))] : Real(load.reference_length[a]);
        }
        return size;
    };
    for (std::size_t b = 1; b < axes() && state_->packing.cell.any(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            add(finite, tilt(a, b), -Real(load.shear[a + b * (b - 1) / 2]) * without(b, false));
        }
    }
    for (int a = 0; a < static_cast<int>(axes()); ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const Real length = without(axis, load.kind != LoadKind::nominal);
        add(finite, wall(a), -Real(load.stress[axis]) * length);
        add(unit, wall(a), -Real(load.rate_of(axis)) * length);
    }
    force = h.solve(finite);
    rate = h.solve(unit);
    infinitesimal = h.solve(small);
    for (const Vector* x : {&finite, &force}) {
        for (const Real& f : *x) {
            force_scale = std::max(force_scale, Real(abs(f)));
        }
    }
}

template <class Real> std::vector<Contact> TruthIn<Real>::near_images() const {
    const auto& p = state_->packing;
    std::vector<std::pair<double, Contact>> found; // gaps in double: only those that are not far from the smallest
    if (!p.cell.any()) {
        return {};
    }
    const std::size_t d = axes();
    // The lattice (upper triangle) and its inverse, whose rows are one over the heights of the cell long.
    Eigen::Matrix3d lattice = Eigen::Matrix3d::Identity();
    double reach = 2 * p.max_radius(); // |r| is below it for one image at least of any disk and its own
    for (std::size_t b = 0; b < d; ++b) {
        const auto column = static_cast<Eigen::Index>(b);
        for (std::size_t a = 0; a <= b; ++a) {
            lattice(static_cast<Eigen::Index>(a), column) =
                static_cast<double>(q[a == b ? wall(static_cast<int>(a)) : tilt(a, b)]);
        }
        reach += p.cell.periodic[b] ? lattice.col(column).norm() : 0;
    }
    const Eigen::Matrix3d inverse = lattice.inverse();
    std::array<int, most_axes> most{0, 0, 0}; // images on either side
    for (std::size_t a = 0; a < d; ++a) {
        most[a] =
            p.cell.periodic[a] ? static_cast<int>(reach * inverse.row(static_cast<Eigen::Index>(a)).norm()) + 1 : 0;
    }
    const auto centre = [&](int i) {
        Eigen::Vector3d x = Eigen::Vector3d::Zero();
        for (std::size_t a = 0; a < d; ++a) {
            x[static_cast<Eigen::Index>(a)] = static_cast<double>(q[of_disk(i) + a]);
        }
        return x;
    };
    double smallest = HUGE_VAL;
    const auto visit = [&](int i, int j, const Eigen::Vector3d& apart, const std::array<int, most_axes>& m) {
        Image image;
        Eigen::Vector3d r = apart;
        for (std::size_t a = 0; a < d; ++a) {
            image.m[a] = static_cast<std::int8_t>(m[a]);
            r += m[a] * lattice.col(static_cast<Eigen::Index>(a));
        }
        const Contact pair(ContactKind::disk_disk, i, j, image);
        if (i == j && !(pair.image > Image{})) {
            return;
        }
        const double rounded = r.norm() - p.radius[static_cast<std::size_t>(i)] - p.radius[static_cast<std::size_t>(j)];
        const bool listed = std::ranges::find(state_->contacts, pair) != state_->contacts.end();
        smallest = !listed && can_move(pair) ? std::min(smallest, rounded) : smallest;
        found.emplace_back(rounded, pair);
    };
    for (int i = 0; i < p.disk_count(); ++i) {
        for (int j = i; j < p.disk_count(); ++j) {
            const Eigen::Vector3d apart = centre(j) - centre(i), periods = inverse * apart;
            std::array<int, most_axes> nearby{0, 0, 0};
            for (std::size_t a = 0; a < d; ++a) {
                nearby[a] = most[a] > 0 ? -static_cast<int>(std::round(periods[static_cast<Eigen::Index>(a)])) : 0;
            }
            for (int m = -most[0]; m <= most[0]; ++m) {
                for (int k = -most[1]; k <= most[1]; ++k) {
                    for (int l = -most[2]; l <= most[2]; ++l) {
                        visit(i, j, apart, {nearby[0] + m, nearby[1] + k, nearby[2] + l});
                    }
                }
            }
        }
    }
    std::vector<Contact> near;
    for (const auto& [rounded, pair] : found) {
        if (rounded <= std::max(smallest, 0.0) + 1e-6 * p.min_radius()) {
            near.push_back(pair);
        }
    }
    return near;
}

template <class Real> void TruthIn<Real>::find_other_pairs() {
    const auto& p = state_->packing;
    const auto listed = [this](const Contact& c) {
        return std::ranges::find(state_->contacts, c) != state_->contacts.end();
    };
    const auto add = [&](const Contact& c, bool can_move) {
        if (!listed(c)) {
            others.push_back({c, gap(c), can_move});
        }
    };
    const auto free = [&p](int i) { return p.fixed.empty() || p.fixed[static_cast<std::size_t>(i)] == 0; };
    for (int i = 0; i < p.disk_count(); ++i) {
        for (int j = i + 1; j < p.disk_count() && !p.cell.any(); ++j) {
            add({ContactKind::disk_disk, i, j}, can_move({ContactKind::disk_disk, i, j}));
        }
        for (int a = 0; a < p.dimension; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            if (p.walls.lower[axis] != WallKind::absent) {
                add({ContactKind::lower_wall, i, a}, free(i));
            }
            if (p.walls.upper[axis] != WallKind::absent) {
                add({ContactKind::upper_wall, i, a}, free(i) || p.walls.upper[axis] == WallKind::movable);
            }
        }
    }
    for (const Contact& pair : near_images()) {
        add(pair, can_move(pair));
    }
    std::ranges::sort(others, [](const auto& x, const auto& y) { return x.gap < y.gap; });
}

template <class Real> int TruthIn<Real>::sign(std::size_t contact) const {
    const int finite = sign_of(force[contact], force_scale);
    return finite != 0 ? finite : sign_of(infinitesimal[contact], Real(1));
}

template <class Real> auto TruthIn<Real>::nearest() const -> const OtherPair* {
    for (const OtherPair& other : others) {
        if (other.can_move) {
            return &other;
        }
    }
    return nullptr;
}

template <class Real> int TruthIn<Real>::equilibrium() const {
    const bool holds =
        std::ranges::any_of(state_->contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
    return holds ? -1 : at_rest();
}

template <class Real> std::vector<Contact> TruthIn<Real>::most_negative() const {
    for (const bool finite : {true, false}) {
        const Vector& f = finite ? force : infinitesimal;
        const Real scale = finite ? force_scale : Real(1);
        std::vector<Contact> smallest;
        Real least = 0;
        for (std::size_t l = 0; l < f.size(); ++l) {
            if (!finite && sign_of(force[l], force_scale) != 0) {
                continue;
            }
            const bool held = state_->contacts[l].kind == ContactKind::held;
            const Real key = held ? Real(-abs(f[l])) : f[l];
            if (sign_of(key, scale) >= 0) {
                continue;
            }
            if (smallest.empty() || sign_of(key - least, scale) < 0) {
                least = key;
                smallest.clear();
            }
            if (sign_of(key - least, scale) == 0) {
                smallest.push_back(state_->contacts[l]);
            }
        }
        if (!smallest.empty()) {
            return smallest;
        }
    }
    return {};
}

template <class Real> double TruthIn<Real>::singular_value() const {
    const SquareMatrix<Real> h = contact_matrix();
    const auto n = static_cast<Eigen::Index>(h.size());
    Eigen::MatrixXd m(n, n);
    for (std::size_t i = 0; i < h.size(); ++i) {
        for (std::size_t j = 0; j < h.size(); ++j) {
            m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = static_cast<double>(h(i, j));
        }
    }
    return Eigen::JacobiSVD<Eigen::MatrixXd>(m).singularValues().minCoeff();
}

template <class Real> int TruthIn<Real>::at_rest() const {
    bool all_positive = true;
    for (std::size_t l = 0; l < force.size(); ++l) {
        if (state_->contacts[l].kind == ContactKind::held) {
            if (sign(l) != 0) {
                return -1;
            }
            continue;
        }
        if (sign(l) < 0) {
            return -1;
        }
        all_positive = all_positive && sign(l) > 0;
    }
    for (const OtherPair& other : others) {
        const int s = sign_of(other.gap, Real(state_->packing.min_radius()));
        if (s < 0) {
            return -1;
        }
        all_positive = all_positive && (s > 0 || !other.can_move);
    }
    return all_positive ? 1 : 0;
}

template <class Real> void TruthIn<Real>::find_interval() {
    const Real sigma = state_->load.loaded_stress();
    Real rates = 0;
    for (const Real& r : rate) {
        rates = std::max(rates, Real(abs(r)));
    }
    for (const int direction : {-1, 1}) {
        End& end = direction < 0 ? low : high;
        Real nearest_distance = 0;
        for (std::size_t l = 0; l < force.size(); ++l) {
            if (sign_of(rate[l] * direction, rates) >= 0) {
                continue;
            }
            const Real distance = force[l] / abs(rate[l]);
            const Real scale = abs(sigma) + abs(distance);
            if (end.unbounded || distance < nearest_distance - negligible<Real> * scale) {
                end.opens.clear();
                nearest_distance = distance;
            }
            if (end.unbounded || distance <= nearest_distance + negligible<Real> * scale) {
                end.opens.push_back(static_cast<int>(l));
            }
            end.unbounded = false;
        }
        end.stress = sigma + direction * nearest_distance;
    }
}

template <class Real>
TruthIn<Real>::TruthIn(const State& state, At where) : Geometry<Real>(state.packing), state_(&state) {
    find_dofs();
    if (coordinate_.size() != state.contacts.size() || coordinate_.empty()) {
        why = "N is not N_f";
        return;
    }
    known = where == At::stored || newton();
    if (known) {
        find_forces();
    }
    if (!known) {
        return;
    }
    for (std::size_t k = 0; k < q.size(); ++k) {
        moved = std::max(moved, Real(abs(q[k] - Real(state.packing.q[k]))));
    }
    find_other_pairs();
    find_interval();
}

/// 200 digits: 668 bits.
using Real = Decimal<200>;
using Truth = TruthIn<Real>;

} // namespace isostat::oracle
