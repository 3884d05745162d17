#include "certificate/held_minimum.hpp"

#include "certificate/parts.hpp"
#include "contact/separation.hpp"
#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/bodies.hpp"
#include "verified/vertex_bounds.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

// exact: all other numbers of this file: coordinates of a body

namespace isostat {

namespace {

using roundoff::u;

// arcs.md A8, sums of non-negative terms are raised by it
constexpr double up = 1 + 1e-9; // sums over coordinates and products of bounds, three deep (B1)

/// Velocities on which one held coordinate moves at the rate 1 and no other row changes.
struct HeldMotion {
    std::vector<double> v; // on coordinates
    double size = 0;       // 2-norm
    double residual = 0;   // 2-norm of G v - e at the stored configuration
    double terms = 0;      // 2-norm of the sums of the sizes of the terms of G v
};

/// \pre the row `slot` is of a held coordinate. Cost: a solve.
HeldMotion motion_of(const Vertex& vertex, std::size_t slot) {
    const auto& contacts = vertex.structure.contacts();
    std::vector<double> on_dofs(contacts.size(), 0.0);
    on_dofs[slot] = 1;
    vertex.factorisation.solve_velocities(on_dofs);
    std::ranges::transform(on_dofs, on_dofs.begin(), std::negate());
    HeldMotion motion{vertex.structure.dofs().on_coordinates(on_dofs)};
    motion.size = euclidean_norm(on_dofs) * up;
    double residual = 0, terms = 0;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const auto rate = gap_gradient(vertex.packing, contacts[l]).rate(motion.v, l == slot ? -1.0 : 0.0);
        // clumps.md U8, a product of a row with velocities
        const double bound = std::abs(rate.value) + 24 * u * rate.terms;
        residual += bound * bound;
        terms += rate.terms * rate.terms;
    }
    motion.residual = std::sqrt(residual) * up;
    motion.terms = std::sqrt(terms) * up;
    return motion;
}

double norm_of(const std::vector<double>& x) {
    return std::sqrt(Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x)).squaredNorm()) * up;
}

constexpr std::size_t most_mechanisms = 256; // cost: eigenvalues of more are not said

/// Eigenvalues x of (form - x columns^T columns), ascending, whatever form is within `error`, entry by entry, and the
/// columns within `off` (Frobenius norm): in the basis that makes both forms diagonal, as it is computed, by Weyl's
/// inequality: |x - x~| <= (o + |x~| s) / (1 - s), o and s what the forms are from their diagonals (U8).
std::vector<Enclosure> eigenvalues(const Eigen::MatrixXd& form, const Eigen::MatrixXd& error,
                                   const Eigen::MatrixXd& columns, double off) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(form, columns.transpose() * columns);
    if (solver.info() != Eigen::Success) {
        return std::vector<Enclosure>(static_cast<std::size_t>(form.rows()), Enclosure{0, roundoff::infinity});
    }
    const Eigen::MatrixXd& q = solver.eigenvectors();
    const Eigen::VectorXd& values = solver.eigenvalues();
    const auto norm = [](const Eigen::MatrixXd& m) { return m.cwiseAbs().rowwise().sum().maxCoeff(); };
    // clumps.md U8, two products after each other
    const double roundings = 4 * static_cast<double>(columns.rows() + 2) * u;
    const Eigen::MatrixXd size = q.cwiseAbs();
    const Eigen::MatrixXd rest = q.transpose() * form * q - Eigen::MatrixXd(values.asDiagonal());
    const double open = norm(rest.cwiseAbs() + size.transpose() * (error + roundings * form.cwiseAbs()) * size) * up;
    const Eigen::MatrixXd turned = columns * q;
    const double moved = (off + roundings * columns.norm()) * q.norm() * up;
    const double stretch = (norm(turned.transpose() * turned - Eigen::MatrixXd::Identity(q.rows(), q.rows())) +
                            roundings * turned.squaredNorm() + (2 * turned.norm() + moved) * moved) *
                           up;
    std::vector<Enclosure> all;
    for (const double value : values) {
        all.push_back(
            {value, stretch < 1 ? (open + std::abs(value) * stretch) / (1 - stretch) * up : roundoff::infinity});
    }
    return all;
}

/// The proof for held coordinates that move by a `reach`, on which the configuration moves by at most `way` (2-norms).
class HeldForm {
  public:
    HeldForm(const Vertex& vertex, const Load& load, const std::vector<std::size_t>& acting)
        : vertex_(vertex), contacts_(vertex.structure.contacts()), load_(load), acting_(acting),
          lipschitz_(lipschitz(vertex.packing, contacts_)), arcs_(vertex.packing),
          force_size_(force_norm(vertex, load.loaded_stress())) {
        for (const std::size_t slot : acting_) {
            motions_.push_back(motion_of(vertex, slot));
        }
    }

    std::optional<HeldMinimum> prove(double way, double nearest, double off) {
        const double open = std::min(arcs_.below(nearest), vertex_.packing.max_radius());
        if (!(open > far_weight(vertex_.packing, open) * (way + 2 * vertex_.enclosure.distance()) * up) ||
            !stay_in_sectors(way) || !look_at(way) || !forces_stay_positive()) {
            return {};
        }
        const double reach = way / fastest();
        find_form();
        const Eigen::Index k = form_.rows();
        const Enclosure least = eigenvalues(form_, error_, Eigen::MatrixXd::Identity(k, k), 0).front();
        const double curvature = (least.value - least.radius) / up;
        const double step = newton_step();
        if (!(curvature > 0) || !(step < 0.49 * reach) || !(off * up < reach)) { // clumps.md U8, below a half
            return {};
        }
        nearer_ = 2 * step * fastest() * up;
        HeldMinimum minimum{(vertex_.enclosure.distance() + nearer_) * up, curvature};
        for (Eigen::Index i = 0; i < k; ++i) {
            for (Eigen::Index j = i; j < k; ++j) {
                const double wide = error_(i, j) * up + std::abs(form_(i, j)) * 2 * u; // of the sums that are the ends
                minimum.form.push_back({form_(i, j) - wide, form_(i, j) + wide});
            }
        }
        return minimum;
    }

    /// Rates and eigenvalues at the minimum that was proved last.
    void describe(HeldMinimum& minimum) {
        (void)look_at(nearer_); // nearer than what was looked at before
        find_form();
        find_rates(minimum);
        find_variation(minimum);
    }

    /// The motions become one, along which d2W is least as far as double tells. \return d2W/ds2, s its fastest
    /// coordinate
    Enclosure least_curvature() {
        find_form();
        const Eigen::VectorXd least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(form_).eigenvectors().col(0);
        HeldMotion sum{std::vector<double>(vertex_.packing.q.size(), 0.0)};
        for (std::size_t i = 0; i < motions_.size(); ++i) {
            const HeldMotion& m = motions_[i];
            const double share = least(static_cast<Eigen::Index>(i)) / least.cwiseAbs().maxCoeff();
            for (std::size_t c = 0; c < sum.v.size(); ++c) {
                sum.v[c] += share * m.v[c];
            }
            sum.size += std::abs(share) * m.size * up;
            sum.residual +=
                // the roundings of a sum of m motions (clumps.md, U4)
                std::abs(share) * (m.residual + 2 * static_cast<double>(motions_.size()) * u * m.terms) * up;
        }
        const double fastest = Eigen::Map<const Eigen::ArrayXd>(sum.v.data(), std::ssize(sum.v)).abs().maxCoeff();
        motions_ = {std::move(sum)};
        const bool regular = look_at(0);
        const double slowest = fastest - velocity_error(motions_[0]); // of that coordinate
        if (!regular || !(slowest > 0)) {
            return {0, roundoff::infinity};
        }
        find_form();
        const double slower = slowest / fastest;
        // clumps.md U4, W'' over the square of the fastest coordinate
        const double off = error_(0, 0) + std::abs(form_(0, 0)) * (1 - slower * slower + 8 * u);
        // clumps.md U4, W'' over the square of the fastest coordinate
        return {form_(0, 0) / (fastest * fastest), off * (1.001 / (slowest * slowest))};
    }

  private:
    /// What the matrix and the forces change by within a `way`; false: the matrix is not proved regular there, or the
    /// lengths on which the load depends may change much.
    bool look_at(double way) {
        way_ = way;
        turned_ = (vertex_.statics.normal_uncertainty() + lipschitz_ * way) * up;
        sigma_min_ = (vertex_.inverse.sigma_min - turned_) / up;
        strain_ = 0;
        for (std::size_t a = 0; follows_ && a < vertex_.packing.axes(); ++a) {
            const double length = std::max(0.0, vertex_.packing.q[vertex_.packing.length_at(a)]);
            strain_ = std::max(strain_, (way + vertex_.enclosure.distance()) / length * up);
        }
        force_changes_ = change_of(force_size_, norm_of(load_.external_force(vertex_.packing)));
        return sigma_min_ > 0 && strain_ < 1.0 / 64; // clumps.md U8, the strain that is allowed
    }
    /// Of forces of that norm, which balance a load of that norm, within the way: a load under true stresses is one or
    /// two lengths, and changes by less than 2.5 times their strain.
    [[nodiscard]] double change_of(double forces, double load) const {
        // clumps.md U8, what a load under true stresses changes by
        return (lipschitz_ * way_ * forces + 2.5 * strain_ * load) / sigma_min_ * up;
    }
    [[nodiscard]] bool stay_in_sectors(double way) const {
        const double distance = vertex_.enclosure.distance();
        const double moved = (way + distance) * up;
        return !arcs_.any() ||
               (distance < way / 16 && moved < arcs_.farthest() && // clumps.md U9, the stored place
                std::ranges::all_of(contacts_, [&](const Contact& contact) { return arcs_.faces(contact, moved); }));
    }
    [[nodiscard]] Enclosure force(std::size_t l) const {
        return vertex_.statics.force(ContactId(l), load_.loaded_stress());
    }

    [[nodiscard]] bool forces_stay_positive() const {
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            const Enclosure f = force(l);
            if (contacts_[l].is_unilateral() && !(f.value > (f.radius + force_changes_) * up)) {
                return false;
            }
        }
        return true;
    }

    /// |B mu| (2-norm), B an inverse of the form as double computes it, mu the multipliers; infinite where |1 - B M|
    /// may exceed a quarter within reach.
    [[nodiscard]] double newton_step() const {
        const Eigen::Index k = form_.rows();
        const Eigen::MatrixXd inverse = form_.inverse();
        const Eigen::MatrixXd size = inverse.cwiseAbs();
        const double roundings = static_cast<double>(k + 4) * u; // clumps.md U8, a product with k terms
        Eigen::VectorXd multiplier(k);
        Eigen::VectorXd open(k);
        for (Eigen::Index i = 0; i < k; ++i) {
            const Enclosure f = force(acting_[static_cast<std::size_t>(i)]);
            multiplier(i) = f.value;
            open(i) = f.radius + roundings * std::abs(f.value);
        }
        const Eigen::MatrixXd rest = (Eigen::MatrixXd::Identity(k, k) - inverse * form_).cwiseAbs() +
                                     size * (error_ + roundings * form_.cwiseAbs());
        const Eigen::VectorXd step = (inverse * multiplier).cwiseAbs() + size * open;
        // clumps.md U8, the defect of the inverse
        return rest.norm() * up < 0.25 ? step.norm() * up : roundoff::infinity;
    }

    /// The most that the configuration moves (2-norm) where the held coordinates move by 1, anywhere within reach.
    [[nodiscard]] double fastest() const {
        double square = 0;
        for (const HeldMotion& m : motions_) {
            const double most = m.size + velocity_error(m);
            square += most * most;
        }
        return std::sqrt(square) * up;
    }

    /// |v - v~| of a motion, anywhere within reach.
    [[nodiscard]] double velocity_error(const HeldMotion& m) const {
        return (m.residual + turned_ * m.size) / sigma_min_ * up;
    }

    /// d2W = - sum f_l D_l v_i . D_l v_j / D_l, as the kept gaps do not change, and under true stresses the second
    /// derivative of the area times their potential, F_a / L_a on the lengths: and by how much it may be off, anywhere
    /// within reach.
    void find_form() {
        const auto k = static_cast<Eigen::Index>(motions_.size());
        form_ = error_ = Eigen::MatrixXd::Zero(k, k);
        Eigen::MatrixXd at(k, static_cast<Eigen::Index>(most_axes)); // D_l v
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            if (!contacts_[l].of_disks()) {
                continue;
            }
            for (Eigen::Index i = 0; i < k; ++i) {
                const auto rate =
                    separation(vertex_.packing.layout(), motions_[static_cast<std::size_t>(i)].v, contacts_[l]);
                at.row(i) = Eigen::Map<const Eigen::RowVectorXd>(rate.data(), at.cols());
            }
            const double d = zero_distance(vertex_.packing, contacts_[l]);
            const Enclosure f = force(l);
            add_term(at, separation_weight(contacts_[l]), -f.value / d, (f.radius + force_changes_) / d);
        }
        for (const WallForce& wall : follows_ ? load_.wall_forces(vertex_.packing) : std::vector<WallForce>()) {
            const auto c = static_cast<std::size_t>(wall.coordinate);
            for (Eigen::Index i = 0; i < k; ++i) {
                at.row(i).setZero();
                at(i, 0) = motions_[static_cast<std::size_t>(i)].v[c];
            }
            const double part = -wall.stress * wall.length * wall.other / vertex_.packing.q[c];
            add_term(at, 1, part, 4 * strain_ * std::abs(part)); // clumps.md U8, what a load over a length changes by
        }
    }

    /// Adds `factor` times the products of these rows, of motions as they are known: each row changes by `weight` times
    /// what its motion does, and the factor by `open`.
    void add_term(const Eigen::MatrixXd& at, double weight, double factor, double open) {
        Eigen::VectorXd off(at.rows());
        for (Eigen::Index i = 0; i < at.rows(); ++i) {
            const HeldMotion& m = motions_[static_cast<std::size_t>(i)];
            // clumps.md U8, ten terms of a separation
            off(i) = weight * (velocity_error(m) + 16 * u * m.size) * up;
        }
        const Eigen::VectorXd size = at.rowwise().norm() * up;
        const Eigen::MatrixXd moved = (size + off) * (size + off).transpose();
        const Eigen::MatrixXd changed = size * off.transpose() + off * (size + off).transpose() + roundings_ * moved;
        form_ += factor * (at * at.transpose());
        error_ += (std::abs(factor) * changed + open * moved) * (up * up);
    }

    /// dc = - M^-1 dmu: what that leaves over the smallest eigenvalue (U10). At the minimum, which is within reach.
    void find_rates(HeldMinimum& minimum) const {
        double slopes = 0;
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            const Enclosure f = vertex_.statics.slope(ContactId(l));
            slopes += (std::abs(f.value) + f.radius) * (std::abs(f.value) + f.radius);
        }
        const double changes = change_of(std::sqrt(slopes) * up, norm_of(load_.unit_force(vertex_.packing)));
        Eigen::VectorXd multiplier(form_.rows());
        Eigen::VectorXd open(form_.rows());
        for (std::size_t i = 0; i < acting_.size(); ++i) {
            const Enclosure slope = vertex_.statics.slope(ContactId(acting_[i]));
            multiplier(static_cast<Eigen::Index>(i)) = slope.value;
            open(static_cast<Eigen::Index>(i)) = slope.radius + changes;
        }
        const Eigen::VectorXd rate = -form_.ldlt().solve(multiplier);
        // clumps.md U8, a product with k terms, and the multiplier
        const double roundings = static_cast<double>(form_.rows() + 4) * u;
        const Eigen::VectorXd size = form_.cwiseAbs() * rate.cwiseAbs() + multiplier.cwiseAbs();
        const Eigen::VectorXd rest =
            (form_ * rate + multiplier).cwiseAbs() + error_ * rate.cwiseAbs() + open + roundings * size;
        minimum.rate.assign(rate.begin(), rate.end());
        minimum.rate_bound = rest.norm() / minimum.curvature * up;
        for (std::size_t a = 0; a < vertex_.packing.axes(); ++a) {
            double value = 0;
            double bound = 0;
            for (std::size_t i = 0; i < motions_.size(); ++i) {
                const double v = motions_[i].v[vertex_.packing.length_at(a)];
                const double c = minimum.rate[i];
                const double off = velocity_error(motions_[i]);
                value += v * c;
                bound += (std::abs(v) + off) * minimum.rate_bound + (off + roundings * std::abs(v)) * std::abs(c);
            }
            minimum.length_rate[a] = {value, bound * up};
        }
    }

    /// Columns: velocities of the bodies in (X, Y, angle), X and Y of the mean of the centres of their members, less
    /// their mean along periodic axes, and of the walls or the cell; and the error of all columns together (Frobenius
    /// norm) where the configuration is within `moved` of the stored one (2-norm). The angle turns at arms x v /
    /// |arms|^2, an inversion of the arms. \pre the plane
    [[nodiscard]] std::pair<Eigen::MatrixXd, double> of_bodies(const std::vector<HeldMotion>& motions,
                                                               double moved) const {
        const Packing& packing = vertex_.packing;
        const Bodies bodies(packing);
        const int n = packing.disk_count();
        const auto rest = std::ssize(packing.q) - 2 * n;
        const auto at = [](const std::vector<double>& q, int i) {
            return Eigen::Map<const Eigen::RowVector2d>(&q[2 * static_cast<std::size_t>(i)]);
        };
        Eigen::MatrixX2d middle = Eigen::MatrixX2d::Zero(n, 2);
        Eigen::VectorXd members = Eigen::VectorXd::Zero(n); // of bodies, at their first members
        Eigen::VectorXd inertia = members;
        for (int i = 0; i < n; ++i) {
            middle.row(bodies.of(i)) += at(packing.q, i);
            ++members[bodies.of(i)];
        }
        Eigen::MatrixX2d arm(n, 2);
        for (int i = 0; i < n; ++i) {
            arm.row(i) = at(packing.q, i) - middle.row(bodies.of(i)) / members[bodies.of(i)];
            inertia[bodies.of(i)] += arm.row(i).squaredNorm();
        }
        const double shortest = std::sqrt((members.array() > 1).select(inertia.array(), roundoff::infinity).minCoeff());
        moved += roundings_ * Eigen::Map<const Eigen::VectorXd>(packing.q.data(), 2 * n).norm();
        Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(3 * n + rest, static_cast<Eigen::Index>(motions.size()));
        const Eigen::VectorXd is_body = (members.array() > 0).cast<double>();
        double off = 0;
        for (Eigen::Index c = 0; c < columns.cols(); ++c) {
            const HeldMotion& m = motions[static_cast<std::size_t>(c)];
            for (int i = 0; i < n; ++i) {
                const int body = bodies.of(i);
                const Eigen::Vector2d v = at(m.v, i).transpose();
                columns.col(c).segment<2>(3 * body) += v / members[body];
                if (members[body] > 1) {
                    columns(3 * body + 2, c) += (arm(i, 0) * v.y() - arm(i, 1) * v.x()) / inertia[body];
                }
            }
            columns.col(c).tail(rest) = Eigen::Map<const Eigen::VectorXd>(&m.v[2 * static_cast<std::size_t>(n)], rest);
            for (Eigen::Index a = 0; a < 2; ++a) {
                if (packing.cell.periodic[static_cast<std::size_t>(a)]) {
                    const auto along = columns.col(c)(Eigen::seqN(a, n, 3));
                    columns.col(c)(Eigen::seqN(a, n, 3)) -= is_body * (along.sum() / is_body.sum());
                }
            }
            const double e = velocity_error(m) + roundings_ * m.size;
            const double most =
                e * (1 + 1 / shortest) + (m.size + e) * moved / (shortest * std::max(shortest - moved, 0.0));
            off += most * most;
        }
        return {columns, std::sqrt(off) * up};
    }

    /// Eigenvalues of d2W on all mechanisms in (X, Y, angle), without the zeros of the free motions.
    void find_variation(HeldMinimum& minimum) const {
        std::vector<HeldMotion> motions;
        for (std::size_t l = 0; l < contacts_.size(); ++l) {
            if (contacts_[l].kind == ContactKind::held && !std::ranges::binary_search(acting_, l)) {
                motions.push_back(motion_of(vertex_, l));
            }
        }
        motions.insert(motions.end(), motions_.begin(), motions_.end());
        if (motions.size() > most_mechanisms || vertex_.packing.dimension != plane) {
            return;
        }
        const auto [columns, off] = of_bodies(motions, minimum.away);
        const Eigen::Index k = form_.rows();
        Eigen::MatrixXd form = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
        Eigen::MatrixXd error = form;
        form.bottomRightCorner(k, k) = form_;
        error.bottomRightCorner(k, k) = error_;
        const std::vector<Enclosure> all = eigenvalues(form, error, columns, off);
        if (std::ranges::all_of(all, [](const Enclosure& value) { return std::isfinite(value.radius); })) {
            minimum.second_variation.assign(all.end() - k, all.end());
        }
    }

    const Vertex& vertex_;
    const std::vector<Contact>& contacts_;
    const Load& load_;
    const std::vector<std::size_t>& acting_;
    bool follows_ = load_.kind == LoadKind::true_stress;
    double lipschitz_;
    ArcBodies arcs_;
    // clumps.md U8, a sum over N contacts
    double roundings_ = (static_cast<double>(contacts_.size()) + 32) * u; // relative, of sums over the contacts
    double force_size_;
    std::vector<HeldMotion> motions_;
    Eigen::MatrixXd form_, error_;
    double nearer_ = 0, way_ = 0, turned_ = 0, strain_ = 0, sigma_min_ = vertex_.inverse.sigma_min, force_changes_ = 0;
};

/// Where something that changes at a `rate`, a sum of `terms` in magnitude, is 0: counted in the direction of the
/// stress.
double way_to_zero(double value, double rate, double terms, int direction) {
    const double falls = -direction * rate;
    return falls > 0x1p-40 * terms ? value / falls : roundoff::infinity; // message: rates below it are roundings
}

/// Rates of the forces on such a motion at a fixed stress: H f' + H' f = F', where normals turn with the relative
/// velocity over the distance.
std::vector<double> turning_of(const Vertex& vertex, const Load& load, const std::vector<double>& velocity) {
    const auto& contacts = vertex.structure.contacts();
    std::vector<double> turning(contacts.size(), 0.0); // on degrees of freedom
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (!contacts[l].of_disks()) {
            continue;
        }
        const auto along = separation(vertex.packing.layout(), velocity, contacts[l]);
        const double times =
            vertex.statics.force(ContactId(l), load.loaded_stress()).value / zero_distance(vertex.packing, contacts[l]);
        Separation(contacts[l], vertex.packing.layout())
            .for_each_entry(vertex.structure.dofs(), along,
                            [&](int dof, double entry) { turning[static_cast<std::size_t>(dof)] -= times * entry; });
    }
    for (const WallForce& wall : load.wall_forces(vertex.packing)) { // true stresses follow the lengths
        const auto strain = [&](int at) {
            const auto c = static_cast<std::size_t>(at);
            return at < 0 ? 0 : velocity[c] / vertex.packing.q[c];
        };
        turning[static_cast<std::size_t>(vertex.structure.dofs().dof_of(static_cast<std::size_t>(wall.coordinate)))] -=
            wall.stress * wall.length * wall.other * (strain(wall.length_at) + strain(wall.other_at));
    }
    vertex.factorisation.solve_forces(turning);
    return turning;
}

std::vector<double> combined(const std::vector<HeldMotion>& motions, std::span<const double> shares) {
    std::vector<double> sum(motions.front().v.size(), 0.0);
    for (std::size_t i = 0; i < motions.size(); ++i) {
        for (std::size_t c = 0; c < sum.size(); ++c) {
            sum[c] += shares[i] * motions[i].v[c];
        }
    }
    return sum;
}

/// A value, its rate, and the sum of the terms of this rate in magnitude.
struct Flattening {
    double value = 0;
    double rate = 0;
    double terms = 0;
};

/// Of the least eigenvalue of the form of a minimum, while the configuration moves at `velocity` and the
/// forces change at `rates`: x^T M' x, M' from v' = - G^-1 of what the rows of the motion v change by.
Flattening flattening(const Vertex& vertex, const Load& load, const HeldMinimum& minimum,
                      const std::vector<HeldMotion>& motions, const std::vector<double>& velocity,
                      const std::vector<double>& rates) {
    const auto k = static_cast<Eigen::Index>(motions.size());
    Eigen::MatrixXd form(k, k);
    auto entry = minimum.form.begin();
    for (Eigen::Index i = 0; i < k; ++i) {
        for (Eigen::Index j = i; j < k; ++j, ++entry) {
            form(i, j) = form(j, i) = entry->lower + (entry->upper - entry->lower) / 2;
        }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(form);
    const std::vector<double> v = combined(motions, {solver.eigenvectors().data(), motions.size()}); // the first column
    const auto& contacts = vertex.structure.contacts();
    const auto& dofs = vertex.structure.dofs();
    const auto apart = [&](const std::vector<double>& rate, const Contact& contact) {
        const auto along = separation(vertex.packing.layout(), rate, contact);
        return Eigen::Vector3d(along[0], along[1], along[2]);
    };
    std::vector<double> turned(contacts.size(), 0.0);
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (contacts[l].of_disks()) {
            turned[l] =
                apart(velocity, contacts[l]).dot(apart(v, contacts[l])) / zero_distance(vertex.packing, contacts[l]);
        }
    }
    vertex.factorisation.solve_velocities(turned);
    const std::vector<double> changes = dofs.on_coordinates(turned); // of v
    Flattening least{solver.eigenvalues()(0)};
    const auto add = [&least](double term) {
        least.rate += term;
        least.terms += std::abs(term);
    };
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (contacts[l].of_disks()) {
            const Eigen::Vector3d of_v = apart(v, contacts[l]);
            const double d = zero_distance(vertex.packing, contacts[l]);
            add(-rates[l] * of_v.squaredNorm() / d);
            add(-2 * vertex.statics.force(ContactId(l), load.loaded_stress()).value *
                of_v.dot(apart(changes, contacts[l])) / d);
        }
    }
    return least;
}

} // namespace

double force_norm(const Vertex& vertex, double sigma) {
    double square = 0;
    for (int l = 0; l < vertex.structure.size(); ++l) {
        const Enclosure f = vertex.statics.force(ContactId(l), sigma);
        square += (std::abs(f.value) + f.radius) * (std::abs(f.value) + f.radius);
    }
    return std::sqrt(square) * up;
}

Yielding yielding_at(const Vertex& vertex, const Load& load, const std::vector<std::size_t>& acting,
                     const HeldMinimum& minimum, const std::vector<Contact>& candidates) {
    const double sigma = load.loaded_stress();
    const auto& contacts = vertex.structure.contacts();
    std::vector<HeldMotion> motions;
    for (const std::size_t slot : acting) {
        motions.push_back(motion_of(vertex, slot));
    }
    const std::vector<double> velocity = combined(motions, minimum.rate);
    const std::vector<double> turning = turning_of(vertex, load, velocity);
    std::vector<double> rates;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        rates.push_back(vertex.statics.slope(ContactId(l)).value + turning[l]);
    }
    Flattening least; // under true stresses the lengths have terms of their own: not asked
    if (load.kind != LoadKind::true_stress) {
        least = flattening(vertex, load, minimum, motions, velocity, rates);
    }
    Yielding yielding;
    yielding.length_rate = minimum.length_rate;
    yielding.second_variation = minimum.second_variation;
    for (const int direction : {-1, 1}) {
        Yielding::Event& event = direction < 0 ? yielding.down : yielding.up;
        double nearest = roundoff::infinity;
        const auto look = [&](const Contact& contact, bool opens, double value, double rate, double terms) {
            if (const double way = way_to_zero(value, rate, terms, direction); way < nearest) {
                nearest = way;
                event = {contact, opens, false, sigma + direction * way};
            }
        };
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (contacts[l].is_unilateral() && !vertex.statics.is_structural_zero(ContactId(l))) {
                look(contacts[l], true, vertex.statics.force(ContactId(l), sigma).value, rates[l],
                     std::abs(vertex.statics.slope(ContactId(l)).value) + std::abs(turning[l]));
            }
        }
        for (const Contact& pair : candidates) {
            const auto rate = gap_gradient(vertex.packing, pair).rate(velocity);
            look(pair, false, gap(vertex.packing, pair), rate.value, rate.terms);
        }
        if (const double way = way_to_zero(least.value, least.rate, least.terms, direction); way < nearest) {
            event = {Yielding::Event().contact, false, true, sigma + direction * way};
        }
    }
    return yielding;
}

Enclosure least_curvature(const Vertex& vertex, const Load& load, const std::vector<std::size_t>& slots) {
    return HeldForm(vertex, load, slots).least_curvature();
}

std::optional<HeldMinimum> minimum_near(const Vertex& vertex, const Load& load, const std::vector<std::size_t>& acting,
                                        double nearest, double off) {
    HeldForm form(vertex, load, acting);
    // 0x1p-39: choice: the first share that is tried; 0x1p3: choice: shares of the smallest radius that are tried, each
    // proved by itself
    for (double share = 0x1p-39; share < 1; share *= 0x1p3) { // on a shorter way the form changes less
        if (auto minimum = form.prove(share * vertex.packing.min_radius(), nearest, off)) {
            form.describe(*minimum);
            return minimum;
        }
    }
    return {};
}

} // namespace isostat
